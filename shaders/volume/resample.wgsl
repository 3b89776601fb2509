// What the levels of the pyramid are made with: eight linear fetches around a texel, in listed bricks of 8³
// texels. Elsewhere is nothing, as textures begin.
#import "common/listed_bricks.wgsl"

struct Resample {
    // Bricks listed for this dispatch.
    bricks: u32,
    // Of the level's texels, in voxels.
    spacing: f32,
    pad0: u32,
    pad1: u32,
}

@group(0) @binding(0) var source: texture_3d<f32>;
@group(0) @binding(1) var clamped: sampler;
@group(0) @binding(2) var level: texture_storage_3d<STORAGE_FORMAT, write>;
@group(0) @binding(3) var<uniform> bound_resample: Resample;
var<private> resample: Resample;
@group(0) @binding(5) var<storage, read> bricks: array<u32>;

// The texel that an invocation fills; beyond every level if there is none.
fn texel_of(group: vec3u, local: vec3u) -> vec3u {
    let listed = listed_brick(group);
    if (listed >= resample.bricks) {
        return vec3u(~0u);
    }
    return voxel_in(bricks[listed], group, local);
}

// The mean of the fetches at the corners of a cube of half width `offset`, in texels of the source:
// a product of the kernels that the shaders derive.
fn mean_around(centre: vec3f, offset: f32) -> f32 {
    let scale = 1.0 / vec3f(textureDimensions(source));
    var sum = 0.0;
    for (var corner = 0u; corner < 8u; corner += 1u) {
        let side = vec3f(f32(corner & 1u), f32(corner >> 1u & 1u), f32(corner >> 2u)) * 2.0 - 1.0;
        sum += textureSampleLevel(source, clamped, (centre + side * offset) * scale, 0.0).r;
    }
    return sum / 8.0;
}
