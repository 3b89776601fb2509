// Filling of pyramid levels in listed bricks of 8³ texels. All other texels remain zero.
#import "common/listed_bricks.wgsl"

struct PyramidLevelUniform {
    // Number of bricks listed for this dispatch.
    bricks: u32,
    // Spacing of the level's texels, in voxels.
    spacing: f32,
    pad0: u32,
    pad1: u32,
}

@group(0) @binding(3) var<uniform> bound_resample: PyramidLevelUniform;
var<private> resample: PyramidLevelUniform;
@group(0) @binding(5) var<storage, read> bricks: array<u32>;

// Texel that an invocation fills; out of range for invocations without one.
fn level_texel(group: vec3u, local: vec3u) -> vec3u {
    let listed = listed_brick(group);
    if (listed >= resample.bricks) {
        return vec3u(~0u);
    }
    return voxel_in(bricks[listed], group, local);
}
