//! The volume of the sky's visibility.

use super::floor_map::FloorMap;
use crate::gpu::resources::fill_time::FillTime;
use crate::gpu::volume::texture_3d;
use crate::gpu::{Context, GpuError};
use crate::model::Resolution;
use crate::plan::FloorPlace;

/// Bytes of four sums of a block.
pub(crate) const SUM_BYTES: u64 = 16;

/// Most texels that the rays of one direction may take: 128 MiB of sheets.
const MOST_TEXELS: u64 = 1 << 26;

/// How open to the sky each block of voxels is.
#[derive(Debug)]
pub(crate) struct SkyVolume {
    /// Blocks along x, y and z.
    pub dims: [usize; 3],
    /// Voxels along the edge of a block.
    pub divisor: usize,
    /// V₁ in rgb, V₀ in a.
    pub view: wgpu::TextureView,
    /// What the floor sees of the sky, where there was one when it was filled.
    pub floor: Option<FloorMap>,
    /// How long it took.
    pub fill: FillTime,
    /// Counts up with every use; the least recently used goes first.
    pub last_used: u64,
}

impl SkyVolume {
    /// Makes the texture; nothing is filled yet.
    ///
    /// # Errors
    /// When memory is out.
    pub(crate) fn new(
        context: &Context,
        grid: [usize; 3],
        resolution: Resolution,
        floor: Option<FloorPlace>,
    ) -> Result<Self, GpuError> {
        let most_sums = context.device.limits().max_storage_buffer_binding_size / SUM_BYTES;
        let divisor = divisor_for(grid, resolution, (MOST_TEXELS, most_sums));
        let dims = grid.map(|n| n.div_ceil(divisor));
        let texture = context.texture(&texture_3d(
            "SkyVolume::texture",
            dims,
            wgpu::TextureFormat::Rgba16Float,
            wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::STORAGE_BINDING
                | wgpu::TextureUsages::COPY_SRC,
        ))?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let floor = floor.map(|place| FloorMap::new(context, place)).transpose()?;
        Ok(Self { dims, divisor, view, floor, fill: FillTime::default(), last_used: 0 })
    }

    /// Index space to texture coordinates: (p + ½) × lookup.
    pub(crate) fn lookup(&self) -> [f32; 3] {
        self.dims.map(|n| 1.0 / (n * self.divisor) as f32)
    }

    /// Bytes of its texture.
    pub(crate) fn bytes(&self) -> u64 {
        let map = if self.floor.is_some() { FloorMap::bytes() } else { 0 };
        map + 8 * self.dims.iter().map(|&n| n as u64).product::<u64>()
    }
}

/// Voxels along the edge of a block: those of a resolution, or more where the rays of one direction would take more texels
/// than they may, or there would be more blocks than the adapter's buffers hold sums for.
pub(crate) fn divisor_for(
    grid: [usize; 3],
    resolution: Resolution,
    (most_texels, most_sums): (u64, u64),
) -> usize {
    let mut divisor = resolution.divisor();
    let texels = |divisor: usize| {
        let [x, y, z] = grid.map(|n| n.div_ceil(divisor) as u64);
        // Rays drift by a block per slice at most.
        [[x, y, z], [y, z, x], [z, x, y]].map(|[a, b, c]| a * (a + b) * (a + c)).into_iter().max()
    };
    let blocks = |divisor: usize| grid.map(|n| n.div_ceil(divisor) as u64).iter().product::<u64>();
    while texels(divisor) > Some(most_texels) || blocks(divisor) > most_sums {
        divisor *= 2;
    }
    divisor
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_volumes_are_followed_in_larger_blocks() {
        let of = |n: usize, resolution| divisor_for([n; 3], resolution, (MOST_TEXELS, u64::MAX));
        assert_eq!(of(256, Resolution::Full), 1);
        assert_eq!(of(257, Resolution::Full), 2);
        assert_eq!(of(512, Resolution::Half), 2);
        assert_eq!(of(1024, Resolution::Half), 4);
        assert_eq!(of(2048, Resolution::Quarter), 8);
        // Of a row of voxels 256 blocks fit: their rays drift as far as they go.
        assert_eq!(divisor_for([4096, 1, 1], Resolution::Full, (MOST_TEXELS, u64::MAX)), 16);
        // The least that adapters bind is 128 MiB.
        let least = (128 << 20) / SUM_BYTES;
        assert_eq!(divisor_for([256; 3], Resolution::Full, (MOST_TEXELS, least)), 2);
        assert_eq!(divisor_for([203; 3], Resolution::Full, (MOST_TEXELS, least)), 1);
    }
}
