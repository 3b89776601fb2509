//! Downsampling of volumes by block averages, for adapters that cannot hold all voxels.

use glam::{DAffine3, DMat3, DVec3};
use rayon::prelude::*;

use super::{Samples, Volume, VolumeError};
use crate::cancellation::{CancelToken, PIECE_VALUES};

impl Volume {
    /// Averages blocks of the given numbers of voxels along x, y and z to one voxel each: same position in world
    /// space, same number type (means are rounded), at least one voxel along each axis. The last block of an axis may
    /// have fewer voxels; non-finite values and padding are excluded from means. Label maps, whose numbers have no
    /// mean, get the most frequent label of each block.
    ///
    /// # Errors
    /// Fails like [`Volume::new`].
    pub fn block_averaged(self, block: [usize; 3]) -> Result<Self, VolumeError> {
        let dims = self.dims();
        let block = [0, 1, 2].map(|axis| block[axis].clamp(1, dims[axis]));
        if block == [1; 3] { Ok(self) } else { self.to_block_averaged(block) }
    }

    /// Does the averaging of [`Self::block_averaged`] without consuming the volume.
    ///
    /// # Errors
    /// Fails like [`Volume::new`].
    pub fn to_block_averaged(&self, block: [usize; 3]) -> Result<Self, VolumeError> {
        let dims = self.dims();
        let block = [0, 1, 2].map(|axis| block[axis].clamp(1, dims[axis]));
        let padding = self.padding_value();
        let samples = BlockPartition { dims, block, padding }.average(self.samples(), self.is_label_map());
        // The centre of a block is that of its voxels: for two voxels, index 0.5.
        let edges = DVec3::from(block.map(|n| n as f64));
        let index_from_block =
            DAffine3 { matrix3: DMat3::from_diagonal(edges), translation: 0.5 * (edges - 1.0) };
        let geometry = self.world_from_index() * index_from_block;
        let reduced = Self::new(self.name(), block_counts(dims, block), geometry, samples)?;
        let reduced = match padding {
            Some(padding) => reduced.with_padding(padding)?,
            None => reduced,
        };
        let reduced = match self.hidden_table() {
            // If all blocks lie in it, their values are shown.
            Some(table) => reduced.clone().without_known_table(table.in_blocks(block)).unwrap_or(reduced),
            None => reduced,
        };
        let reduced = reduced.with_metadata_of(self);
        Ok(Self { grid: reduced.grid.with_blocks_of(&self.grid, block, 0.5 * (edges - 1.0)), ..reduced })
    }
}

/// Returns the number of blocks along each axis.
pub fn block_counts(dims: [usize; 3], block: [usize; 3]) -> [usize; 3] {
    [0, 1, 2].map(|axis| dims[axis].div_ceil(block[axis]))
}

/// Partition of a grid into blocks of voxels to be averaged.
#[derive(Debug, Clone, Copy)]
pub struct BlockPartition {
    /// Voxels of the grid along x, y, z.
    pub dims: [usize; 3],
    /// Voxels of a block along x, y, z, none of them 0.
    pub block: [usize; 3],
    /// Padding value that is excluded from means.
    pub padding: Option<f64>,
}

impl BlockPartition {
    /// Returns the mean of each block in the same number type; for labels the most frequent one.
    pub fn average(&self, samples: &Samples, are_labels: bool) -> Samples {
        match samples {
            samples if are_labels => self.most_frequent(samples),
            Samples::U8(values) => Samples::U8(self.integer_means(values, |mean| mean as u8)),
            Samples::I8(values) => Samples::I8(self.integer_means(values, |mean| mean as i8)),
            Samples::U16(values) => Samples::U16(self.integer_means(values, |mean| mean as u16)),
            Samples::I16(values) => Samples::I16(self.integer_means(values, |mean| mean as i16)),
            Samples::U32(values) => Samples::U32(self.integer_means(values, |mean| mean as u32)),
            Samples::I32(values) => Samples::I32(self.integer_means(values, |mean| mean as i32)),
            Samples::F32(values) => Samples::F32(self.means(values, |mean| mean as f32, |mean| mean)),
            Samples::F64(values) => Samples::F64(self.means(values, |mean| mean, |mean| mean)),
        }
    }

    /// Returns the first voxel of each block.
    pub fn first_voxels(&self, samples: &Samples) -> Samples {
        let [nx, ny, nz] = self.dims;
        let [sx, sy, sz] = self.block;
        let rows = (0..nz).step_by(sz).flat_map(|z| (0..ny).step_by(sy).map(move |y| (z * ny + y) * nx));
        let firsts: Vec<usize> = rows.flat_map(|row| (row..row + nx).step_by(sx)).collect();
        samples.gather(&firsts)
    }

    /// Returns the rounded mean of each block. A mean that equals the padding value by chance is moved to the next
    /// integer, so that the block does not become missing.
    fn integer_means<T: Copy + Into<f64> + Sync, R: Send>(
        &self,
        values: &[T],
        number: impl Fn(f64) -> R + Sync,
    ) -> Vec<R> {
        self.means(values, number, |mean| {
            let whole = mean.round();
            let beside = if mean < whole { whole - 1.0 } else { whole + 1.0 };
            if Some(whole) == self.padding { beside } else { whole }
        })
    }

    /// Returns the most frequent value of each block, the lowest of equally frequent ones; blocks without finite
    /// values get the padding value, or NaN.
    fn most_frequent(&self, samples: &Samples) -> Samples {
        let chosen = self.most_frequent_voxels(|voxel| samples.value(voxel));
        samples.gather(&chosen)
    }

    /// Returns for each block the index of a voxel with its most frequent value.
    fn most_frequent_voxels(&self, value: impl Fn(usize) -> f64 + Sync) -> Vec<usize> {
        let &Self { dims, block, padding } = self;
        let [nx, ny, _] = dims;
        let [width, height, depth] = block_counts(dims, block);
        let interrupt = CancelToken::current();
        let choose = |at: usize| {
            // After cancellation any voxel will do, as the result is discarded.
            if at.is_multiple_of(PIECE_VALUES) && interrupt.should_stop() {
                return 0;
            }
            let low = [at % width, at / width % height, at / (width * height)];
            let [xs, ys, zs] = [0, 1, 2]
                .map(|axis| low[axis] * block[axis]..((low[axis] + 1) * block[axis]).min(dims[axis]));
            // A list is searched, as a block has only a few different labels.
            let mut counted: Vec<(f64, usize, usize)> = Vec::new();
            for z in zs.clone() {
                for y in ys.clone() {
                    for voxel in (z * ny + y) * nx + xs.start..(z * ny + y) * nx + xs.end {
                        let found = value(voxel);
                        match counted.iter_mut().find(|(known, ..)| *known == found) {
                            Some((_, count, _)) => *count += 1,
                            None => counted.push((found, 1, voxel)),
                        }
                    }
                }
            }
            let is_something = |value: f64| value.is_finite() && Some(value) != padding;
            counted
                .iter()
                .max_by(|(a, m, _), (b, n, _)| {
                    is_something(*a).cmp(&is_something(*b)).then(m.cmp(n)).then(b.total_cmp(a))
                })
                .map_or((zs.start * ny + ys.start) * nx + xs.start, |&(.., voxel)| voxel)
        };
        (0..width * height * depth).into_par_iter().map(choose).collect()
    }

    /// Returns the mean of each block after `round`; blocks without finite values get the padding value, or NaN.
    fn means<T: Copy + Into<f64> + Sync, R: Send>(
        &self,
        values: &[T],
        number: impl Fn(f64) -> R + Sync,
        round: impl Fn(f64) -> f64 + Sync,
    ) -> Vec<R> {
        let &Self { dims, block, padding } = self;
        let [nx, ny, nz] = dims;
        let [width, height, depth] = block_counts(dims, block);
        let interrupt = CancelToken::current();
        let slice = |k: usize| {
            let (mut sums, mut counts) = (vec![0.0; width * height], vec![0u32; width * height]);
            for z in (k * block[2]..nz.min((k + 1) * block[2])).take_while(|_| !interrupt.should_stop()) {
                for y in 0..ny {
                    let row = &values[(z * ny + y) * nx..][..nx];
                    let first = y / block[1] * width;
                    let blocks = sums[first..].iter_mut().zip(&mut counts[first..]);
                    for (voxels, (sum, count)) in row.chunks(block[0]).zip(blocks) {
                        let values = voxels.iter().map(|&value| value.into());
                        for value in values.filter(|value| value.is_finite() && Some(*value) != padding) {
                            *sum += value;
                            *count += 1;
                        }
                    }
                }
            }
            let mean = |(sum, count): (f64, u32)| {
                number(if count == 0 { padding.unwrap_or(f64::NAN) } else { round(sum / f64::from(count)) })
            };
            sums.into_iter().zip(counts).map(mean).collect::<Vec<_>>()
        };
        (0..depth).into_par_iter().flat_map_iter(slice).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DataKind, MissingVoxels, ValueMeaning, ValueMetadata};

    #[test]
    fn blocks_become_their_means_where_they_were() {
        let values = (0..4 * 3 * 2).map(|value| value as u8).collect();
        let volume =
            Volume::with_spacing("t", [4, 3, 2], DVec3::new(1.0, 2.0, 3.0), Samples::U8(values)).unwrap();
        let half = volume.clone().block_averaged([2, 2, 2]).unwrap();
        assert_eq!((half.dims(), half.file_dims()), ([2, 2, 1], [4, 3, 2]));
        // 0, 1, 4, 5 and twelve more: 8.5; the second row of blocks has one row of voxels.
        let Samples::U8(means) = half.samples() else { panic!("the type changed") };
        assert_eq!(means, &[9, 11, 15, 17]);
        assert_eq!(half.spacing_mm(), DVec3::new(2.0, 4.0, 6.0));
        let corner = half.world_from_index().transform_point3(DVec3::ZERO);
        assert_eq!(corner, volume.world_from_index().transform_point3(DVec3::splat(0.5)));
        // A second reduction along one axis only.
        let quarter = half.block_averaged([2, 1, 1]).unwrap();
        assert_eq!((quarter.dims(), quarter.file_dims()), ([1, 2, 1], [4, 3, 2]));
        assert_eq!(volume.clone().block_averaged([1; 3]).unwrap().content_id(), volume.content_id());
    }

    #[test]
    fn means_are_no_padding() {
        let volume = |values: Vec<i16>| {
            Volume::with_spacing("t", [values.len(), 1, 1], DVec3::ONE, Samples::I16(values)).unwrap()
        };
        let padded = volume(vec![-6, -4, -8, -3, -5, -5, -5, 7]).with_padding(-5.0).unwrap();
        let half = padded.block_averaged([2, 1, 1]).unwrap();
        // The first mean is −5, and −5.5 rounds to −6; the third block is missing, and so is half of the last.
        assert_eq!([0, 1, 2, 3].map(|x| half.value(x, 0, 0)), [-4.0, -6.0, -5.0, 7.0]);
        assert_eq!(half.missing().map(MissingVoxels::count), Some(1));
    }

    #[test]
    fn blocks_of_labels_have_the_label_of_most() {
        let mut hints = ValueMetadata::default();
        hints.meaning = ValueMeaning::Labels;
        let values = vec![0, 0, 0, 9, 3, 9, 255, 9, 255, 255, 9, 9];
        let volume = Volume::with_spacing("t", [12, 1, 1], DVec3::ONE, Samples::U8(values)).unwrap();
        let volume = volume.with_metadata(hints).with_padding(255.0).unwrap();
        let half = volume.block_averaged([2, 1, 1]).unwrap();
        let Samples::U8(labels) = half.samples() else { panic!("the type changed") };
        assert_eq!(labels, &[0, 0, 3, 9, 255, 9], "and never one that is none of both");
        assert!(matches!(half.kind().kind, DataKind::LabelMap { .. }));
    }

    #[test]
    fn what_is_not_finite_stays_out_of_means() {
        let values = vec![1.0, f32::NAN, f32::INFINITY, f32::NAN, 4.0, 5.0];
        let volume = Volume::with_spacing("t", [6, 1, 1], DVec3::ONE, Samples::F32(values)).unwrap();
        let half = volume.block_averaged([2; 3]).unwrap();
        assert_eq!(half.dims(), [3, 1, 1]);
        assert_eq!((half.value(0, 0, 0), half.value(2, 0, 0)), (1.0, 4.5));
        assert!(half.value(1, 0, 0).is_nan());
        assert_eq!(half.non_finite_voxels(), 1);
    }
}
