// The next level of the pyramid, at half the resolution.
//
// A level must have the B-spline's variance at its own scale: 4^l/3 in voxels², of which the
// trilinear fetch brings 4^l/6. From 4^l/6 to 4^(l+1)/6 lacks 4^l/2, half a texel² of level l: the
// kernel [1, 7, 7, 1]/16 has just that, and is the mean of two linear fetches at ± 0.625 texel.
@group(0) @binding(0) var finer: texture_3d<f32>;
@group(0) @binding(1) var clamped: sampler;
@group(0) @binding(2) var coarser: texture_storage_3d<STORAGE_FORMAT, write>;

// A dispatch fills some slices: a whole level could keep a slow adapter busy for seconds.
struct Slices {
    first: u32,
    end: u32,
    pad0: u32,
    pad1: u32,
}

@group(0) @binding(3) var<uniform> slices: Slices;

const OFFSET = 0.625;

@compute @workgroup_size(8, 4, 4)
fn main(@builtin(global_invocation_id) invocation: vec3u) {
    let id = invocation + vec3u(0u, 0u, slices.first);
    if (any(id >= textureDimensions(coarser)) || id.z >= slices.end) {
        return;
    }
    let centre = vec3f(id) * 2.0 + 1.0;
    let scale = 1.0 / vec3f(textureDimensions(finer));
    var sum = 0.0;
    for (var corner = 0u; corner < 8u; corner += 1u) {
        let side = vec3f(f32(corner & 1u), f32(corner >> 1u & 1u), f32(corner >> 2u)) * 2.0 - 1.0;
        sum += textureSampleLevel(finer, clamped, (centre + side * OFFSET) * scale, 0.0).r;
    }
    textureStore(coarser, id, vec4f(sum / 8.0));
}
