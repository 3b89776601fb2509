// Level 0 of the pyramid: the volume blurred once with [1/12, 10/12, 1/12]³, so that one trilinear
// fetch has the variance of the cubic B-spline (1/6 from the blur, 1/6 from the fetch; 1/3 in all).
//
// [a, 1 − 2a, a] along an axis is the mean of two linear fetches at ± 2a from the voxel.
@group(0) @binding(0) var density_texture: texture_3d<f32>;
@group(0) @binding(1) var clamped: sampler;
@group(0) @binding(2) var level: texture_storage_3d<STORAGE_FORMAT, write>;

// A dispatch fills some slices: a whole level could keep a slow adapter busy for seconds.
struct Slices {
    first: u32,
    end: u32,
    pad0: u32,
    pad1: u32,
}

@group(0) @binding(3) var<uniform> slices: Slices;

const OFFSET = 1.0 / 6.0;

@compute @workgroup_size(8, 4, 4)
fn main(@builtin(global_invocation_id) invocation: vec3u) {
    let id = invocation + vec3u(0u, 0u, slices.first);
    if (any(id >= textureDimensions(level)) || id.z >= slices.end) {
        return;
    }
    // The pyramid has four voxels of padding, the density texture one.
    let centre = vec3f(id) - 4.0 + 1.0 + 0.5;
    let scale = 1.0 / vec3f(textureDimensions(density_texture));
    var sum = 0.0;
    for (var corner = 0u; corner < 8u; corner += 1u) {
        let side = vec3f(f32(corner & 1u), f32(corner >> 1u & 1u), f32(corner >> 2u)) * 2.0 - 1.0;
        sum += textureSampleLevel(density_texture, clamped, (centre + side * OFFSET) * scale, 0.0).r;
    }
    textureStore(level, id, vec4f(sum / 8.0));
}
