//! Volume on the GPU: density texture with a replicated border, and the pyramid made from it.

pub(super) mod brick_list;
pub(super) mod cell_list;
pub(super) mod cell_set_cache;
mod field_texture;
pub(super) mod layers;
pub(super) mod page_pool;
pub(super) mod preclassified;
pub(super) mod presence;
pub(super) mod pyramid;
pub(super) mod reused_textures;
mod texture_shapes;
mod textures;
pub(super) mod transfer_tables;

pub(crate) use pyramid::pyramid_views::{PyramidLevels, PyramidViews};
pub(crate) use texture_shapes::{brick_dims, texture_3d};
#[cfg(feature = "testing")]
pub use textures::stored_density;
pub(crate) use textures::{density_texture, pyramid_texture};

use std::sync::Arc;

use half::f16;

use self::field_texture::FieldTexture;
use self::page_pool::PagePool;
use self::presence::PresenceTextures;
use self::pyramid::density_pyramid::DensityPyramid;
use self::reused_textures::ReusedTextures;
use self::texture_shapes::{pyramid_dims, texel_count};
use self::textures::{density_is_unorm, unorm16};
use super::resources::gpu_tools::GpuTools;
use super::resources::resource_pool::ResourcePool;
use super::{GpuContext, GpuError};
use crate::pipelines::binding::{NamedResource, ShaderPipeline, bind_buffer, bind_view, sampler};
use crate::pipelines::pipeline_variant::GridBoundaries;
use crate::pipelines::uniforms::{GridUniform, PagesUniform};
use crate::plan::PagedView;
use chiaroscuro_volume::{
    BRICK_EDGE, BrickBounds, CELL_EDGE, DatasetField, Observer, Volume, math::SceneSpace,
};

/// Size of an upload step in bytes, small enough for a few milliseconds.
const UPLOAD_BYTES: usize = 2 << 20;

/// Inputs shared by all passes over a volume: device, pipelines, volume and pool.
#[derive(Clone, Copy)]
pub(crate) struct VolumeContext<'a> {
    pub context: &'a GpuContext,
    pub shaders: &'a super::ShaderLibrary,
    pub volume: &'a GpuVolume,
    /// Observer whose way through the volume the pass follows.
    observer: Observer,
    /// 1 × 1 × 1 texture that is bound where a shader declares a texture which the pass does not need.
    pub placeholder: &'a wgpu::TextureView,
    pub pool: &'a ResourcePool,
}

impl<'a> VolumeContext<'a> {
    /// Combines the tools of a device with a volume, for a pass of the eye.
    pub(crate) fn new(tools: &'a GpuTools, volume: &'a GpuVolume) -> Self {
        let GpuTools { context, shaders, pool, placeholder, .. } = tools;
        Self { context, shaders, volume, observer: Observer::Eye, placeholder, pool }
    }

    /// Combines the tools of a device with a volume, for a pass that follows light.
    pub(crate) fn for_light(tools: &'a GpuTools, volume: &'a GpuVolume) -> Self {
        Self { observer: Observer::Light, ..Self::new(tools, volume) }
    }
}

impl VolumeContext<'_> {
    /// Returns a pooled uniform buffer for the submission being recorded.
    pub(crate) fn uniform<T: bytemuck::NoUninit>(&self, label: &'static str, value: T) -> wgpu::Buffer {
        self.pool.buffer(self.context, label, &[value], wgpu::BufferUsages::UNIFORM)
    }

    /// Returns a pooled storage buffer for the submission being recorded; it may be longer than `values`.
    pub(crate) fn storage<T: bytemuck::NoUninit>(&self, label: &'static str, values: &[T]) -> wgpu::Buffer {
        self.pool.buffer(self.context, label, values, wgpu::BufferUsages::STORAGE)
    }

    /// Returns a pooled storage buffer of at least `room` bytes, so that lists of any length up to that share one
    /// buffer.
    pub(crate) fn storage_of_at_least<T: bytemuck::NoUninit>(
        &self,
        label: &'static str,
        values: &[T],
        room: u64,
    ) -> wgpu::Buffer {
        self.pool.buffer_of_at_least(self.context, label, values, wgpu::BufferUsages::STORAGE, room)
    }

    /// Creates a bind group, cached in the pool.
    pub(crate) fn bind(
        &self,
        label: &str,
        pipeline: &ShaderPipeline,
        group: usize,
        entries: &[NamedResource<'_>],
    ) -> wgpu::BindGroup {
        self.pool.bind(self.context, label, pipeline, group, entries)
    }

    /// Creates bind group 1 of passes that read a pyramid but not the density texture.
    pub(crate) fn bind_pyramid(&self, pipeline: &ShaderPipeline, pyramid: &PyramidViews) -> wgpu::BindGroup {
        let volume = self.volume;
        let grid = self.uniform("Volume::grid", volume.grid(0));
        self.bind(
            "Volume::pyramid_bind_group",
            pipeline,
            1,
            &[
                bind_buffer("bound_grid", &grid),
                bind_view("pyramid_texture", &pyramid.all),
                bind_view("presence_texture", self.presence(PyramidLevels::All)),
                sampler("clamped", &volume.clamped),
            ],
        )
    }

    /// Creates bind group 1 of passes that sample density.
    pub(crate) fn bind_volume(
        &self,
        pipeline: &ShaderPipeline,
        dilation: i32,
        levels: PyramidLevels,
        pyramids: PassPyramids<'_>,
    ) -> wgpu::BindGroup {
        self.bind_paged_volume(pipeline, dilation, levels, pyramids, None)
    }

    /// Creates bind group 1 of passes that sample density, of pages where a view of them is given.
    pub(crate) fn bind_paged_volume(
        &self,
        pipeline: &ShaderPipeline,
        dilation: i32,
        levels: PyramidLevels,
        pyramids: PassPyramids<'_>,
        paged: Option<&PagedView>,
    ) -> wgpu::BindGroup {
        let volume = self.volume;
        let mut grid = volume.grid(dilation);
        if let Some(paged) = paged {
            grid.dims = paged.scene.dims.map(|n| n as f32);
        }
        let grid = self.uniform("Volume::grid", grid);
        let (pages_uniform, no_table);
        let mut entries = vec![
            bind_buffer("bound_grid", &grid),
            bind_view("density_texture", &volume.density_view),
            bind_view("pyramid_texture", levels.choose(pyramids.primary)),
            bind_view("presence_texture", self.presence(levels)),
            sampler("clamped", &volume.clamped),
            sampler("nearest", &volume.nearest),
        ];
        if let Some(views) = pyramids.lighting {
            let tints = pyramids.tints.map_or(self.placeholder, |views| levels.choose(views));
            entries.push(bind_view("lighting_pyramid", levels.choose(views)));
            entries.push(bind_view("tint_pyramid", tints));
            entries.push(bind_view("lighting_presence_texture", self.presence_for(Observer::Light, levels)));
            // Every pass of the eye has these bindings.
            let pool = volume.pages.as_ref().zip(paged);
            let pages = pool.map_or_else(PagesUniform::default, |(pool, view)| pool.uniform(view));
            pages_uniform = self.uniform("Volume::pages", pages);
            no_table = self.storage("Volume::no_pages", &[0_u32]);
            let page_table = pool.and_then(|(pool, _)| pool.table()).unwrap_or(&no_table);
            entries.push(bind_buffer("bound_pages", &pages_uniform));
            entries.push(bind_view("page_pool", pool.map_or(self.placeholder, |(pool, _)| &pool.view)));
            entries.push(bind_buffer("page_table", page_table));
        }
        self.bind("Volume::bind_group", pipeline, 1, &entries)
    }

    /// Returns the view of the presence texture of the pass's observer if voxels are missing or hidden, else the
    /// placeholder.
    pub(crate) fn presence(&self, levels: PyramidLevels) -> &wgpu::TextureView {
        self.presence_for(self.observer, levels)
    }

    /// Returns the view of the presence texture of an observer if voxels are missing or hidden, else the placeholder.
    pub(crate) fn presence_for(&self, observer: Observer, levels: PyramidLevels) -> &wgpu::TextureView {
        let presence = self.volume.presence.as_ref();
        presence.map_or(self.placeholder, |presence| levels.choose(&presence.get(observer).views))
    }
}

/// Pyramids that a pass reads: of densities, or of pre-classified voxels ([`preclassified`]).
#[derive(Clone, Copy)]
pub(crate) struct PassPyramids<'a> {
    pub primary: &'a PyramidViews,
    /// Pyramid of what attenuates light, for eye passes that cast near-field rays.
    pub lighting: Option<&'a PyramidViews>,
    /// Pyramid of the tints of further layers, for eye passes.
    pub tints: Option<&'a PyramidViews>,
}

/// Textures, samplers and brick data of a volume.
#[derive(Debug)]
pub(crate) struct GpuVolume {
    /// Volume that is uploaded; kept for later uploads and for the passes' work on the CPU.
    pub volume: Arc<Volume>,
    /// Density ranges of bricks of 8³ voxels, which hold for pages of finer levels as well.
    pub bricks: Arc<BrickBounds>,
    /// Density ranges of bricks of the uploaded voxels alone.
    pub own_bricks: Arc<BrickBounds>,
    /// Transform between index space and scene space.
    pub scene: SceneSpace,
    /// Densities with a border of one voxel.
    pub density: wgpu::Texture,
    pub density_view: wgpu::TextureView,
    /// Pyramid of densities, once a picture has read it.
    pub pyramid: Option<DensityPyramid>,
    /// Views of a single texel, bound in place of a pyramid that no picture has read.
    no_pyramid: PyramidViews,
    /// Densities of all fields, if voxels are composed of layers.
    pub fields: Option<Box<FieldTexture>>,
    /// Pages of finer levels, if the picture reads some.
    pub pages: Option<PagePool>,
    /// Presence textures, if voxels are missing or hidden.
    pub presence: Option<PresenceTextures>,
    /// Packed coordinates of the bricks that are non-empty, for each level of the pyramid of densities.
    pub filled_levels: Vec<Vec<u32>>,
    pub clamped: wgpu::Sampler,
    nearest: wgpu::Sampler,
    is_unorm: bool,
    grid: GridUniform,
}

impl GpuVolume {
    /// Creates the textures. Nothing is uploaded yet, except textures that are passed in. Missing voxels count as
    /// absent if `counts_missing`, else only hidden ones do.
    ///
    /// # Errors
    /// Returns an error if the adapter cannot hold the textures.
    pub(crate) fn new(
        context: &GpuContext,
        volume: &Arc<Volume>,
        bricks: &Arc<BrickBounds>,
        counts_missing: bool,
        reused: ReusedTextures,
    ) -> Result<Self, GpuError> {
        let dims = volume.dims();
        let (density, pyramid) = match reused.density {
            None => (density_texture(context, volume, dims)?, None),
            Some(known) => known,
        };
        let texel = context.texture(&texture_3d(
            "Volume::no_pyramid",
            [1; 3],
            wgpu::TextureFormat::R16Float,
            wgpu::TextureUsages::TEXTURE_BINDING,
        ))?;
        let presence = match reused.presence.filter(|_| presence::is_needed(volume, counts_missing)) {
            None => PresenceTextures::new(context, volume, dims, counts_missing)?,
            Some((known, _)) => Some(known.with_observers_of(context, volume, dims)?),
        };
        let padded = pyramid_dims(dims);
        let reciprocal = |sizes: [usize; 3]| sizes.map(|n| 1.0 / n as f32);
        let grid = GridUniform {
            dims: dims.map(|n| n as f32),
            dilation: 0,
            density_scale: reciprocal(dims.map(|n| n + 2)),
            pad0: 0.0,
            pyramid_scale: reciprocal(padded),
            pad1: 0.0,
            cell_scale: reciprocal(bricks.dims.map(|n| n * BRICK_EDGE / CELL_EDGE)),
            pad2: 0.0,
        };
        Ok(Self {
            volume: Arc::clone(volume),
            bricks: Arc::clone(bricks),
            own_bricks: Arc::clone(bricks),
            scene: volume.scene(),
            density_view: density.create_view(&wgpu::TextureViewDescriptor::default()),
            density,
            filled_levels: pyramid::nonempty_bricks(bricks, dims),
            pyramid,
            no_pyramid: PyramidViews::new(&texel),
            fields: None,
            pages: None,
            presence,
            clamped: context.sampler("Volume::clamped"),
            nearest: context.device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("Volume::nearest"),
                ..Default::default()
            }),
            is_unorm: density_is_unorm(context, volume),
            grid,
        })
    }

    /// Adds the texture of all fields, of which voxels are composed.
    ///
    /// # Errors
    /// Returns an error if the adapter cannot hold it.
    pub(crate) fn with_fields(
        self,
        context: &GpuContext,
        fields: &Arc<[DatasetField]>,
    ) -> Result<Self, GpuError> {
        Ok(Self { fields: Some(Box::new(FieldTexture::new(context, fields)?)), ..self })
    }

    /// Creates the pyramid of densities if there is none. Returns true if it has yet to be filled.
    ///
    /// # Errors
    /// Returns an error if the adapter cannot hold it.
    pub(crate) fn begin_pyramid(&mut self, context: &GpuContext) -> Result<bool, GpuError> {
        if self.pyramid.is_none() {
            self.pyramid = Some(DensityPyramid::new(context, &self.volume)?);
        }
        Ok(self.pyramid.as_ref().is_some_and(|pyramid| !pyramid.is_complete()))
    }

    /// Returns the views of the pyramid of densities, which are those of a single texel until a picture reads it.
    pub(crate) fn pyramid_views(&self) -> &PyramidViews {
        self.pyramid.as_ref().map_or(&self.no_pyramid, |pyramid| &pyramid.views)
    }

    /// Returns the number of z-slices per upload step.
    pub(crate) fn slices_per_step(&self) -> usize {
        let [nx, ny, _] = self.volume.dims();
        (UPLOAD_BYTES / (nx * ny * 2)).max(1)
    }

    /// Uploads some z-slices, each with a replicated border of one voxel; the first and last slices are also
    /// replicated in front and behind.
    pub(crate) fn upload(&self, context: &GpuContext, slices: std::ops::Range<usize>) {
        use rayon::prelude::*;
        if let Some(fields) = &self.fields {
            fields.upload(context, slices.clone());
        }
        let [nx, ny, nz] = self.volume.dims();
        let encode =
            |density: f32| if self.is_unorm { unorm16(density) } else { f16::from_f32(density).to_bits() };
        let first = if slices.start == 0 { 0 } else { slices.start + 1 };
        let end = if slices.end == nz { nz + 2 } else { slices.end + 1 };
        // Voxel that a texel of the border replicates.
        let voxel = |texel: usize, n: usize| texel.saturating_sub(1).min(n - 1);
        let words: Vec<u16> = (first..end)
            .into_par_iter()
            .flat_map_iter(|z| {
                let slice: Vec<u16> =
                    self.volume.slice_densities(voxel(z, nz)).into_iter().map(encode).collect();
                let mut padded = Vec::with_capacity((nx + 2) * (ny + 2));
                for y in 0..ny + 2 {
                    let row = &slice[voxel(y, ny) * nx..][..nx];
                    padded.push(row[0]);
                    padded.extend_from_slice(row);
                    padded.push(row[nx - 1]);
                }
                padded
            })
            .collect();
        let (width, height) = (nx as u32 + 2, ny as u32 + 2);
        context.queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                texture: &self.density,
                mip_level: 0,
                origin: wgpu::Origin3d { x: 0, y: 0, z: first as u32 },
                aspect: wgpu::TextureAspect::All,
            },
            bytemuck::cast_slice(&words),
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(2 * width),
                rows_per_image: Some(height),
            },
            wgpu::Extent3d { width, height, depth_or_array_layers: (end - first) as u32 },
        );
    }

    /// Returns the grid boundaries that can be visible with any transfer function.
    pub(crate) fn possible_boundaries(&self) -> GridBoundaries {
        if self.presence.is_some() { GridBoundaries::MissingVoxels } else { GridBoundaries::OppositeFaces }
    }

    /// Returns the uniform of the grid, for a pass whose samples reach `dilation` cells beyond their own.
    pub(crate) fn grid(&self, dilation: i32) -> GridUniform {
        GridUniform { dilation, ..self.grid }
    }

    /// Returns the size of the textures, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        // The coarser levels of the pyramid add a seventh.
        let pyramid = self
            .pyramid
            .as_ref()
            .map_or(0, |pyramid| texel_count(&pyramid.texture) * 16 / 7 + pyramid.gradient_bytes());
        let presence = self.presence.as_ref().map_or(0, PresenceTextures::bytes);
        let fields = self.fields.as_ref().map_or(0, |fields| fields.bytes());
        let pages = self.pages.as_ref().map_or(0, PagePool::bytes);
        2 * texel_count(&self.density) + pyramid + presence + fields + pages
    }
}
