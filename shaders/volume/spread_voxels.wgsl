// Spreading of voxels whose material is known, for level 0 of a pyramid: blurred like densities (volume/prefilter.wgsl).
// With crisp edges a wider blur takes its place where its opacity is higher, which is outside of flat and of convex
// shapes: the table makes their edges steep there (crates/scene/src/transfer/crisp_ramp.rs), and the steps of voxels
// would show. Thin structures keep the narrow blur.
//
// A workgroup classifies its 8 × 8 × 4 texels and those around them, each once. The importing shader provides the
// material of a voxel at any place, as voxel_material().
#option CRISP: edges of labels become steep
#import "volume/levels.wgsl"

@group(0) @binding(2) var level: texture_storage_3d<rgba16float, write>;

const WIDTH = 10u;
const DEPTH = 6u;
const COUNT = 600u;
// Number of invocations in a workgroup.
const INVOCATIONS = 256u;

var<workgroup> materials: array<vec4f, COUNT>;

// Material of the texel of an invocation, spread from the voxels around it.
fn spread_material(group: vec3u, local: vec3u, index: u32) -> vec4f {
    let listed = min(listed_brick(group), resample.bricks - 1u);
    // The pyramid begins four voxels before the grid, and the blur one texel before those that are filled.
    let first = vec3i(voxel_in(bricks[listed], group, vec3u(0u))) - 5;
    for (var turn = 0u; turn < COUNT; turn += INVOCATIONS) {
        let at = min(turn + index, COUNT - 1u);
        materials[at] = voxel_material(first + vec3i(vec3u(at % WIDTH, at / WIDTH % WIDTH, at / (WIDTH * WIDTH))));
    }
    workgroupBarrier();
    var sum = vec4f(0.0);
#if CRISP
    var wide = vec4f(0.0);
#endif
    for (var z = 0u; z < 3u; z += 1u) {
        for (var y = 0u; y < 3u; y += 1u) {
            for (var x = 0u; x < 3u; x += 1u) {
                let side = vec3u(x, y, z);
                // [1, 10, 1] / 12 along each axis.
                let weights = select(vec3f(1.0 / 12.0), vec3f(5.0 / 6.0), side == vec3u(1u));
                let at = local + side;
                let material = materials[at.x + WIDTH * (at.y + WIDTH * at.z)];
                sum += weights.x * weights.y * weights.z * material;
#if CRISP
                // [1, 2, 1] / 4 along each axis.
                let wide_weights = select(vec3f(0.25), vec3f(0.5), side == vec3u(1u));
                wide += wide_weights.x * wide_weights.y * wide_weights.z * material;
#endif
            }
        }
    }
#if CRISP
    sum = select(sum, wide, wide.r > sum.r);
#endif
    return sum;
}
