// Moments of sky visibility at listed blocks: mean transmittance over directions, V₀, and mean of transmittance times
// direction, V₁, gathered from the rays of a batch around each block's centre and added to the sums of earlier
// batches.
#import "sky/rays.wgsl"
#import "common/listed_cells.wgsl"

@group(0) @binding(1) var sheets: texture_3d<f32>;
@group(0) @binding(2) var clamped: sampler;
// Sums of the moments, one for each listed block.
@group(0) @binding(3) var<storage, read_write> sums: array<vec4f>;
// V₁ in rgb, V₀ in a.
@group(0) @binding(4) var moments: texture_storage_3d<rgba16float, write>;
@group(0) @binding(5) var<storage, read> cells: array<u32>;

// Number of directions in a batch. A constant rather than a uniform, because drivers unroll loops with a known end.
override DIRECTIONS: u32 = 4u;
// Set for the last batch, which stores the mean.
override IS_LAST: bool = true;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    sweep = bound_sweep;
    let id = voxel_of_listed_cell(group, lane);
    if (any(id >= sweep.dims)) {
        return;
    }
    let at = listed_voxel(listed_cell(group, lane), lane);
    var sum = sums[at] * sweep.has_sums;
    for (var i = 0u; i < DIRECTIONS; i += 1u) {
        let rays = bound_sweep.rays[i];
        let place = place_in_sheets(rays, vec3f(id));
        let passed = textureSampleLevel(sheets, clamped, place, 0.0).r;
        sum += rays.weight * passed * vec4f(rays.direction_to_light, 1.0);
    }
    if (IS_LAST) {
        textureStore(moments, id, sum * sweep.share);
    } else {
        sums[at] = sum;
    }
}
