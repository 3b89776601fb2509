// Drawing of a finished picture into a render pass of a host program: one triangle over the viewport.
#import "output/srgb.wgsl"

// Set if the target encodes to sRGB on writing.
override LINEAR_TARGET: bool = false;

@group(0) @binding(0) var picture: texture_2d<f32>;

struct Corner {
    @builtin(position) position: vec4f,
    // Position in the picture: 0 … 1 from the upper left.
    @location(0) place: vec2f,
}

@vertex
fn triangle_corner(@builtin(vertex_index) index: u32) -> Corner {
    // Half of a square with twice the viewport's edges.
    let place = 2.0 * vec2f(f32(index & 1u), f32(index >> 1u));
    return Corner(vec4f(2.0 * place.x - 1.0, 1.0 - 2.0 * place.y, 0.0, 1.0), place);
}

// Loaded, not sampled: 32-bit floats are not filterable on all adapters.
@fragment
fn paint_pixel(at: Corner) -> @location(0) vec4f {
    let size = textureDimensions(picture);
    let texel = textureLoad(picture, min(vec2u(at.place * vec2f(size)), size - 1u), 0);
    if (LINEAR_TARGET) {
        return vec4f(linear_from_srgb(texel.rgb), texel.a);
    }
    return texel;
}
