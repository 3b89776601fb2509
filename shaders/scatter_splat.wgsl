// Forward splatting (P §3.5, eq. 9): one thread per voxel adds density × footprint to the sheet of a
// slab. Voxels come from lists; no texture is sampled.
#import "common/footprint.wgsl"
#import "common/listed_bricks.wgsl"

// Bricks of a slab: coordinates of ten bits each, and where the brick's voxels begin.
@group(0) @binding(0) var<storage, read> bricks: array<vec2u>;
// Densities of 8³ voxels per brick, two to a word, as 16-bit normalised numbers.
@group(0) @binding(1) var<storage, read> voxels: array<u32>;
// How many footprints were splatted.
@group(0) @binding(2) var<storage, read_write> splats: atomic<u32>;

fn voxel_density(first: u32, local: vec3u) -> f32 {
    let at = local.x + 8u * (local.y + 8u * local.z);
    let word = voxels[first + at / 2u];
    let pair = unpack2x16unorm(word);
    return select(pair.x, pair.y, at % 2u == 1u);
}

@compute @workgroup_size(8, 8, 4)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let listed = listed_brick(group);
    if (listed >= scatter.count) {
        return;
    }
    let brick = bricks[scatter.first + listed];
    let voxel = voxel_in(brick.x, group, local);
    let density = voxel_density(brick.y, voxel % 8u);
    if (density == 0.0) {
        return;
    }
    let centre = vec3f(voxel);
    let at = locate(centre);
    let depth = depth_of(scatter.frame, f32(scatter.k));
    let slab = 0.5 * scatter.frame.slab;
    if (abs(at.z - depth) >= scatter.half.z + slab) {
        return;
    }
    // The kernel's box, seen from where it is widest and where it is narrowest.
    let spread = scatter.frame.inverse_distance;
    let near = max(1.0 + (at.z - scatter.half.z) * spread, 1e-6);
    let far = max(1.0 + (at.z + scatter.half.z) * spread, 1e-6);
    let low = at.xy - scatter.half.xy;
    let high = at.xy + scatter.half.xy;
    let first = max(ceil(min(low / near, low / far)), vec2f(0.0));
    let last = min(floor(max(high / near, high / far)), vec2f(scatter.frame.size) - 1.0);
    if (any(first > last)) {
        return;
    }
    atomicAdd(&splats, 1u);
    for (var j = first.y; j <= last.y; j += 1.0) {
        for (var i = first.x; i <= last.x; i += 1.0) {
            let pixel = vec2f(i, j);
            let share = i32(round(density * footprint(centre, ray_of(scatter.frame, pixel), depth, false) * UNIT));
            if (share != 0) {
                atomicAdd(&sheets[sheet_index(vec2u(pixel), scatter.k)], share);
            }
        }
    }
}
