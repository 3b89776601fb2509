//! Presence texture of volumes with missing or hidden voxels: presence (the fraction of the kernel on existing voxels)
//! and its differences.
//!
//! A mip pyramid parallel to that of density. Computed on the CPU and uploaded, since few volumes have such voxels.

use std::ops::Range;

use rayon::prelude::*;

use super::PyramidViews;
use super::texture_shapes::{PYRAMID_PADDING, pyramid_dims, texture_3d};
use crate::plan::MAX_STRETCH_LEVEL;
use crate::{GpuContext, GpuError};
use chiaroscuro_volume::Volume;

/// Index of the coarsest level.
const MAX_LEVEL: u32 = MAX_STRETCH_LEVEL as u32;

/// Size of a texel in bytes: presence, and its differences along x, y and z.
const TEXEL_BYTES: usize = 4;

/// Number of steps from 0 to 1 of signed bytes. Software drivers interpolate signed bytes in floating point, but
/// unsigned ones in eight bits, which tilts normals.
const SNORM_STEPS: f32 = 127.0;

/// Number of texels of level 0 per upload step: some 20 ms, and 16 MiB of temporary memory.
const STEP_TEXELS: usize = 1 << 20;

/// Presence texture of a volume with missing or hidden voxels.
#[derive(Debug, Clone)]
pub(crate) struct PresenceTexture {
    pub texture: wgpu::Texture,
    pub views: PyramidViews,
}

impl PresenceTexture {
    /// Creates the texture for a volume as if it had these dimensions; `None` if all voxels are present.
    ///
    /// # Errors
    /// Returns an error if the adapter cannot hold it.
    pub(crate) fn new(
        context: &GpuContext,
        volume: &Volume,
        dims: [usize; 3],
    ) -> Result<Option<Self>, GpuError> {
        if !volume.has_absent_voxels() {
            return Ok(None);
        }
        let texture = context.texture(&wgpu::TextureDescriptor {
            mip_level_count: MAX_LEVEL + 1,
            ..texture_3d(
                "Volume::presence",
                pyramid_dims(dims),
                wgpu::TextureFormat::Rgba8Snorm,
                wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            )
        })?;
        let views = PyramidViews::new(&texture);
        Ok(Some(Self { texture, views }))
    }

    /// Returns the slices of the coarsest level, split into short upload steps.
    pub(crate) fn steps(&self) -> impl Iterator<Item = Range<usize>> + use<> {
        let size = self.texture.size();
        let slices = (size.depth_or_array_layers >> MAX_LEVEL) as usize;
        let texels = (size.width as usize * size.height as usize) << MAX_LEVEL;
        let each = (STEP_TEXELS / texels).max(1);
        (0..slices).step_by(each).map(move |first| first..slices.min(first + each))
    }

    /// Computes and uploads some slices of the coarsest level, with the corresponding slices of all finer levels.
    pub(crate) fn upload(&self, context: &GpuContext, volume: &Volume, slices: Range<usize>) {
        for (mip_level, slab) in (0..).zip(presence_levels(volume, slices.clone())) {
            let kept = slices.start << (MAX_LEVEL - mip_level)..slices.end << (MAX_LEVEL - mip_level);
            let [width, height, _] = slab.dims.map(|n| n as u32);
            context.queue.write_texture(
                wgpu::TexelCopyTextureInfo {
                    texture: &self.texture,
                    mip_level,
                    origin: wgpu::Origin3d { x: 0, y: 0, z: kept.start as u32 },
                    aspect: wgpu::TextureAspect::All,
                },
                bytemuck::cast_slice(&slab.texels(&kept)),
                wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(width * TEXEL_BYTES as u32),
                    rows_per_image: Some(height),
                },
                wgpu::Extent3d { width, height, depth_or_array_layers: kept.len() as u32 },
            );
        }
    }

    /// Returns the size of the texture, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let size = self.texture.size();
        let texels = u64::from(size.width) * u64::from(size.height) * u64::from(size.depth_or_array_layers);
        // The coarser levels add a seventh.
        TEXEL_BYTES as u64 * texels * 8 / 7
    }
}

/// Presence at the texels of some slices of one level.
struct PresenceSlab {
    /// Number of texels along x and y, and number of slices.
    dims: [usize; 3],
    /// Index of the first slice within the level.
    first_slice: usize,
    /// Number of slices of the whole level.
    level_depth: usize,
    values: Vec<f32>,
}

/// Computes all levels, finest first: at least the slices within the given ones of the coarsest level, and one to
/// either side.
fn presence_levels(volume: &Volume, coarsest: Range<usize>) -> Vec<PresenceSlab> {
    let depth = pyramid_dims(volume.dims())[2];
    // Differences read the neighbouring slices.
    let widened = coarsest.start.saturating_sub(1)..(coarsest.end + 1).min(depth >> MAX_LEVEL);
    // Slices of each level that the next is computed from: texel i from 2i − 1 … 2i + 2.
    let mut slices = vec![widened];
    for level in (0..MAX_LEVEL).rev() {
        let Range { start, end } = slices[slices.len() - 1].clone();
        slices.push((2 * start).saturating_sub(1)..(2 * end + 1).min(depth >> level));
    }
    let mut slabs: Vec<PresenceSlab> = Vec::with_capacity(slices.len());
    for kept in slices.into_iter().rev() {
        let slab = match slabs.last() {
            None => prefiltered_presence(volume, kept),
            Some(finer) => finer.downsample(kept),
        };
        slabs.push(slab);
    }
    slabs
}

/// Computes slices of level 0: the presence of voxels, blurred like densities (`shaders/volume/prefilter.wgsl`).
/// Outside the grid is 0.
fn prefiltered_presence(volume: &Volume, slices: Range<usize>) -> PresenceSlab {
    let dims = volume.dims();
    let [nx, ny, depth] = pyramid_dims(dims);
    let voxel = |texel: usize, n: usize| texel.checked_sub(PYRAMID_PADDING).filter(|&voxel| voxel < n);
    // The blur along z reads the neighbouring slices, too.
    let first = slices.start.saturating_sub(1);
    let count = (slices.end + 1).min(depth) - first;
    let share = |at: usize| {
        let place = [at % nx, at / nx % ny, first + at / (nx * ny)];
        let [Some(x), Some(y), Some(z)] = [0, 1, 2].map(|axis| voxel(place[axis], dims[axis])) else {
            return 0.0;
        };
        volume.presence(x + dims[0] * (y + dims[1] * z))
    };
    let shares = (0..nx * ny * count).into_par_iter().map(share).collect();
    let start =
        PresenceSlab { dims: [nx, ny, count], first_slice: first, level_depth: depth, values: shares };
    (0..3).fold(start, |slab, axis| {
        let kept = if axis == 2 { slices.clone() } else { 0..slab.dims[axis] };
        slab.filter_axis(axis, kept, 1, |at| {
            [(at - 1, 1.0 / 12.0), (at, 5.0 / 6.0), (at + 1, 1.0 / 12.0), (at + 1, 0.0)]
        })
    })
}

impl PresenceSlab {
    /// Computes slices of the next coarser level (`shaders/volume/downsample.wgsl`).
    fn downsample(&self, slices: Range<usize>) -> Self {
        let halve = |slab: &Self, axis: usize, kept: Range<usize>| {
            slab.filter_axis(axis, kept, 2, |at| {
                let taps = [2 * at - 1, 2 * at, 2 * at + 1, 2 * at + 2];
                let weights = [1.0 / 16.0, 7.0 / 16.0, 7.0 / 16.0, 1.0 / 16.0];
                std::array::from_fn(|tap| (taps[tap], weights[tap]))
            })
        };
        let [nx, ny, _] = self.dims;
        halve(&halve(&halve(self, 2, slices), 0, 0..nx / 2), 1, 0..ny / 2)
    }

    /// Filters along an axis with four taps, at one result for `step` texels. `taps` gives the texels and weights for
    /// each position in `kept`; texels beyond the ends of the level are clamped.
    fn filter_axis(
        &self,
        axis: usize,
        kept: Range<usize>,
        step: usize,
        taps: impl Fn(i64) -> [(i64, f32); 4] + Sync,
    ) -> Self {
        let stride: usize = self.dims[..axis].iter().product();
        let (mut dims, mut first, mut depth) = (self.dims, self.first_slice, self.level_depth);
        dims[axis] = kept.len();
        let (mut start, mut count) = (0, self.dims[axis]);
        if axis == 2 {
            (start, count) = (first, depth);
            (first, depth) = (kept.start, depth / step);
        }
        let sum = |at: usize| {
            let (below, along) = (at % stride, kept.start + at / stride % dims[axis]);
            let row = at / (stride * dims[axis]) * (stride * self.dims[axis]) + below;
            let value = |place: i64| {
                let place = place.clamp(0, count as i64 - 1) as usize - start;
                self.values[row + place * stride]
            };
            taps(along as i64).iter().map(|&(place, weight)| weight * value(place)).sum()
        };
        let shares = (0..dims.iter().product::<usize>()).into_par_iter().map(sum).collect();
        Self { dims, first_slice: first, level_depth: depth, values: shares }
    }

    /// Encodes some slices as texels.
    fn texels(&self, slices: &Range<usize>) -> Vec<i8> {
        let slice = self.dims[0] * self.dims[1];
        let kept = (slices.start - self.first_slice) * slice..(slices.end - self.first_slice) * slice;
        kept.into_par_iter().flat_map_iter(|at| self.texel(at)).collect()
    }

    /// Encodes the texel at an index: presence, and differences of its neighbours, clamped at the border like a
    /// sampler does.
    fn texel(&self, at: usize) -> [i8; TEXEL_BYTES] {
        let change = |axis: usize| {
            let stride: usize = self.dims[..axis].iter().product();
            let place = at / stride % self.dims[axis];
            let before = if place > 0 { at - stride } else { at };
            let next = if place + 1 < self.dims[axis] { at + stride } else { at };
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

    #[test]
    fn levels_keep_the_sum_of_what_is_there() {
        let dims = [13, 9, 7];
        let (volume, there) = volume_with_holes(dims);
        let slabs = presence_levels(&volume, 0..16 >> MAX_LEVEL);
        assert_eq!(slabs.len(), MAX_LEVEL as usize + 1);
        assert_eq!(slabs[0].dims, [24, 24, 16]);
        for (level, slab) in (0..).zip(&slabs) {
            let sum = slab.values.iter().sum::<f32>() * 8f32.powi(level);
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
        let slabs = presence_levels(&volume, 0..pyramid_dims(dims)[2] >> MAX_LEVEL);
        let [nx, ny, _] = slabs[0].dims;
        let row = nx * (PYRAMID_PADDING + 2 + ny * (PYRAMID_PADDING + 2));
        let along_x: Vec<[i8; TEXEL_BYTES]> =
            (0..16).map(|x| slabs[0].texel(row + PYRAMID_PADDING + x)).collect();
        // Prefiltered step function: 1/12, 11/12, 1.
        assert_eq!([6, 7, 8, 9].map(|x: usize| along_x[x][0]), [-127, -106, 106, 127]);
        assert_eq!([5, 6, 7, 8, 9, 10].map(|x: usize| along_x[x][1]), [0, 11, 116, 116, 11, 0]);
        assert!(along_x.iter().all(|texel| texel[2..] == [0; 2]), "{along_x:?}");
    }

    #[test]
    fn slab_by_slab_it_is_the_same() {
        let dims = [7, 9, 21];
        let (volume, _) = volume_with_holes(dims);
        let coarsest = pyramid_dims(dims)[2] >> MAX_LEVEL;
        let at_once = presence_levels(&volume, 0..coarsest);
        for first in 0..coarsest {
            for ((level, whole), slab) in
                (0..).zip(&at_once).zip(presence_levels(&volume, first..first + 1))
            {
                let kept = first << (MAX_LEVEL - level)..(first + 1) << (MAX_LEVEL - level);
                assert_eq!(slab.texels(&kept), whole.texels(&kept), "slice {first}, level {level}");
            }
        }
    }
}
