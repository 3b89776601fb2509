//! Packing of lights into uniforms, and binding of their attenuation volumes.

use glam::DVec3;

use super::light_volume::LightVolume;
use crate::pipelines::binding::{NamedResource, bind_view};
use crate::pipelines::layouts::ATTENUATION;
use crate::pipelines::uniforms;
use crate::plan::ActiveLight;
use crate::volume::VolumeContext;
use chiaroscuro_scene::{LightArea, LightGeometry, SceneLight, Settings};
use chiaroscuro_volume::math::SceneSpace;

/// Light with its attenuation volume.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LightInput<'a> {
    pub light: &'a ActiveLight,
    /// Attenuation volume; `None` if the light casts no shadows, or if rays compute them.
    pub volume: Option<&'a LightVolume>,
}

/// Builds the uniform of a light.
pub(crate) fn light_uniform(
    light: &SceneLight,
    volume: Option<&LightVolume>,
    scene: &SceneSpace,
    settings: &Settings,
) -> uniforms::LightUniform {
    // Balance compensates for the light lost in shadows; without shadows it is not applied.
    let balance = if settings.shadows.algorithm.is_on() { settings.shadows.balance } else { 1.0 };
    let cone = light.cone();
    let linear = |c: f32| chiaroscuro_scene::linear_from_srgb(f64::from(c));
    let (place, perspective) = match light.kind {
        LightGeometry::Parallel => (light.direction(), 0.0),
        LightGeometry::Perspective => (light.position.into(), 1.0),
    };
    let border = |of: fn(&LightArea) -> DVec3| light.area.map_or([0.0; 3], |area| of(&area).as_vec3().into());
    uniforms::LightUniform {
        position_or_direction: place.as_vec3().into(),
        perspective,
        color: light.color.map(|c| (linear(c) * light.intensity * balance) as f32),
        extinction_scale: light.density_scale as f32,
        lookup: volume.map_or([0.0; 3], |volume| volume.dims.map(|n| 1.0 / (n * volume.divisor) as f32)),
        cone_cos_inner: cone.cos_inner as f32,
        cone_axis: cone.axis.as_vec3().into(),
        cone_cos_outer: cone.cos_outer as f32,
        last_step_extension: volume.map_or(0.0, |volume| 0.5 * volume.divisor as f64 * scene.smallest_edge())
            as f32,
        points: light.sample_count(settings.shadows.area.samples),
        shape: light.area.map_or(0, |area| area.shape as u32),
        near_steps: light.near_field_steps(settings.effective_near_field()),
        area_right: border(|area| area.right),
        two_sided: f32::from(u8::from(!light.casts_shadows)),
        area_up: border(|area| area.up),
        pad0: 0.0,
        area_near: border(|area| area.near),
        pad1: 0.0,
    }
}

/// Binds the attenuation volumes in the order of their lights, and the placeholder to unused slots.
pub(crate) fn attenuation_bindings<'a>(
    gpu: VolumeContext<'a>,
    attenuation: &[&'a wgpu::TextureView],
) -> Vec<NamedResource<'a>> {
    let of_light = |slot: usize| attenuation.get(slot).copied().unwrap_or(gpu.placeholder);
    (0..).zip(ATTENUATION).map(|(slot, name)| bind_view(name, of_light(slot))).collect()
}
