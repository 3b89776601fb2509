//! Missing voxels: their values are not finite, or are the padding value of the file. They hold no material, but
//! reconstruction beside them needs densities, for which means of nearby voxels are substituted.

use rayon::prelude::*;

use crate::cancellation::{CancelToken, PIECE_VALUES};

/// Number of 64-bit words between two polls for cancellation.
const WORDS_PER_PIECE: usize = PIECE_VALUES / 64;

/// Set of the missing voxels of a grid, with their substitute values.
#[derive(Debug, Clone, PartialEq)]
pub struct MissingVoxels {
    dims: [usize; 3],
    /// Bit mask of missing voxels, x fastest.
    bits: Vec<u64>,
    count: usize,
    /// Mean of the present voxels in each block of 2³; if a block has none, that of the smallest enclosing larger
    /// block that has some.
    substitutes: Vec<f64>,
}

impl MissingVoxels {
    /// Scans all voxels of a grid, at least one of which must be present: `value` returns a voxel's value, or `None`
    /// if it is missing. Returns `None` if no voxel is missing.
    pub(super) fn find(dims: [usize; 3], value: impl Fn(usize) -> Option<f64> + Sync) -> Option<Self> {
        let voxels = dims.iter().product::<usize>();
        let interrupt = CancelToken::current();
        let bits: Vec<u64> = (0..voxels.div_ceil(64))
            .into_par_iter()
            .map(|word| {
                if word.is_multiple_of(WORDS_PER_PIECE) && interrupt.should_stop() {
                    return 0;
                }
                let places = word * 64..((word + 1) * 64).min(voxels);
                places.filter(|&voxel| value(voxel).is_none()).fold(0, |bits, voxel| bits | 1 << (voxel % 64))
            })
            .collect();
        let count = bits.par_iter().map(|word| word.count_ones() as usize).sum();
        (count > 0).then(|| Self {
            dims,
            count,
            substitutes: fill_missing_means(block_means(dims, value), halved_dims(dims)),
            bits,
        })
    }

    /// Returns the number of missing voxels.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns true if the voxel at an index, x fastest, is missing.
    pub fn contains(&self, voxel: usize) -> bool {
        self.bits[voxel / 64] >> (voxel % 64) & 1 == 1
    }

    /// Iterates over the missing voxels of slice `z`: indices within the slice, x fastest, and substitute values.
    pub(super) fn substitutes_in_slice(&self, z: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let [nx, ny, _] = self.dims;
        let [width, height, _] = halved_dims(self.dims);
        let first = z * nx * ny;
        (0..nx * ny).filter(move |at| self.contains(first + at)).map(move |at| {
            let block = at % nx / 2 + width * (at / nx / 2 + height * (z / 2));
            (at, self.substitutes[block])
        })
    }
}

/// Returns the number of blocks of two voxels along each axis.
fn halved_dims(dims: [usize; 3]) -> [usize; 3] {
    dims.map(|n| n.div_ceil(2))
}

/// Returns the mean of the present voxels in each block of 2³; NaN for blocks without any.
fn block_means(dims: [usize; 3], value: impl Fn(usize) -> Option<f64> + Sync) -> Vec<f64> {
    let [width, height, depth] = halved_dims(dims);
    let [nx, ny, nz] = dims;
    let mean = |block: usize| {
        let [x, y, z] = [block % width, block / width % height, block / (width * height)].map(|c| 2 * c);
        let (mut sum, mut count) = (0.0, 0u32);
        for z in z..(z + 2).min(nz) {
            for y in y..(y + 2).min(ny) {
                for x in x..(x + 2).min(nx) {
                    if let Some(value) = value(x + nx * (y + ny * z)) {
                        sum += value;
                        count += 1;
                    }
                }
            }
        }
        // 0 / 0 is NaN, for blocks without any.
        sum / f64::from(count)
    };
    (0..width * height * depth).into_par_iter().map(mean).collect()
}

/// Replaces NaN in a grid by the means of larger blocks, recursively.
fn fill_missing_means(mut values: Vec<f64>, dims: [usize; 3]) -> Vec<f64> {
    if values.len() == 1 || !values.iter().any(|value| value.is_nan()) {
        return values;
    }
    let there = |voxel: usize| Some(values[voxel]).filter(|value| !value.is_nan());
    let coarser = halved_dims(dims);
    let means = fill_missing_means(block_means(dims, there), coarser);
    values.par_iter_mut().enumerate().filter(|(_, value)| value.is_nan()).for_each(|(at, value)| {
        let [x, y, z] = [at % dims[0], at / dims[0] % dims[1], at / (dims[0] * dims[1])].map(|c| c / 2);
        *value = means[x + coarser[0] * (y + coarser[1] * z)];
    });
    values
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::{Samples, ValueRange, Volume, VolumeError};

    #[test]
    fn missing_voxels_get_means_of_nearby_ones() {
        // Of 5 × 4 × 3 voxels with their own numbers, these are missing.
        let dims = [5, 4, 3];
        let lost = [0, 6, 19, 59, 58];
        let missing =
            MissingVoxels::find(dims, |voxel| (!lost.contains(&voxel)).then_some(voxel as f64)).unwrap();
        assert_eq!(missing.count(), 5);
        assert!((0..60).all(|voxel| missing.contains(voxel) == lost.contains(&voxel)));
        // Voxels 1, 5, 20, 21, 25 and 26 remain in the block of 0 and 6.
        let mean = (1.0 + 5.0 + 20.0 + 21.0 + 25.0 + 26.0) / 6.0;
        let near = |found: f64, wanted: f64| (found - wanted).abs() < 1e-5;
        let first: Vec<_> = missing.substitutes_in_slice(0).collect();
        assert_eq!(first.iter().map(|(at, _)| *at).collect::<Vec<_>>(), [0, 6, 19]);
        assert!(near(first[0].1, mean) && near(first[1].1, mean), "{first:?}");
        assert_eq!(missing.substitutes_in_slice(1).count(), 0);
        // The last block is one voxel wide and deep: voxel 54 remains in it.
        let last: Vec<_> = missing.substitutes_in_slice(2).collect();
        assert!(near(last[1].1, 54.0), "{last:?}");
    }

    #[test]
    fn larger_blocks_stand_in_where_all_is_missing() {
        let dims = [16, 16, 16];
        let value = |voxel: usize| (voxel % 16 >= 12).then_some(3.0);
        let missing = MissingVoxels::find(dims, value).unwrap();
        assert_eq!(missing.count(), 12 * 256);
        assert!((0..16).all(|z| missing.substitutes_in_slice(z).all(|(_, value)| value == 3.0)));
        assert_eq!(MissingVoxels::find(dims, |_| Some(1.0)), None);
    }

    #[test]
    fn padding_is_no_value() {
        let volume = |padding: Option<f64>| {
            let samples = Samples::I16(vec![-3024, -1000, 0, 1000, -3024, 40, 50, 60]);
            let volume = Volume::with_spacing("t", [4, 2, 1], DVec3::ONE, samples).unwrap();
            padding.map_or(Ok(volume.clone()), |value| volume.with_padding(value))
        };
        let padded = volume(Some(-3024.0)).unwrap();
        assert_eq!(padded.value_range(), ValueRange::new(-1000.0, 1000.0));
        assert_eq!(padded.missing().map(MissingVoxels::count), Some(2));
        assert_eq!(padded.value(0, 0, 0), -3024.0, "what the file says");
        // The mean of −1000 and 40 is substituted for both.
        assert_eq!(padded.slice_densities(0)[0], 0.26);
        assert_eq!(padded.non_finite_voxels(), 0);
        assert_ne!(padded.content_id(), volume(None).unwrap().content_id());
        assert_eq!(volume(Some(7.0)).unwrap().missing(), None);
        let tenths = Samples::F32(vec![0.1, 0.2, 0.3]);
        let tenths =
            Volume::with_spacing("t", [3, 1, 1], DVec3::ONE, tenths).unwrap().with_padding(0.1).unwrap();
        assert_eq!(tenths.missing().map(MissingVoxels::count), Some(1));
        let all = Volume::with_spacing("t", [1; 3], DVec3::ONE, Samples::U8(vec![3])).unwrap();
        assert!(matches!(all.with_padding(3.0), Err(VolumeError::NothingFinite)));
    }
}
