//! Voxels on the faces of a grid.

/// Returns the indices of the voxels of one of the six faces of a grid: at the start and at the end of x, of y and of z.
/// A face with edges longer than `max_per_edge` is subsampled evenly, to at most that many voxels along each edge.
pub(crate) fn face_voxels(dims: [usize; 3], face: usize, max_per_edge: usize) -> impl Iterator<Item = usize> {
    let strides = [1, dims[0], dims[0] * dims[1]];
    let (axis, is_last) = (face / 2, face % 2 == 1);
    let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    let first = if is_last { (dims[axis] - 1) * strides[axis] } else { 0 };
    let places = move |axis: usize| (0..dims[axis]).step_by(dims[axis].div_ceil(max_per_edge));
    places(u).flat_map(move |i| places(v).map(move |j| first + i * strides[u] + j * strides[v]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_have_the_voxels_at_either_end_of_an_axis() {
        let dims = [3, 4, 5];
        for face in 0..6 {
            let mut found: Vec<usize> = face_voxels(dims, face, 5).collect();
            found.sort_unstable();
            let end = if face % 2 == 1 { dims[face / 2] - 1 } else { 0 };
            let place = |at: usize| [at % 3, at / 3 % 4, at / 12];
            let right: Vec<usize> = (0..60).filter(|&at| place(at)[face / 2] == end).collect();
            assert_eq!(found, right, "{face}");
        }
        assert_eq!(face_voxels(dims, 4, 2).collect::<Vec<_>>(), [0, 6, 2, 8]);
    }
}
