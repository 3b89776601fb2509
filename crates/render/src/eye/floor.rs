//! Floor pass: the light on the floor under the volume, with the shadows that fall on it.

use super::eye_pass::EyePass;
use crate::light::floor_shadow::FloorShadowMap;
use crate::light::light_uniform::{attenuation_bindings, light_uniform};
use crate::light::raycast::RaycastVariant;
use crate::pipelines::binding::{bind_buffer, bind_view};
use crate::pipelines::pipeline_variant::{
    GridBoundaries, LightCount, PipelineVariant, ShaderConstants, SkyVariant, flag,
};
use crate::pipelines::uniforms;
use crate::plan::{ActiveLights, FloorPlane, ray_reach};
use crate::resources::pass;
use crate::sky::floor_map::FloorSkyMap;
use crate::volume::transfer_tables::{TransferTables, UNLIMITED_REACH};
use crate::volume::{PyramidLevels, VolumeContext};
use crate::{GpuError, RenderOptions};
use chiaroscuro_scene::{
    ClassificationOrder, FloorSettings, MAX_LIGHTS, SceneLight, Settings, linear_from_srgb,
};
use chiaroscuro_volume::math::SceneSpace;

/// Factor by which a submission has fewer rows than in the eye pass: the ray to each light is about as long as the
/// one from the eye.
pub(crate) const ROW_COST: u32 = 2;

/// Inputs of the floor pass besides the volume.
#[derive(Clone, Copy)]
pub(crate) struct FloorInputs<'a> {
    pub tables: &'a TransferTables,
    pub eye: &'a EyePass,
    pub lights: &'a ActiveLights,
    pub settings: &'a Settings,
    pub options: &'a RenderOptions,
    /// Sky visibility on the floor, if a map of it is used.
    pub sky: Option<&'a FloorSkyMap>,
    /// Transmittance maps of the lights, in their order; `None` for lights without one, whose rays are cast in the
    /// pass.
    pub shadows: &'a [Option<&'a FloorShadowMap>],
}

/// Draws some rows of the floor, where it is not hidden by the volume in `picture`.
pub(crate) fn draw_floor(
    gpu: VolumeContext<'_>,
    FloorInputs { tables, eye, lights: lit, settings, options, sky, shadows }: FloorInputs<'_>,
    picture: &wgpu::TextureView,
    floor_light: &wgpu::TextureView,
    rows: std::ops::Range<u32>,
    encoder: &mut wgpu::CommandEncoder,
) -> Result<(), GpuError> {
    let VolumeContext { context, shaders, volume, .. } = gpu;
    let frame = eye.frame();
    let lights = LightCount { all: lit.all().len() as u32, shadowed: lit.shadowed().len() as u32 };
    let reach = i32::from(ray_reach(&settings.shadows, &volume.scene));
    let dilation = if options.switches.empty_space_skipping { reach } else { UNLIMITED_REACH };
    let boundaries = tables.lighting.boundaries(volume, dilation, 0.0);
    let variant = FloorVariant::from_settings(settings, lights).with_boundaries(boundaries);
    let pipeline = shaders.pipeline(&variant)?;
    let tiles = pass::tile_workgroups([frame.size[0], rows.end - rows.start]);
    let runs = pass::interleaved_runs(context, tiles);
    let uniform = uniforms::FloorUniform {
        first_row: rows.start,
        end_row: rows.end,
        runs,
        ..floor_uniform(eye, &volume.scene, settings, lit, shadows)
    };
    let uniform = gpu.uniform("Floor::uniform", uniform);
    let pass_group = gpu.bind(
        "Floor::bind_group",
        &pipeline,
        0,
        &[
            bind_buffer("bound_floor_disc", &uniform),
            bind_buffer("table", tables.lighting.lookup_buffer()),
            bind_view("distances", &tables.light_distances),
            bind_view("picture", picture),
            bind_view("floor_light", floor_light),
            bind_view("sky_map", sky.map_or(gpu.placeholder, |map| &map.view)),
        ],
    );
    let volume_group =
        gpu.bind_volume(&pipeline, dilation, PyramidLevels::Finest, tables.lighting_pyramids(volume));
    let maps: Vec<_> =
        shadows.iter().map(|map| map.as_ref().map_or(gpu.placeholder, |map| &map.view)).collect();
    let lights_group = gpu.bind("Floor::lights", &pipeline, 2, &attenuation_bindings(gpu, &maps));
    pass::dispatch(encoder, "Floor::pass", &pipeline, &[&pass_group, &volume_group, &lights_group], tiles);
    Ok(())
}

/// Pipeline variant of the floor pass. Rays to lights are marched like those from the voxels of a light volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct FloorVariant {
    rays: RaycastVariant,
    lights: LightCount,
    sky: SkyVariant,
    /// Classification used for coloured shadows (voxels classified first, or densities); `None` if shadows have no
    /// colour.
    shadow_classification: Option<ClassificationOrder>,
}

impl FloorVariant {
    /// Creates the variant for this number of lights.
    pub(crate) fn from_settings(settings: &Settings, lights: LightCount) -> Self {
        let colored = settings.has_colored_shadows().then_some(settings.classification());
        Self {
            rays: RaycastVariant::from_settings(settings),
            lights,
            sky: SkyVariant::from_settings(settings),
            shadow_classification: colored,
        }
    }

    /// Returns the variant with the grid boundaries that rays may meet.
    fn with_boundaries(self, ends: GridBoundaries) -> Self {
        Self { rays: self.rays.with_boundaries(ends), ..self }
    }
}

impl PipelineVariant for FloorVariant {
    fn shader(&self) -> &'static str {
        "eye/floor.wgsl"
    }

    fn constants(&self) -> ShaderConstants {
        let mut constants = self.rays.constants();
        constants.extend(self.lights.constants());
        constants.push(self.sky.constant());
        constants.push(flag("COLORED", self.shadow_classification.is_some()));
        constants
            .push(flag("PRECLASSIFY", self.shadow_classification.is_some_and(ClassificationOrder::is_pre)));
        constants
    }
}

/// Builds the uniform of eye, floor and lights, for all rows.
fn floor_uniform(
    eye: &EyePass,
    scene: &SceneSpace,
    settings: &Settings,
    lit: &ActiveLights,
    shadows: &[Option<&FloorShadowMap>],
) -> uniforms::FloorUniform {
    let uniforms::EyeUniform { frame, shading, space, shading_cut, .. } = eye.uniform();
    let FloorSettings { on: _, height, radius, color, opacity, shadow_only } = settings.floor;
    // Height of a point along the up axis, as an affine function of index coordinates.
    let up = settings.camera.up.direction();
    let [a, b, c] = scene.scene_from_index.matrix3.transpose().mul_vec3(up).as_vec3().to_array();
    let offset = scene.scene_from_index.translation.dot(up) as f32;
    let balance = if settings.shadows.algorithm.is_on() { settings.shadows.balance } else { 1.0 };
    let [map_x, map_y] =
        FloorPlane::from_settings(settings).map_or([[0.0; 4]; 2], FloorPlane::texture_from_scene);
    let mut packed = [bytemuck::Zeroable::zeroed(); MAX_LIGHTS];
    for (at, (slot, light)) in packed.iter_mut().zip(lit.all()).enumerate() {
        // An area light approximated by a single point has no extent, and the floor has no highlights.
        let area = light.light.area.filter(|_| settings.shadows.area.samples > 1);
        *slot = light_uniform(&SceneLight { area, ..light.light }, None, scene, settings);
        // Lights with a transmittance map need no rays to points on them.
        if shadows.get(at).is_some_and(Option::is_some) {
            slot.points = 0;
        }
    }
    uniforms::FloorUniform {
        frame,
        space,
        shading,
        shading_cut,
        plane: [a, b, c, height as f32 - offset],
        up: up.as_vec3().to_array(),
        height: height as f32,
        color: color.map(|c| linear_from_srgb(f64::from(c)) as f32),
        opacity: opacity as f32,
        radius: radius as f32,
        fade_width: (radius * (1.0 - FloorSettings::OPAQUE_SHARE)) as f32,
        inverse_balance: (1.0 / balance.max(1e-9)) as f32,
        shadow_only: f32::from(u8::from(shadow_only)),
        first_row: 0,
        end_row: frame.size[1],
        runs: 1,
        pad0: 0,
        sky: eye.uniform().sky,
        map_x,
        map_y,
        lights: packed,
    }
}
