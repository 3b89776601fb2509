// Surfaces near listed blocks, found in the extinction of blocks: the direction in which opacity falls, and the
// distance at which extinction falls through half of its maximum.
#import "sky/surface_block.wgsl"
#import "common/listed_cells.wgsl"

@group(0) @binding(1) var extinction: texture_3d<f32>;
@group(0) @binding(2) var clamped: sampler;
@group(0) @binding(5) var<storage, read> cells: array<u32>;
// Maximum number of directions of a sky.
const MAX_SKY_DIRECTIONS = 96;

struct SkyDirectionsUniform {
    // Unit vectors towards the sky in scene space, along which light is followed.
    directions: array<vec4f, MAX_SKY_DIRECTIONS>,
}

@group(0) @binding(8) var<uniform> bound_directions: SkyDirectionsUniform;

// Packed surface of each listed block.
@group(0) @binding(6) var<storage, read_write> surfaces: array<vec4u>;

// Number of places along the normal, half a block apart, and that of the block's centre: surfaces look up blocks of
// which they are up to 1 ¾ blocks in front and ¼ behind, and more where pixels blur the volume.
const PLACES = 9;
const CENTRE = 5;

// Opacity of a shortest edge of a voxel that a block has all around if it is so deep in material that no light reaches
// it, through 1.5 blocks.
const BURIED_OPACITY = 0.9;

// Optical depth per shortest edge of a voxel, at a position in blocks.
fn depth_at(b: vec3f) -> f32 {
    return textureSampleLevel(extinction, clamped, (b + 1.5) * geometry.block_scale, 0.0).r;
}

fn opacity_at(b: vec3f) -> f32 {
    return 1.0 - exp(-depth_at(b));
}

// Opacity around a block, at the corners half a block away and on the axes 1.5 blocks away.
struct OpacityAround {
    // Vector towards falling opacity; its length is arbitrary.
    falling: vec3f,
    least: f32,
}

fn opacity_around(b: vec3f) -> OpacityAround {
    var sum = vec3f(0.0);
    var least = 1.0;
    for (var i = 0u; i < 8u; i += 1u) {
        let corner = vec3f(f32(i & 1u), f32(i >> 1u & 1u), f32(i >> 2u)) - 0.5;
        let opacity = opacity_at(b + corner);
        sum -= corner * opacity;
        least = min(least, opacity);
    }
    for (var i = 0u; i < 6u; i += 1u) {
        let axis = select(vec3f(0.0), vec3f(1.0), vec3u(i >> 1u) == vec3u(0u, 1u, 2u));
        let side = axis * (f32(i & 1u) * 2.0 - 1.0);
        let opacity = opacity_at(b + 1.5 * side);
        sum -= side * opacity;
        least = min(least, opacity);
    }
    return OpacityAround(sum, least);
}

// V₀ and the light of an open surface under a white sky as the mean over all directions has them: 12 ⟨c (1 − c)⟩ and
// 4 ⟨c⟩ with the cosine c = max(n·ω, 0), both nearly 1.
fn open_light(normal: vec3f) -> vec2f {
    var sum = vec2f(0.0);
    // Never true for a unit vector: software drivers compile loops whose length is a uniform alone for each dispatch
    // anew, and never free them.
    let count = select(geometry.directions, 0u, normal.x > 2.0);
    for (var i = 0u; i < count; i += 1u) {
        let cosine = max(dot(normal, bound_directions.directions[i].xyz), 0.0);
        sum += vec2f(12.0 * cosine * (1.0 - cosine), 4.0 * cosine);
    }
    return sum / f32(geometry.directions);
}

// Surface nearest to a block along a normal; its share is 0 if there is none.
fn surface_along(b: vec3f, normal: vec3f) -> BlockSurface {
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
    // Surfaces near the ends of the places count less, because there are none beyond.
    let ends = 0.5 * vec2f(f32(CENTRE), f32(PLACES - 1 - CENTRE));
    let is_near = saturate(2.0 * min(ends.x + nearest, ends.y - nearest));
    return BlockSurface(normal, -nearest, solidity(most) * is_near, vec2f(1.0), false);
}

// Surface nearest to a block; its share is 0 if there is none.
fn nearest_surface(b: vec3f) -> BlockSurface {
    let around = opacity_around(b);
    let clarity = saturate(20.0 * length(around.falling));
    var surface = BlockSurface(vec3f(0.0, 0.0, 1.0), 0.0, 0.0, vec2f(1.0), around.least > BURIED_OPACITY);
    // A loop of one turn or none: software drivers jump over it in empty places and deep in the material, while they
    // execute both sides of branches.
    let turns = select(0, 1, clarity > 0.01 && !surface.is_buried && geometry.has_surfaces == 1u);
    for (var turn = 0; turn < turns; turn += 1) {
        surface = surface_along(b, normalize(around.falling));
        surface.scale = vec2f(1.0) / open_light(scene_normal(surface));
    }
    // Faint normals count less.
    surface.share *= clarity;
    return surface;
}

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    geometry = bound_geometry;
    let id = voxel_of_listed_cell(group, lane);
    if (any(id >= geometry.dims)) {
        return;
    }
    // Not a branch on the uniform alone, which software drivers compile anew for each dispatch.
    var surface = nearest_surface(vec3f(id));
    surface.share *= f32(geometry.has_surfaces);
    surface.is_buried = surface.is_buried && geometry.has_surfaces == 1u;
    surfaces[listed_voxel(listed_cell(group, lane), lane)] = pack_surface(surface);
}
