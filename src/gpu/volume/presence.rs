//! Where voxels are missing: the share of kernels that lies on those that are there, in a texture beside the pyramid and
//! like it, level by level. Made here and uploaded, since few volumes have any.

use rayon::prelude::*;

use super::LevelViews;
use super::shapes::{PYRAMID_PADDING, padded, texture_3d};
use crate::data::{Missing, Volume};
use crate::gpu::{Context, GpuError};
use crate::plan::MAX_STRETCH_LEVEL;

/// The texture, for a volume in which voxels are missing.
#[derive(Debug)]
pub(crate) struct Presence {
    pub texture: wgpu::Texture,
    pub views: LevelViews,
}

impl Presence {
    /// Makes it for a volume, if it had these dimensions; `None` where no voxel is missing.
    ///
    /// # Errors
    /// When the adapter cannot hold it.
    pub(crate) fn new(
        context: &Context,
        volume: &Volume,
        dims: [usize; 3],
    ) -> Result<Option<Self>, GpuError> {
        if volume.missing().is_none() {
            return Ok(None);
        }
        let texture = context.texture(&wgpu::TextureDescriptor {
            mip_level_count: MAX_STRETCH_LEVEL as u32 + 1,
            ..texture_3d(
                "Volume::presence",
                padded(dims),
                wgpu::TextureFormat::R8Unorm,
                wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            )
        })?;
        let views = LevelViews::new(&texture);
        Ok(Some(Self { texture, views }))
    }

    /// Uploads all levels.
    pub(crate) fn upload(&self, context: &Context, volume: &Volume) {
        let Some(missing) = volume.missing() else { return };
        let mut level = prefiltered(missing, volume.dims());
        for mip_level in 0..self.texture.mip_level_count() {
            if mip_level > 0 {
                level = level.halved();
            }
            let [width, height, depth] = level.dims.map(|n| n as u32);
            context.queue.write_texture(
                wgpu::TexelCopyTextureInfo {
                    texture: &self.texture,
                    mip_level,
                    origin: wgpu::Origin3d::ZERO,
                    aspect: wgpu::TextureAspect::All,
                },
                &level.bytes(),
                wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(width),
                    rows_per_image: Some(height),
                },
                wgpu::Extent3d { width, height, depth_or_array_layers: depth },
            );
        }
    }
}

/// Shares at the texels of a level.
struct Level {
    dims: [usize; 3],
    shares: Vec<f32>,
}

/// Level 0: 1 where a voxel is there, else 0, blurred as densities are (`shaders/volume/prefilter.wgsl`). Around the grid
/// is nothing.
fn prefiltered(missing: &Missing, dims: [usize; 3]) -> Level {
    let [nx, ny, nz] = padded(dims);
    let voxel = |texel: usize, n: usize| texel.checked_sub(PYRAMID_PADDING).filter(|&voxel| voxel < n);
    let share = |at: usize| {
        let place = [at % nx, at / nx % ny, at / (nx * ny)];
        let [Some(x), Some(y), Some(z)] = [0, 1, 2].map(|axis| voxel(place[axis], dims[axis])) else {
            return 0.0;
        };
        if missing.contains(x + dims[0] * (y + dims[1] * z)) { 0.0 } else { 1.0 }
    };
    let start = Level { dims: [nx, ny, nz], shares: (0..nx * ny * nz).into_par_iter().map(share).collect() };
    (0..3).fold(start, |level, axis| {
        level.resampled(axis, 1, |at| {
            [(at - 1, 1.0 / 12.0), (at, 5.0 / 6.0), (at + 1, 1.0 / 12.0), (at + 1, 0.0)]
        })
    })
}

impl Level {
    /// The next level (`shaders/volume/downsample.wgsl`).
    fn halved(&self) -> Self {
        let halve = |level: &Self, axis: usize| {
            level.resampled(axis, 2, |at| {
                let taps = [2 * at - 1, 2 * at, 2 * at + 1, 2 * at + 2];
                let weights = [1.0 / 16.0, 7.0 / 16.0, 7.0 / 16.0, 1.0 / 16.0];
                std::array::from_fn(|tap| (taps[tap], weights[tap]))
            })
        };
        halve(&halve(&halve(self, 0), 1), 2)
    }

    /// Sums of four texels along an axis, of which there are `step` for one of the result: `taps` are their places, which
    /// may lie beyond the outermost and mean it then, with their weights.
    fn resampled(&self, axis: usize, step: usize, taps: impl Fn(i64) -> [(i64, f32); 4] + Sync) -> Self {
        let stride: usize = self.dims[..axis].iter().product();
        let last = self.dims[axis] as i64 - 1;
        let mut dims = self.dims;
        dims[axis] = (dims[axis] / step).max(1);
        let sum = |at: usize| {
            let (below, along) = (at % stride, at / stride % dims[axis]);
            let row = at / (stride * dims[axis]) * (stride * self.dims[axis]) + below;
            let value = |place: i64| self.shares[row + place.clamp(0, last) as usize * stride];
            taps(along as i64).iter().map(|&(place, weight)| weight * value(place)).sum()
        };
        let shares = (0..dims.iter().product::<usize>()).into_par_iter().map(sum).collect();
        Self { dims, shares }
    }

    fn bytes(&self) -> Vec<u8> {
        self.shares.par_iter().map(|share| (share * 255.0).round() as u8).collect()
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::data::Samples;

    #[test]
    fn levels_keep_the_sum_of_what_is_there() {
        let dims = [13, 9, 7];
        let values: Vec<f32> = (0..13 * 9 * 7).map(|at| if at % 5 == 0 { f32::NAN } else { 1.0 }).collect();
        let there = values.iter().filter(|value| value.is_finite()).count() as f32;
        let volume = Volume::with_spacing("t", dims, DVec3::ONE, Samples::F32(values)).unwrap();
        let mut level = prefiltered(volume.missing().unwrap(), dims);
        assert_eq!(level.dims, [24, 24, 16]);
        for halvings in 0..=MAX_STRETCH_LEVEL as u32 {
            let sum = level.shares.iter().sum::<f32>() * 8f32.powi(halvings as i32);
            // Coarse texels at the outermost edge count what spreads beyond twice.
            assert!((sum / there - 1.0).abs() < 0.02, "level {halvings}: {sum} of {there}");
            level = level.halved();
        }
    }
}
