// Parallel rays through blocks of voxels, and where blocks lie among them (src/plan/geometry/sweep.rs).

// Most directions of a batch.
const MAX_SKY_RAYS = 8;

struct SkyRays {
    // Unit vector towards where the light comes from, in scene space.
    towards: vec3f,
    // Shortest edges of a voxel from slice to slice.
    step: f32,
    // Blocks that rays get further from slice to slice, along the axes that follow that of the slices.
    drift: vec2f,
    // Where ray (0, 0) crosses the first slice.
    first: vec2f,
    size: vec2u,
    // The slices lie across it.
    axis: u32,
    // 1 where light goes up the axis.
    rises: u32,
    // The light that comes from there, where what is marched is light and not what is left of it (bounces/sweep.wgsl).
    arriving: vec3f,
    // Layer of its first slice.
    layer: u32,
    // 1, or 0 where a batch has fewer.
    weight: f32,
    // Of its tiles among those of the batch.
    first_tile: u32,
    pad0: f32,
    pad1: f32,
}

struct Sweep {
    // Blocks.
    dims: vec3u,
    // The mean over all directions, from their sum.
    share: f32,
    // Of the textures of blocks, with those around the grid, and of sheets: one over their sizes.
    block_scale: vec3f,
    // 0 in the first batch.
    has_sums: f32,
    sheet_scale: vec3f,
    pad0: f32,
    rays: array<SkyRays, MAX_SKY_RAYS>,
}

@group(0) @binding(0) var<uniform> bound_sweep: Sweep;
var<private> sweep: Sweep;

// The components of a block, or of the grid's size: along the axis of the slices, and the two that follow.
fn turned_to(rays: SkyRays, block: vec3f) -> vec3f {
    return select(select(block, block.yzx, rays.axis == 1u), block.zxy, rays.axis == 2u);
}

// And back.
fn turned_from(rays: SkyRays, turned: vec3f) -> vec3f {
    return select(select(turned, turned.zxy, rays.axis == 1u), turned.yzx, rays.axis == 2u);
}

// Where a place in blocks lies: among the rays, in xy, and at which slice, in z.
fn place_among(rays: SkyRays, block: vec3f) -> vec3f {
    let turned = turned_to(rays, block);
    let last = turned_to(rays, vec3f(sweep.dims)).x - 1.0;
    let n = select(last - turned.x, turned.x, rays.rises == 1u);
    return vec3f(turned.yz - rays.drift * n - rays.first, n);
}
