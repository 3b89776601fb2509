//! Attenuation volumes: one texture per light.

use std::sync::Arc;

use super::floor_shadow::FloorShadow;
use crate::data::BRICK_EDGE;
use crate::gpu::pipelines::binding::{Named, view_of};
use crate::gpu::pipelines::variant::Only;
use crate::gpu::resources::fill_time::FillTime;
use crate::gpu::resources::pass;
use crate::gpu::volume::listed_bricks::{self, Listed};
use crate::gpu::volume::{Gpu, GpuVolume, texture_3d};
use crate::gpu::{Context, GpuError};
use crate::model::Precision;
use crate::plan::{BrickSet, CellSet, CellsAhead, FloorPlace, LightKey, LightView, reverse_reach_voxels};

/// One light's attenuation volume.
#[derive(Debug)]
pub(crate) struct LightVolume {
    /// Voxels along x, y, z.
    pub dims: [usize; 3],
    /// Data voxels per light voxel along an axis.
    pub divisor: usize,
    /// Attenuation, 0 … 1; of red, green and blue light where shadows are coloured.
    pub texture: wgpu::Texture,
    /// A view of all of it.
    pub view: wgpu::TextureView,
    /// What gets to the floor, if that is looked up.
    pub floor: Option<FloorShadow>,
    /// Cells (of light voxels) that hold, or will hold, values.
    pub filled: Arc<CellSet>,
    /// How far, in data cells around what the transfer functions show, those lie at most.
    pub reach: u8,
    /// How far ahead of samples it is looked up, the last first.
    pub aheads: Vec<CellsAhead>,
    /// Cells around what is filled, which only previews look up, and which no material darkens.
    margin: CellSet,
    /// Cells of the margin that are cleared, by this volume or the one that had its texture before.
    cleared: Option<CellSet>,
    /// How long it took.
    pub fill: FillTime,
    /// Counts up with every use; the least recently used goes first.
    pub last_used: u64,
}

/// What is filled of a light volume.
#[derive(Debug)]
pub(crate) struct Filling {
    /// Cells (of light voxels) to be filled.
    pub filled: Arc<CellSet>,
    /// Cells around them, to be cleared.
    pub margin: CellSet,
    /// How far, in data cells around what the transfer functions show, those to be filled lie at most.
    pub reach: u8,
    /// How far ahead of samples it will be looked up.
    pub aheads: Vec<CellsAhead>,
    /// Where the floor lies, if a map is to say what gets there.
    pub floor: Option<FloorPlace>,
}

impl LightVolume {
    /// Makes the texture, or takes that of a volume that is not wanted any more; nothing is filled yet.
    ///
    /// # Errors
    /// When memory is out.
    pub(crate) fn new(
        context: &Context,
        volume: &GpuVolume,
        key: &LightKey,
        filling: Filling,
        recyclable: &mut Vec<Self>,
    ) -> Result<Self, GpuError> {
        let Filling { filled, margin, reach, aheads, floor } = filling;
        let divisor = key.resolution().divisor();
        let block = volume.scene.smallest_edge() * divisor as f64;
        let floor = floor.map(|place| FloorShadow::new(context, place, block, key.samples())).transpose()?;
        let dims = volume.volume.dims().map(|n| n.div_ceil(divisor));
        let format = match (key.precision(), key.has_colors()) {
            // An adapter that cannot store bytes keeps what it can.
            (Precision::Byte, false) if context.byte_volumes => wgpu::TextureFormat::R8Unorm,
            (Precision::Byte | Precision::Half, false) => context.storage_format,
            (Precision::Byte, true) => wgpu::TextureFormat::Rgba8Unorm,
            (Precision::Half, true) => wgpu::TextureFormat::Rgba16Float,
        };
        let fresh = |texture, view, cleared: Option<CellSet>| Self {
            dims,
            divisor,
            texture,
            view,
            floor,
            margin,
            cleared,
            filled,
            reach,
            aheads,
            fill: FillTime::default(),
            last_used: 0,
        };
        let fits = |known: &Self| known.dims == dims && known.texture.format() == format;
        if let Some(at) = recyclable.iter().position(fits) {
            let Self { texture, view, cleared, .. } = recyclable.swap_remove(at);
            return Ok(fresh(texture, view, cleared));
        }
        let texture = attenuation_texture(context, dims, format)?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(fresh(texture, view, None))
    }

    /// Another one with the same voxels, nothing of which is filled yet.
    ///
    /// # Errors
    /// When memory is out.
    pub(crate) fn alike(&self, context: &Context, format: wgpu::TextureFormat) -> Result<Self, GpuError> {
        let texture = attenuation_texture(context, self.dims, format)?;
        Ok(Self {
            dims: self.dims,
            divisor: self.divisor,
            view: texture.create_view(&wgpu::TextureViewDescriptor::default()),
            texture,
            floor: None,
            filled: Arc::clone(&self.filled),
            reach: self.reach,
            aheads: self.aheads.clone(),
            margin: CellSet::default(),
            cleared: None,
            fill: FillTime::default(),
            last_used: 0,
        })
    }

    /// The part of the margin that is yet to be cleared: nothing, while a light is dragged.
    pub(crate) fn uncleared_margin(&self) -> Vec<Listed> {
        let list = |cells: &CellSet| cells.bricks().map(listed_bricks::listed).collect();
        self.cleared
            .as_ref()
            .map_or_else(|| list(&self.margin), |cleared| list(&self.margin.without(cleared)))
    }

    /// Lets all light into the listed cells.
    pub(crate) fn clear_margin(
        &self,
        gpu: Gpu<'_>,
        bricks: &[Listed],
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        if bricks.is_empty() {
            return Ok(());
        }
        let Gpu { shaders, .. } = gpu;
        let pipeline = shaders.pipeline_into(&Only("light/clear_margin.wgsl"), self.texture.format())?;
        let list = listed_bricks::upload(gpu, bricks);
        let own = gpu.bind(
            "LightVolume::clear_margin",
            &pipeline,
            0,
            &[
                Named { name: "bricks", resource: listed_bricks::exactly(&list, bricks) },
                view_of("attenuation", &self.view),
            ],
        );
        pass::dispatch(
            encoder,
            "LightVolume::clear_margin",
            &pipeline,
            &[&own],
            listed_bricks::workgroups(bricks.len() as u32),
        );
        Ok(())
    }

    /// The first of its steps is recorded.
    pub(crate) fn begin(&mut self) {
        self.fill.begin();
        self.cleared = Some(self.margin.clone());
    }

    /// Whether it holds attenuations of red, green and blue light.
    pub(crate) fn has_colors(&self) -> bool {
        self.texture.format().components() > 1
    }

    /// Bytes of its texture, and of the floor's map.
    pub(crate) fn bytes(&self) -> u64 {
        let texel = u64::from(self.texture.format().block_copy_size(None).unwrap_or(4));
        let floor = self.floor.as_ref().map_or(0, FloorShadow::bytes);
        floor + texel * self.dims.iter().map(|&n| n as u64).product::<u64>()
    }
}

/// The texture of a light volume.
///
/// # Errors
/// When memory is out.
pub(crate) fn attenuation_texture(
    context: &Context,
    dims: [usize; 3],
    format: wgpu::TextureFormat,
) -> Result<wgpu::Texture, GpuError> {
    context.texture(&texture_3d(
        "LightVolume::attenuation",
        dims,
        format,
        wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::STORAGE_BINDING
            | wgpu::TextureUsages::COPY_SRC
            | wgpu::TextureUsages::COPY_DST,
    ))
}

/// The data bricks whose scattered sheets are splatted back into `filled`: within the reverse kernel of
/// radius two.
pub(crate) fn read_bricks(
    volume: &GpuVolume,
    filled: &CellSet,
    divisor: usize,
    views: &[LightView],
) -> BrickSet {
    let reach_bricks = (reverse_reach_voxels(views, &volume.scene) / BRICK_EDGE as f64).ceil() as usize;
    filled.to_bricks().refined(divisor, volume.bricks.dims).dilated(reach_bricks)
}
