// Declarations shared by the passes of scattered light: blocks and their scattering.
#import "common/most_light.wgsl"

struct BounceUniform {
    // Number of blocks along x, y and z.
    dims: vec3u,
    // One over the number of directions.
    share: f32,
    // Common colour of all light, if there is one; its amount is then stored in the first component.
    color: vec3f,
    // Minimum extinction of the blocks that are processed.
    min_extinction: f32,
}

@group(0) @binding(3) var<uniform> bound_bounce: BounceUniform;
var<private> bounce: BounceUniform;
// Scattering in rgb, extinction in a: optical depths per shortest edge of a voxel.
@group(0) @binding(4) var<storage, read> scattering: array<vec4f>;

// Index of a block in the lists.
fn block_index(id: vec3u) -> u32 {
    return (id.z * bounce.dims.y + id.y) * bounce.dims.x + id.x;
}
