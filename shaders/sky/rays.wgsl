// Parallel rays through blocks of voxels, and the position of blocks among them
// (crates/render/src/plan/geometry/sweep.rs).

// Maximum number of directions in a batch.
const MAX_SKY_RAYS = 8;

// Distance from the grid, in blocks, from which on rays start in the open (sky/moments.wgsl).
const MAX_DISTANCE_OUTSIDE = 1.0;

struct SweepRaysUniform {
    // Unit vector towards the light, in scene space.
    direction_to_light: vec3f,
    // Path length from slice to slice, in shortest edges of a voxel.
    step: f32,
    // Shift of the rays from slice to slice, in blocks, along the two axes that follow that of the slices.
    drift: vec2f,
    // Position where ray (0, 0) crosses the first slice.
    first: vec2f,
    size: vec2u,
    // Axis across which the slices lie.
    axis: u32,
    // 1 if light travels up the axis, else 0.
    is_ascending: u32,
    // Radiance that arrives from this direction, for sweeps of light rather than transmittance
    // (scattered_light/sweep.wgsl).
    incoming_radiance: vec3f,
    // Layer of the first slice in the sheets.
    layer: u32,
    // 1, or 0 for unused entries of a batch.
    weight: f32,
    // Index of the first tile of this direction among those of the batch.
    first_tile: u32,
    pad0: f32,
    pad1: f32,
}

struct SweepUniform {
    // Number of blocks along x, y and z.
    dims: vec3u,
    // One over the number of directions, which turns the sum into the mean.
    share: f32,
    // One over the sizes of the block textures (including the border) and of the sheets.
    block_scale: vec3f,
    // 0 in the first batch, else 1.
    has_sums: f32,
    sheet_scale: vec3f,
    pad0: f32,
    rays: array<SweepRaysUniform, MAX_SKY_RAYS>,
}

@group(0) @binding(0) var<uniform> bound_sweep: SweepUniform;
var<private> sweep: SweepUniform;

// Permutes the components of a block or of the grid's size: along the axis of the slices, then the two that follow.
fn to_sweep_axes(rays: SweepRaysUniform, block: vec3f) -> vec3f {
    return select(select(block, block.yzx, rays.axis == 1u), block.zxy, rays.axis == 2u);
}

// Inverse of to_sweep_axes.
fn from_sweep_axes(rays: SweepRaysUniform, turned: vec3f) -> vec3f {
    return select(select(turned, turned.zxy, rays.axis == 1u), turned.yzx, rays.axis == 2u);
}

// Position of a point in block coordinates among the rays, in xy, and its slice, in z.
fn ray_coordinates(rays: SweepRaysUniform, block: vec3f) -> vec3f {
    let turned = to_sweep_axes(rays, block);
    let last = to_sweep_axes(rays, vec3f(sweep.dims)).x - 1.0;
    let n = select(last - turned.x, turned.x, rays.is_ascending == 1u);
    return vec3f(turned.yz - rays.drift * n - rays.first, n);
}

// Place of a block among the rays of one direction, as texture coordinates of the sheets.
fn place_in_sheets(rays: SweepRaysUniform, block: vec3f) -> vec3f {
    return place_of_ray(rays, ray_coordinates(rays, block));
}

// Place of ray coordinates of one direction, as texture coordinates of the sheets.
fn place_of_ray(rays: SweepRaysUniform, ray: vec3f) -> vec3f {
    return (ray + vec3f(0.5, 0.5, f32(rays.layer) + 0.5)) * sweep.sheet_scale;
}
