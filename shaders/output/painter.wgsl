// Painter of pictures and fills into render passes of the window or of a host program, as one triangle over the
// viewport.
//
// The window does not leave this to egui's shader, which filters textures in two ways, for the pictures of tests, too,
// and chooses between them for every pixel. Software drivers execute both: 900 cycles for each pixel of the window.
#import "common/srgb.wgsl"

// Set if the target encodes to sRGB on writing.
override LINEAR_TARGET: bool = false;

@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var picture_sampler: sampler;

// Encoded shift of pictures that are not shifted (crates/render/src/output/window_painter.rs).
const UNSHIFTED = 32768;

struct Corner {
    @builtin(position) position: vec4f,
    // Position in the picture: 0 … 1 from the upper left.
    @location(0) place: vec2f,
    // Instance index, which carries parameters that would otherwise need a buffer.
    @location(1) @interpolate(flat) number: u32,
}

@vertex
fn triangle_corner(@builtin(vertex_index) index: u32, @builtin(instance_index) number: u32) -> Corner {
    // Half of a square with twice the viewport's edges.
    let place = 2.0 * vec2f(f32(index & 1u), f32(index >> 1u));
    return Corner(vec4f(2.0 * place.x - 1.0, 1.0 - 2.0 * place.y, 0.0, 1.0), place, number);
}

fn for_target(srgb: vec3f) -> vec3f {
    if (LINEAR_TARGET) {
        return linear_from_srgb(srgb);
    }
    return srgb;
}

// Picture of opaque pixels, filtered and drawn with a uniform opacity. The low byte of the number is the opacity in
// 255ths; the bits above are the shift to the right in pixels, offset by 32768.
@fragment
fn draw_picture(at: Corner) -> @location(0) vec4f {
    let opacity = f32(at.number & 255u) / 255.0;
    let moved = f32(i32(at.number >> 8u) - UNSHIFTED) / f32(textureDimensions(picture).x);
    let place = at.place - vec2f(moved, 0.0);
    return vec4f(for_target(textureSampleLevel(picture, picture_sampler, place, 0.0).rgb) * opacity, opacity);
}

// Nearest texel of a picture with its own alpha. Loaded, not sampled: 32-bit floats are not filterable on all adapters.
@fragment
fn draw_texel(at: Corner) -> @location(0) vec4f {
    let size = textureDimensions(picture);
    let texel = textureLoad(picture, min(vec2u(at.place * vec2f(size)), size - 1u), 0);
    return vec4f(for_target(texel.rgb), texel.a);
}

// Uniform colour; the number is 0xBBGGRR.
@fragment
fn draw_fill(at: Corner) -> @location(0) vec4f {
    return vec4f(for_target(unpack4x8unorm(at.number).rgb), 1.0);
}
