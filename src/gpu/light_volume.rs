//! Attenuation volumes: one texture per light, cached by the key that says what it was made from.

use super::listed_bricks;
use super::pass;
use super::tables::view_entry;
use super::volume::{Gpu, GpuVolume, brick_dims, entry, texture_3d};
use super::{Context, GpuError};
use crate::model::{MAX_LIGHTS, Precision};
use crate::plan::{BrickSet, LightKey, LightView};

/// One light's attenuation volume, complete or being filled.
#[derive(Debug)]
pub(super) struct LightVolume {
    /// What it is made from.
    pub key: LightKey,
    /// Voxels along x, y, z.
    pub dims: [usize; 3],
    /// Data voxels per light voxel along an axis.
    pub divisor: usize,
    /// Attenuation, 0 … 1.
    pub texture: wgpu::Texture,
    /// The same.
    pub view: wgpu::TextureView,
    /// Bricks (of light voxels) that hold, or will hold, values.
    pub filled: BrickSet,
    /// Whether everything in `filled` is there.
    pub complete: bool,
    /// Counts up with every use; the least recently used goes first.
    pub last_used: u64,
}

impl LightVolume {
    /// Makes the texture; nothing is filled yet.
    ///
    /// # Errors
    /// When memory is out.
    pub(super) fn new(
        context: &Context,
        volume: &GpuVolume,
        key: LightKey,
        filled: BrickSet,
    ) -> Result<Self, GpuError> {
        let divisor = key.resolution().divisor();
        let dims = volume.volume.dims().map(|n| n.div_ceil(divisor));
        let format = match key.precision() {
            // An adapter that cannot store bytes keeps what it can.
            Precision::Byte if context.byte_volumes => wgpu::TextureFormat::R8Unorm,
            Precision::Byte | Precision::Half => context.storage_format,
        };
        let texture = context.texture(&texture_3d(
            "LightVolume::attenuation",
            dims,
            format,
            wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::STORAGE_BINDING
                | wgpu::TextureUsages::COPY_SRC
                | wgpu::TextureUsages::COPY_DST,
        ))?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Self { key, dims, divisor, texture, view, filled, complete: false, last_used: 0 })
    }

    /// Lights the listed bricks fully.
    pub(super) fn light_up(
        &self,
        gpu: Gpu<'_>,
        bricks: &[u32],
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        if bricks.is_empty() {
            return Ok(());
        }
        let Gpu { context, shaders, .. } = gpu;
        let pipeline = shaders.pipeline_into("light_around.wgsl", &[], self.texture.format())?;
        let list = listed_bricks::upload(context, bricks);
        let own = pass::bind(
            context,
            "LightVolume::around",
            &pipeline,
            0,
            &[entry(0, list.as_entire_binding()), view_entry(1, &self.view)],
        );
        pass::dispatch(
            encoder,
            "LightVolume::around",
            &pipeline,
            &[&own],
            listed_bricks::workgroups(bricks.len() as u32),
        );
        Ok(())
    }

    /// Bytes of its texture.
    pub(super) fn bytes(&self) -> u64 {
        let texel = u64::from(self.texture.format().block_copy_size(None).unwrap_or(4));
        texel * self.dims.iter().map(|&n| n as u64).product::<u64>()
    }
}

/// Bind group 2 of the passes that shade: the light volumes, in the order of their lights.
pub(super) fn light_bind_group(
    gpu: Gpu<'_>,
    pipeline: &wgpu::ComputePipeline,
    attenuation: &[&wgpu::TextureView],
) -> wgpu::BindGroup {
    let view = |slot: usize| attenuation.get(slot).copied().unwrap_or(gpu.nothing);
    let views: Vec<_> = (0..MAX_LIGHTS).map(|slot| view_entry(slot as u32, view(slot))).collect();
    pass::bind(gpu.context, "LightVolume::bind_group", pipeline, 2, &views)
}

/// The bricks of a light volume that hold the given bricks of the data.
pub(super) fn bricks_holding(volume: &GpuVolume, lit: &BrickSet, divisor: usize) -> BrickSet {
    let dims = volume.volume.dims().map(|n| n.div_ceil(divisor));
    lit.coarsened(divisor, brick_dims(dims))
}

/// The data bricks whose sheets the back-projection of `filled` reads: within the reverse kernel of
/// radius two.
pub(super) fn read_bricks(
    volume: &GpuVolume,
    filled: &BrickSet,
    divisor: usize,
    views: &[LightView],
) -> BrickSet {
    let widest = views
        .iter()
        .map(|view| {
            let last = view.frame.first_depth + f64::from(view.frame.slab_count) * view.frame.slab;
            view.frame.pitch_at(last).max(view.kernel_edge)
        })
        .fold(0.0, f64::max);
    let reach_voxels = 2.0 * widest / volume.scene.smallest_edge();
    // One voxel more, for linear fetches between pixels.
    let reach_bricks = ((reach_voxels + 1.0) / 8.0).ceil() as usize;
    filled.refined(divisor, volume.bricks.dims).dilated(reach_bricks)
}
