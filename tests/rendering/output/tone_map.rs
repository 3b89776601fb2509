//! Tone maps against their formulas, in double precision: from the linear light of pictures to what is shown of it.

use chiaroscuro::gpu::{Renderer, ShaderLibrary};
use chiaroscuro::model::{Depth, ImageSpec, Settings, ToneMap};
use glam::DVec3;

use crate::common::{Dataset, context, render};
use crate::compare::{Difference, Limit, compare};
use crate::scenes;
use crate::thresholds::TONE_MAP;

const SIZE: [u32; 2] = [96, 80];

/// The Khronos PBR neutral tone mapper's compression of what is brighter than 0.8, as it is published:
/// <https://github.com/KhronosGroup/ToneMapping>. Two parts are left out on purpose: the offset for light that surfaces
/// reflect whatever their colour, which volumes do not have, and the way to white, which would take away hue.
fn neutral(color: DVec3) -> DVec3 {
    let start_compression = 0.8;
    let peak = color.max_element();
    if peak < start_compression {
        return color;
    }
    let d = 1.0 - start_compression;
    let new_peak = 1.0 - d * d / (peak + d - start_compression);
    color * (new_peak / peak)
}

/// IEC 61966-2-1.
fn srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// What is shown of premultiplied light before nothing, with straight alpha.
fn shown(light: [f32; 4], tone_map: ToneMap) -> [f64; 4] {
    let [r, g, b, alpha] = light.map(f64::from);
    if alpha <= 0.0 {
        return [0.0; 4];
    }
    let straight = DVec3::new(r, g, b) / alpha;
    let mapped = match tone_map {
        ToneMap::Neutral => neutral(straight),
        ToneMap::Clip => straight.clamp(DVec3::ZERO, DVec3::ONE),
    };
    [srgb(mapped.x), srgb(mapped.y), srgb(mapped.z), alpha]
}

/// How bright the lights of the pictures are: from hardly anything to far beyond white.
const INTENSITIES: [f64; 4] = [0.2, 1.0, 4.0, 200.0];

fn look(intensity: f64, tone_map: ToneMap) -> Settings {
    let mut settings = scenes::look();
    settings.lights[0].intensity = intensity;
    settings.lights[0].color = [1.0, 0.7, 0.4];
    settings.output.tone_map = tone_map;
    settings
}

/// Light of all the pictures, and what the renderer shows of it with 16 bits.
fn sweep(mut renderer: Renderer, tone_map: ToneMap) -> (Vec<[f32; 4]>, Vec<f64>) {
    let loaded = Dataset::new(scenes::creature(32, DVec3::ONE));
    let (mut light, mut found) = (Vec::new(), Vec::new());
    for intensity in INTENSITIES {
        let settings = look(intensity, tone_map);
        light.extend(render(&mut renderer, &loaded, &settings, SIZE).light);
        let shot = ImageSpec { depth: Depth::Sixteen, transparent: true, ..ImageSpec::new(SIZE) };
        let rows = renderer.bands_of(&loaded, &settings, &shot, 4096, 1 << 20).all();
        found.extend(rows.expect("the picture is rendered").values().into_iter().map(f64::from));
    }
    (light, found)
}

fn check(renderer: Renderer, tone_map: ToneMap) -> Result<Difference, String> {
    let (light, found) = sweep(renderer, tone_map);
    let expected: Vec<f64> = light.iter().flat_map(|&texel| shown(texel, tone_map)).collect();
    compare(&format!("{tone_map:?}"), &found, &expected, Limit { max: TONE_MAP, rmse: TONE_MAP })
}

#[test]
fn tone_maps_are_their_formulas() {
    for tone_map in [ToneMap::Neutral, ToneMap::Clip] {
        let renderer = Renderer::new(&context()).expect("a renderer");
        check(renderer, tone_map).unwrap_or_else(|err| panic!("{err}"));
    }
}

/// The comparison is worth what it compares: values before, at and far behind the shoulder.
#[test]
fn all_of_the_curve_is_compared() {
    let (light, _) = sweep(Renderer::new(&context()).expect("a renderer"), ToneMap::Neutral);
    let peaks: Vec<f32> = light
        .iter()
        .filter(|texel| texel[3] > 0.1)
        .map(|texel| texel[..3].iter().copied().fold(0.0, f32::max) / texel[3])
        .collect();
    for range in [0.0..0.4, 0.4..0.8, 0.8..1.0, 1.0..2.0, 2.0..8.0, 8.0..1e3] {
        let count = peaks.iter().filter(|peak| range.contains(*peak)).count();
        assert!(count > 50, "{count} values in {range:?}");
    }
    let half = light.iter().filter(|texel| (0.2..0.8).contains(&texel[3])).count();
    assert!(half > 50, "{half} values are half transparent");
}

#[test]
fn other_tone_maps_are_noticed() {
    for (from, to) in [
        ("const SHOULDER = 0.8;", "const SHOULDER = 0.79;"),
        ("w * w / (max(peak, SHOULDER) - SHOULDER + w)", "w * w / max(peak, SHOULDER)"),
        ("max(max(color.r, color.g), color.b)", "max(color.r, color.g) * 0.99"),
        ("compressed / max(peak, 1e-6)", "compressed"),
        ("light.rgb / max(light.a, 1e-6)", "light.rgb"),
    ] {
        let r16 = wgpu::TextureFormat::R16Float;
        let source =
            ShaderLibrary::source("output/display_deep.wgsl", r16, r16).expect("the shader is there");
        assert!(source.contains(from), "the shader no longer contains {from:?}");
        let context = context();
        let shaders = ShaderLibrary::with_mutation(&context, from, to);
        let renderer = Renderer::with_shaders(&context, shaders).expect("a renderer");
        assert!(check(renderer, ToneMap::Neutral).is_err(), "{to} is not noticed");
    }
}
