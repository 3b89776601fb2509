//! The march of a sky's light, direction by direction.

use glam::DVec3;

use super::batches::{Batches, sheet_size};
use super::blocks::BlocksPass;
use super::floor_map::MAP_EDGE;
use super::sheets::RaySheets;
use super::volume::{SUM_BYTES, SkyVolume};
use crate::gpu::pipelines::binding::{Named, buffer, sampler, view_of};
use crate::gpu::pipelines::uniforms;
use crate::gpu::pipelines::variant::{ColorVariant, Constants, Variant, flag};
use crate::gpu::resources::pass;
use crate::gpu::volume::transfer_tables::Tables;
use crate::gpu::volume::{Gpu, texture_3d};
use crate::gpu::{Context, GpuError, RenderOptions};
use crate::model::Settings;
use crate::plan::{SkyKey, SweepFrame, directions_above, sweep_directions};

/// The filling of a volume of the sky's visibility.
#[derive(Debug)]
pub(crate) struct SkyBuild {
    /// Rays from every direction.
    around: Batches,
    /// Rays from above, for a floor: those from all around would draw petals under what is small.
    above: Batches,
    /// What multiplies the extinction.
    density_scale: f64,
    textures: Textures,
}

/// What only the filling needs.
#[derive(Debug)]
struct Textures {
    /// Optical depth of blocks, with one of nothing around the grid.
    blocks: wgpu::TextureView,
    /// What rays deposit.
    sheets: RaySheets,
    /// Moments so far.
    sums: wgpu::Buffer,
    /// The same of the floor's map.
    floor_sums: Option<wgpu::Buffer>,
    bytes: u64,
}

impl SkyBuild {
    /// Lays out the filling of a volume.
    ///
    /// # Errors
    /// When memory is out.
    pub(crate) fn new(gpu: Gpu<'_>, key: &SkyKey, volume: &SkyVolume) -> Result<Self, GpuError> {
        let scene = &gpu.volume.scene;
        let frames_of = |directions: Vec<DVec3>| {
            let frames =
                directions.into_iter().map(|towards| SweepFrame::new(scene, volume.divisor, towards));
            frames.collect::<Vec<_>>()
        };
        let around = frames_of(sweep_directions(key.directions()));
        let up = volume.floor.as_ref().map(|floor| floor.place.up.direction());
        let above = up.map_or_else(Vec::new, |up| frames_of(directions_above(up, key.directions())));
        let all = around.iter().chain(&above);
        let size = sheet_size(all, gpu.context.storage_format, around.len() + above.len());
        let textures = Textures::new(gpu.context, volume, size)?;
        let [around, above] = [around, above].map(|frames| Batches::new(frames, size[2]));
        Ok(Self { around, above, density_scale: key.density_scale(), textures })
    }

    /// Batches of directions.
    pub(crate) fn batches(&self) -> usize {
        self.around.count() + self.above.count()
    }

    /// Bytes that only the filling needs.
    pub(crate) fn bytes(&self) -> u64 {
        self.textures.bytes
    }

    /// Fills the blocks with what attenuates light.
    pub(crate) fn fill_blocks(
        &self,
        gpu: Gpu<'_>,
        tables: &Tables,
        settings: &Settings,
        options: &RenderOptions,
        volume: &SkyVolume,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let pass = BlocksPass {
            shader: "sky/blocks.wgsl",
            dims: volume.dims,
            divisor: volume.divisor,
            density_scale: self.density_scale,
            albedo: 0.0,
            one_color: false,
            format: gpu.context.storage_format,
            tables,
            settings,
            options,
        };
        pass.record(gpu, &[view_of("extinction", &self.textures.blocks)], encoder)
    }

    /// Follows light from the directions of a batch, and adds what arrives to what came before.
    pub(crate) fn fill_batch(
        &self,
        gpu: Gpu<'_>,
        volume: &SkyVolume,
        batch: usize,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let Textures { blocks, sheets, sums, .. } = &self.textures;
        // Those from all around come first.
        let (batches, batch, is_above) = match batch.checked_sub(self.around.count()) {
            None => (&self.around, batch, false),
            Some(batch) => (&self.above, batch, true),
        };
        let is_last = batch + 1 == batches.count();
        let pass = SweepPass {
            shader: "sky/sweep.wgsl",
            one_color: false,
            frames: batches.frames(batch),
            dims: volume.dims,
            sheets,
            is_first: batch == 0,
            share: 1.0 / batches.directions() as f32,
        };
        let uniform = pass.record(gpu, view_of("extinction", blocks), |_| DVec3::ZERO, encoder)?;
        if is_above {
            return self.fill_floor(gpu, volume, &uniform, is_last, encoder);
        }
        let gather = gpu.shaders.pipeline(&GatherVariant {
            is_last: Some(is_last),
            ..GatherVariant::of("sky/moments.wgsl", batches)
        })?;
        let entries = [
            buffer("bound_sweep", &uniform),
            view_of("sheets", &sheets.view),
            sampler("clamped", &gpu.volume.clamped),
            buffer("sums", sums),
            view_of("moments", &volume.view),
        ];
        let own = gpu.bind("Sky::moments", &gather, 0, &entries);
        let groups = volume.dims.map(|n| (n as u32).div_ceil(4));
        pass::dispatch(encoder, "Sky::moments", &gather, &[&own], groups);
        Ok(())
    }

    /// Adds what the floor sees of a batch of directions to what came before.
    fn fill_floor(
        &self,
        gpu: Gpu<'_>,
        volume: &SkyVolume,
        sweep: &wgpu::Buffer,
        is_last: bool,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let (Some(floor), Some(sums)) = (&volume.floor, &self.textures.floor_sums) else { return Ok(()) };
        let uniform = floor.uniform(&gpu.volume.scene, volume.divisor, 1.0 / self.above.directions() as f64);
        let uniform = gpu.uniform("Sky::floor_map", uniform);
        let pipeline = gpu.shaders.pipeline(&GatherVariant {
            is_last: Some(is_last),
            ..GatherVariant::of("sky/floor_map.wgsl", &self.above)
        })?;
        let entries = [
            buffer("bound_sweep", sweep),
            buffer("bound_map", &uniform),
            view_of("sheets", &self.textures.sheets.view),
            buffer("sums", sums),
            view_of("moments", &floor.view),
        ];
        let own = gpu.bind("Sky::floor_map", &pipeline, 0, &entries);
        pass::dispatch(encoder, "Sky::floor_map", &pipeline, &[&own], pass::tiles([MAP_EDGE; 2]));
        Ok(())
    }
}

impl Textures {
    fn new(context: &Context, volume: &SkyVolume, sheet_size: [usize; 3]) -> Result<Self, GpuError> {
        let dims = volume.dims;
        let usages = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING;
        let format = context.storage_format;
        let block_size = dims.map(|n| n + 2);
        let blocks = context.texture(&texture_3d("Sky::blocks", block_size, format, usages))?;
        let sheets = RaySheets::new(context, sheet_size, format)?;
        let texels = |size: [usize; 3]| size.iter().map(|&n| n as u64).product::<u64>();
        let sums = |label, count: u64| {
            context.empty_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: SUM_BYTES * count,
                usage: wgpu::BufferUsages::STORAGE,
                mapped_at_creation: false,
            })
        };
        let floor = volume.floor.as_ref().map(|_| u64::from(MAP_EDGE * MAP_EDGE));
        let texel = u64::from(format.block_copy_size(None).unwrap_or(4));
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Self {
            blocks: view(&blocks),
            sums: sums("Sky::sums", texels(dims)),
            floor_sums: floor.map(|texels| sums("Sky::floor_sums", texels)),
            bytes: texel * texels(block_size)
                + sheets.bytes()
                + SUM_BYTES * (texels(dims) + floor.unwrap_or(0)),
            sheets,
        })
    }
}

/// A batch of directions in which light is followed through blocks, by a shader that imports `sky/rays.wgsl`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SweepPass<'a> {
    pub shader: &'static str,
    /// Whether light has one colour all through (`bounces/sweep.wgsl`).
    pub one_color: bool,
    pub frames: &'a [SweepFrame],
    /// Blocks along x, y and z.
    pub dims: [usize; 3],
    /// What is filled.
    pub sheets: &'a RaySheets,
    /// Whether nothing has been summed before.
    pub is_first: bool,
    /// One over all directions: what makes their sum a mean.
    pub share: f32,
}

impl SweepPass<'_> {
    /// Records it: light that arrives from directions goes through what `blocks` name, into the sheets. Returns what the passes
    /// that gather from these need to know.
    pub(crate) fn record(
        &self,
        gpu: Gpu<'_>,
        blocks: Named<'_>,
        arriving: impl Fn(DVec3) -> DVec3,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<wgpu::Buffer, GpuError> {
        let Self { shader, one_color, frames, dims, sheets, is_first, share } = *self;
        let edge = gpu.volume.scene.smallest_edge();
        // What is left over has no weight, and no rays.
        let mut rays = [bytemuck::Zeroable::zeroed(); uniforms::MAX_SKY_RAYS];
        let mut layer = 0;
        for (slot, frame) in rays.iter_mut().zip(frames) {
            *slot = pack(frame, edge, layer, arriving(frame.towards));
            layer += frame.slices();
        }
        let reciprocal = |size: [usize; 3]| size.map(|n| 1.0 / n as f32);
        let uniform = uniforms::Sweep {
            dims: dims.map(|n| n as u32),
            share,
            block_scale: reciprocal(dims.map(|n| n + 2)),
            has_sums: if is_first { 0.0 } else { 1.0 },
            sheet_scale: reciprocal(sheets.size),
            pad0: 0.0,
            rays,
        };
        let uniform = gpu.uniform("Sweep::uniform", uniform);
        let pipeline = gpu.shaders.pipeline_into(&ColorVariant { shader, one_color }, sheets.format)?;
        let entries = [
            buffer("bound_sweep", &uniform),
            blocks,
            sampler("clamped", &gpu.volume.clamped),
            view_of("sheets", &sheets.view),
        ];
        let own = gpu.bind("Sweep::own", &pipeline, 0, &entries);
        let across = |side: usize| frames.iter().map(|frame| frame.size[side]).max().unwrap_or(1).div_ceil(8);
        let groups = [across(0), across(1), frames.len() as u32];
        pass::dispatch(encoder, "Sweep::pass", &pipeline, &[&own], groups);
        Ok(uniform)
    }
}

/// The rays of a direction for the shaders, from which so much light arrives; `edge` is that of a voxel.
fn pack(frame: &SweepFrame, edge: f64, layer: usize, arriving: DVec3) -> uniforms::SkyRays {
    uniforms::SkyRays {
        towards: frame.towards.as_vec3().into(),
        step: (frame.step / edge) as f32,
        drift: frame.drift.as_vec2().into(),
        first: frame.first.map(|at| at as f32),
        size: frame.size,
        axis: frame.axis as u32,
        rises: u32::from(frame.rises),
        arriving: arriving.as_vec3().into(),
        layer: layer as u32,
        weight: 1.0,
        pad0: 0.0,
        pad1: 0.0,
        pad2: 0.0,
    }
}

/// What tells one pipeline that gathers from a sweep from another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct GatherVariant {
    pub shader: &'static str,
    /// Directions of a batch.
    directions: usize,
    /// Whether none comes after it, of a shader that stores the mean then.
    is_last: Option<bool>,
}

impl GatherVariant {
    /// That of a shader which stores no mean.
    pub(crate) fn of(shader: &'static str, batches: &Batches) -> Self {
        Self { shader, directions: batches.each(), is_last: None }
    }
}

impl Variant for GatherVariant {
    fn shader(&self) -> &'static str {
        self.shader
    }

    fn constants(&self) -> Constants {
        let mut constants = vec![("DIRECTIONS", self.directions as f64)];
        constants.extend(self.is_last.map(|is_last| flag("IS_LAST", is_last)));
        constants
    }
}
