// Gathering of swept light at listed blocks: the sum over the directions of a batch, interpolated between the rays
// around each block's centre and added to the sums of earlier batches.
#import "sky/rays.wgsl"
#import "scattered_light/bounce.wgsl"
#import "common/listed_cells.wgsl"

@group(0) @binding(1) var sheets: texture_3d<f32>;
@group(0) @binding(2) var clamped: sampler;
@group(0) @binding(5) var<storage, read_write> sums: array<vec4f>;
@group(0) @binding(6) var<storage, read> cells: array<u32>;

// Number of directions in a batch. A constant rather than a uniform, because drivers unroll loops with a known end.
override DIRECTIONS: u32 = 4u;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    sweep = bound_sweep;
    bounce = bound_bounce;
    let id = voxel_of_listed_cell(group, lane);
    if (any(id >= sweep.dims)) {
        return;
    }
    let at = block_index(id);
    if (scattering[at].a < bounce.min_extinction) {
        return;
    }
    var sum = sums[at].rgb * sweep.has_sums;
    for (var i = 0u; i < DIRECTIONS; i += 1u) {
        let rays = bound_sweep.rays[i];
        let place = place_in_sheets(rays, vec3f(id));
        sum += rays.weight * textureSampleLevel(sheets, clamped, place, 0.0).rgb;
    }
    sums[at] = vec4f(sum, 0.0);
}
