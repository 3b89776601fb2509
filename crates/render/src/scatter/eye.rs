//! Eye pass of the scattering engine: compositing of scattered sheets.

use std::ops::Range;

use super::footprints::{FootprintInputs, FootprintPhases};
use super::splat::{ScatterVariant, SheetScatterer, SplatParameters, SplatQuantity, sums};
use super::voxels::ScatterState;
use crate::eye::eye_pass::EyePass;
use crate::eye::eye_variant::SamplingVariant;
use crate::eye::light_lookup::{LightLookup, light_bind_group};
use crate::pipelines::binding::{bind_buffer, bind_view, sampler};
use crate::pipelines::pipeline_variant::{
    PipelineVariant, ShaderConstants, ShadingVariant, SingleVariant, flag,
};
use crate::plan::{BrickSet, SheetFrame};
use crate::resources::pass;
use crate::volume::VolumeContext;
use crate::volume::transfer_tables::{TransferTables, upload_distances};
use crate::{GpuError, RenderOptions};
use chiaroscuro_scene::{Settings, SheetOrder};
use chiaroscuro_volume::{BRICK_EDGE, Observer};

/// Number of slabs per submission: each is splatted and composited, which takes a software adapter some milliseconds.
pub(crate) const SLABS_PER_STEP: u32 = 2;

/// Pipeline variant of the pass that composites sheets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct ScatterEyeVariant {
    shading: ShadingVariant,
    sampling: SamplingVariant,
    sheets: ScatterVariant,
    /// `true` if pixels are wider than voxels somewhere.
    is_stretched: bool,
}

impl PipelineVariant for ScatterEyeVariant {
    fn shader(&self) -> &'static str {
        "scatter/eye.wgsl"
    }

    fn constants(&self) -> ShaderConstants {
        let mut constants = self.shading.constants();
        constants.extend(self.sampling.constants());
        constants.extend(self.sheets.constants());
        constants.push(flag("STRETCH", self.is_stretched));
        constants
    }
}

/// Sheets of the eye, with the colour and opacity that its rays have accumulated.
#[derive(Debug)]
pub(crate) struct EyeScatter {
    scatterer: SheetScatterer,
    /// Splatting of single footprints; `None` if sheets are composited.
    footprints: Option<FootprintPhases>,
    /// Distances, in bricks, to the nearest brick visible to the eye.
    distances: wgpu::TextureView,
    /// Accumulated colour and opacity of each ray.
    rays: wgpu::Buffer,
    clamped: wgpu::Sampler,
    /// Distance, in slabs to either side, of the sheets whose difference is the gradient.
    gradient_slabs: u32,
}

impl EyeScatter {
    /// Prepares the sheets of a picture.
    pub(crate) fn new(
        gpu: VolumeContext<'_>,
        scattering: &ScatterState,
        tables: &TransferTables,
        frame: &SheetFrame,
        settings: &Settings,
        options: &RenderOptions,
    ) -> Result<Self, GpuError> {
        let sampling = &settings.sampling;
        let order = sampling.order;
        // Slices of voxels are one voxel apart.
        let ahead = if order == SheetOrder::ImageAligned { frame.gradient_steps().slabs } else { 1 };
        let seen = bricks_to_splat(frame, &tables.eye.occupied_bricks, options);
        let is_pre = settings.classification().is_pre();
        let quantity = if is_pre { SplatQuantity::Material } else { SplatQuantity::Density };
        let splat =
            SplatParameters { kernel: sampling.kernel, quadrature: sampling.quadrature, order, quantity };
        let scatterer =
            SheetScatterer::new(gpu, &scattering.voxels, frame, splat, &tables.eye, &seen, 2 * ahead + 1)?;
        let footprints = (order == SheetOrder::EveryFootprint)
            .then(|| FootprintPhases::new(gpu, &scatterer))
            .transpose()?;
        let occupied = &tables.eye.occupied_bricks;
        let distances = occupied.distances();
        let distances = upload_distances(
            gpu.context,
            "EyeScatter::distances",
            occupied.dims,
            &distances,
            wgpu::TextureFormat::R8Uint,
        )?;
        Ok(Self {
            scatterer,
            footprints,
            distances,
            // Four 32-bit floats per ray.
            rays: sums(gpu.context, "EyeScatter::rays", 4, frame.size)?,
            clamped: gpu.context.sampler("EyeScatter::clamped"),
            gradient_slabs: ahead,
        })
    }

    /// Splats and composites some slabs.
    #[expect(clippy::too_many_arguments, reason = "what the gathering pass takes, and two more")]
    pub(crate) fn draw(
        &self,
        gpu: VolumeContext<'_>,
        scattering: &ScatterState,
        eye: &EyePass,
        tables: &TransferTables,
        looked_up: LightLookup<'_>,
        picture: &wgpu::TextureView,
        slabs: Range<u32>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let VolumeContext { context, shaders, volume, .. } = gpu;
        let uniform = eye.uniform_buffer(context, self.gradient_slabs);
        let is_last = slabs.end == self.scatterer.sheet_count();
        if let Some(footprints) = &self.footprints {
            let inputs = FootprintInputs {
                scattering,
                eye,
                eye_uniform: &uniform,
                table: &tables.eye.buffer,
                looked_up,
                rays: &self.rays,
                clamped: &self.clamped,
            };
            for k in slabs {
                footprints.draw(gpu, &self.scatterer, inputs, k, encoder)?;
            }
            return if is_last { self.resolve(gpu, picture, encoder) } else { Ok(()) };
        }
        let gradients = eye.gradients(gpu.volume);
        let variant = ScatterEyeVariant {
            shading: eye.shading_variant(),
            sampling: eye.sampling_variant(gradients.is_some()),
            sheets: self.scatterer.variant(),
            is_stretched: eye.is_stretched(),
        };
        let pipeline = shaders.pipeline(&variant)?;
        let own = pass::bind(
            context,
            "EyeScatter::bind_group",
            &pipeline,
            0,
            &[
                bind_buffer("bound_eye", &uniform),
                bind_buffer("table", &tables.eye.buffer),
                bind_view("distances", &self.distances),
                bind_buffer("lighting_table", tables.lighting.lookup_buffer()),
                bind_view("gradients", gradients.unwrap_or(gpu.placeholder)),
            ],
        );
        let grid = gpu.uniform("Volume::grid", volume.grid(0));
        let of_lights = light_bind_group(gpu, &pipeline, looked_up);
        for k in slabs {
            // Slabs ahead are splatted before a slab that takes gradients from them is composited.
            let from = if k == 0 { 0 } else { k + self.gradient_slabs };
            for splatted in from..=k + self.gradient_slabs {
                if self.scatterer.is_filled(splatted) {
                    self.scatterer.splat(gpu, scattering, splatted, encoder)?;
                }
            }
            // Empty sheets need neither clearing nor compositing.
            let touched = tables.eye.has_extinction_at_zero()
                || self.scatterer.is_filled(k)
                || k >= self.gradient_slabs && self.scatterer.is_filled(k - self.gradient_slabs);
            if !touched {
                continue;
            }
            let slab = self.scatterer.uniform_buffer(context, k, 1.0);
            let shared = pass::bind(
                context,
                "EyeScatter::sheets",
                &pipeline,
                1,
                &[
                    bind_buffer("bound_grid", &grid),
                    bind_view("pyramid_texture", eye.levels().choose(tables.eye.pyramid(volume))),
                    bind_view("lighting_pyramid", eye.levels().choose(tables.lighting.pyramid(volume))),
                    bind_view("tint_pyramid", gpu.placeholder),
                    bind_view("presence_texture", gpu.presence(eye.levels())),
                    bind_view("lighting_presence_texture", gpu.presence_for(Observer::Light, eye.levels())),
                    sampler("clamped", &volume.clamped),
                    bind_buffer("bound_scatter", &slab),
                    bind_buffer("sheets", &self.scatterer.sheets),
                    bind_buffer("rays", &self.rays),
                ],
            );
            pass::dispatch(
                encoder,
                "EyeScatter::composite",
                &pipeline,
                &[&own, &shared, &of_lights],
                pass::tile_workgroups(self.scatterer.frame.size),
            );
        }
        if is_last { self.resolve(gpu, picture, encoder) } else { Ok(()) }
    }

    /// Writes the accumulated rays into the picture.
    fn resolve(
        &self,
        gpu: VolumeContext<'_>,
        picture: &wgpu::TextureView,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let VolumeContext { context, shaders, .. } = gpu;
        let pipeline = shaders.pipeline(&SingleVariant("scatter/resolve.wgsl"))?;
        let uniform = self.scatterer.uniform_buffer(context, 0, 1.0);
        let own = pass::bind(
            context,
            "EyeScatter::picture",
            &pipeline,
            0,
            &[bind_buffer("rays", &self.rays), bind_view("picture", picture)],
        );
        let shared =
            pass::bind(context, "EyeScatter::frame", &pipeline, 1, &[bind_buffer("bound_scatter", &uniform)]);
        pass::dispatch(
            encoder,
            "EyeScatter::resolve",
            &pipeline,
            &[&own, &shared],
            pass::tile_workgroups(self.scatterer.frame.size),
        );
        Ok(())
    }

    /// Returns the size of sheets and rays, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.scatterer.bytes() + self.rays.size()
    }
}

/// Returns the bricks with voxels that can reach a visible sample, or a neighbour of one from which its gradient is
/// taken.
pub(crate) fn bricks_to_splat(frame: &SheetFrame, occupied: &BrickSet, options: &RenderOptions) -> BrickSet {
    if !options.switches.empty_space_skipping {
        return BrickSet::full(occupied.dims);
    }
    let widest = frame.widest_stretch();
    // Kernel radius (at most √2 of it along a slanted axis), plus the gradient's step of one pixel or voxel.
    let reach = (2.0 * std::f64::consts::SQRT_2 + 1.5) * widest + frame.slab / frame.voxel_edge;
    occupied.dilated((reach / BRICK_EDGE as f64).ceil() as usize)
}
