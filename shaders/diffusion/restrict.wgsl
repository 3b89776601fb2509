// Right side of the next coarser level: the mean residual of the merged blocks. Those with an odd sum of coordinates
// have been balanced last, and have none. Every other block of the coarser level is balanced with it at once.
#import "diffusion/solution.wgsl"

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    level = bound_level;
    if (any(id >= level.coarser_dims)) {
        return;
    }
    var sum = vec3f(0.0);
    for (var index = 0u; index < 8u; index += 1u) {
        let block = merged_block(id, index);
        if (all(block < level.dims) && ((block.x + block.y + block.z) & 1u) == 0u) {
            let at = at_level(block);
            let balance = balance_of(at, block);
            sum += right_sides[at].rgb + balance.inflow - balance.conductance * solution[at].rgb;
        }
    }
    let at = at_coarser(id);
    right_sides[at] = vec4f(sum / 8.0, 0.0);
    level.dims = level.coarser_dims;
    level.first = level.coarser_first;
    solution[at] = first_solution(at, id);
}
