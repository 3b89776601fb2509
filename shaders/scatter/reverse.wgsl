// Reverse splatting (P §3.5, eq. 10): one thread per pixel of a sheet adds its deposit to the voxels under its
// footprint, and the footprint to their weights.
#import "scatter/footprint.wgsl"

// Distances in bricks: r to the nearest whose sheets are read.
@group(0) @binding(0) var distances: texture_3d<u32>;
// Ring with four slabs per texel.
@group(0) @binding(1) var ring: texture_2d_array<f32>;
// Σ D·h, and the weight volume Σ h, in units of 2⁻²⁴.
@group(0) @binding(2) var<storage, read_write> light: array<atomic<i32>>;
@group(0) @binding(3) var<storage, read_write> weights: array<atomic<i32>>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    scatter = bound_scatter;
    if (any(id.xy >= scatter.frame.size)) {
        return;
    }
    let depth = depth_of(scatter.frame, f32(scatter.k));
    let ray = ray_of(scatter.frame, vec2f(id.xy));
    let p = ray.origin + ray.direction * depth;
    // Pixels may miss the grid by up to the kernel's width.
    let brick = nearest_brick(p);
    if (textureLoad(distances, brick, 0).r > 0u) {
        return;
    }
    let deposit = textureLoad(ring, id.xy, (scatter.k / 4u) % textureNumLayers(ring), 0)[scatter.k % 4u];
    // Voxels whose kernel, stretched and extended by the slab, can reach the ray.
    let reach = scatter.stretch * kernel_extents(normalize(ray.direction))
        + 0.5 * scatter.frame.slab * abs(ray.direction);
    let low = (p - reach + 0.5) / scatter.voxel_step - 0.5;
    let high = (p + reach + 0.5) / scatter.voxel_step - 0.5;
    let first = max(vec3i(ceil(low)), vec3i(0));
    let last = min(vec3i(floor(high)), vec3i(scatter.light_dims) - 1);
    for (var z = first.z; z <= last.z; z += 1) {
        for (var y = first.y; y <= last.y; y += 1) {
            for (var x = first.x; x <= last.x; x += 1) {
                let voxel = vec3i(x, y, z);
                let centre = (vec3f(voxel) + 0.5) * scatter.voxel_step - 0.5;
                let weight = footprint(centre, ray, depth, true) * scatter.pixel_share;
                let share = i32(round(weight * FIXED_POINT_ONE));
                if (share != 0) {
                    let at = x + i32(scatter.light_dims.x) * (y + i32(scatter.light_dims.y) * z);
                    atomicAdd(&weights[at], share);
                    atomicAdd(&light[at], i32(round(weight * deposit * FIXED_POINT_ONE)));
                }
            }
        }
    }
}

// Half the kernel's extents along the axes of the grid: a cylinder along the ray, of radius two and half length two,
// or a cube.
fn kernel_extents(along: vec3f) -> vec3f {
    let cylinder = 2.0 * (abs(along) + sqrt(max(1.0 - along * along, vec3f(0.0))));
    return select(vec3f(2.0), cylinder, KERNEL == KERNEL_GAUSSIAN);
}
