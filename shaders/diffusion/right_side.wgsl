// Right side of the diffusion equation: what blocks scatter of the light that the last sweep changed; before the first
// sweep all that they scatter or emit. Every other block is balanced with it at once.
#import "diffusion/solution.wgsl"

@group(0) @binding(4) var<storage, read> scattering: array<vec4f>;
@group(0) @binding(5) var<storage, read> received: array<vec4f>;
@group(0) @binding(6) var<storage, read> first: array<vec4f>;
@group(0) @binding(7) var<storage, read> last: array<vec4f>;

// Set after the first sweep.
override HAS_BOUNCED: bool = true;

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    level = bound_level;
    if (any(id >= level.dims)) {
        return;
    }
    let at = at_level(id);
    let found = scattering[at];
    var side = vec3f(0.0);
    if (found.a > 0.0) {
        if (HAS_BOUNCED) {
            side = found.rgb * (received[at].rgb - last[at].rgb);
        } else {
            side = first[at].rgb;
        }
    }
    right_sides[at] = vec4f(side, 0.0);
    solution[at] = first_solution(at, id);
}
