// Solution of the coarsest level, whose blocks one workgroup holds: relaxed until it is balanced.
#import "diffusion/solution.wgsl"

// Number of relaxations of each half of the blocks; along four blocks each divides the error by two at least.
const RELAXATIONS = 8u;

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(local_invocation_id) id: vec3u) {
    level = bound_level;
    let is_inside = all(id < level.dims);
    let at = at_level(min(id, level.dims - 1u));
    for (var step = 0u; step < 2u * RELAXATIONS; step += 1u) {
        if (is_inside && ((id.x + id.y + id.z + step) & 1u) == 0u) {
            solution[at] = balanced_solution(at, id);
        }
        storageBarrier();
    }
}
