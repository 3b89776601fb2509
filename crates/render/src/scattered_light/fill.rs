//! Filling of a volume of scattered light: its temporary textures and its steps.

use glam::DVec3;

use super::block_passes::{BlockPasses, workgroups_over_blocks};
use super::diffusion::{DiffusionSolver, diffuses};
use super::source_variant::SourceVariant;
use super::steps::{ScatteringStep, SweepSource, scattering_steps};
use super::textures::ScatteringTextures;
use super::volume::ScatteredLightVolume;
use crate::light::light_uniform::light_uniform;
use crate::pipelines::binding::{bind_buffer, bind_view, sampler};
use crate::pipelines::pipeline_variant::{ColorVariant, SingleVariant};
use crate::pipelines::uniforms;
use crate::plan::{ActiveLights, BouncesKey, SweepFrame, UniformLightColor, boxes_around, sweep_directions};
use crate::resources::pass;
use crate::sky::direction_batches::{BATCH_BLOCKS, DirectionBatches, sheet_size};
use crate::sky::extinction_blocks::{self, BlocksPass};
use crate::sky::sweep::{SweepGatherVariant, SweepPass};
use crate::volume::VolumeContext;
use crate::volume::cell_list::CellList;
use crate::volume::transfer_tables::TransferTables;
use crate::{GpuError, RenderOptions};
use chiaroscuro_scene::{MAX_LIGHTS, Settings};

/// Inputs from the picture for the filling: transfer tables, settings and lights.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ScatteringInputs<'a> {
    pub tables: &'a TransferTables,
    pub settings: &'a Settings,
    pub lights: &'a ActiveLights,
}

/// Work to fill a volume of scattered light.
#[derive(Debug)]
pub(crate) struct ScatteredLightFill {
    /// Rays of the intermediate bounces, and those of the last bounce.
    batches: [DirectionBatches; 2],
    /// Number of blocks along x, y and z.
    dims: [usize; 3],
    /// Number of rays from a block to the points of all lights.
    rays_per_block: usize,
    bounces: u32,
    /// Maximum number of points on an area light.
    max_light_points: u32,
    has_sky: bool,
    /// Common colour of all light, if there is one.
    one_color: Option<UniformLightColor>,
    /// Blocks in which something may attenuate light.
    attenuating_cells: CellList,
    /// Blocks that pictures look up.
    output_cells: CellList,
    textures: ScatteringTextures,
    /// Solver for the light of all later bounces, if more than one is wanted.
    diffusion: Option<DiffusionSolver>,
}

impl ScatteredLightFill {
    /// Plans the filling of a volume, and allocates its temporary textures.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(
        gpu: VolumeContext<'_>,
        tables: &TransferTables,
        options: &RenderOptions,
        key: &BouncesKey,
        settings: &Settings,
        volume: &ScatteredLightVolume,
    ) -> Result<Self, GpuError> {
        let scene = &gpu.volume.scene;
        let frames = [key.directions_of_a_bounce(), key.directions()].map(|directions| {
            sweep_directions(directions)
                .into_iter()
                .map(|towards| SweepFrame::new(scene, volume.blocks.divisor, towards))
                .collect::<Vec<_>>()
        });
        let one_color = key.one_color();
        let format = ScatteringTextures::sheet_format(gpu.context, one_color.is_some());
        let [frames_per_bounce, last] = frames.each_ref().map(Vec::len);
        let followed = key.bounces().saturating_sub(1) as usize * frames_per_bounce + last;
        let size = sheet_size(frames.iter().flatten(), format, followed);
        let textures = ScatteringTextures::new(gpu.context, volume, size, one_color.is_some())?;
        let edges = (scene.voxel_edges / scene.smallest_edge()).as_vec3() * volume.blocks.divisor as f32;
        let diffusion =
            (key.bounces() > 1).then(|| DiffusionSolver::new(gpu.context, volume.blocks.dims, edges.into()));
        let lights = settings.lights.iter().filter(|light| light.on).count();
        let rays = (lights * key.points() as usize).max(1);
        let (dims, divisor) = (volume.blocks.dims, volume.blocks.divisor);
        // Sample points of single voxels may be in the next cell, if lamps alone shine.
        let margin = usize::from(divisor == 1 && !settings.sky.is_on());
        let met = extinction_blocks::attenuating_cells(tables, options, dims, divisor, margin);
        // Pictures also look up the last bounce beside the blocks that scatter light.
        let visible_cells = met.union(&volume.filled_cells);
        let [each, last] = frames;
        Ok(Self {
            batches: [
                DirectionBatches::new(each, size[2], &boxes_around(&met)),
                DirectionBatches::new(last, size[2], &boxes_around(&visible_cells)),
            ],
            attenuating_cells: CellList::new(gpu.context, &met),
            output_cells: CellList::new(gpu.context, &volume.filled_cells),
            dims: volume.blocks.dims,
            rays_per_block: rays,
            bounces: key.bounces(),
            max_light_points: key.points(),
            has_sky: settings.sky.is_on(),
            one_color,
            textures,
            diffusion,
        })
    }

    /// Returns the steps of the filling, in order.
    pub(crate) fn steps(&self) -> Vec<ScatteringStep> {
        let [slices, at_once] = [self.dims[2], self.slices_per_step()];
        let batches = |followed| self.batches(followed).count();
        scattering_steps(self.bounces, self.has_sky, slices, at_once, batches)
    }

    /// Returns the number of slices of blocks that cast rays to lights in one step, so that it takes no longer than a
    /// batch of directions.
    fn slices_per_step(&self) -> usize {
        let [x, y, z] = self.dims;
        (BATCH_BLOCKS / (x * y * self.rays_per_block * x.max(y).max(z))).max(1)
    }

    /// Returns the rays of a sweep.
    fn batches(&self, followed: SweepSource) -> &DirectionBatches {
        let [bounce, last] = &self.batches;
        if followed == SweepSource::LastBounce { last } else { bounce }
    }

    /// Returns the size of the temporary resources, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let diffusion = self.diffusion.as_ref().map_or(0, |diffusion| diffusion.bytes);
        self.textures.bytes + diffusion + self.attenuating_cells.bytes() + self.output_cells.bytes()
    }

    /// Records one step of the filling.
    pub(crate) fn record(
        &self,
        gpu: VolumeContext<'_>,
        look: ScatteringInputs<'_>,
        volume: &ScatteredLightVolume,
        step: ScatteringStep,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        match step {
            ScatteringStep::Blocks => {
                self.fill_blocks(gpu, look, volume, encoder)?;
                self.diffusion.iter().try_for_each(|diffusion| {
                    diffusion.record_stencils(gpu, &self.textures.scattering, encoder)
                })
            }
            ScatteringStep::Batch(followed, batch) => {
                self.fill_batch(gpu, look.settings, volume, followed, batch, encoder)
            }
            ScatteringStep::SingleScattering { slice } => {
                if self.has_sky && slice == 0 {
                    self.block_passes(gpu, volume, SweepSource::Sky).record_received_light(false, encoder)?;
                }
                self.fill_single_scattering(gpu, look, volume, slice, encoder)
            }
            ScatteringStep::Emission { bounce } => {
                let passes = self.block_passes(gpu, volume, SweepSource::Bounce);
                if bounce > 0 {
                    passes.record_received_light(!self.has_sky, encoder)?;
                }
                let diffusion = self.diffusion.as_ref().filter(|_| diffuses(self.bounces, bounce));
                if let Some(diffusion) = diffusion {
                    diffusion.record_cycle(gpu, bounce > 0, self.textures.diffusion_inputs(), encoder)?;
                }
                // Two steps of the same kind are mixed.
                let mixes = bounce > 1 && diffuses(self.bounces, bounce - 1) && diffusion.is_some();
                if mixes {
                    let mixing = SingleVariant("scattered_light/mixing.wgsl");
                    passes.record(&mixing, encoder)?;
                }
                let source = SourceVariant {
                    has_bounced: bounce > 0,
                    diffuses: diffusion.is_some(),
                    mixes,
                    one_color: self.one_color.is_some(),
                };
                passes.record(&source, encoder)
            }
            ScatteringStep::Result => {
                let variant = self.color_variant("scattered_light/result.wgsl");
                self.block_passes(gpu, volume, SweepSource::LastBounce).record(&variant, encoder)
            }
        }
    }

    /// Returns the light in the form that sweeps follow: the amount in every component, if all light has one colour.
    fn swept_light(&self, light: DVec3) -> DVec3 {
        self.one_color.map_or(light, |one| DVec3::splat(one.amount(light)))
    }

    /// Returns the blocks that gather the swept light.
    fn receiving_cells(&self, followed: SweepSource) -> &CellList {
        if followed == SweepSource::LastBounce { &self.output_cells } else { &self.attenuating_cells }
    }

    /// Creates the variant of a shader that depends only on the number of colours.
    fn color_variant(&self, shader: &'static str) -> ColorVariant {
        ColorVariant { shader, one_color: self.one_color.is_some() }
    }

    /// Builds the uniform shared by passes over blocks: limited to blocks that scatter light, but for the last bounce
    /// to none.
    fn bounce_uniform(
        &self,
        gpu: VolumeContext<'_>,
        volume: &ScatteredLightVolume,
        followed: SweepSource,
    ) -> wgpu::Buffer {
        let uniform = uniforms::BounceUniform {
            dims: volume.blocks.dims.map(|n| n as u32),
            share: 1.0 / self.batches(followed).directions() as f32,
            color: self.one_color.map_or([1.0; 3], |one| one.color.as_vec3().into()),
            min_extinction: if followed == SweepSource::LastBounce { -1.0 } else { f32::MIN_POSITIVE },
        };
        gpu.uniform("Bounces::shared", uniform)
    }

    fn fill_blocks(
        &self,
        gpu: VolumeContext<'_>,
        ScatteringInputs { tables, settings, .. }: ScatteringInputs<'_>,
        volume: &ScatteredLightVolume,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let scattering = &settings.scattering;
        let pass = BlocksPass {
            shader: "scattered_light/blocks.wgsl",
            dims: volume.blocks.dims,
            divisor: volume.blocks.divisor,
            sample_offset: extinction_blocks::sample_offset(volume.blocks.divisor, !self.has_sky),
            density_scale: scattering.density_scale,
            max_depth: f32::MAX,
            albedo: scattering.albedo,
            one_color: self.one_color.is_some(),
            format: self.textures.medium_format,
            cells: &self.attenuating_cells,
            tables,
            settings,
        };
        let entries = [
            bind_buffer("look_table", tables.eye.lookup_buffer()),
            bind_view("look_pyramid", &tables.tint_views().unwrap_or(tables.eye.pyramid(gpu.volume)).all),
            bind_buffer("scattering", &self.textures.scattering),
            bind_view("medium", &self.textures.medium),
        ];
        pass.record(gpu, &entries, encoder)
    }

    /// Sweeps light in the directions of a batch (emitted by blocks, or arriving from the sky), and adds it to the
    /// sums of the blocks.
    fn fill_batch(
        &self,
        gpu: VolumeContext<'_>,
        settings: &Settings,
        volume: &ScatteredLightVolume,
        followed: SweepSource,
        batch: usize,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let ScatteringTextures { medium, sheets, scattering, sums, .. } = &self.textures;
        let radiance = settings.sky.radiance(settings.camera.up).filter(|_| followed == SweepSource::Sky);
        let arriving = |towards: DVec3| {
            let of =
                |c: usize| radiance.map_or(0.0, |sky| (sky.mean[c] + sky.slope[c].dot(towards)).max(0.0));
            self.swept_light(DVec3::from([0, 1, 2].map(of)))
        };
        let batches = self.batches(followed);
        let pass = SweepPass {
            shader: "scattered_light/sweep.wgsl",
            one_color: self.one_color.is_some(),
            rays: batches.rays(batch),
            dims: volume.blocks.dims,
            sheets,
            is_first: batch == 0,
            share: 0.0,
        };
        let entries = [bind_view("medium", medium), bind_view("sheets", &sheets.view)];
        let uniform = pass.record(gpu, &entries, arriving, encoder)?;

        let gather =
            gpu.shaders.pipeline(&SweepGatherVariant::new("scattered_light/gather.wgsl", batches))?;
        let shared = self.bounce_uniform(gpu, volume, followed);
        let entries = [
            bind_buffer("bound_sweep", &uniform),
            bind_view("sheets", &sheets.view),
            sampler("clamped", &gpu.volume.clamped),
            bind_buffer("bound_bounce", &shared),
            bind_buffer("scattering", scattering),
            bind_buffer("sums", sums),
            self.receiving_cells(followed).binding(),
        ];
        let own = gpu.bind("Bounces::gather", &gather, 0, &entries);
        let groups = self.receiving_cells(followed).workgroups();
        pass::dispatch(encoder, "Bounces::gather", &gather, &[&own], groups);
        Ok(())
    }

    fn fill_single_scattering(
        &self,
        gpu: VolumeContext<'_>,
        ScatteringInputs { settings, lights: lit, .. }: ScatteringInputs<'_>,
        volume: &ScatteredLightVolume,
        slice: usize,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let scene = &gpu.volume.scene;
        let end = (slice + self.slices_per_step()).min(self.dims[2]);
        let shadowed = lit.shadowed().len();
        let mut lights = [bytemuck::Zeroable::zeroed(); MAX_LIGHTS];
        for (index, (slot, lit)) in lights.iter_mut().zip(lit.all()).enumerate() {
            let whole = light_uniform(&lit.light, None, scene, settings);
            // Only shadows depend on the size of a light, so lights without shadows take one point.
            let points = if index < shadowed { self.max_light_points } else { 1 };
            let color = self.swept_light(DVec3::from(whole.color.map(f64::from))).as_vec3().into();
            *slot = uniforms::LightUniform { points: whole.points.min(points), color, ..whole };
        }
        let uniform = uniforms::SingleScatteringUniform {
            space: uniforms::SpaceUniform::new(scene),
            block_scale: volume.blocks.dims.map(|n| 1.0 / (n + 2) as f32),
            voxel_step: volume.blocks.divisor as f32,
            count: lit.all().len() as u32,
            shadowed: shadowed as u32,
            edge: scene.smallest_edge() as f32,
            emission: (settings.shading.emission / settings.scattering.albedo.max(1e-9)) as f32,
            slice: slice as u32,
            end: end as u32,
            pad0: 0.0,
            has_sky: f32::from(u8::from(self.has_sky)),
            lights,
        };
        let uniform = gpu.uniform("Bounces::first", uniform);
        let shared = self.bounce_uniform(gpu, volume, SweepSource::Sky);
        let pipeline = gpu.shaders.pipeline(&self.color_variant("scattered_light/single_scattering.wgsl"))?;
        let entries = [
            bind_buffer("bound_scene", &uniform),
            bind_view("medium", &self.textures.medium),
            sampler("clamped", &gpu.volume.clamped),
            bind_buffer("bound_bounce", &shared),
            bind_buffer("scattering", &self.textures.scattering),
            bind_buffer("received", &self.textures.received),
            bind_buffer("first", &self.textures.single_scattering),
        ];
        let own = gpu.bind("Bounces::first", &pipeline, 0, &entries);
        let [x, y, _] = workgroups_over_blocks(volume);
        let groups = [x, y, ((end - slice) as u32).div_ceil(4)];
        pass::dispatch(encoder, "Bounces::first", &pipeline, &[&own], groups);
        Ok(())
    }

    /// Returns what passes over all blocks share.
    fn block_passes<'a>(
        &'a self,
        gpu: VolumeContext<'a>,
        volume: &'a ScatteredLightVolume,
        followed: SweepSource,
    ) -> BlockPasses<'a> {
        BlockPasses {
            gpu,
            shared: self.bounce_uniform(gpu, volume, followed),
            textures: &self.textures,
            // One bounce alone has no later ones.
            solution: self.diffusion.as_ref().map_or(&self.textures.mixing, |diffusion| &diffusion.solution),
            output_cells: &self.output_cells,
            volume,
        }
    }
}
