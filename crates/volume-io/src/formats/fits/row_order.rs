//! Row order of FITS images: files store the lowest row first, volumes store the top row first.

use glam::{DAffine3, DMat3, DVec3};

use chiaroscuro_volume::{ResolvedPortion, Samples, with_samples};

/// Converts the kept part of a grid whose rows are counted from the top to the row order of the file, counted from
/// the bottom: the same rows, in reverse. Not valid for block averages, as the last block may be smaller.
pub(super) fn kept_in_file_order(kept: ResolvedPortion) -> ResolvedPortion {
    let [_, rows, _] = kept.dims();
    let lowest = kept.low[1] + rows.saturating_sub(1) * kept.stride[1];
    let (mut low, mut high, mut step) = (kept.low, kept.high, kept.stride);
    low[1] = kept.grid[1] - 1 - lowest;
    high[1] = kept.grid[1] - kept.low[1];
    step[1] = step[1].min(high[1] - low[1]);
    ResolvedPortion { low, high, stride: step, ..kept }
}

/// Reverses the order of the rows of each slice.
pub(super) fn reverse_rows(samples: &mut Samples, [nx, ny, _]: [usize; 3]) {
    with_samples!(samples, values => {
        for slice in values.chunks_exact_mut(nx * ny) {
            for row in 0..ny / 2 {
                let (above, below) = slice.split_at_mut((ny - 1 - row) * nx);
                above[row * nx..(row + 1) * nx].swap_with_slice(&mut below[..nx]);
            }
        }
    });
}

/// Returns the affine from grid indices, with `rows` rows counted from the top, to the indices of the file.
pub(super) fn file_from_index(rows: u64) -> DAffine3 {
    let matrix3 = DMat3::from_diagonal(DVec3::new(1.0, -1.0, 1.0));
    DAffine3 { matrix3, translation: DVec3::new(0.0, rows as f64 - 1.0, 0.0) }
}
