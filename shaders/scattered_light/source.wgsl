// Emission of blocks for the next bounce: scattered direct light, and scattered light of all bounces so far and to
// come, as far as it is known. Before the first sweep that is what diffusion says, and after each the last sweep's
// light, corrected by what diffusion makes of its change.
#import "scattered_light/bounce.wgsl"
#import "scattered_light/medium.wgsl"
#import "scattered_light/series.wgsl"

@group(0) @binding(6) var<storage, read> first: array<vec4f>;
@group(0) @binding(9) var medium: texture_storage_3d<TARGET_FORMAT, write>;
@group(0) @binding(10) var<storage, read> mixing: array<vec4f>;
// Light that the step before reached, unmixed.
@group(0) @binding(12) var<storage, read_write> reached_before: array<vec4f>;

// Set from the first sweep on.
override HAS_BOUNCED: bool = true;
// Set if there is a step before to mix with.
override MIXES: bool = false;

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    bounce = bound_bounce;
    if (any(id >= bounce.dims)) {
        return;
    }
    let at = block_index(id);
    let found = scattering[at];
    if (found.a < bounce.min_extinction) {
        return;
    }
    var light = vec3f(0.0);
    if (HAS_BOUNCED) {
        let step = series_step(at);
        let reached = last[at].rgb + step;
        light = reached;
        if (MIXES) {
            light -= mixing[0].rgb * (reached - reached_before[at].rgb);
        }
        step_before[at] = vec4f(step, 0.0);
        reached_before[at] = vec4f(reached, 0.0);
    } else if (DIFFUSES) {
        light = solution[at].rgb;
    }
    light = max(light, vec3f(0.0));
    last[at] = vec4f(light, 0.0);
    if (found.a > 0.0) {
        let given = min(first[at].rgb + found.rgb * light, vec3f(MAX_HALF_FLOAT));
        textureStore(medium, id + 1u, medium_texel(given, found.a));
    }
}
