//! Filling of a sky-visibility volume: its temporary textures and its steps.

use glam::DVec3;

use super::block_texture::BlockTexture;
use super::direction_batches::{DirectionBatches, sheet_size};
use super::extinction_blocks::{self, BlocksPass};
use super::floor_map::FloorSkyMap;
use super::sharpened_blocks::{SOLID_DEPTH, SharpenedBlocks};
use super::sheets::RaySheets;
use super::surfaces::{START_REACH, SurfaceBlocks};
use super::sweep::{SweepGatherVariant, SweepPass};
use super::volume::{SUM_BYTES, SkyVolume};
use crate::pipelines::binding::{bind_buffer, bind_view, sampler};
use crate::plan::{SkyKey, SweepFrame, boxes_around, directions_above, sweep_directions};
use crate::resources::pass;
use crate::volume::cell_list::CellList;
use crate::volume::transfer_tables::TransferTables;
use crate::volume::{VolumeContext, texture_3d};
use crate::{GpuContext, GpuError, RenderOptions};
use chiaroscuro_scene::Settings;

/// Work to fill a volume of sky visibility.
#[derive(Debug)]
pub(crate) struct SkyFill {
    /// Rays from all directions.
    all_directions: DirectionBatches,
    /// Rays from above, for the floor; the few directions all around would draw petal-shaped shadows under small
    /// objects.
    upper_directions: DirectionBatches,
    /// Factor applied to extinction.
    density_scale: f64,
    /// `true` if dense material has surfaces that face the sky.
    has_surfaces: bool,
    /// Blocks in which something may attenuate light.
    attenuating_cells: CellList,
    /// Blocks that pictures look up.
    output_cells: CellList,
    textures: SkyTextures,
    /// Blocks with sharp surfaces; `None` if material has no surfaces.
    sharpened: Option<SharpenedBlocks>,
}

/// Temporary textures and buffers for the filling.
#[derive(Debug)]
struct SkyTextures {
    /// Optical depth of blocks, with a border of empty blocks around the grid.
    blocks: wgpu::TextureView,
    /// Transmittance along rays.
    sheets: RaySheets,
    /// Surfaces of the blocks that pictures look up.
    surfaces: SurfaceBlocks,
    /// Sums of the moments over the batches so far.
    sums: wgpu::Buffer,
    /// Temporary resources for the floor's map.
    floor: Option<FloorTextures>,
    bytes: u64,
}

/// Temporary textures and buffers for the floor's map.
#[derive(Debug)]
struct FloorTextures {
    /// Transmittance of rays where they meet the floor.
    transmittance: RaySheets,
    /// Sums of the moments over the batches so far.
    sums: wgpu::Buffer,
}

impl SkyFill {
    /// Plans the filling of a volume, and allocates its temporary textures.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(
        gpu: VolumeContext<'_>,
        tables: &TransferTables,
        options: &RenderOptions,
        key: &SkyKey,
        volume: &SkyVolume,
    ) -> Result<Self, GpuError> {
        let scene = &gpu.volume.scene;
        let frames_of = |directions: Vec<DVec3>| {
            let frames =
                directions.into_iter().map(|towards| SweepFrame::new(scene, volume.blocks.divisor, towards));
            frames.collect::<Vec<_>>()
        };
        let around = frames_of(sweep_directions(key.directions()));
        let up = volume.floor.as_ref().map(|floor| floor.extent.up.direction());
        let above = up.map_or_else(Vec::new, |up| frames_of(directions_above(up, key.directions())));
        let BlockTexture { dims, divisor, .. } = volume.blocks;
        let attenuating =
            |margin| extinction_blocks::attenuating_cells(tables, options, dims, divisor, margin);
        let met = attenuating(0);
        let sharpen = || SharpenedBlocks::new(gpu.context, dims, &attenuating(1));
        let sharpened = key.has_surfaces().then(sharpen).transpose()?;
        // Rays start in front of surfaces.
        let reach = if key.has_surfaces() { START_REACH } else { 0.0 };
        let mut read = boxes_around(&volume.filled_cells);
        for [low, high] in &mut read {
            *low -= reach;
            *high += reach;
        }
        read.extend(boxes_around(&met));
        let size = sheet_size(around.iter(), gpu.context.storage_format, around.len());
        let around = DirectionBatches::new(around, size[2], &read);
        let above = DirectionBatches::with_end_layers(above, &boxes_around(&met));
        let [met, looked_up] = [&met, &*volume.filled_cells].map(|cells| CellList::new(gpu.context, cells));
        let textures = SkyTextures::new(gpu.context, volume, size, &above, looked_up.voxel_count())?;
        Ok(Self {
            all_directions: around,
            upper_directions: above,
            density_scale: key.density_scale(),
            has_surfaces: key.has_surfaces(),
            attenuating_cells: met,
            output_cells: looked_up,
            textures,
            sharpened,
        })
    }

    /// Returns the number of batches of directions.
    pub(crate) fn batches(&self) -> usize {
        self.all_directions.count() + self.upper_directions.count()
    }

    /// Returns the size of the temporary resources, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let sharpened = self.sharpened.as_ref().map_or(0, SharpenedBlocks::bytes);
        self.textures.bytes + sharpened + self.attenuating_cells.bytes() + self.output_cells.bytes()
    }

    /// Uploads the geometry of blocks.
    fn geometry(&self, gpu: VolumeContext<'_>, volume: &SkyVolume) -> wgpu::Buffer {
        let directions = self.all_directions.directions();
        SurfaceBlocks::geometry(gpu, &volume.blocks, directions, self.has_surfaces)
    }

    /// Returns the extinction that rays meet.
    fn swept(&self) -> &wgpu::TextureView {
        self.sharpened.as_ref().map_or(&self.textures.blocks, |sharpened| &sharpened.view)
    }

    /// Fills the blocks of extinction.
    pub(crate) fn fill_blocks(
        &self,
        gpu: VolumeContext<'_>,
        tables: &TransferTables,
        settings: &Settings,
        volume: &SkyVolume,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        volume.clear_margin(gpu, encoder)?;
        let pass = BlocksPass {
            shader: "sky/extinction_blocks.wgsl",
            dims: volume.blocks.dims,
            divisor: volume.blocks.divisor,
            sample_offset: extinction_blocks::sample_offset(volume.blocks.divisor, false),
            density_scale: self.density_scale,
            max_depth: if self.has_surfaces { SOLID_DEPTH } else { f32::MAX },
            albedo: 0.0,
            one_color: false,
            format: gpu.context.storage_format,
            cells: &self.attenuating_cells,
            tables,
            settings,
        };
        pass.record(gpu, &[bind_view("extinction", &self.textures.blocks)], encoder)?;
        let SkyTextures { blocks, surfaces, .. } = &self.textures;
        if let Some(sharpened) = &self.sharpened {
            sharpened.fill(gpu, &volume.blocks, blocks, encoder)?;
        }
        let directions = SurfaceBlocks::directions(gpu, &self.all_directions);
        surfaces.find(gpu, blocks, &self.output_cells, &self.geometry(gpu, volume), &directions, encoder)
    }

    /// Sweeps the directions of a batch, and adds their transmittance to the moments.
    pub(crate) fn fill_batch(
        &self,
        gpu: VolumeContext<'_>,
        volume: &SkyVolume,
        batch: usize,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        // Batches from all directions precede those from above.
        if let Some(batch) = batch.checked_sub(self.all_directions.count()) {
            return self.fill_floor(gpu, volume, batch, encoder);
        }
        let SkyTextures { sheets, surfaces, sums, .. } = &self.textures;
        let pass = SweepPass {
            shader: "sky/sweep.wgsl",
            one_color: false,
            rays: self.all_directions.rays(batch),
            dims: volume.blocks.dims,
            sheets,
            is_first: batch == 0,
            share: 1.0 / self.all_directions.directions() as f32,
        };
        let entries = [bind_view("extinction", self.swept()), bind_view("sheets", &sheets.view)];
        let uniform = pass.record(gpu, &entries, |_| DVec3::ZERO, encoder)?;
        let gather = SweepGatherVariant::with_mean("sky/moments.wgsl", &self.all_directions, batch);
        let gather = gpu.shaders.pipeline(&gather)?;
        let geometry = self.geometry(gpu, volume);
        let entries = [
            bind_buffer("bound_sweep", &uniform),
            bind_view("sheets", &sheets.view),
            sampler("clamped", &gpu.volume.clamped),
            bind_buffer("sums", sums),
            bind_buffer("surfaces", &surfaces.buffer),
            bind_buffer("bound_geometry", &geometry),
            bind_view("moments", &volume.blocks.view),
            self.output_cells.binding(),
        ];
        let own = gpu.bind("Sky::moments", &gather, 0, &entries);
        pass::dispatch(encoder, "Sky::moments", &gather, &[&own], self.output_cells.workgroups());
        Ok(())
    }

    /// Sweeps the directions of a batch down to the floor, and adds the result to the moments of its map.
    fn fill_floor(
        &self,
        gpu: VolumeContext<'_>,
        volume: &SkyVolume,
        batch: usize,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let SkyTextures { floor: Some(FloorTextures { transmittance, sums }), .. } = &self.textures else {
            return Ok(());
        };
        let Some(floor) = &volume.floor else { return Ok(()) };
        let place = floor.uniform(
            &gpu.volume.scene,
            volume.blocks.divisor,
            1.0 / self.upper_directions.directions() as f64,
        );
        let place = gpu.uniform("Sky::floor_map", place);
        let pass = SweepPass {
            shader: "sky/floor_sweep.wgsl",
            one_color: false,
            rays: self.upper_directions.rays(batch),
            dims: volume.blocks.dims,
            sheets: transmittance,
            is_first: batch == 0,
            share: 0.0,
        };
        let entries = [
            bind_view("extinction", self.swept()),
            bind_view("transmittance", &transmittance.view),
            bind_buffer("bound_map", &place),
        ];
        let uniform = pass.record(gpu, &entries, |_| DVec3::ZERO, encoder)?;
        let gather = SweepGatherVariant::with_mean("sky/floor_map.wgsl", &self.upper_directions, batch);
        let gather = gpu.shaders.pipeline(&gather)?;
        let entries = [
            bind_buffer("bound_sweep", &uniform),
            bind_buffer("bound_map", &place),
            bind_view("transmittance", &transmittance.view),
            sampler("clamped", &gpu.volume.clamped),
            bind_buffer("sums", sums),
            bind_view("moments", &floor.view),
        ];
        let own = gpu.bind("Sky::floor_map", &gather, 0, &entries);
        pass::dispatch(encoder, "Sky::floor_map", &gather, &[&own], pass::tile_workgroups([floor.edge; 2]));
        Ok(())
    }
}

impl SkyTextures {
    /// Allocates sheets of `sheet_size` texels, sums for `looked_up` blocks, and if there is a floor the textures for
    /// its map.
    fn new(
        context: &GpuContext,
        volume: &SkyVolume,
        sheet_size: [usize; 3],
        above: &DirectionBatches,
        looked_up: u64,
    ) -> Result<Self, GpuError> {
        let usages = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING;
        let format = context.storage_format;
        let block_size = volume.blocks.dims.map(|n| n + 2);
        let blocks = context.texture(&texture_3d("Sky::blocks", block_size, format, usages))?;
        let sheets = RaySheets::new(context, sheet_size, format)?;
        let sums = |label, count: u64| {
            context.uninitialised_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: SUM_BYTES * count.max(1),
                usage: wgpu::BufferUsages::STORAGE,
                mapped_at_creation: false,
            })
        };
        let of_floor = |floor: &FloorSkyMap| {
            // Before the rays there are a column and a row of rays that miss the grid.
            let [width, height] = above.max_size().map(|n| n + 1);
            let transmittance =
                RaySheets::new(context, [width, height, above.directions_per_batch()], format)?;
            Ok::<_, GpuError>(FloorTextures { transmittance, sums: sums("Sky::floor_sums", floor.texels()) })
        };
        let floor = volume.floor.as_ref().map(of_floor).transpose()?;
        let sums = sums("Sky::sums", looked_up);
        let surfaces = SurfaceBlocks::new(context, looked_up);
        let of_floor = floor.as_ref().map_or(0, |floor| floor.transmittance.bytes() + floor.sums.size());
        let texel = u64::from(format.block_copy_size(None).unwrap_or(4));
        let block_bytes = texel * block_size.iter().map(|&n| n as u64).product::<u64>();
        Ok(Self {
            blocks: blocks.create_view(&wgpu::TextureViewDescriptor::default()),
            bytes: block_bytes + sheets.bytes() + sums.size() + surfaces.buffer.size() + of_floor,
            sheets,
            surfaces,
            sums,
            floor,
        })
    }
}
