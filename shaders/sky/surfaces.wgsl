// Surfaces near listed blocks, found in the extinction of blocks: the direction in which opacity falls, and the
// distance at which extinction falls through half of its maximum.
#import "sky/surface_block.wgsl"
#import "common/listed_cells.wgsl"

@group(0) @binding(1) var extinction: texture_3d<f32>;
@group(0) @binding(2) var clamped: sampler;
@group(0) @binding(5) var<storage, read> cells: array<u32>;
// Packed surface of each listed block.
@group(0) @binding(6) var<storage, read_write> surfaces: array<vec4u>;

// Number of places along the normal, half a block apart, and that of the block's centre: surfaces look up blocks of
// which they are up to 1 ¾ blocks in front and ¼ behind, and more where pixels blur the volume.
const PLACES = 9;
const CENTRE = 5;

// Range of optical depths per shortest edge of a voxel over which fog turns into material with a surface: opacities
// of 0.4 … 0.8 per voxel. Light enters less deeply than two voxels then.
const FOG_DEPTH = 0.5;
const SURFACE_DEPTH = 1.5;

// Optical depth per shortest edge of a voxel, at a position in blocks.
fn depth_at(b: vec3f) -> f32 {
    return textureSampleLevel(extinction, clamped, (b + 1.5) * geometry.block_scale, 0.0).r;
}

fn opacity_at(b: vec3f) -> f32 {
    return 1.0 - exp(-depth_at(b));
}

// Vector towards falling opacity; its length is arbitrary.
fn falling_opacity(b: vec3f) -> vec3f {
    var sum = vec3f(0.0);
    for (var i = 0u; i < 8u; i += 1u) {
        let corner = vec3f(f32(i & 1u), f32(i >> 1u & 1u), f32(i >> 2u)) - 0.5;
        sum -= corner * opacity_at(b + corner);
    }
    for (var i = 0u; i < 6u; i += 1u) {
        let axis = select(vec3f(0.0), vec3f(1.0), vec3u(i >> 1u) == vec3u(0u, 1u, 2u));
        let side = axis * (f32(i & 1u) * 2.0 - 1.0);
        sum -= side * opacity_at(b + 1.5 * side);
    }
    return sum;
}

// Surface nearest to a block; its share is 0 if there is none.
fn nearest_surface(b: vec3f) -> BlockSurface {
    let falling = falling_opacity(b);
    let normal = falling * (1.0 / max(length(falling), 1e-6));
    var depths: array<f32, PLACES>;
    var most = 0.0;
    for (var k = 0; k < PLACES; k += 1) {
        depths[k] = depth_at(b + normal * (0.5 * f32(k - CENTRE)));
        most = max(most, depths[k]);
    }
    // Position of the surface along the normal; far beyond all places if there is none.
    var nearest = 1e3;
    for (var k = 0; k + 1 < PLACES; k += 1) {
        let inner = depths[k] - 0.5 * most;
        let outer = depths[k + 1] - 0.5 * most;
        let position = 0.5 * (f32(k - CENTRE) + inner / max(inner - outer, 1e-6));
        let is_nearer = inner >= 0.0 && outer < 0.0 && abs(position) < abs(nearest);
        nearest = select(nearest, position, is_nearer);
    }
    // Faint normals count less, and so do surfaces near the ends of the places, beyond which there are none.
    let ends = 0.5 * vec2f(f32(CENTRE), f32(PLACES - 1 - CENTRE));
    let is_near = saturate(2.0 * min(ends.x + nearest, ends.y - nearest));
    let share = smoothstep(FOG_DEPTH, SURFACE_DEPTH, most) * is_near * saturate(20.0 * length(falling));
    return BlockSurface(normal, -nearest, share);
}

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    geometry = bound_geometry;
    let id = voxel_of_listed_cell(group, lane);
    if (any(id >= geometry.dims)) {
        return;
    }
    var surface = BlockSurface(vec3f(0.0, 0.0, 1.0), 0.0, 0.0);
    let nearest = nearest_surface(vec3f(id));
    // Not a branch on the uniform alone, which software drivers compile anew for each dispatch.
    if (nearest.share * f32(geometry.has_surfaces) > 0.0) {
        surface = nearest;
    }
    surfaces[listed_voxel(listed_cell(group, lane), lane)] = pack_surface(surface);
}
