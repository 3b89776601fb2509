// What passes of scattered light share: blocks, and what scatters light in them.
#import "common/most_light.wgsl"

struct Bounce {
    // Blocks.
    dims: vec3u,
    // One over the number of directions.
    share: f32,
    // That of light which has one colour all through, whose amount is then the first of three.
    color: vec3f,
    // Blocks of less extinction are left out.
    least: f32,
}

@group(0) @binding(3) var<uniform> bound_bounce: Bounce;
var<private> bounce: Bounce;
// Scattering in rgb, extinction in a: optical depths per shortest edge of a voxel.
@group(0) @binding(4) var<storage, read> scattering: array<vec4f>;

// The place of a block in lists.
fn number_of(id: vec3u) -> u32 {
    return (id.z * bounce.dims.y + id.y) * bounce.dims.x + id.x;
}
