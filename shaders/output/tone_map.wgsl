// Display of linear, premultiplied light: average of a pixel's samples, tone map, background, sRGB.
#import "common/srgb.wgsl"

struct DisplayUniform {
    // Background colours at the top and the bottom, in sRGB.
    top: vec4f,
    bottom: vec4f,
    // 1: leave the background out and write straight alpha.
    transparent: u32,
    // Tone map: 0 neutral, 1 clip.
    clip: u32,
    // Factor for the light of the volume.
    exposure: f32,
    // First row of this part of the picture, and number of rows of the whole.
    first_row: f32,
    rows: f32,
    // First column of this part of the picture.
    first_column: f32,
    // Step between the output values if the background is dithered; else 0.
    dither_step: f32,
    // Factor for the light of the floor, without the exposure of previews, which compensates for the volume only.
    floor_exposure: f32,
}

@group(0) @binding(0) var<uniform> bound_display: DisplayUniform;
var<private> display: DisplayUniform;
@group(0) @binding(1) var picture: texture_2d<f32>;
// Light of the floor, premultiplied as well.
@group(0) @binding(3) var floor_light: texture_2d<f32>;

// Number of samples along an edge of a pixel.
override SAMPLES: u32 = 1u;

// Start of the shoulder of the neutral tone map.
const SHOULDER = 0.8;

// Neutral tone map: identity up to the shoulder. Above it the largest component approaches 1 with a continuous slope,
// 1 − w²/(peak − 0.8 + w) with w = 0.2, and the others keep their ratio to it.
fn neutral_tone_map(color: vec3f) -> vec3f {
    let peak = max(max(color.r, color.g), color.b);
    let w = 1.0 - SHOULDER;
    let compressed = 1.0 - w * w / (max(peak, SHOULDER) - SHOULDER + w);
    return color * select(1.0, compressed / max(peak, 1e-6), peak > SHOULDER);
}

// Light of the volume, composited over that of the floor, at one sample.
fn sample_light(at: vec2u, has_floor: bool) -> vec4f {
    let volume = textureLoad(picture, at, 0) * vec4f(vec3f(display.exposure), 1.0);
    let below = textureLoad(floor_light, select(vec2u(0u), at, has_floor), 0);
    return volume + (1.0 - volume.a) * below * vec4f(vec3f(display.floor_exposure), 1.0);
}

// Linear, premultiplied light of a pixel: the mean of its samples.
fn pixel_light(pixel: vec2u) -> vec4f {
    // A floor texture of one texel means no floor.
    let has_floor = all(textureDimensions(floor_light) == textureDimensions(picture));
    var light = vec4f(0.0);
    for (var j = 0u; j < SAMPLES; j += 1u) {
        for (var i = 0u; i < SAMPLES; i += 1u) {
            light += sample_light(pixel * SAMPLES + vec2u(i, j), has_floor);
        }
    }
    return light / f32(SAMPLES * SAMPLES);
}

// Ordered dither, in steps: an 8 × 8 pattern (Bayer 1973) over the whole picture, in which each of 64 offsets between
// −½ and ½ appears once. The bits of x xor y and of y, interleaved in reverse.
fn ordered_dither(place: vec2u) -> f32 {
    let a = place.x ^ place.y;
    let b = place.y;
    let bits = ((a & 1u) << 5u) | ((b & 1u) << 4u) | ((a & 2u) << 2u) | ((b & 2u) << 1u) | ((a & 4u) >> 1u) | ((b & 4u) >> 2u);
    return (f32(bits) + 0.5) / 64.0 - 0.5;
}

// Background colour at a pixel, in sRGB.
fn background_at(pixel: vec2u) -> vec3f {
    let place = vec2f(pixel) + vec2f(display.first_column, display.first_row);
    let background = mix(display.top.rgb, display.bottom.rgb, (place.y + 0.5) / display.rows);
    return max(background + ordered_dither(vec2u(place)) * display.dither_step, vec3f(0.0));
}

// Display colours of a pixel, with straight alpha if the background is left out.
fn display_color(pixel: vec2u) -> vec4f {
    let light = pixel_light(pixel);
    let straight = light.rgb / max(light.a, 1e-6);
    let mapped = select(neutral_tone_map(straight), clamp(straight, vec3f(0.0), vec3f(1.0)), display.clip != 0u);
    // Uniforms are not used as branch conditions: Mesa's software driver would compile each shader again for their
    // values, for every dispatch, and keep it.
    let alone = vec4f(srgb_from_linear(select(vec3f(0.0), mapped, light.a > 0.0)), light.a);
    let background = background_at(pixel);
    let mixed = srgb_from_linear(mix(linear_from_srgb(background), mapped, light.a));
    // Exactly the background where the picture is empty, without the round trip through linear light.
    let before_background = vec4f(select(mixed, background, light.a <= 0.0), 1.0);
    return select(before_background, alone, display.transparent != 0u);
}
