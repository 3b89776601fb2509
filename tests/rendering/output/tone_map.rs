//! Tone maps against their formulas in double precision: from the linear light of pictures to the displayed values.

use chiaroscuro_render::{Renderer, ShaderLibrary};
use chiaroscuro_scene::{ImageSpec, PixelFormat, Settings, ToneMap};
use glam::DVec3;

use crate::common::{Dataset, damaged_renderer, new_renderer, render};
use crate::compare::{ErrorLimit, ErrorMeasure, compare};
use crate::scenes;
use crate::thresholds::{EIGHT_BITS, TONE_MAP};

const SIZE: [u32; 2] = [96, 80];

/// The Khronos PBR neutral tone mapper's compression of values above 0.8, as it is published:
/// <https://github.com/KhronosGroup/ToneMapping>. Two parts are left out on purpose: the offset for the Fresnel
/// reflection of surfaces, which volumes do not have, and the desaturation towards white, which would take away hue.
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

/// sRGB transfer function of IEC 61966-2-1, from linear light.
fn srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Displayed values of premultiplied light without background, with straight alpha.
fn displayed(light: [f32; 4], tone_map: ToneMap, exposure: f64) -> [f64; 4] {
    let [r, g, b, alpha] = light.map(f64::from);
    if alpha <= 0.0 {
        return [0.0; 4];
    }
    let straight = exposure * DVec3::new(r, g, b) / alpha;
    let mapped = match tone_map {
        ToneMap::Neutral => neutral(straight),
        ToneMap::Clip => straight.clamp(DVec3::ZERO, DVec3::ONE),
    };
    [srgb(mapped.x), srgb(mapped.y), srgb(mapped.z), alpha]
}

/// Intensities of the lights in the pictures: from almost 0 to far beyond white.
const INTENSITIES: [f64; 4] = [0.2, 1.0, 4.0, 200.0];

fn look(intensity: f64, tone_map: ToneMap, exposure: f64) -> Settings {
    let mut settings = scenes::look();
    settings.lights[0].intensity = intensity;
    settings.lights[0].color = [1.0, 0.7, 0.4];
    settings.output.tone_map = tone_map;
    // Light is read back with a ray through each pixel.
    settings.output.antialiasing = 1;
    settings.output.exposure = exposure;
    settings
}

/// Linear light of all the pictures, and the displayed values with 16 bits.
fn render_all_intensities(
    mut renderer: Renderer,
    tone_map: ToneMap,
    exposure: f64,
) -> (Vec<[f32; 4]>, Vec<f64>) {
    let loaded = Dataset::new(scenes::creature(32, DVec3::ONE));
    let (mut light, mut found) = (Vec::new(), Vec::new());
    for intensity in INTENSITIES {
        let settings = look(intensity, tone_map, exposure);
        light.extend(render(&mut renderer, &loaded, &settings, SIZE).linear);
        let image_spec = ImageSpec { depth: PixelFormat::Sixteen, transparent: true, ..ImageSpec::new(SIZE) };
        let rows = renderer.bands_with_limits(&loaded, &settings, &image_spec, 4096, 1 << 20).all();
        found.extend(rows.expect("the picture is rendered").values().into_iter().map(f64::from));
    }
    (light, found)
}

fn check(renderer: Renderer, tone_map: ToneMap, exposure: f64) -> Result<ErrorMeasure, String> {
    let (light, found) = render_all_intensities(renderer, tone_map, exposure);
    let expected: Vec<f64> = light.iter().flat_map(|&texel| displayed(texel, tone_map, exposure)).collect();
    compare(
        &format!("{tone_map:?} {exposure}"),
        &found,
        &expected,
        ErrorLimit { max: TONE_MAP, rmse: TONE_MAP },
    )
}

#[test]
fn tone_maps_are_their_formulas() {
    for (tone_map, exposure) in
        [(ToneMap::Neutral, 1.0), (ToneMap::Clip, 1.0), (ToneMap::Neutral, 2.5), (ToneMap::Clip, 0.3)]
    {
        let renderer = new_renderer();
        check(renderer, tone_map, exposure).unwrap_or_else(|err| panic!("{err}"));
    }
}

/// Guards the comparison: it covers values before, at and far behind the shoulder.
#[test]
fn all_of_the_curve_is_compared() {
    let (light, _) = render_all_intensities(new_renderer(), ToneMap::Neutral, 1.0);
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
        ("vec4f(vec3f(display.exposure), 1.0)", "vec4f(display.exposure)"),
    ] {
        let r16 = wgpu::TextureFormat::R16Float;
        let source =
            ShaderLibrary::source("output/display_deep.wgsl", r16, r16).expect("the shader is there");
        assert!(source.contains(from), "the shader no longer contains {from:?}");
        let renderer = damaged_renderer(from, to);
        assert!(check(renderer, ToneMap::Neutral, 1.2).is_err(), "{to} is not noticed");
    }
}

/// Linear pictures are exposed like displayed ones, so that volume and background relate as on the screen; the light
/// that is read back, by which balances are measured, is not.
#[test]
fn linear_pictures_have_the_exposure_and_light_has_not() {
    let loaded = Dataset::new(scenes::creature(32, DVec3::ONE));
    let mut renderer = new_renderer();
    let linear = |renderer: &mut Renderer, settings: &Settings| -> Vec<f32> {
        let image_spec = ImageSpec { depth: PixelFormat::Linear, transparent: true, ..ImageSpec::new(SIZE) };
        renderer
            .bands_with_limits(&loaded, settings, &image_spec, 4096, 1 << 20)
            .all()
            .expect("a picture")
            .values()
    };
    let plain = look(1.0, ToneMap::Neutral, 1.0);
    let exposed = look(1.0, ToneMap::Neutral, 3.0);
    let (before, after) = (linear(&mut renderer, &plain), linear(&mut renderer, &exposed));
    let wanted: Vec<f64> = before
        .chunks_exact(4)
        .flat_map(|texel| [3.0 * texel[0], 3.0 * texel[1], 3.0 * texel[2], texel[3]].map(f64::from))
        .collect();
    let found: Vec<f64> = after.into_iter().map(f64::from).collect();
    compare("exposed", &found, &wanted, ErrorLimit { max: TONE_MAP, rmse: TONE_MAP })
        .expect("three times the light");
    let light =
        |renderer: &mut Renderer, settings: &Settings| render(renderer, &loaded, settings, SIZE).linear;
    assert!(light(&mut renderer, &plain) == light(&mut renderer, &exposed));
}

#[test]
fn the_background_is_not_exposed_and_the_floor_is() {
    let loaded = Dataset::new(scenes::creature(32, DVec3::ONE));
    let mut renderer = new_renderer();
    let mut settings = look(1.0, ToneMap::Clip, 1.0);
    settings.floor.on = true;
    settings.camera.elevation_deg = 40.0;
    let before = render(&mut renderer, &loaded, &settings, SIZE);
    let floor = renderer.read_floor().expect("a floor");
    settings.output.exposure = 0.5;
    let after = render(&mut renderer, &loaded, &settings, SIZE);
    let texel = |bytes: &[u8], at: usize| [0, 1, 2].map(|channel| bytes[4 * at + channel]);
    let (mut bare, mut covered) = (0, 0);
    for (at, below) in floor.iter().enumerate() {
        if before.linear[at][3] > 0.0 {
            continue;
        }
        if below[3] == 0.0 {
            assert_eq!(texel(&before.display, at), texel(&after.display, at));
            bare += 1;
        } else if below[3] == 1.0 {
            for (byte, light) in std::iter::zip(texel(&after.display, at), below) {
                let wanted = srgb((0.5 * f64::from(*light)).min(1.0));
                let found = f64::from(byte) / 255.0;
                assert!((found - wanted).abs() < EIGHT_BITS, "{found} instead of {wanted}");
            }
            covered += 1;
        }
    }
    assert!(bare > 50 && covered > 300, "{bare} pixels of background, {covered} of floor");
}
