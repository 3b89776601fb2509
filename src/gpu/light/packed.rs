//! Lights as the passes that shade take them: packed for uniforms, and their volumes bound.

use glam::DVec3;

use super::volume::LightVolume;
use crate::gpu::bounces::volume::BouncesVolume;
use crate::gpu::pipelines::binding::{Named, Pipeline, view_of};
use crate::gpu::pipelines::layouts::ATTENUATION;
use crate::gpu::pipelines::uniforms;
use crate::gpu::sky::volume::SkyVolume;
use crate::gpu::volume::Gpu;
use crate::math::SceneSpace;
use crate::model::{LightArea, LightKind, SKY_AHEAD, SceneLight, Settings, SkyRadiance};
use crate::plan::LitLight;

/// A light, and the volume that says how much of it is left.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LightInput<'a> {
    pub lit: &'a LitLight,
    /// `None` where nothing attenuates it, or rays say how much.
    pub volume: Option<&'a LightVolume>,
}

/// A light for the shaders.
pub(crate) fn pack_light(
    light: &SceneLight,
    volume: Option<&LightVolume>,
    scene: &SceneSpace,
    settings: &Settings,
) -> uniforms::Light {
    // Balance makes up for the light that shadows take away; without shadows there is none.
    let balance = if settings.shadows.algorithm.is_on() { settings.shadows.balance } else { 1.0 };
    let cone = light.cone();
    let linear = |c: f32| crate::model::linear_from_srgb(f64::from(c));
    let to_index = &scene.index_from_scene;
    let (place, place_in_index, perspective) = match light.kind {
        LightKind::Parallel => (light.direction(), to_index.transform_vector3(light.direction()), 0.0),
        LightKind::Perspective => {
            let position = light.position.into();
            (position, to_index.transform_point3(position), 1.0)
        }
    };
    let border = |of: fn(&LightArea) -> DVec3| light.area.map_or([0.0; 3], |area| of(&area).as_vec3().into());
    uniforms::Light {
        place: place.as_vec3().into(),
        perspective,
        color: light.color.map(|c| (linear(c) * light.intensity * balance) as f32),
        extinction_scale: light.density_scale as f32,
        lookup: volume.map_or([0.0; 3], |volume| volume.dims.map(|n| 1.0 / (n * volume.divisor) as f32)),
        hood_inner: cone.cos_inner as f32,
        hood_axis: cone.axis.as_vec3().into(),
        hood_outer: cone.cos_outer as f32,
        place_in_index: place_in_index.as_vec3().into(),
        two_sided: f32::from(u8::from(!light.casts_shadows)),
        near_ahead: volume.map_or(0.0, |volume| 0.5 * volume.divisor as f64 * scene.smallest_edge()) as f32,
        points: light.area.map_or(1, |_| settings.shadows.area.samples),
        shape: light.area.map_or(0, |area| area.shape as u32),
        pad0: 0,
        area_right: border(|area| area.right),
        pad1: 0.0,
        area_up: border(|area| area.up),
        pad2: 0.0,
        area_near: border(|area| area.near),
        pad3: 0.0,
    }
}

/// Light that comes from all around, as far as there is a volume of it.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Around<'a> {
    /// How open to the sky places are.
    pub sky: Option<&'a SkyVolume>,
    /// Light that has bounced.
    pub bounces: Option<&'a BouncesVolume>,
}

/// What passes that shade look up.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LookedUp<'a> {
    /// The light volumes in the order of their lights, or the combined one.
    pub attenuation: &'a [&'a wgpu::TextureView],
    pub around: Around<'a>,
}

/// The sky for the shaders; black where there is none.
pub(crate) fn pack_sky(settings: &Settings, scene: &SceneSpace, volume: Option<&SkyVolume>) -> uniforms::Sky {
    let radiance = settings.sky.radiance(settings.camera.up);
    let color = |c: usize| {
        let of = |sky: &SkyRadiance| sky.slope[c].extend(sky.mean[c]).as_vec4().into();
        radiance.as_ref().map_or([0.0; 4], of)
    };
    uniforms::Sky {
        red: color(0),
        green: color(1),
        blue: color(2),
        lookup: volume.map_or([0.0; 3], SkyVolume::lookup),
        ahead: volume.map_or(0.0, |volume| SKY_AHEAD * volume.divisor as f64 * scene.smallest_edge()) as f32,
    }
}

/// Bounced light for the shaders; none where there is none.
pub(crate) fn pack_bounces(
    settings: &Settings,
    scene: &SceneSpace,
    volume: Option<&BouncesVolume>,
) -> uniforms::Bounces {
    let scattering = &settings.scattering;
    uniforms::Bounces {
        lookup: volume.map_or([0.0; 3], BouncesVolume::lookup),
        ahead: volume.map_or(0.0, |volume| SKY_AHEAD * volume.divisor as f64 * scene.smallest_edge()) as f32,
        share: (scattering.strength * scattering.albedo) as f32,
        pad0: 0.0,
        pad1: 0.0,
        pad2: 0.0,
    }
}

/// The light volumes in the order of their lights, as shaders name them; something in place of those that are not there.
pub(crate) fn light_entries<'a>(gpu: Gpu<'a>, attenuation: &[&'a wgpu::TextureView]) -> Vec<Named<'a>> {
    let of_light = |slot: usize| attenuation.get(slot).copied().unwrap_or(gpu.placeholder);
    (0..).zip(ATTENUATION).map(|(slot, name)| view_of(name, of_light(slot))).collect()
}

/// Bind group 2 of the passes that shade what the eye sees.
pub(crate) fn light_bind_group(
    gpu: Gpu<'_>,
    pipeline: &Pipeline,
    LookedUp { attenuation, around }: LookedUp<'_>,
) -> wgpu::BindGroup {
    let mut entries = light_entries(gpu, attenuation);
    entries.push(view_of("sky_texture", around.sky.map_or(gpu.placeholder, |volume| &volume.view)));
    entries.push(view_of("bounced_texture", around.bounces.map_or(gpu.placeholder, |volume| &volume.view)));
    gpu.bind("LightVolume::bind_group", pipeline, 2, &entries)
}
