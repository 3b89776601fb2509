// Edges of a picture: one thread per pixel looks whether light changes more sharply there than pixels show, and lists
// such pixels, through which the eye pass then casts several rays. Elsewhere the ray through the middle is kept: it
// is nearly the mean where light is smooth across a few pixels.
#import "common/sizes.wgsl"
#import "sheets/tiles.wgsl"

struct EdgesUniform {
    // Pixels per row and column.
    size: vec2u,
    // Range of rows of this dispatch; the end is exclusive.
    first_row: u32,
    end_row: u32,
    // Contrast of the faintest edge that counts, as a share of the light.
    min_contrast: f32,
    pad0: u32,
    pad1: u32,
    pad2: u32,
}

@group(0) @binding(0) var<uniform> bound_edges: EdgesUniform;
var<private> edges: EdgesUniform;
// Light of the rays through the middles of pixels.
@group(0) @binding(1) var middles: texture_2d<f32>;
@group(0) @binding(2) var picture: texture_storage_2d<rgba32float, write>;
// Workgroups that cover the listed pixels (three numbers), the number of these, and each with its column in the low
// half and its row in the high half. Pixels are listed in any order, which does not change the picture.
@group(0) @binding(3) var<storage, read_write> edge_list: array<atomic<u32>>;

// Contrast that counts in darkness, where a grey step is 1/(255 · 12.92) = 3e-4: three steps of what is seen through
// the volume, and of its light with an exposure of up to 4. Ten times what rays leave that end early.
const MIN_DARK_CONTRAST = vec4f(2.5e-4, 2.5e-4, 2.5e-4, 1e-3);

// Light at a pixel, with the transmittance in place of alpha; the picture continues evenly beyond its border.
fn light_at(pixel: vec2i) -> vec4f {
    let light = textureLoad(middles, clamp(pixel, vec2i(0), vec2i(edges.size) - 1), 0);
    return vec4f(light.rgb, 1.0 - light.a);
}

// Whether an edge may cross a pixel or its border, by light in a row or column of five pixels around it. A step of
// contrast k makes the second difference k in the pixels on both sides, and the fourth 3 k; where light is smooth
// over some pixels the fourth is much smaller than the second, and the mean over a pixel is off by a 24th of that.
fn is_edge(pixel: vec2i, step: vec2i) -> bool {
    let before = light_at(pixel - step);
    let middle = light_at(pixel);
    let behind = light_at(pixel + step);
    let bend = abs(before - 2.0 * middle + behind);
    let sharpness = abs(light_at(pixel - 2 * step) - 4.0 * (before + behind) + 6.0 * middle + light_at(pixel + 2 * step));
    let contrast = max(edges.min_contrast * max(max(before, behind), middle), MIN_DARK_CONTRAST);
    return any(min(bend, sharpness / 3.0) > contrast);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    edges = bound_edges;
    let pixel = group.xy * TILE_EDGE + in_tile(local.xy) + vec2u(0u, edges.first_row);
    if (pixel.x >= edges.size.x || pixel.y >= edges.end_row) {
        return;
    }
    let at = vec2i(pixel);
    if (is_edge(at, vec2i(1, 0)) || is_edge(at, vec2i(0, 1))) {
        let entry = atomicAdd(&edge_list[3], 1u);
        atomicStore(&edge_list[entry + 4u], pixel.x | (pixel.y << 16u));
        atomicMax(&edge_list[0], 1u);
        atomicMax(&edge_list[1], entry / (TILE_EDGE * TILE_EDGE) + 1u);
        atomicMax(&edge_list[2], 1u);
    } else {
        textureStore(picture, pixel, textureLoad(middles, pixel, 0));
    }
}
