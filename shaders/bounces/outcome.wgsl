// The light that blocks receive that has been scattered, after infinitely many bounces: what the last but one had brought,
// and the geometric series of which the last is the first term.
#import "bounces/bounce.wgsl"

@group(0) @binding(5) var<storage, read> sums: array<vec4f>;
@group(0) @binding(7) var<storage, read> last: array<vec4f>;
@group(0) @binding(9) var<storage, read> ratio: array<vec4f>;
@group(0) @binding(10) var bounced: texture_storage_3d<rgba16float, write>;

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    bounce = bound_bounce;
    if (any(id >= bounce.dims)) {
        return;
    }
    let at = number_of(id);
    let before = last[at].rgb;
    let brought = sums[at].rgb * bounce.share - before;
    textureStore(bounced, id, vec4f(max(before + brought / (1.0 - ratio[0].rgb), vec3f(0.0)), 1.0));
}
