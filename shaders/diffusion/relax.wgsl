// Relaxation of every other block: those whose coordinates have an even sum, or an odd one, so that no block depends on
// another of the same dispatch.
#import "diffusion/solution.wgsl"

// Parity of the sum of the blocks' coordinates.
override PARITY: u32 = 0u;

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) thread: vec3u) {
    level = bound_level;
    let id = vec3u(2u * thread.x + ((thread.y + thread.z + PARITY) & 1u), thread.yz);
    if (any(id >= level.dims)) {
        return;
    }
    let at = at_level(id);
    solution[at] = balanced_solution(at, id);
}
