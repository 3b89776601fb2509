// Forward splatting (P §3.5, eq. 9): one thread per voxel adds density × footprint to the sheet of a slab. Voxels are
// read from lists; no texture is sampled.
#import "scatter/footprint.wgsl"
#import "common/listed_bricks.wgsl"
#import "volume/material.wgsl"

// Bricks of a slab: packed coordinates of ten bits each, and the word where their voxels begin.
@group(0) @binding(0) var<storage, read> bricks: array<vec2u>;
// Number of footprints splatted.
@group(0) @binding(2) var<storage, read_write> splats: atomic<u32>;

@compute @workgroup_size(8, 8, 4)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    scatter = bound_scatter;
    let listed = listed_brick(group);
    if (listed >= scatter.count) {
        return;
    }
    let brick = bricks[scatter.first + listed];
    let voxel = voxel_in(brick.x, group, local);
    let field = voxel_field(brick.y, voxel % BRICK_EDGE);
    let density = field.density;
    let material = material_of(field);
    let extinction = material.extinction / scatter.extinction_unit;
    // Bricks may extend beyond the grid, where there are no voxels.
    if (any(vec3f(voxel) >= scatter.dims) || (density == 0.0 && (SPLAT == SPLAT_DENSITY || extinction == 0.0))) {
        return;
    }
    let centre = vec3f(voxel);
    let seen = project_to_sheets(centre);
    let depth = depth_of(scatter.frame, f32(scatter.k));
    if (ORDER == ORDER_IMAGE_ALIGNED) {
        if (abs(seen.z - depth) >= scatter.half_extents.z + 0.5 * scatter.frame.slab) {
            return;
        }
    } else if (dot(scatter.axis, centre) != slice_of(f32(scatter.k))) {
        return;
    }
    let box = pixels_under(seen);
    if (any(box.first > box.last)) {
        return;
    }
    atomicAdd(&splats, 1u);
    let value = select(density, extinction, SPLAT == SPLAT_EXTINCTION);
    for (var j = box.first.y; j <= box.last.y; j += 1.0) {
        for (var i = box.first.x; i <= box.last.x; i += 1.0) {
            let pixel = vec2f(i, j);
            let ray = ray_of(scatter.frame, pixel);
            var weight: f32;
            if (ORDER == ORDER_IMAGE_ALIGNED) {
                weight = footprint(centre, ray, depth, false);
            } else {
                weight = whole_footprint(centre, ray, stretch_of(seen.z)) / crossing_of(ray, 0.0).thickness;
            }
            let at = sheet_index(vec2u(pixel), scatter.k);
            let share = i32(round(value * weight * FIXED_POINT_ONE));
            if (share != 0) {
                atomicAdd(&sheets[at], share);
            }
            if (SPLAT == SPLAT_MATERIAL && extinction * weight > 0.0) {
                let sums = vec4i(round(vec4f(material.color, 1.0) * (extinction * weight * FIXED_POINT_ONE)));
                atomicAdd(&sheets[channel_index(at, 1u)], sums.r);
                atomicAdd(&sheets[channel_index(at, 2u)], sums.g);
                atomicAdd(&sheets[channel_index(at, 3u)], sums.b);
                atomicAdd(&sheets[channel_index(at, 4u)], sums.a);
            }
        }
    }
}
