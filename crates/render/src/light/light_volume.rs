//! Attenuation volume of a light, in a texture of its own.

use std::sync::Arc;

use super::floor_shadow::FloorShadowMap;
use crate::pipelines::binding::{NamedResource, bind_view};
use crate::pipelines::pipeline_variant::SingleVariant;
use crate::plan::{
    BrickSet, CellSet, FloorPlane, LightKey, LightView, NearFieldOffset, reverse_reach_voxels,
};
use crate::resources::fill_time::FillStopwatch;
use crate::resources::filled_cells::{CellMargin, FilledCells};
use crate::resources::pass;
use crate::volume::brick_list::{self, BrickEntry};
use crate::volume::{GpuVolume, VolumeContext, texture_3d};
use crate::{GpuContext, GpuError};
use chiaroscuro_scene::LightVolumePrecision;
use chiaroscuro_volume::BRICK_EDGE;

/// Attenuation volume of one light.
#[derive(Debug)]
pub(crate) struct LightVolume {
    /// Number of voxels along x, y and z.
    pub dims: [usize; 3],
    /// Number of data voxels per light voxel, along an axis.
    pub divisor: usize,
    /// Texture of the attenuation, 0 … 1; for red, green and blue light where shadows are coloured.
    pub texture: wgpu::Texture,
    /// View of the whole texture.
    pub view: wgpu::TextureView,
    /// Map of the light at the floor, if it is looked up.
    pub floor: Option<FloorShadowMap>,
    /// Cells (of light voxels) that hold values, or will when the volume is complete.
    pub filled_cells: FilledCells,
    /// Maximum distance, in data cells, of the filled cells from visible ones.
    pub reach: u8,
    /// Offsets of lookups towards the light, most recent first.
    pub lookup_offsets: Vec<NearFieldOffset>,
    /// Cells around the filled ones, which only previews look up and which are fully lit.
    margin: CellMargin,
    /// Margin already cleared, by this volume or the previous one with the same texture.
    cleared_margin: Option<CellMargin>,
    /// Stopwatch for the filling of the volume.
    pub fill_time: FillStopwatch,
}

/// Extent of a light volume that is to be filled.
#[derive(Debug)]
pub(crate) struct LightVolumeExtent {
    /// Cells (of light voxels) to be filled.
    pub filled: Arc<CellSet>,
    /// Cells around the filled ones, to be cleared.
    pub margin: CellMargin,
    /// Maximum distance, in data cells, of the cells to be filled from visible ones.
    pub reach: u8,
    /// Offsets of lookups towards the light.
    pub aheads: Vec<NearFieldOffset>,
    /// Extent of the floor, if it gets a shadow map.
    pub floor: Option<FloorPlane>,
}

impl LightVolume {
    /// Creates the volume, with the texture of a recyclable volume if one fits; nothing is filled yet.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(
        context: &GpuContext,
        volume: &GpuVolume,
        key: &LightKey,
        filling: LightVolumeExtent,
        recyclable: &mut Vec<Self>,
    ) -> Result<Self, GpuError> {
        let LightVolumeExtent { filled, margin, reach, aheads, floor } = filling;
        let divisor = key.resolution().divisor();
        let block = volume.scene.smallest_edge() * divisor as f64;
        let floor =
            floor.map(|place| FloorShadowMap::new(context, place, block, key.samples())).transpose()?;
        let dims = volume.volume.dims().map(|n| n.div_ceil(divisor));
        let format = match (key.precision(), key.has_colors()) {
            // Adapters that cannot store bytes use the storage format.
            (LightVolumePrecision::Byte, false) if context.has_byte_volumes => wgpu::TextureFormat::R8Unorm,
            (LightVolumePrecision::Byte | LightVolumePrecision::Half, false) => context.storage_format,
            (LightVolumePrecision::Byte, true) => wgpu::TextureFormat::Rgba8Unorm,
            (LightVolumePrecision::Half, true) => wgpu::TextureFormat::Rgba16Float,
        };
        let volume_with = |texture, view, cleared_margin: Option<CellMargin>| Self {
            dims,
            divisor,
            texture,
            view,
            floor,
            margin,
            cleared_margin,
            filled_cells: FilledCells::new(filled),
            reach,
            lookup_offsets: aheads,
            fill_time: FillStopwatch::default(),
        };
        let fits = |known: &Self| known.dims == dims && known.texture.format() == format;
        if let Some(at) = recyclable.iter().position(fits) {
            let Self { texture, view, cleared_margin, .. } = recyclable.swap_remove(at);
            return Ok(volume_with(texture, view, cleared_margin));
        }
        let texture = attenuation_texture(context, dims, format)?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(volume_with(texture, view, None))
    }

    /// Creates a volume with the same voxels, of which nothing is filled.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn with_same_voxels(
        &self,
        context: &GpuContext,
        format: wgpu::TextureFormat,
    ) -> Result<Self, GpuError> {
        let texture = attenuation_texture(context, self.dims, format)?;
        Ok(Self {
            dims: self.dims,
            divisor: self.divisor,
            view: texture.create_view(&wgpu::TextureViewDescriptor::default()),
            texture,
            floor: None,
            filled_cells: self.filled_cells.clone(),
            reach: self.reach,
            lookup_offsets: self.lookup_offsets.clone(),
            margin: CellMargin::default(),
            cleared_margin: None,
            fill_time: FillStopwatch::default(),
        })
    }

    /// Returns the part of the margin that has yet to be cleared; empty while a light is dragged.
    pub(crate) fn uncleared_margin(&self) -> Vec<BrickEntry> {
        let cleared = self.cleared_margin.as_ref();
        let rest = cleared.map_or_else(|| self.margin.cells(), |cleared| self.margin.difference(cleared));
        rest.bricks().map(brick_list::brick_entry).collect()
    }

    /// Sets the listed cells to fully lit.
    pub(crate) fn clear_margin(
        &self,
        gpu: VolumeContext<'_>,
        bricks: &[BrickEntry],
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        if bricks.is_empty() {
            return Ok(());
        }
        let VolumeContext { shaders, .. } = gpu;
        let pipeline =
            shaders.pipeline_into(&SingleVariant("light/clear_margin.wgsl"), self.texture.format())?;
        let list = brick_list::upload_bricks(gpu, bricks);
        let own = gpu.bind(
            "LightVolume::clear_margin",
            &pipeline,
            0,
            &[
                NamedResource { name: "bricks", resource: brick_list::bind_exact_length(&list, bricks) },
                bind_view("attenuation", &self.view),
            ],
        );
        pass::dispatch(
            encoder,
            "LightVolume::clear_margin",
            &pipeline,
            &[&own],
            brick_list::two_workgroups_per_brick(bricks.len() as u32),
        );
        Ok(())
    }

    /// Starts filling: starts the stopwatch, and counts the margin as cleared.
    pub(crate) fn begin_filling(&mut self) {
        self.fill_time.begin();
        self.cleared_margin = Some(self.margin.clone());
    }

    /// Returns true if the volume holds the attenuation of red, green and blue light.
    pub(crate) fn has_colors(&self) -> bool {
        self.texture.format().components() > 1
    }

    /// Returns the size of the texture and the floor map, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let texel = u64::from(self.texture.format().block_copy_size(None).unwrap_or(4));
        let floor = self.floor.as_ref().map_or(0, FloorShadowMap::bytes);
        floor + texel * self.dims.iter().map(|&n| n as u64).product::<u64>()
    }
}

/// Creates the texture of an attenuation volume.
///
/// # Errors
/// Returns an error if memory is exhausted.
pub(crate) fn attenuation_texture(
    context: &GpuContext,
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

/// Returns the data bricks whose scattered sheets are back-projected into `filled`: those within the reverse kernel
/// of radius two.
pub(crate) fn back_projected_bricks(
    volume: &GpuVolume,
    filled: &CellSet,
    divisor: usize,
    views: &[LightView],
) -> BrickSet {
    let reach_bricks = (reverse_reach_voxels(views, &volume.scene) / BRICK_EDGE as f64).ceil() as usize;
    filled.to_bricks().refined(divisor, volume.bricks.dims).dilated(reach_bricks)
}
