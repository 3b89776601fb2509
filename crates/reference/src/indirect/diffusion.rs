//! Diffusion of scattered light, −∇·(D ∇f) + (σ − ς) f = q, in one colour: one multigrid cycle over grids that
//! halve along each axis, with relaxation of every other block.

use glam::DVec3;

/// Optical depth of the grid's longest edge that extinction has at least.
const MIN_DEPTH: f64 = 3.0;
/// Second differences that the interpolation of sweeps adds: t(1 − t)/2 twice, in the mean over t, for two axes of
/// three.
const SPREAD: f64 = 0.111;
/// Maximum number of blocks along each axis of the coarsest grid.
const COARSEST_EDGE: usize = 4;
/// Number of relaxations of the coarsest grid.
const COARSEST_RELAXATIONS: usize = 8;

/// Grid of blocks with conductances between neighbours.
#[derive(Debug)]
pub(super) struct DiffusionGrid {
    dims: [usize; 3],
    /// Conductance to the next block along each axis, 0 at the last.
    faces: [Vec<f64>; 3],
    /// Conductance to nowhere: what is absorbed or leaves the grid.
    sink: Vec<f64>,
    coarser: Option<Box<Self>>,
}

/// Returns the coordinates of a block.
fn block_at(dims: [usize; 3], at: usize) -> [usize; 3] {
    [at % dims[0], at / dims[0] % dims[1], at / (dims[0] * dims[1])]
}

/// Returns the index of a block.
fn index_of(dims: [usize; 3], [x, y, z]: [usize; 3]) -> usize {
    (z * dims[1] + y) * dims[0] + x
}

impl DiffusionGrid {
    /// Creates the grid and its coarser ones from optical depths of extinction and scattering per shortest edge of a
    /// voxel, for blocks with these edges.
    pub(super) fn new(dims: [usize; 3], edges: DVec3, extinction: &[f64], scattering: &[f64]) -> Self {
        let longest = (edges * DVec3::from(dims.map(|n| n as f64))).max_element();
        let coefficient = |sigma: f64, edge: f64| {
            let sigma = sigma.max(MIN_DEPTH / longest);
            let half = 0.5 * sigma * edge;
            half / half.tanh() / (3.0 * sigma) + SPREAD * sigma * edge * edge
        };
        let count = extinction.len();
        let mut sink: Vec<f64> =
            extinction.iter().zip(scattering).map(|(all, part)| (all - part).max(0.0)).collect();
        let faces = std::array::from_fn(|axis| {
            let edge = edges[axis];
            let mut faces = vec![0.0; count];
            for (at, &own) in extinction.iter().enumerate() {
                let block = block_at(dims, at);
                let borders = [block[axis] == 0, block[axis] + 1 == dims[axis]];
                // Marshak's condition: half a block, and then half of all directions.
                let outward = 1.0 / (edge * (0.5 * edge / coefficient(own, edge) + 2.0));
                sink[at] += outward * borders.map(|is| f64::from(u8::from(is))).iter().sum::<f64>();
                if !borders[1] {
                    let mut next = block;
                    next[axis] += 1;
                    let mean = 0.5 * (own + extinction[index_of(dims, next)]);
                    faces[at] = coefficient(mean, edge) / (edge * edge);
                }
            }
            faces
        });
        Self::with_coarser(dims, faces, sink)
    }

    fn with_coarser(dims: [usize; 3], faces: [Vec<f64>; 3], sink: Vec<f64>) -> Self {
        let coarser = dims.iter().any(|&n| n > COARSEST_EDGE).then(|| {
            let halved = dims.map(|n| n.div_ceil(2));
            let mut merged = Self {
                dims: halved,
                faces: [(); 3].map(|()| vec![0.0; halved.iter().product()]),
                sink: vec![0.0; halved.iter().product()],
                coarser: None,
            };
            for (at, sink) in sink.iter().enumerate() {
                let block = block_at(dims, at);
                let into = index_of(halved, block.map(|n| n / 2));
                merged.sink[into] += sink / 8.0;
                for axis in 0..3 {
                    if block[axis] % 2 == 1 {
                        merged.faces[axis][into] += faces[axis][at] / 16.0;
                    }
                }
            }
            Box::new(Self::with_coarser(halved, merged.faces, merged.sink))
        });
        Self { dims, faces, sink, coarser }
    }

    /// Returns the solution after one cycle.
    pub(super) fn solve(&self, right: &[f64]) -> Vec<f64> {
        let mut found = vec![0.0; right.len()];
        let Some(coarser) = &self.coarser else {
            for _ in 0..COARSEST_RELAXATIONS {
                self.relax(&mut found, right, 0);
                self.relax(&mut found, right, 1);
            }
            return found;
        };
        self.relax(&mut found, right, 0);
        self.relax(&mut found, right, 1);
        let mut residual = vec![0.0; coarser.sink.len()];
        for (at, right) in right.iter().enumerate() {
            let (inflow, conductance) = self.balance(&found, at);
            residual[self.merged_into(coarser, at)] += (right + inflow - conductance * found[at]) / 8.0;
        }
        let correction = coarser.solve(&residual);
        for (at, found) in found.iter_mut().enumerate() {
            *found += correction[self.merged_into(coarser, at)];
        }
        for parity in [1, 0, 1, 0] {
            self.relax(&mut found, right, parity);
        }
        found
    }

    fn merged_into(&self, coarser: &Self, at: usize) -> usize {
        index_of(coarser.dims, block_at(self.dims, at).map(|n| n / 2))
    }

    /// Returns the flow into a block from its neighbours, and the sum of its conductances.
    fn balance(&self, found: &[f64], at: usize) -> (f64, f64) {
        let block = block_at(self.dims, at);
        let (mut inflow, mut conductance) = (0.0, self.sink[at]);
        for axis in 0..3 {
            for is_next in [false, true] {
                let mut other = block;
                if is_next {
                    other[axis] += 1;
                } else if let Some(before) = block[axis].checked_sub(1) {
                    other[axis] = before;
                } else {
                    continue;
                }
                if other[axis] < self.dims[axis] {
                    let other = index_of(self.dims, other);
                    let face = self.faces[axis][at.min(other)];
                    inflow += face * found[other];
                    conductance += face;
                }
            }
        }
        (inflow, conductance)
    }

    /// Balances all blocks whose coordinates have a sum of this parity.
    fn relax(&self, found: &mut [f64], right: &[f64], parity: usize) {
        for (at, right) in right.iter().enumerate() {
            if block_at(self.dims, at).iter().sum::<usize>() % 2 == parity {
                let (inflow, conductance) = self.balance(found, at);
                found[at] = (right + inflow) / conductance;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Grid of even material without absorption.
    fn grid(dims: [usize; 3], sigma: f64) -> DiffusionGrid {
        let even = vec![sigma; dims.iter().product()];
        DiffusionGrid::new(dims, DVec3::ONE, &even, &even)
    }

    #[test]
    fn repeated_cycles_balance_every_block() {
        for dims in [[9, 12, 7], [16, 16, 16], [3, 4, 2], [1, 1, 20]] {
            let grid = grid(dims, 1.5);
            let right: Vec<f64> = (0..dims.iter().product()).map(|at| (at as f64).sin() + 1.0).collect();
            let mut found = vec![0.0; right.len()];
            let mut left = right.clone();
            for _ in 0..12 {
                let more = grid.solve(&left);
                found.iter_mut().zip(more).for_each(|(found, more)| *found += more);
                for (at, left) in left.iter_mut().enumerate() {
                    let (inflow, conductance) = grid.balance(&found, at);
                    *left = right[at] + inflow - conductance * found[at];
                }
            }
            let most = left.iter().fold(0.0_f64, |most, left| most.max(left.abs()));
            assert!(most < 1e-3, "{dims:?}: {most} of 2 is left");
        }
    }

    /// Even sources q between two borders at a distance L: f = q L/2 (2 + L/4D) in the middle; four sides are so far
    /// that they do not count.
    #[test]
    fn a_slab_has_the_profile_of_the_closed_form() {
        let dims = [160, 160, 16];
        let grid = grid(dims, 2.0);
        let right = vec![1.0; dims.iter().product()];
        let mut found = vec![0.0; right.len()];
        for _ in 0..8 {
            let left: Vec<f64> = (0..right.len())
                .map(|at| {
                    let (inflow, conductance) = grid.balance(&found, at);
                    right[at] + inflow - conductance * found[at]
                })
                .collect();
            found.iter_mut().zip(grid.solve(&left)).for_each(|(found, more)| *found += more);
        }
        let coefficient = 1.0 / 1.0_f64.tanh() / 6.0 + 0.222;
        let length = 16.0;
        let middle = found[index_of(dims, [80, 80, 8])];
        let expected = 0.5 * length * (2.0 + 0.25 * length / coefficient);
        assert!((middle / expected - 1.0).abs() < 0.02, "{middle} {expected}");
    }
}
