//! Eye pass: from density and attenuation volumes to the linear picture.

use super::looked_up::{Around, LookedUp, light_bind_group, pack_bounces, pack_sky};
use crate::gpu::light::combine::CombinedLight;
use crate::gpu::light::packed::{LightInput, pack_light};
use crate::gpu::pipelines::binding::{buffer, view_of};
use crate::gpu::pipelines::uniforms;
use crate::gpu::pipelines::variant::{
    Constants, Ends, LightCount, Reconstruction, ShadingVariant, SkyVariant, Variant, deposit_constant, flag,
    is_cut,
};
use crate::gpu::resources::pass;
use crate::gpu::volume::transfer_tables::{EVERYWHERE, Tables};
use crate::gpu::volume::{Gpu, Levels};
use crate::gpu::{Context, GpuError, RenderOptions};
use crate::math::{Bounds, SceneSpace};
use crate::model::{Classification, Deposit, MAX_LIGHTS, Projection, Settings, ShadowAlgorithm};
use crate::plan::picture_frame;
use crate::plan::{PixelWindow, SheetFrame, ray_reach, sample_reach, scatter_reach_bricks};

/// Parameters of the eye pass of one picture, besides the volume.
#[derive(Debug)]
pub(crate) struct EyePass {
    frame: SheetFrame,
    uniform: uniforms::Eye,
    /// Reach of a sample's kernel, in cells around its own.
    dilation: i32,
    /// Pyramid levels that kernels read.
    levels: Levels,
    variant: GatherVariant,
}

impl EyePass {
    /// Prepares the pass for some lights (shadowed ones first, without those that are in the combined volume), and
    /// for sky visibility and scattered light where there are volumes of them.
    pub(crate) fn new(
        scene: &SceneSpace,
        settings: &Settings,
        window: PixelWindow,
        (lights, combined, around): (&[LightInput<'_>], Option<&CombinedLight>, Around<'_>),
        options: &RenderOptions,
    ) -> Self {
        let frame = picture_frame(settings, scene, window);
        let direct = settings.shadows.algorithm == ShadowAlgorithm::Direct;
        let shadowed = lights.iter().filter(|input| input.lit.is_shadowed()).count();
        let mut packed = [bytemuck::Zeroable::zeroed(); MAX_LIGHTS];
        for (slot, input) in packed.iter_mut().zip(lights) {
            *slot = pack_light(&input.lit.light, input.volume, scene, settings);
        }
        let stretch_level = frame.max_stretch_level();
        let (remains, shading_cut) = (settings.cuts.seen(), settings.cuts.shading());
        let (eye, w) = match settings.camera.projection {
            Projection::Perspective => (settings.camera.eye(), 1.0),
            Projection::Orthographic => (settings.camera.scene_from_view().z_axis, 0.0),
        };
        let (gradient_pixels, gradient_slabs) = frame.gradient_steps();
        let uniform = uniforms::Eye {
            frame: uniforms::SheetFrame::new(&frame),
            shading: pack_shading(settings, scene, options),
            space: uniforms::Space::new(scene),
            eye: eye.as_vec3().extend(w).into(),
            first_row: 0,
            end_row: window.size[1],
            dilation: if options.empty_space_skipping { scatter_reach_bricks(&frame) } else { EVERYWHERE },
            dark: options.min_transmittance,
            gradient_pixels: gradient_pixels as i32,
            gradient_slabs: gradient_slabs as i32,
            runs: 1,
            near_edge: scene.smallest_edge() as f32,
            combined_lookup: combined.map_or([0.0; 3], CombinedLight::lookup),
            pad0: 0.0,
            seen: uniforms::Cut::new(&remains.region(scene)),
            faces: uniforms::Cut::new(&remains.region(scene).within(&Bounds::of_grid(scene.dims, 0.0))),
            shading_cut: uniforms::Cut::new(&shading_cut.region(scene)),
            sky: pack_sky(settings, scene, around.sky),
            bounces: pack_bounces(settings, scene, around.bounces),
            lights: packed,
        };
        let mut seen = sample_reach(&frame, scene, settings.sampling.quadrature, options.preview);
        if direct {
            seen = seen.max(ray_reach(&settings.shadows, scene));
        }
        let dilation = if options.empty_space_skipping { i32::from(seen) } else { EVERYWHERE };
        // Normals of classified voxels come from the next pyramid level.
        let is_classified = settings.sampling.classification == Classification::Pre;
        let levels = Levels::of(stretch_level > 0.0 || is_classified);
        let count = LightCount { all: lights.len() as u32, shadowed: shadowed as u32 };
        let variant =
            GatherVariant::of(settings, count, stretch_level > 0.0).with_combined(combined.is_some());
        Self { frame, uniform, dilation, levels, variant }
    }

    /// Returns the number of slabs in the stack.
    pub(crate) fn slab_count(&self) -> u32 {
        self.frame.slab_count
    }

    /// Returns the geometry of the eye's rays and slabs.
    pub(crate) fn frame(&self) -> &SheetFrame {
        &self.frame
    }

    /// Creates the uniform buffer of the whole picture, for the scattering engine; `gradient_slabs` is the distance,
    /// in slabs, of the sheets that gradients are taken from.
    pub(crate) fn uniform_buffer(&self, context: &Context, gradient_slabs: u32) -> wgpu::Buffer {
        let uniform = uniforms::Eye { gradient_slabs: gradient_slabs as i32, ..self.uniform };
        context.buffer("Eye::uniform", &[uniform], wgpu::BufferUsages::UNIFORM)
    }

    /// Returns the uniform of eye and lights.
    pub(crate) fn uniform(&self) -> uniforms::Eye {
        self.uniform
    }

    /// Returns the shading part of the pipeline variant, for passes that only shade.
    pub(crate) fn shading_variant(&self) -> ShadingVariant {
        self.variant.shading
    }

    /// Returns the sampling part of the pipeline variant, for the scattering engine; `has_gradients` tells if there
    /// is a gradient texture.
    pub(crate) fn sampling_variant(&self, has_gradients: bool) -> SamplingVariant {
        SamplingVariant { has_gradients, ..self.variant.sampling }
    }

    /// Returns the view of the gradient texture, if there is one; it holds gradients of density, so pre-classified
    /// volumes have none.
    pub(crate) fn gradients<'a>(&self, gpu: Gpu<'a>) -> Option<&'a wgpu::TextureView> {
        if self.variant.shading.classification == Classification::Pre {
            return None;
        }
        gpu.volume.gradients_views.as_ref().map(|views| self.levels.choose(views))
    }

    /// Returns true if pixels are wider than voxels somewhere in the view.
    pub(crate) fn is_stretched(&self) -> bool {
        self.variant.is_stretched
    }

    /// Returns the pyramid levels that kernels read.
    pub(crate) fn levels(&self) -> Levels {
        self.levels
    }

    /// Draws some rows of the picture.
    pub(crate) fn draw(
        &self,
        gpu: Gpu<'_>,
        tables: &Tables,
        looked_up: LookedUp<'_>,
        picture: &wgpu::TextureView,
        rows: std::ops::Range<u32>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let Gpu { context, shaders, .. } = gpu;
        let gradients = self.gradients(gpu);
        let ends = tables.ends(gpu.volume, self.dilation, self.frame.max_stretch_level());
        let variant = self.variant.with_gradients(gradients.is_some()).ending(ends);
        let pipeline = shaders.pipeline(&variant)?;
        let tiles = pass::tiles([self.frame.size[0], rows.end - rows.start]);
        let runs = pass::runs(context, tiles);
        let uniform = uniforms::Eye { first_row: rows.start, end_row: rows.end, runs, ..self.uniform };
        let uniform = gpu.uniform("Eye::uniform", uniform);
        let own = gpu.bind(
            "Eye::bind_group",
            &pipeline,
            0,
            &[
                buffer("bound_eye", &uniform),
                buffer("table", tables.eye.gathered()),
                view_of("distances", &tables.eye_distances),
                view_of("picture", picture),
                buffer("lighting_table", tables.lighting.gathered()),
                view_of("light_distances", &tables.light_distances),
                view_of("gradients", gradients.unwrap_or(gpu.placeholder)),
            ],
        );
        let of_volume = gpu.bind_volume(&pipeline, self.dilation, self.levels, tables.pyramids(gpu.volume));
        let of_lights = light_bind_group(gpu, &pipeline, looked_up);
        pass::dispatch(encoder, "Eye::pass", &pipeline, &[&own, &of_volume, &of_lights], tiles);
        Ok(())
    }
}

/// Pipeline variant of the eye pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct GatherVariant {
    reconstruction: Reconstruction,
    /// `true` if pixels are wider than voxels somewhere.
    is_stretched: bool,
    sampling: SamplingVariant,
    /// `true` if slabs are subdivided by need.
    by_need: bool,
    /// `true` if opacity is integrated between the densities at both ends of each step.
    preintegrated: bool,
    /// `true` if normals are gradients of the kernel itself.
    kernel_gradients: bool,
    shading: ShadingVariant,
    /// Deposit rule of the rays that samples cast to lights; `None` if light volumes are looked up.
    rays: Option<Deposit>,
}

/// Sources of the normals and of the near-field light at samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct SamplingVariant {
    /// `true` if normals come from neighbouring sheets.
    sheet_gradients: bool,
    /// `true` if normals come from the gradient texture.
    has_gradients: bool,
    /// Number of steps of near-field rays; 0 without a near field.
    near_steps: u32,
}

impl SamplingVariant {
    /// Returns the values of its override constants and conditions.
    pub(crate) fn constants(self) -> Constants {
        vec![
            flag("SHEET_GRADIENTS", self.sheet_gradients),
            flag("GRADIENT_TEXTURE", self.has_gradients),
            ("NEAR_STEPS", f64::from(self.near_steps)),
        ]
    }
}

impl GatherVariant {
    /// Creates the variant for this number of lights, without the gradient texture; `is_stretched` tells if pixels
    /// are wider than voxels somewhere.
    pub(crate) fn of(settings: &Settings, lights: LightCount, is_stretched: bool) -> Self {
        let Settings { sampling, shadows, cuts, shading, .. } = settings;
        let casts_rays = shadows.algorithm == ShadowAlgorithm::Direct;
        let near_steps = if lights.shadowed > 0 { settings.near_field().steps() } else { 0 };
        Self {
            reconstruction: Reconstruction::new(settings.eye_kernel(), sampling.quadrature),
            is_stretched,
            sampling: SamplingVariant {
                sheet_gradients: settings.has_sheet_gradients(),
                has_gradients: false,
                near_steps,
            },
            kernel_gradients: settings.has_kernel_gradients(),
            by_need: settings.has_slabs_by_need(),
            preintegrated: settings.has_preintegrated_slabs(),
            shading: ShadingVariant {
                lights,
                is_combined: false,
                // Rays to lights are part of the eye pass, so the cut of the shading applies here, too.
                is_cut: is_cut(cuts.seen()) || (casts_rays || near_steps > 0) && is_cut(cuts.shading()),
                sides: shading.sides,
                classification: sampling.classification,
                sky: SkyVariant::of(settings),
                has_bounces: settings.has_bounces(),
                is_anisotropic: settings.scattering.anisotropy != 0.0,
                has_colored_shadows: settings.has_colored_shadows(),
            },
            rays: casts_rays.then_some(shadows.deposit),
        }
    }

    /// Sets if the shadowed lights are in one combined volume.
    pub(crate) fn with_combined(mut self, is_combined: bool) -> Self {
        self.shading.is_combined = is_combined;
        self
    }

    /// Sets the grid boundaries that samples may meet.
    pub(crate) fn ending(mut self, ends: Ends) -> Self {
        self.reconstruction = self.reconstruction.ending(ends);
        self
    }

    /// Sets if normals come from the gradient texture.
    pub(crate) fn with_gradients(mut self, has_gradients: bool) -> Self {
        self.sampling.has_gradients = has_gradients;
        self
    }
}

impl Variant for GatherVariant {
    fn shader(&self) -> &'static str {
        "eye/gather.wgsl"
    }

    fn constants(&self) -> Constants {
        let mut constants = self.reconstruction.constants();
        constants.extend(self.shading.constants());
        constants.extend([
            flag("STRETCH", self.is_stretched),
            flag("BY_NEED", self.by_need),
            flag("PREINTEGRATED", self.preintegrated),
            flag("KERNEL_GRADIENTS", self.kernel_gradients),
            flag("DIRECT", self.rays.is_some()),
        ]);
        constants.extend(self.sampling.constants());
        if let Some(deposit) = self.rays {
            constants.push(deposit_constant(deposit));
        }
        constants
    }
}

/// Builds the uniform of the shading and shadow parameters.
pub(crate) fn pack_shading(
    settings: &Settings,
    scene: &SceneSpace,
    options: &RenderOptions,
) -> uniforms::Shading {
    let (shading, shadows) = (&settings.shading, &settings.shadows);
    let unit = settings.opacity_unit.in_scene(scene).max(1e-9);
    uniforms::Shading {
        emission: shading.emission as f32,
        ambient: settings.flat_ambient() as f32,
        diffuse: shading.diffuse as f32,
        specular: shading.specular as f32,
        shininess: shading.shininess as f32,
        surface_gradient: (shading.surface_gradient / unit) as f32,
        strength: shadows.strength as f32,
        ambient_offset: shadows.ambient_offset as f32,
        gain: shadows.gain as f32,
        bias: (shadows.bias_voxels * scene.smallest_edge()) as f32,
        ray_step: shadows.ray_step(scene) as f32,
        dark_depth: options.max_optical_depth(),
        anisotropy: settings.scattering.anisotropy as f32,
        pad0: 0.0,
        pad1: 0.0,
        pad2: 0.0,
    }
}
