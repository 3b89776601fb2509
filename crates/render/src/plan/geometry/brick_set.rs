//! Sets of bricks, with dilation and distance transform.
//!
//! Distances are Chebyshev's (the largest of the three coordinate differences), so that everything nearer than a
//! brick's distance is a cube of empty bricks that a ray can leave in one step.

/// Set of bricks of a grid.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BrickSet {
    /// Number of bricks along x, y, z.
    pub dims: [usize; 3],
    /// Membership flag of each brick, x fastest.
    pub members: Vec<bool>,
}

impl BrickSet {
    /// Creates a set from the membership flags.
    pub fn new(dims: [usize; 3], members: Vec<bool>) -> Self {
        debug_assert_eq!(members.len(), dims.iter().product::<usize>());
        Self { dims, members }
    }

    /// Creates the set of all bricks.
    pub fn full(dims: [usize; 3]) -> Self {
        Self::new(dims, vec![true; dims.iter().product()])
    }

    /// Returns the union of two sets on the same grid.
    pub fn union(&self, other: &Self) -> Self {
        let members = self.members.iter().zip(&other.members).map(|(a, b)| *a || *b).collect();
        Self::new(self.dims, members)
    }

    /// Returns the difference of two sets on the same grid: members of this one that are not in the other.
    pub fn difference(&self, other: &Self) -> Self {
        let members = self.members.iter().zip(&other.members).map(|(a, b)| *a && !*b).collect();
        Self::new(self.dims, members)
    }

    /// Returns true if this set is a subset of the other, on the same grid.
    pub fn is_subset(&self, other: &Self) -> bool {
        self.dims == other.dims && self.members.iter().zip(&other.members).all(|(a, b)| !*a || *b)
    }

    /// Returns the set dilated by `reach` bricks.
    pub fn dilated(&self, reach: usize) -> Self {
        let near = self.distances().into_iter().map(|distance| usize::from(distance) <= reach).collect();
        Self::new(self.dims, near)
    }

    /// Returns the set on a grid with bricks `factor` times as large: a coarse brick is a member if any of its bricks
    /// is.
    pub fn coarsened(&self, factor: usize, dims: [usize; 3]) -> Self {
        let mut coarse = Self::new(dims, vec![false; dims.iter().product()]);
        for (at, _) in self.members.iter().enumerate().filter(|(_, member)| **member) {
            let [x, y, z] = self.position(at).map(|c| c / factor);
            let at = coarse.at(x.min(dims[0] - 1), y.min(dims[1] - 1), z.min(dims[2] - 1));
            coarse.members[at] = true;
        }
        coarse
    }

    /// Returns the bricks inside the coarse bricks of this set, the reverse of [`Self::coarsened`].
    pub fn refined(&self, factor: usize, dims: [usize; 3]) -> Self {
        let mut fine = Self::new(dims, vec![false; dims.iter().product()]);
        for at in 0..fine.members.len() {
            let [x, y, z] = fine.position(at).map(|c| c / factor);
            let inside = x < self.dims[0] && y < self.dims[1] && z < self.dims[2];
            fine.members[at] = inside && self.members[self.at(x, y, z)];
        }
        fine
    }

    /// Iterates over the coordinates of the members.
    pub fn positions(&self) -> impl Iterator<Item = [usize; 3]> + '_ {
        self.positions_in_rows(|_| true)
    }

    /// Iterates over the coordinates of the members in those rows along x that are wanted, by their y and z.
    pub fn positions_in_rows(
        &self,
        is_wanted: impl Fn([usize; 2]) -> bool,
    ) -> impl Iterator<Item = [usize; 3]> {
        let [nx, ny, _] = self.dims;
        let rows = self.members.chunks(nx.max(1)).enumerate();
        rows.filter(move |(row, _)| is_wanted([row % ny, row / ny])).flat_map(move |(row, members)| {
            let members = members.iter().enumerate().filter(|(_, member)| **member);
            members.map(move |(x, _)| [x, row % ny, row / ny])
        })
    }

    /// Returns the distance of every brick to the nearest member, limited to 255; 0 for members.
    pub fn distances(&self) -> Vec<u8> {
        let mut distances: Vec<u8> =
            self.members.iter().map(|&member| if member { 0 } else { 255 }).collect();
        // Chebyshev's distance separates by axis: the distance over three axes is the minimum over the third axis of
        // max(distance over the first two, step); a forward and a backward sweep per axis find it.
        let [nx, ny, nz] = self.dims;
        for (stride, length) in [(1, nx), (nx, ny), (nx * ny, nz)] {
            for start in 0..distances.len() {
                if start / stride % length == 0 {
                    distance_transform_line(&mut distances, start, stride, length);
                }
            }
        }
        distances
    }

    fn at(&self, x: usize, y: usize, z: usize) -> usize {
        x + self.dims[0] * (y + self.dims[1] * z)
    }

    fn position(&self, at: usize) -> [usize; 3] {
        [at % self.dims[0], at / self.dims[0] % self.dims[1], at / self.dims[0] / self.dims[1]]
    }
}

/// Transforms one line of the separable Chebyshev distance: `out[i]` = min over j of max(`in[j]`, |i − j|).
fn distance_transform_line(distances: &mut [u8], start: usize, stride: usize, length: usize) {
    let line: Vec<u8> = (0..length).map(|i| distances[start + i * stride]).collect();
    if line.iter().all(|&d| d == 255) || line.iter().all(|&d| d == 0) {
        return;
    }
    for i in 0..length {
        let mut best = line[i];
        // Elements further away than the best distance so far cannot improve it.
        let mut step = 1;
        while step < usize::from(best) && (step <= i || i + step < length) {
            let left = if step <= i { line[i - step] } else { 255 };
            let right = if i + step < length { line[i + step] } else { 255 };
            best = best.min(left.min(right).max(step as u8));
            step += 1;
        }
        distances[start + i * stride] = best;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(dims: [usize; 3], members: &[[usize; 3]]) -> BrickSet {
        let mut set = BrickSet::new(dims, vec![false; dims.iter().product()]);
        for &[x, y, z] in members {
            let at = set.at(x, y, z);
            set.members[at] = true;
        }
        set
    }

    #[test]
    fn distances_are_chebyshevs() {
        let members = [[1, 1, 0], [6, 3, 4], [0, 7, 2]];
        let set = set([8, 9, 5], &members);
        for (at, distance) in set.distances().into_iter().enumerate() {
            let p = set.position(at);
            let expected =
                members.iter().map(|m| (0..3).map(|a| m[a].abs_diff(p[a])).max().unwrap()).min().unwrap();
            assert_eq!(usize::from(distance), expected, "at {p:?}");
        }
    }

    #[test]
    fn an_empty_set_is_far_from_everything() {
        assert!(set([3, 3, 3], &[]).distances().iter().all(|&distance| distance == 255));
    }

    #[test]
    fn dilation_coarsening_and_refining() {
        let fine = set([5, 5, 5], &[[4, 0, 0]]);
        assert_eq!(fine.dilated(1).positions().count(), 2 * 2 * 2);
        let coarse = fine.coarsened(2, [3, 3, 3]);
        assert_eq!(coarse.positions().collect::<Vec<_>>(), [[2, 0, 0]]);
        assert!(fine.is_subset(&coarse.refined(2, [5, 5, 5])));
        assert!(!coarse.refined(2, [5, 5, 5]).is_subset(&fine));
        assert_eq!(fine.dilated(1).difference(&fine).positions().count(), 7);
    }
}
