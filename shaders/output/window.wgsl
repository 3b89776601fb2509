// The window's picture and what lies under its panels: one triangle over the viewport.
//
// egui's own shader filters textures in two ways, for pictures of tests too, and chooses between them for every
// pixel. Software drivers do both: 900 cycles for each pixel of the window.
#import "output/srgb.wgsl"

// The target converts to sRGB when it is written to.
override LINEAR_TARGET: bool = false;

@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var picture_sampler: sampler;

// What stands for pictures that are not moved (src/gpu/output/window.rs).
const MOVED_BY_NOTHING = 32768;

struct Corner {
    @builtin(position) position: vec4f,
    // In the picture: 0 … 1 from the upper left.
    @location(0) place: vec2f,
    // The draw's number, which carries what would otherwise need a buffer.
    @location(1) @interpolate(flat) number: u32,
}

@vertex
fn corner(@builtin(vertex_index) index: u32, @builtin(instance_index) number: u32) -> Corner {
    // Half of a square of twice the viewport's edges.
    let place = 2.0 * vec2f(f32(index & 1u), f32(index >> 1u));
    return Corner(vec4f(2.0 * place.x - 1.0, 1.0 - 2.0 * place.y, 0.0, 1.0), place, number);
}

fn for_target(srgb: vec3f) -> vec3f {
    if (LINEAR_TARGET) {
        return linear_from_srgb(srgb);
    }
    return srgb;
}

// An opaque picture. The low byte of its number is its opacity in 255ths; above, half of the number of pixels that it
// could have, plus those by which it is moved to the right.
@fragment
fn shown(at: Corner) -> @location(0) vec4f {
    let opacity = f32(at.number & 255u) / 255.0;
    let moved = f32(i32(at.number >> 8u) - MOVED_BY_NOTHING) / f32(textureDimensions(picture).x);
    let place = at.place - vec2f(moved, 0.0);
    return vec4f(for_target(textureSampleLevel(picture, picture_sampler, place, 0.0).rgb) * opacity, opacity);
}

// One colour; its number is 0xBBGGRR.
@fragment
fn filled(at: Corner) -> @location(0) vec4f {
    return vec4f(for_target(unpack4x8unorm(at.number).rgb), 1.0);
}
