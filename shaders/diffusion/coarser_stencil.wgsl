// Conductances of the next coarser level, as means over the merged blocks: of sinks, and of faces, which are fewer and
// lead twice as far.
#import "diffusion/level.wgsl"

@group(0) @binding(1) var<storage, read_write> stencils: array<vec4u>;

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    level = bound_level;
    if (any(id >= level.coarser_dims)) {
        return;
    }
    var sum = Stencil(vec3f(0.0), vec3f(0.0));
    for (var index = 0u; index < 8u; index += 1u) {
        let block = merged_block(id, index);
        if (all(block < level.dims)) {
            let stencil = unpack_stencil(stencils[at_level(block)]);
            // Faces of the second block along an axis are those of the merged one.
            let is_outer = (block & vec3u(1u)) == vec3u(1u);
            sum.faces += select(vec3f(0.0), 0.5 * stencil.faces, is_outer);
            sum.sink += stencil.sink;
        }
    }
    stencils[at_coarser(id)] = pack_stencil(Stencil(sum.faces / 8.0, sum.sink / 8.0));
}
