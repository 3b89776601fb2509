//! The filling of a volume of light that has bounced.

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

/// What of a picture bounced light is made from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Look<'a> {
    pub tables: &'a Tables,
    pub settings: &'a Settings,
    pub lit: &'a LitLights,
}

/// The filling of a volume of light that has bounced.
#[derive(Debug)]
pub(crate) struct BouncesBuild {
    /// Rays in the directions of a bounce, and in those of the last.
    batches: [Batches; 2],
    /// Blocks along x, y and z.
    dims: [usize; 3],
    /// Rays from a block to all lights.
    rays: usize,
    bounces: u32,
    /// Points that stand for a light that has a size.
    points: u32,
    has_sky: bool,
    /// That of all light, if there is one.
    one_color: Option<OneColor>,
    /// Blocks in which something attenuates light.
    met: ListedCells,
    /// Blocks that pictures look up.
    looked_up: ListedCells,
    textures: Textures,
}

impl BouncesBuild {
    /// Lays out the filling of a volume.
    ///
    /// # Errors
    /// When memory is out.
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
        // What is seen of the last bounce may lie beside what light bounces off.
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

    /// Its pieces, in order.
    pub(crate) fn steps(&self) -> Vec<BounceStep> {
        let slices = (self.dims[2], self.slices_at_once());
        steps(self.bounces, self.has_sky, slices, |followed| self.batches(followed).count())
    }

    /// So many slices of blocks cast rays to lights at once that they take no more steps than a batch of directions.
    fn slices_at_once(&self) -> usize {
        let [x, y, z] = self.dims;
        (BATCH_BLOCKS / (x * y * self.rays * x.max(y).max(z))).max(1)
    }

    /// Rays along which light is followed.
    fn batches(&self, followed: Followed) -> &Batches {
        let [bounce, last] = &self.batches;
        if followed == Followed::Last { last } else { bounce }
    }

    /// Bytes that only the filling needs.
    pub(crate) fn bytes(&self) -> u64 {
        self.textures.bytes + self.met.bytes() + self.looked_up.bytes()
    }

    /// Records a piece.
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
                // The last but one leaps, and every other before it: two bounces tell where to.
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

    /// What is followed of some light: its amount, where all has one colour.
    fn followed_of(&self, light: DVec3) -> DVec3 {
        self.one_color.map_or(light, |one| DVec3::splat(one.amount(light)))
    }

    /// The blocks that get the light that is followed.
    fn reached(&self, followed: Followed) -> &ListedCells {
        if followed == Followed::Last { &self.looked_up } else { &self.met }
    }

    /// A shader that reads what is followed.
    fn variant(&self, shader: &'static str) -> ColorVariant {
        ColorVariant { shader, one_color: self.one_color.is_some() }
    }

    /// What passes over blocks share: those in which light is scattered, or for the last bounce all of them.
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

    /// Follows light in the directions of a batch, that of blocks or of a sky, and adds what arrives to what came before.
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
            // Only shadows show how large a light is.
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

    /// Records a pass over blocks that reads what was gathered.
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

/// What tells the first source from those of bounces.
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
