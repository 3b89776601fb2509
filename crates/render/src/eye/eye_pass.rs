//! Eye pass: from density and attenuation volumes to the linear picture.

use glam::DVec3;

use super::eye_variant::{EyeVariant, SamplingVariant};
use super::light_lookup::{
    AmbientVolumes, LightLookup, light_bind_group, scattered_light_uniform, sky_uniform,
};
use super::ray_target::{DrawnRay, RayTarget};
use crate::light::combined_light::CombinedLight;
use crate::light::light_uniform::{LightInput, light_uniform};
use crate::pipelines::binding::{bind_buffer, bind_view};
use crate::pipelines::pipeline_variant::{LightCount, ShadingVariant};
use crate::pipelines::uniforms;
use crate::plan::picture_frame;
use crate::plan::{PagedView, PixelWindow, SheetFrame, ray_reach, sample_reach, scatter_reach_bricks};
use crate::resources::pass;
use crate::volume::transfer_tables::{TransferTables, UNLIMITED_REACH};
use crate::volume::{GpuVolume, PyramidLevels, VolumeContext};
use crate::{GpuContext, GpuError, RenderOptions};
use chiaroscuro_scene::{MAX_LIGHTS, Projection, RayProjection, Settings, ShadowAlgorithm};
use chiaroscuro_volume::math::{Aabb, SceneSpace};

/// Parameters of the eye pass of one picture, besides the volume.
#[derive(Debug)]
pub(crate) struct EyePass {
    frame: SheetFrame,
    uniform: uniforms::EyeUniform,
    /// Rays of the whole picture of which a part is drawn, and the first pixel of the part among them.
    rays: uniforms::SheetFrameUniform,
    first_pixel: [f32; 2],
    /// Reach of a sample's kernel, in cells around its own.
    dilation: i32,
    /// Pyramid levels that kernels read.
    levels: PyramidLevels,
    variant: EyeVariant,
    /// Finer levels that samples read, if there are pages of them.
    paged: Option<PagedView>,
}

/// Light that reaches the samples of a picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EyeLights<'a> {
    /// Lights with their volumes: shadowed ones first, without those that are in the combined volume.
    pub lights: &'a [LightInput<'a>],
    pub combined: Option<&'a CombinedLight>,
    pub ambient: AmbientVolumes<'a>,
}

impl EyePass {
    /// Prepares the pass for some lights, and for sky visibility and scattered light where there are volumes of them; light is
    /// that of the volume in memory, with the scene space `in_memory`, also where samples read finer levels.
    pub(crate) fn new(
        in_memory: &SceneSpace,
        settings: &Settings,
        window: PixelWindow,
        EyeLights { lights, combined, ambient }: EyeLights<'_>,
        options: &RenderOptions,
        paged: Option<PagedView>,
    ) -> Self {
        let scene = paged.as_ref().map_or(in_memory, |paged| &paged.scene);
        let mut frame = picture_frame(settings, scene, window);
        if options.work.point_samples {
            frame.coarsest_level = 0.0;
        }
        let direct = settings.shadows.algorithm == ShadowAlgorithm::Direct;
        let shadowed = lights.iter().filter(|input| input.light.is_shadowed()).count();
        let mut packed = [bytemuck::Zeroable::zeroed(); MAX_LIGHTS];
        for (slot, input) in packed.iter_mut().zip(lights) {
            *slot = light_uniform(&input.light.light, input.volume, in_memory, settings);
        }
        let stretch_level = frame.max_stretch_level();
        let (visible_region, shading_cut) = (settings.cuts.visible_part(), settings.cuts.shadowing_part());
        let (eye, w) = match settings.camera.projection {
            Projection::Perspective => (settings.camera.position(), 1.0),
            Projection::Orthographic => (settings.camera.scene_from_view().z_axis, 0.0),
        };
        let gradient_steps = frame.gradient_steps();
        let uniform = uniforms::EyeUniform {
            frame: uniforms::SheetFrameUniform::new(&frame),
            shading: shading_uniform(settings, in_memory, options),
            space: uniforms::SpaceUniform::new(scene),
            eye: eye.as_vec3().extend(w).into(),
            first_row: 0,
            end_row: window.size[1],
            dilation: if options.switches.empty_space_skipping {
                scatter_reach_bricks(&frame)
            } else {
                UNLIMITED_REACH
            },
            min_transmittance: options.switches.min_transmittance,
            gradient_pixels: gradient_steps.pixels as i32,
            gradient_slabs: gradient_steps.slabs as i32,
            runs: 1,
            // Unit of near-field rays, at whose ends light volumes are filled.
            voxel_edge: in_memory.smallest_edge() as f32,
            combined_lookup: combined.map_or([0.0; 3], CombinedLight::lookup),
            max_undivided_share: settings.sampling.max_undivided_share as f32,
            visible_cut: uniforms::CutUniform::new(&visible_region.region(scene)),
            face_cut: uniforms::CutUniform::new(
                &visible_region.region(scene).intersection(&Aabb::of_grid(scene.dims, 0.0)),
            ),
            shading_cut: uniforms::CutUniform::new(&shading_cut.region(scene)),
            sky: sky_uniform(settings, in_memory, ambient.sky),
            scattered_light: scattered_light_uniform(settings, in_memory, ambient.bounces),
            lights: packed,
        };
        let mut seen = sample_reach(&frame, scene, settings.sampling.quadrature, options.work.preview);
        if direct {
            seen = seen.max(ray_reach(&settings.shadows, scene));
        }
        let dilation = if options.switches.empty_space_skipping { i32::from(seen) } else { UNLIMITED_REACH };
        // Normals of classified voxels come from the next pyramid level.
        let is_classified = settings.classification().is_pre();
        let levels = PyramidLevels::for_stretch(stretch_level > 0.0 || is_classified);
        let count = LightCount { all: lights.len() as u32, shadowed: shadowed as u32 };
        let variant =
            EyeVariant::from_settings(settings, count, stretch_level > 0.0).with_combined(combined.is_some());
        let (uniform, variant) = match &paged {
            None => (uniform, variant),
            Some(paged) => (with_lookups_scaled(uniform, paged.coarse), variant.with_pages()),
        };
        let (rays, first_pixel) = rays_of_part(settings, scene, window, &frame);
        Self { frame, uniform, rays, first_pixel, dilation, levels, variant, paged }
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
    pub(crate) fn uniform_buffer(&self, context: &GpuContext, gradient_slabs: u32) -> wgpu::Buffer {
        let uniform = uniforms::EyeUniform { gradient_slabs: gradient_slabs as i32, ..self.uniform };
        context.buffer("Eye::uniform", &[uniform], wgpu::BufferUsages::UNIFORM)
    }

    /// Returns the uniform of eye and lights.
    pub(crate) fn uniform(&self) -> uniforms::EyeUniform {
        self.uniform
    }

    /// Returns the shading part of the pipeline variant, for passes that only shade.
    pub(crate) fn shading_variant(&self) -> ShadingVariant {
        self.variant.shading
    }

    /// Returns the sampling part of the pipeline variant, for the scattering engine, which has no kernel at points;
    /// `has_gradients` tells if there is a gradient texture.
    pub(crate) fn sampling_variant(&self, has_gradients: bool) -> SamplingVariant {
        let sampling = self.variant.sampling;
        SamplingVariant { has_gradient_texture: has_gradients, has_near_halves: false, ..sampling }
    }

    /// Returns the view of the gradient texture, if there is one; it holds gradients of density, so pre-classified
    /// volumes have none.
    pub(crate) fn gradients<'a>(&self, volume: &'a GpuVolume) -> Option<&'a wgpu::TextureView> {
        if self.variant.shading.is_preclassified {
            return None;
        }
        volume.pyramid.as_ref()?.gradients_views.as_ref().map(|views| self.levels.choose(views))
    }

    /// Returns true if pixels are wider than voxels somewhere in the view.
    pub(crate) fn is_stretched(&self) -> bool {
        self.variant.is_stretched
    }

    /// Returns the pyramid levels that kernels read.
    pub(crate) fn levels(&self) -> PyramidLevels {
        self.levels
    }

    /// Draws some rows of the picture, with a ray through the middle of each pixel.
    pub(crate) fn draw(
        &self,
        gpu: VolumeContext<'_>,
        tables: &TransferTables,
        looked_up: LightLookup<'_>,
        target: RayTarget<'_>,
        rows: std::ops::Range<u32>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let middle: uniforms::PixelRayUniform = bytemuck::Zeroable::zeroed();
        let ray = uniforms::PixelRayUniform { place: [0.0, 0.0, 0.0, 1.0], ..middle };
        let ray = DrawnRay { target, ray, slab_count: self.frame.slab_count };
        self.cast_rays(gpu, tables, looked_up, ray, rows, encoder)
    }

    /// Returns the reach of a sample in cells.
    ///
    /// An extreme may lie in a cell that shows nothing. On the way from there to a cell that shows something, values
    /// stay among those that the curve does not show, unless voxels are missing between them; so the ray is clear in
    /// any case. A mean is also of what the curve does not show.
    fn dilation(&self, volume: &GpuVolume) -> i32 {
        let skips = match self.variant.projection {
            None => true,
            Some(RayProjection::Maximum | RayProjection::Minimum) => volume.presence.is_none(),
            Some(RayProjection::Mean) => false,
        };
        if skips { self.dilation } else { UNLIMITED_REACH }
    }

    /// Returns the pipeline variant for a volume and its tables.
    pub(crate) fn pipeline_variant(&self, volume: &GpuVolume, tables: &TransferTables) -> EyeVariant {
        let ends = tables.boundaries(volume, self.dilation(volume), self.frame.max_stretch_level());
        self.variant.with_gradients(self.gradients(volume).is_some()).with_boundaries(ends)
    }

    /// Records a dispatch of one ray through each of all or some pixels, in some rows of a picture.
    pub(super) fn cast_rays(
        &self,
        gpu: VolumeContext<'_>,
        tables: &TransferTables,
        looked_up: LightLookup<'_>,
        DrawnRay { target: RayTarget { picture, earlier, edges }, mut ray, slab_count }: DrawnRay<'_>,
        rows: std::ops::Range<u32>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let VolumeContext { context, shaders, volume, .. } = gpu;
        let gradients = self.gradients(volume);
        let pipeline = shaders.pipeline(&self.pipeline_variant(volume, tables))?;
        let tiles = pass::tile_workgroups([self.frame.size[0], rows.end - rows.start]);
        let runs = pass::interleaved_runs(context, tiles);
        let frame = uniforms::SheetFrameUniform { slab_count, ..self.rays };
        let uniform =
            uniforms::EyeUniform { frame, first_row: rows.start, end_row: rows.end, runs, ..self.uniform };
        let [right, down, ..] = &mut ray.place;
        (*right, *down) = (*right + self.first_pixel[0], *down + self.first_pixel[1]);
        let uniform = gpu.uniform("Eye::uniform", uniform);
        let ray_is_listed = ray.is_listed != 0;
        let ray = gpu.uniform("Eye::ray", ray);
        let own = gpu.bind(
            "Eye::bind_group",
            &pipeline,
            0,
            &[
                bind_buffer("bound_eye", &uniform),
                bind_buffer("table", tables.eye.lookup_buffer()),
                bind_view("distances", &tables.eye_distances),
                bind_view("picture", picture),
                bind_buffer("edge_list", edges),
                bind_buffer("lighting_table", tables.lighting.lookup_buffer()),
                bind_view("light_distances", &tables.light_distances),
                bind_buffer("bound_pixel_ray", &ray),
                bind_view("earlier", earlier),
                bind_view("gradients", gradients.unwrap_or(gpu.placeholder)),
            ],
        );
        let (dilation, pyramids) = (self.dilation(volume), tables.pyramids(gpu.volume));
        let of_volume =
            gpu.bind_paged_volume(&pipeline, dilation, self.levels, pyramids, self.paged.as_ref());
        let of_lights = light_bind_group(gpu, &pipeline, looked_up);
        let groups = [&own, &of_volume, &of_lights];
        if ray_is_listed {
            pass::dispatch_indirect(encoder, "Eye::edges", &pipeline, &groups, edges);
        } else {
            pass::dispatch(encoder, "Eye::pass", &pipeline, &groups, tiles);
        }
        Ok(())
    }
}

/// Returns the rays of the whole picture with the first pixel of a part, whose frame is given: rays of all parts are those of the
/// whole to the last bit then.
fn rays_of_part(
    settings: &Settings,
    scene: &SceneSpace,
    part: PixelWindow,
    frame: &SheetFrame,
) -> (uniforms::SheetFrameUniform, [f32; 2]) {
    // Sheets end at the borders of the part.
    if settings.has_sheet_gradients() || settings.uses_scattering_engine() {
        return (uniforms::SheetFrameUniform::new(frame), [0.0; 2]);
    }
    let whole = picture_frame(settings, scene, part.whole);
    let rays = SheetFrame { size: frame.size, coarsest_level: frame.coarsest_level, ..whole };
    (uniforms::SheetFrameUniform::new(&rays), part.first.map(|n| n as f32))
}

/// Scales look-ups of light from the index space of the volume in memory to that of a finer level, which begins at the same
/// corner.
fn with_lookups_scaled(mut uniform: uniforms::EyeUniform, coarse: DVec3) -> uniforms::EyeUniform {
    let scaled = |lookup: [f32; 3]| (DVec3::from(lookup.map(f64::from)) * coarse).as_vec3().into();
    for light in &mut uniform.lights {
        light.lookup = scaled(light.lookup);
    }
    uniform.combined_lookup = scaled(uniform.combined_lookup);
    uniform.sky.lookup = scaled(uniform.sky.lookup);
    uniform.scattered_light.lookup = scaled(uniform.scattered_light.lookup);
    uniform
}

/// Builds the uniform of the shading and shadow parameters.
pub(crate) fn shading_uniform(
    settings: &Settings,
    scene: &SceneSpace,
    options: &RenderOptions,
) -> uniforms::ShadingUniform {
    let (shading, shadows) = (&settings.shading, &settings.shadows);
    let scattered = settings.scattered_share();
    let unit = settings.layer().opacity_unit.scene_units(scene).max(1e-9);
    uniforms::ShadingUniform {
        emission: shading.emission as f32,
        ambient: (settings.flat_ambient() * scattered) as f32,
        diffuse: (shading.diffuse * scattered) as f32,
        specular: shading.specular as f32,
        shininess: shading.shininess as f32,
        surface_gradient: (shading.surface_gradient / unit) as f32,
        strength: shadows.strength as f32,
        ambient_offset: shadows.ambient_offset as f32,
        gain: shadows.gain as f32,
        bias: (shadows.bias_voxels * scene.smallest_edge()) as f32,
        ray_step: shadows.ray_step(scene) as f32,
        max_optical_depth: options.switches.max_optical_depth(),
        anisotropy: settings.scattering.anisotropy as f32,
        amid: settings.light_amid_material() as f32,
        opacity_unit: unit as f32,
        pad0: 0.0,
    }
}
