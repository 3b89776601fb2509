//! What passes that shade look up: light volumes, and light from all around.

use crate::gpu::bounces::volume::BouncesVolume;
use crate::gpu::light::packed::light_entries;
use crate::gpu::pipelines::binding::{Pipeline, view_of};
use crate::gpu::pipelines::uniforms;
use crate::gpu::sky::volume::SkyVolume;
use crate::gpu::volume::Gpu;
use crate::math::SceneSpace;
use crate::model::{SKY_AHEAD, Settings, SkyRadiance};

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
