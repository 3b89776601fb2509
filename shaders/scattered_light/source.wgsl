// Emission of blocks for the next bounce: scattered direct light, and scattered light of the last bounce. Stores the
// increase over the bounce before. Every other time the limit of the series is extrapolated from the last two bounces
// (scattered_light/ratio.wgsl), and bouncing continues from there, which converges in fewer bounces.
#import "scattered_light/bounce.wgsl"
#import "scattered_light/medium.wgsl"

@group(0) @binding(5) var<storage, read> sums: array<vec4f>;
@group(0) @binding(6) var<storage, read> first: array<vec4f>;
// Light of the previous bounce, and its increase over the one before that.
@group(0) @binding(7) var<storage, read_write> last: array<vec4f>;
@group(0) @binding(8) var<storage, read_write> change: array<vec4f>;
@group(0) @binding(9) var medium: texture_storage_3d<TARGET_FORMAT, write>;

@group(0) @binding(10) var<storage, read> ratio: array<vec4f>;

// Set from the first bounce on.
override HAS_BOUNCED: bool = true;
// Set if the series is extrapolated.
override EXTRAPOLATES: bool = false;

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
        let before = last[at].rgb;
        let brought = sums[at].rgb * bounce.share - before;
        light = before + brought;
        if (EXTRAPOLATES) {
            light = max(before + brought / (1.0 - ratio[0].rgb), vec3f(0.0));
        }
        change[at] = vec4f(brought, 0.0);
    } else {
        change[at] = vec4f(0.0);
    }
    last[at] = vec4f(light, 0.0);
    if (found.a > 0.0) {
        let given = min(first[at].rgb + found.rgb * light, vec3f(MAX_HALF_FLOAT));
        textureStore(medium, id + 1u, medium_texel(given, found.a));
    }
}
