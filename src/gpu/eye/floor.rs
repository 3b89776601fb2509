//! Floor pass: the light on the floor under the volume, with the shadows that fall on it.

use super::gather::EyePass;
use crate::gpu::light::floor_shadow::FloorShadow;
use crate::gpu::light::packed::{light_entries, pack_light};
use crate::gpu::light::raycast::RaycastVariant;
use crate::gpu::pipelines::binding::{buffer, view_of};
use crate::gpu::pipelines::uniforms;
use crate::gpu::pipelines::variant::{Constants, Ends, LightCount, SkyVariant, Variant, flag};
use crate::gpu::resources::pass;
use crate::gpu::sky::floor_map::FloorMap;
use crate::gpu::volume::transfer_tables::{EVERYWHERE, Tables};
use crate::gpu::volume::{Gpu, Levels};
use crate::gpu::{GpuError, RenderOptions};
use crate::math::SceneSpace;
use crate::model::{Classification, Floor, MAX_LIGHTS, SceneLight, Settings, linear_from_srgb};
use crate::plan::{FloorPlace, LitLights, ray_reach};

/// Factor by which a submission has fewer rows than in the eye pass: the ray to each light is about as long as the
/// one from the eye.
pub(crate) const COST: u32 = 2;

/// Inputs of the floor pass besides the volume.
#[derive(Clone, Copy)]
pub(crate) struct FloorInputs<'a> {
    pub tables: &'a Tables,
    pub eye: &'a EyePass,
    pub lit: &'a LitLights,
    pub settings: &'a Settings,
    pub options: &'a RenderOptions,
    /// Sky visibility on the floor, if a map of it is used.
    pub sky: Option<&'a FloorMap>,
    /// Transmittance maps of the lights, in their order; `None` for lights without one, whose rays are cast in the
    /// pass.
    pub shadows: &'a [Option<&'a FloorShadow>],
}

/// Draws some rows of the floor, where it is not hidden by the volume in `picture`.
pub(crate) fn draw(
    gpu: Gpu<'_>,
    FloorInputs { tables, eye, lit, settings, options, sky, shadows }: FloorInputs<'_>,
    picture: &wgpu::TextureView,
    floor_light: &wgpu::TextureView,
    rows: std::ops::Range<u32>,
    encoder: &mut wgpu::CommandEncoder,
) -> Result<(), GpuError> {
    let Gpu { context, shaders, volume, .. } = gpu;
    let frame = eye.frame();
    let lights = LightCount { all: lit.all().len() as u32, shadowed: lit.shadowed().len() as u32 };
    let seen = i32::from(ray_reach(&settings.shadows, &volume.scene));
    let dilation = if options.empty_space_skipping { seen } else { EVERYWHERE };
    let ends = tables.lighting.ends(volume, dilation, 0.0);
    let variant = FloorVariant::of(settings, lights).ending(ends);
    let pipeline = shaders.pipeline(&variant)?;
    let tiles = pass::tiles([frame.size[0], rows.end - rows.start]);
    let runs = pass::runs(context, tiles);
    let uniform = uniforms::Floor {
        first_row: rows.start,
        end_row: rows.end,
        runs,
        ..uniform(eye, &volume.scene, settings, (lit, shadows))
    };
    let uniform = gpu.uniform("Floor::uniform", uniform);
    let own = gpu.bind(
        "Floor::bind_group",
        &pipeline,
        0,
        &[
            buffer("bound_floor_disc", &uniform),
            buffer("table", tables.lighting.gathered()),
            view_of("distances", &tables.light_distances),
            view_of("picture", picture),
            view_of("floor_light", floor_light),
            view_of("sky_map", sky.map_or(gpu.placeholder, |map| &map.view)),
        ],
    );
    let of_volume = gpu.bind_volume(&pipeline, dilation, Levels::Finest, tables.lighting_pyramids(volume));
    let maps: Vec<_> =
        shadows.iter().map(|map| map.as_ref().map_or(gpu.placeholder, |map| &map.view)).collect();
    let of_lights = gpu.bind("Floor::lights", &pipeline, 2, &light_entries(gpu, &maps));
    pass::dispatch(encoder, "Floor::pass", &pipeline, &[&own, &of_volume, &of_lights], tiles);
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
    colored: Option<Classification>,
}

impl FloorVariant {
    /// Creates the variant for this number of lights.
    pub(crate) fn of(settings: &Settings, lights: LightCount) -> Self {
        let colored = settings.has_colored_shadows().then_some(settings.sampling.classification);
        Self { rays: RaycastVariant::of(settings), lights, sky: SkyVariant::of(settings), colored }
    }

    /// Returns the variant with the grid boundaries that rays may meet.
    fn ending(self, ends: Ends) -> Self {
        Self { rays: self.rays.ending(ends), ..self }
    }
}

impl Variant for FloorVariant {
    fn shader(&self) -> &'static str {
        "eye/floor.wgsl"
    }

    fn constants(&self) -> Constants {
        let mut constants = self.rays.constants();
        constants.extend(self.lights.constants());
        constants.push(self.sky.constant());
        constants.push(flag("COLORED", self.colored.is_some()));
        constants.push(flag("PRECLASSIFY", self.colored == Some(Classification::Pre)));
        constants
    }
}

/// Builds the uniform of eye, floor and lights, for all rows.
fn uniform(
    eye: &EyePass,
    scene: &SceneSpace,
    settings: &Settings,
    (lit, shadows): (&LitLights, &[Option<&FloorShadow>]),
) -> uniforms::Floor {
    let uniforms::Eye { frame, shading, space, shading_cut, .. } = eye.uniform();
    let Floor { on: _, height, radius, color, opacity, shadow_only } = settings.floor;
    // Height of a point along the up axis, as an affine function of index coordinates.
    let up = settings.camera.up.direction();
    let [a, b, c] = scene.scene_from_index.matrix3.transpose().mul_vec3(up).as_vec3().to_array();
    let offset = scene.scene_from_index.translation.dot(up) as f32;
    let balance = if settings.shadows.algorithm.is_on() { settings.shadows.balance } else { 1.0 };
    let [map_x, map_y] = FloorPlace::of(settings).map_or([[0.0; 4]; 2], FloorPlace::lookup);
    let mut packed = [bytemuck::Zeroable::zeroed(); MAX_LIGHTS];
    for (at, (slot, light)) in packed.iter_mut().zip(lit.all()).enumerate() {
        // An area light approximated by a single point has no extent, and the floor has no highlights.
        let area = light.light.area.filter(|_| settings.shadows.area.samples > 1);
        *slot = pack_light(&SceneLight { area, ..light.light }, None, scene, settings);
        // Lights with a transmittance map need no rays to points on them.
        if shadows.get(at).is_some_and(Option::is_some) {
            slot.points = 0;
        }
    }
    uniforms::Floor {
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
        fade: (radius * (1.0 - Floor::WHOLE)) as f32,
        light_share: (1.0 / balance.max(1e-9)) as f32,
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
