//! Light volumes that shading passes look up: lights, sky visibility and scattered light.

use crate::light::light_uniform::attenuation_bindings;
use crate::pipelines::binding::{ShaderPipeline, bind_view};
use crate::pipelines::uniforms;
use crate::scattered_light::volume::ScatteredLightVolume;
use crate::sky::block_texture::BlockTexture;
use crate::sky::volume::SkyVolume;
use crate::volume::VolumeContext;
use chiaroscuro_scene::{SKY_LOOKUP_DISTANCE, Settings, SkyRadiance};
use chiaroscuro_volume::math::SceneSpace;

/// Volumes of light from all directions; `None` where a picture has none.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct AmbientVolumes<'a> {
    /// Sky visibility, as moments over directions.
    pub sky: Option<&'a SkyVolume>,
    /// Light that was scattered at least once.
    pub bounces: Option<&'a ScatteredLightVolume>,
}

/// Light volumes that a shading pass looks up.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LightLookup<'a> {
    /// Attenuation volumes in the order of their lights, or the combined one alone.
    pub attenuation: &'a [&'a wgpu::TextureView],
    pub ambient: AmbientVolumes<'a>,
}

/// Builds the uniform of the sky: radiance as a linear function of direction, of which the share that material
/// scatters; black if the sky is off.
pub(crate) fn sky_uniform(
    settings: &Settings,
    scene: &SceneSpace,
    volume: Option<&SkyVolume>,
) -> uniforms::SkyUniform {
    let blocks = volume.map(|volume| &volume.blocks);
    let radiance = settings.sky.radiance(settings.camera.up);
    let scattered = settings.scattered_share();
    let color = |c: usize| {
        let of = |sky: &SkyRadiance| (sky.slope[c].extend(sky.mean[c]) * scattered).as_vec4().into();
        radiance.as_ref().map_or([0.0; 4], of)
    };
    uniforms::SkyUniform {
        red: color(0),
        green: color(1),
        blue: color(2),
        lookup: blocks.map_or([0.0; 3], BlockTexture::lookup),
        lookup_distance: lookup_distance(blocks, scene),
    }
}

/// Returns the distance in front of a surface at which blocks are looked up, in scene units; 0 without blocks.
fn lookup_distance(blocks: Option<&BlockTexture>, scene: &SceneSpace) -> f32 {
    blocks.map_or(0.0, |blocks| SKY_LOOKUP_DISTANCE * blocks.divisor as f64 * scene.smallest_edge()) as f32
}

/// Builds the uniform of scattered light; without a volume of it, the look-up parameters are zero.
pub(crate) fn scattered_light_uniform(
    settings: &Settings,
    scene: &SceneSpace,
    volume: Option<&ScatteredLightVolume>,
) -> uniforms::ScatteredLightUniform {
    let blocks = volume.map(|volume| &volume.blocks);
    let scattering = &settings.scattering;
    uniforms::ScatteredLightUniform {
        lookup: blocks.map_or([0.0; 3], BlockTexture::lookup),
        lookup_distance: lookup_distance(blocks, scene),
        share: (scattering.strength * scattering.albedo) as f32,
        pad0: 0.0,
        pad1: 0.0,
        pad2: 0.0,
    }
}

/// Creates bind group 2, the light volumes, of passes that shade samples for the eye.
pub(crate) fn light_bind_group(
    gpu: VolumeContext<'_>,
    pipeline: &ShaderPipeline,
    LightLookup { attenuation, ambient: around }: LightLookup<'_>,
) -> wgpu::BindGroup {
    let mut entries = attenuation_bindings(gpu, attenuation);
    entries.push(bind_view("sky_texture", around.sky.map_or(gpu.placeholder, |volume| &volume.blocks.view)));
    entries.push(bind_view(
        "bounced_texture",
        around.bounces.map_or(gpu.placeholder, |volume| &volume.blocks.view),
    ));
    gpu.bind("LightVolume::bind_group", pipeline, 2, &entries)
}
