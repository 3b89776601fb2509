//! Filling of a volume of scattered light: its temporary textures and its steps.

use glam::DVec3;

use super::steps::{BounceStep, Followed, steps};
use super::textures::Textures;
use super::volume::BouncesVolume;
use crate::gpu::light::packed::pack_light;
use crate::gpu::pipelines::binding::{Named, buffer, sampler, view_of};
use crate::gpu::pipelines::uniforms;
use crate::gpu::pipelines::variant::{ColorVariant, Constants, Only, Variant, flag};
use crate::gpu::resources::pass;
use crate::gpu::sky::batches::{BATCH_BLOCKS, Batches, sheet_size};
use crate::gpu::sky::blocks::{self, BlocksPass};
use crate::gpu::sky::sweep::{GatherVariant, SweepPass};
use crate::gpu::volume::Gpu;
use crate::gpu::volume::listed_cells::ListedCells;
use crate::gpu::volume::transfer_tables::Tables;
use crate::gpu::{GpuError, RenderOptions};
use crate::model::{MAX_LIGHTS, Settings};
use crate::plan::{BouncesKey, LitLights, OneColor, SweepFrame, boxes_around, sweep_directions};

/// Inputs from the picture for the filling: transfer tables, settings and lights.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Look<'a> {
    pub tables: &'a Tables,
    pub settings: &'a Settings,
    pub lit: &'a LitLights,
}

/// Work to fill a volume of scattered light.
#[derive(Debug)]
pub(crate) struct BouncesBuild {
    /// Rays of the intermediate bounces, and those of the last bounce.
    batches: [Batches; 2],
    /// Number of blocks along x, y and z.
    dims: [usize; 3],
    /// Number of rays from a block to the points of all lights.
    rays: usize,
    bounces: u32,
    /// Maximum number of points on an area light.
    points: u32,
    has_sky: bool,
    /// Common colour of all light, if there is one.
    one_color: Option<OneColor>,
    /// Blocks in which something may attenuate light.
    met: ListedCells,
    /// Blocks that pictures look up.
    looked_up: ListedCells,
    textures: Textures,
}

impl BouncesBuild {
    /// Plans the filling of a volume, and allocates its temporary textures.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(
        gpu: Gpu<'_>,
        (tables, options): (&Tables, &RenderOptions),
        key: &BouncesKey,
        (has_sky, lights): (bool, usize),
        volume: &BouncesVolume,
    ) -> Result<Self, GpuError> {
        let scene = &gpu.volume.scene;
        let frames = [key.directions_of_a_bounce(), key.directions()].map(|directions| {
            sweep_directions(directions)
                .into_iter()
                .map(|towards| SweepFrame::new(scene, volume.divisor, towards))
                .collect::<Vec<_>>()
        });
        let one_color = key.one_color();
        let format = Textures::sheet_format(gpu.context, one_color.is_some());
        let [each, last] = frames.each_ref().map(Vec::len);
        let followed = key.bounces().saturating_sub(1) as usize * each + last;
        let size = sheet_size(frames.iter().flatten(), format, followed);
        let textures = Textures::new(gpu.context, volume, size, one_color.is_some())?;
        let rays = (lights * key.points() as usize).max(1);
        let met = blocks::met(tables, options, volume.dims, volume.divisor);
        // Pictures also look up the last bounce beside the blocks that scatter light.
        let seen = met.with(&volume.filled);
        let [each, last] = frames;
        Ok(Self {
            batches: [
                Batches::new(each, size[2], &boxes_around(&met)),
                Batches::new(last, size[2], &boxes_around(&seen)),
            ],
            met: ListedCells::new(gpu.context, &met),
            looked_up: ListedCells::new(gpu.context, &volume.filled),
            dims: volume.dims,
            rays,
            bounces: key.bounces(),
            points: key.points(),
            has_sky,
            one_color,
            textures,
        })
    }

    /// Returns the steps of the filling, in order.
    pub(crate) fn steps(&self) -> Vec<BounceStep> {
        let slices = (self.dims[2], self.slices_at_once());
        steps(self.bounces, self.has_sky, slices, |followed| self.batches(followed).count())
    }

    /// Returns the number of slices of blocks that cast rays to lights in one step, so that it takes no longer than a
    /// batch of directions.
    fn slices_at_once(&self) -> usize {
        let [x, y, z] = self.dims;
        (BATCH_BLOCKS / (x * y * self.rays * x.max(y).max(z))).max(1)
    }

    /// Returns the rays of a sweep.
    fn batches(&self, followed: Followed) -> &Batches {
        let [bounce, last] = &self.batches;
        if followed == Followed::Last { last } else { bounce }
    }

    /// Returns the size of the temporary resources, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.textures.bytes + self.met.bytes() + self.looked_up.bytes()
    }

    /// Records one step of the filling.
    pub(crate) fn record(
        &self,
        gpu: Gpu<'_>,
        look: Look<'_>,
        volume: &BouncesVolume,
        step: BounceStep,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        match step {
            BounceStep::Blocks => self.fill_blocks(gpu, look, volume, encoder),
            BounceStep::Batch(followed, batch) => {
                self.fill_batch(gpu, look.settings, volume, (followed, batch), encoder)
            }
            BounceStep::First { slice } => self.fill_first(gpu, look, volume, slice, encoder),
            BounceStep::Source { bounce } => {
                let shared = self.shared(gpu, volume, Followed::Bounce);
                // Extrapolates after the second-last bounce, and after every other one before it, since the ratio
                // takes two bounces.
                let leaps = bounce > 1 && (self.bounces - 1 - bounce).is_multiple_of(2);
                if leaps {
                    self.whole(gpu, &Only("bounces/ratio.wgsl"), &shared, volume, encoder)?;
                }
                let one_color = self.one_color.is_some();
                let source = SourceVariant { has_bounced: bounce > 0, leaps, one_color };
                self.whole(gpu, &source, &shared, volume, encoder)
            }
            BounceStep::Outcome => {
                let shared = self.shared(gpu, volume, Followed::Last);
                self.whole(gpu, &self.variant("bounces/outcome.wgsl"), &shared, volume, encoder)
            }
        }
    }

    /// Returns the light in the form that sweeps follow: the amount in every component, if all light has one colour.
    fn followed_of(&self, light: DVec3) -> DVec3 {
        self.one_color.map_or(light, |one| DVec3::splat(one.amount(light)))
    }

    /// Returns the blocks that gather the swept light.
    fn reached(&self, followed: Followed) -> &ListedCells {
        if followed == Followed::Last { &self.looked_up } else { &self.met }
    }

    /// Creates the variant of a shader that depends only on the number of colours.
    fn variant(&self, shader: &'static str) -> ColorVariant {
        ColorVariant { shader, one_color: self.one_color.is_some() }
    }

    /// Builds the uniform shared by passes over blocks: limited to blocks that scatter light, but for the last bounce
    /// to none.
    fn shared(&self, gpu: Gpu<'_>, volume: &BouncesVolume, followed: Followed) -> wgpu::Buffer {
        let uniform = uniforms::Bounce {
            dims: volume.dims.map(|n| n as u32),
            share: 1.0 / self.batches(followed).directions() as f32,
            color: self.one_color.map_or([1.0; 3], |one| one.color.as_vec3().into()),
            least: if followed == Followed::Last { -1.0 } else { f32::MIN_POSITIVE },
        };
        gpu.uniform("Bounces::shared", uniform)
    }

    fn fill_blocks(
        &self,
        gpu: Gpu<'_>,
        Look { tables, settings, .. }: Look<'_>,
        volume: &BouncesVolume,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let scattering = &settings.scattering;
        let pass = BlocksPass {
            shader: "bounces/blocks.wgsl",
            dims: volume.dims,
            divisor: volume.divisor,
            density_scale: scattering.density_scale,
            albedo: scattering.albedo,
            one_color: self.one_color.is_some(),
            format: self.textures.medium_format,
            cells: &self.met,
            tables,
            settings,
        };
        let entries = [
            buffer("look_table", tables.eye.gathered()),
            view_of("look_pyramid", &tables.pyramids(gpu.volume).own.all),
            buffer("scattering", &self.textures.scattering),
            view_of("medium", &self.textures.medium),
        ];
        pass.record(gpu, &entries, encoder)
    }

    /// Sweeps light in the directions of a batch (emitted by blocks, or arriving from the sky), and adds it to the
    /// sums of the blocks.
    fn fill_batch(
        &self,
        gpu: Gpu<'_>,
        settings: &Settings,
        volume: &BouncesVolume,
        (followed, batch): (Followed, usize),
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let Textures { medium, sheets, scattering, sums, .. } = &self.textures;
        let radiance = settings.sky.radiance(settings.camera.up).filter(|_| followed == Followed::Sky);
        let arriving = |towards: DVec3| {
            let of =
                |c: usize| radiance.map_or(0.0, |sky| (sky.mean[c] + sky.slope[c].dot(towards)).max(0.0));
            self.followed_of(DVec3::from([0, 1, 2].map(of)))
        };
        let batches = self.batches(followed);
        let pass = SweepPass {
            shader: "bounces/sweep.wgsl",
            one_color: self.one_color.is_some(),
            rays: batches.rays(batch),
            dims: volume.dims,
            sheets,
            is_first: batch == 0,
            share: 0.0,
        };
        let entries = [view_of("medium", medium), view_of("sheets", &sheets.view)];
        let uniform = pass.record(gpu, &entries, arriving, encoder)?;

        let gather = gpu.shaders.pipeline(&GatherVariant::of("bounces/gather.wgsl", batches))?;
        let shared = self.shared(gpu, volume, followed);
        let entries = [
            buffer("bound_sweep", &uniform),
            view_of("sheets", &sheets.view),
            sampler("clamped", &gpu.volume.clamped),
            buffer("bound_bounce", &shared),
            buffer("scattering", scattering),
            buffer("sums", sums),
            self.reached(followed).entry(),
        ];
        let own = gpu.bind("Bounces::gather", &gather, 0, &entries);
        let groups = self.reached(followed).workgroups();
        pass::dispatch(encoder, "Bounces::gather", &gather, &[&own], groups);
        Ok(())
    }

    fn fill_first(
        &self,
        gpu: Gpu<'_>,
        Look { settings, lit, .. }: Look<'_>,
        volume: &BouncesVolume,
        slice: usize,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let scene = &gpu.volume.scene;
        let end = (slice + self.slices_at_once()).min(self.dims[2]);
        let shadowed = lit.shadowed().len();
        let mut lights = [bytemuck::Zeroable::zeroed(); MAX_LIGHTS];
        for (index, (slot, lit)) in lights.iter_mut().zip(lit.all()).enumerate() {
            let whole = pack_light(&lit.light, None, scene, settings);
            // Only shadows depend on the size of a light, so lights without shadows take one point.
            let points = if index < shadowed { self.points } else { 1 };
            let color = self.followed_of(DVec3::from(whole.color.map(f64::from))).as_vec3().into();
            *slot = uniforms::Light { points: whole.points.min(points), color, ..whole };
        }
        let uniform = uniforms::First {
            space: uniforms::Space::new(scene),
            block_scale: volume.dims.map(|n| 1.0 / (n + 2) as f32),
            voxel_step: volume.divisor as f32,
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
        let shared = self.shared(gpu, volume, Followed::Sky);
        let pipeline = gpu.shaders.pipeline(&self.variant("bounces/first.wgsl"))?;
        let entries = [
            buffer("bound_scene", &uniform),
            view_of("medium", &self.textures.medium),
            sampler("clamped", &gpu.volume.clamped),
            buffer("bound_bounce", &shared),
            buffer("scattering", &self.textures.scattering),
            buffer("sums", &self.textures.sums),
            buffer("first", &self.textures.first),
        ];
        let own = gpu.bind("Bounces::first", &pipeline, 0, &entries);
        let [x, y, _] = groups_of(volume);
        let groups = [x, y, ((end - slice) as u32).div_ceil(4)];
        pass::dispatch(encoder, "Bounces::first", &pipeline, &[&own], groups);
        Ok(())
    }

    /// Records a pass over all blocks that reads the gathered sums.
    fn whole(
        &self,
        gpu: Gpu<'_>,
        variant: &impl Variant,
        shared: &wgpu::Buffer,
        volume: &BouncesVolume,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let Textures { medium, scattering, first, sums, last, change, ratio, .. } = &self.textures;
        let shader = variant.shader();
        let mut entries: Vec<Named<'_>> = vec![buffer("bound_bounce", shared), buffer("sums", sums)];
        match shader {
            "bounces/source.wgsl" => entries.extend([
                buffer("scattering", scattering),
                buffer("first", first),
                buffer("last", last),
                buffer("change", change),
                view_of("medium", medium),
                buffer("ratio", ratio),
            ]),
            "bounces/ratio.wgsl" => entries.extend([
                buffer("scattering", scattering),
                buffer("last", last),
                buffer("change", change),
                buffer("ratio", ratio),
            ]),
            _ => entries.extend([view_of("bounced", &volume.view), self.looked_up.entry()]),
        }
        let pipeline = gpu.shaders.pipeline_into(variant, self.textures.medium_format)?;
        let own = gpu.bind("Bounces::whole", &pipeline, 0, &entries);
        let groups = match shader {
            "bounces/ratio.wgsl" => [1; 3],
            "bounces/outcome.wgsl" => self.looked_up.workgroups(),
            _ => groups_of(volume),
        };
        pass::dispatch(encoder, "Bounces::whole", &pipeline, &[&own], groups);
        Ok(())
    }
}

fn groups_of(volume: &BouncesVolume) -> [u32; 3] {
    volume.dims.map(|n| (n as u32).div_ceil(4))
}

/// Pipeline variant of the pass that computes the emission of blocks for the next bounce.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct SourceVariant {
    has_bounced: bool,
    leaps: bool,
    one_color: bool,
}

impl Variant for SourceVariant {
    fn shader(&self) -> &'static str {
        "bounces/source.wgsl"
    }

    fn constants(&self) -> Constants {
        vec![
            flag("HAS_BOUNCED", self.has_bounced),
            flag("LEAPS", self.leaps),
            flag("ONE_COLOR", self.one_color),
        ]
    }
}
