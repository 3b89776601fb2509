//! Presence of the texels of a box, computed level by level.

use std::ops::Range;

use rayon::prelude::*;

use crate::plan::MAX_STRETCH_LEVEL;
use crate::volume::texture_shapes::{PYRAMID_PADDING, pyramid_dims};
use chiaroscuro_volume::{Observer, Volume};

/// Index of the coarsest level.
pub(super) const MAX_LEVEL: u32 = MAX_STRETCH_LEVEL as u32;

/// Size of a texel in bytes: presence, and its differences along x, y and z.
pub(super) const TEXEL_BYTES: usize = 4;

/// Number of steps from 0 to 1 of signed bytes. Software drivers interpolate signed bytes in floating point, but
/// unsigned ones in eight bits, which tilts normals.
const SNORM_STEPS: f32 = 127.0;

/// Presence of the voxels of a volume for an observer.
#[derive(Debug, Clone, Copy)]
pub(super) struct PresenceSource<'a> {
    pub volume: &'a Volume,
    pub observer: Observer,
    /// `true` if missing voxels are absent; else only hidden ones are.
    pub counts_missing: bool,
}

impl PresenceSource<'_> {
    /// Returns the presence of the voxel at an index, x fastest.
    fn presence(&self, voxel: usize) -> f32 {
        if self.counts_missing {
            self.volume.presence_for(self.observer, voxel)
        } else {
            self.volume.unmasked_share(self.observer, voxel)
        }
    }
}

/// Presence at the texels of a box of one level.
pub(super) struct PresenceBlock {
    /// Indices of the texels within the level.
    texels: [Range<usize>; 3],
    /// Number of texels of the whole level along each axis.
    level: [usize; 3],
    values: Vec<f32>,
}

/// Computes all levels, finest first: at least the texels within the given ones of the coarsest level, and one to
/// either side.
pub(super) fn presence_levels(
    source: PresenceSource<'_>,
    coarsest: &[Range<usize>; 3],
) -> Vec<PresenceBlock> {
    let size = pyramid_dims(source.volume.dims());
    let widened =
        |range: &Range<usize>, by: usize, n: usize| range.start.saturating_sub(by)..(range.end + by).min(n);
    // Differences read the neighbouring texels.
    let mut boxes = vec![[0, 1, 2].map(|axis| widened(&coarsest[axis], 1, size[axis] >> MAX_LEVEL))];
    // Texels of each level that the next is computed from: texel i from 2i − 1 … 2i + 2.
    for level in (0..MAX_LEVEL).rev() {
        let next = &boxes[boxes.len() - 1];
        boxes.push([0, 1, 2].map(|axis| {
            let Range { start, end } = next[axis];
            widened(&(2 * start..2 * end), 1, size[axis] >> level)
        }));
    }
    let mut blocks: Vec<PresenceBlock> = Vec::with_capacity(boxes.len());
    for kept in boxes.into_iter().rev() {
        let block = match blocks.last() {
            None => prefiltered_presence(source, &kept),
            Some(finer) => finer.downsample(&kept),
        };
        blocks.push(block);
    }
    blocks
}

/// Computes texels of level 0: the presence of voxels, blurred like densities (`shaders/volume/prefilter.wgsl`).
/// Outside the grid is 0.
fn prefiltered_presence(source: PresenceSource<'_>, texels: &[Range<usize>; 3]) -> PresenceBlock {
    let dims = source.volume.dims();
    let level = pyramid_dims(dims);
    // The blur reads the neighbouring texels.
    let read = [0, 1, 2].map(|axis| {
        let Range { start, end } = texels[axis];
        start.saturating_sub(1)..(end + 1).min(level[axis])
    });
    let [across, down, slices] = read.each_ref().map(Range::len);
    let voxel = |texel: usize, axis: usize| {
        (read[axis].start + texel).checked_sub(PYRAMID_PADDING).filter(|&voxel| voxel < dims[axis])
    };
    let row = |at: usize| {
        let (y, z) = (voxel(at % down, 1), voxel(at / down, 2));
        (0..across).map(move |x| match (voxel(x, 0), y, z) {
            (Some(x), Some(y), Some(z)) => source.presence(x + dims[0] * (y + dims[1] * z)),
            _ => 0.0,
        })
    };
    let values = (0..down * slices).into_par_iter().flat_map_iter(row).collect();
    let start = PresenceBlock { texels: read.clone(), level, values };
    (0..3).fold(start, |block, axis| {
        block.filter_axis(axis, &texels[axis], 1, |at| {
            [(at - 1, 1.0 / 12.0), (at, 5.0 / 6.0), (at + 1, 1.0 / 12.0), (at + 1, 0.0)]
        })
    })
}

impl PresenceBlock {
    /// Computes texels of the next coarser level (`shaders/volume/downsample.wgsl`).
    fn downsample(&self, texels: &[Range<usize>; 3]) -> Self {
        let halve = |block: &Self, axis: usize| {
            block.filter_axis(axis, &texels[axis], 2, |at| {
                let taps = [2 * at - 1, 2 * at, 2 * at + 1, 2 * at + 2];
                let weights = [1.0 / 16.0, 7.0 / 16.0, 7.0 / 16.0, 1.0 / 16.0];
                std::array::from_fn(|tap| (taps[tap], weights[tap]))
            })
        };
        halve(&halve(&halve(self, 2), 0), 1)
    }

    /// Filters along an axis with four taps, at one result for `step` texels. `taps` gives the texels and weights for
    /// each position in `kept`; texels beyond the ends of the level are clamped.
    fn filter_axis(
        &self,
        axis: usize,
        kept: &Range<usize>,
        step: usize,
        taps: impl Fn(i64) -> [(i64, f32); 4] + Sync,
    ) -> Self {
        let dims = self.texels.each_ref().map(Range::len);
        let stride: usize = dims[..axis].iter().product();
        let (start, last) = (self.texels[axis].start, self.level[axis] as i64 - 1);
        let sources: Vec<[(usize, f32); 4]> = kept
            .clone()
            .map(|at| {
                taps(at as i64).map(|(place, weight)| {
                    ((place.clamp(0, last) as usize).saturating_sub(start) * stride, weight)
                })
            })
            .collect();
        let sum = |below: usize, taps: &[(usize, f32); 4]| -> f32 {
            taps.iter().map(|&(place, weight)| weight * self.values[below + place]).sum()
        };
        let rows = dims[axis + 1..].iter().product::<usize>();
        let values = if axis == 0 {
            let row = |at: usize| sources.iter().map(move |taps| sum(at * dims[0], taps));
            (0..rows).into_par_iter().flat_map_iter(row).collect()
        } else {
            // All texels at one position along the axis have the same taps.
            let row = |at: usize| {
                let first = at / kept.len() * (stride * dims[axis]);
                let taps = &sources[at % kept.len()];
                (first..first + stride).map(move |below| sum(below, taps))
            };
            (0..rows * kept.len()).into_par_iter().flat_map_iter(row).collect()
        };
        let (mut texels, mut level) = (self.texels.clone(), self.level);
        texels[axis] = kept.clone();
        level[axis] /= step;
        Self { texels, level, values }
    }

    /// Encodes the texels in a box.
    pub(super) fn texels(&self, kept: &[Range<usize>; 3]) -> Vec<[i8; TEXEL_BYTES]> {
        let [across, down, slices] = kept.each_ref().map(Range::len);
        let row = |at: usize| {
            let place = [kept[0].start, kept[1].start + at % down, kept[2].start + at / down];
            (0..across).map(move |x| self.texel([place[0] + x, place[1], place[2]]))
        };
        (0..down * slices).into_par_iter().flat_map_iter(row).collect()
    }

    /// Encodes the texel at a place in the level: presence, and differences of its neighbours, clamped at the border
    /// like a sampler does.
    fn texel(&self, place: [usize; 3]) -> [i8; TEXEL_BYTES] {
        let dims = self.texels.each_ref().map(Range::len);
        let [x, y, z] = [0, 1, 2].map(|axis| place[axis] - self.texels[axis].start);
        let at = x + dims[0] * (y + dims[1] * z);
        let change = |axis: usize| {
            let stride: usize = dims[..axis].iter().product();
            let before = if place[axis] > 0 { at - stride } else { at };
            let next = if place[axis] + 1 < self.level[axis] { at + stride } else { at };
            (SNORM_STEPS * (self.values[next] - self.values[before])).round() as i8
        };
        // Presence uses the whole signed range, −1 … 1, which doubles its resolution.
        let share = 2.0 * self.values[at] - 1.0;
        [(SNORM_STEPS * share).round() as i8, change(0), change(1), change(2)]
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use chiaroscuro_volume::Samples;

    fn volume_with_holes(dims: [usize; 3]) -> (Volume, f32) {
        let values: Vec<f32> =
            (0..dims.iter().product::<usize>()).map(|at| if at % 5 == 0 { f32::NAN } else { 1.0 }).collect();
        let there = values.iter().filter(|value| value.is_finite()).count() as f32;
        (Volume::with_spacing("t", dims, DVec3::ONE, Samples::F32(values)).unwrap(), there)
    }

    fn for_eye(volume: &Volume) -> PresenceSource<'_> {
        PresenceSource { volume, observer: Observer::Eye, counts_missing: true }
    }

    fn whole(dims: [usize; 3]) -> [Range<usize>; 3] {
        pyramid_dims(dims).map(|n| 0..n >> MAX_LEVEL)
    }

    #[test]
    fn levels_keep_the_sum_of_what_is_there() {
        let dims = [13, 9, 7];
        let (volume, there) = volume_with_holes(dims);
        let blocks = presence_levels(for_eye(&volume), &whole(dims));
        assert_eq!(blocks.len(), MAX_LEVEL as usize + 1);
        assert_eq!(blocks[0].level, [24, 24, 16]);
        for (level, block) in (0..).zip(&blocks) {
            let sum = block.values.iter().sum::<f32>() * 8f32.powi(level);
            // Clamping at the border counts what spreads beyond it twice.
            assert!((sum / there - 1.0).abs() < 0.02, "level {level}: {sum} of {there}");
        }
    }

    #[test]
    fn changes_lead_from_what_is_missing_to_what_is_there() {
        let dims = [16, 5, 5];
        let values: Vec<f32> =
            (0..dims.iter().product::<usize>()).map(|at| if at % 16 < 8 { f32::NAN } else { 1.0 }).collect();
        let volume = Volume::with_spacing("t", dims, DVec3::ONE, Samples::F32(values)).unwrap();
        let blocks = presence_levels(for_eye(&volume), &whole(dims));
        let middle = PYRAMID_PADDING + 2;
        let along_x: Vec<[i8; TEXEL_BYTES]> =
            (0..16).map(|x| blocks[0].texel([PYRAMID_PADDING + x, middle, middle])).collect();
        // Prefiltered step function: 1/12, 11/12, 1.
        assert_eq!([6, 7, 8, 9].map(|x: usize| along_x[x][0]), [-127, -106, 106, 127]);
        assert_eq!([5, 6, 7, 8, 9, 10].map(|x: usize| along_x[x][1]), [0, 11, 116, 116, 11, 0]);
        assert!(along_x.iter().all(|texel| texel[2..] == [0; 2]), "{along_x:?}");
    }

    #[test]
    fn box_by_box_it_is_the_same() {
        let dims = [17, 9, 21];
        let (volume, _) = volume_with_holes(dims);
        let all = whole(dims);
        let at_once = presence_levels(for_eye(&volume), &all);
        for z in all[2].clone() {
            for x in all[0].clone() {
                let coarsest = [x..x + 1, 1..3, z..z + 1];
                for ((level, whole), block) in
                    (0..).zip(&at_once).zip(presence_levels(for_eye(&volume), &coarsest))
                {
                    let finer = MAX_LEVEL - level;
                    let kept = coarsest.each_ref().map(|range| range.start << finer..range.end << finer);
                    assert_eq!(whole.texels(&kept), block.texels(&kept), "{coarsest:?}, level {level}");
                }
            }
        }
    }
}
