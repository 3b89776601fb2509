// Slab parameters shared by all passes that splat literally, like the paper (P §3.5, figure 3).
#import "common/sizes.wgsl"
#import "sheets/sheet_frame.wgsl"

struct ScatterSlabUniform {
    frame: SheetFrameUniform,
    // Index space to (w·i, w·j, z) with w = 1 + z · inverse_distance, a linear map: three rows.
    sheets_from_index_x: vec4f,
    sheets_from_index_y: vec4f,
    sheets_from_index_z: vec4f,
    // Half the extents of a kernel in (w·i, w·j, z).
    half_extents: vec3f,
    // Width of the kernel relative to that in index space.
    stretch: f32,
    // Number of voxels along x, y and z.
    dims: vec3f,
    // Index of the slab.
    k: u32,
    bricks: vec3i,
    // Number of layers in the ring of sheets.
    layers: u32,
    // Index of the slab's first brick in the list.
    first: u32,
    // Number of bricks listed for this slab.
    count: u32,
    // Weight of a pixel in the grid: pixels per voxel face.
    pixel_share: f32,
    // Number of data voxels per voxel of the light volume, along an axis.
    voxel_step: f32,
    // Number of voxels of the light volume along x, y and z.
    light_dims: vec3u,
    // 1 if the view is a cube face, which covers only the quarter-space around its axis.
    cube_face: u32,
    first_pixel: vec2f,
    // Number of sheets in the stack.
    sheet_count: u32,
    // Volume-aligned sheets: sheet k is the slice first_slice + k · slice_step.
    first_slice: f32,
    // Axis of index space across which the slices lie.
    axis: vec3f,
    slice_step: f32,
    // Maximum extinction of the transfer function, the unit of summed extinctions.
    extinction_unit: f32,
    pad0: f32,
    pad1: f32,
    pad2: f32,
}

// Splatted quantity: densities; extinctions of voxels, for lights; or densities with, for the eye, colours and
// extinctions of voxels.
const SPLAT_DENSITY = 0u;
const SPLAT_EXTINCTION = 1u;
const SPLAT_MATERIAL = 2u;

override SPLAT: u32 = 0u;

// Order of sheets (crates/scene/src/settings/mod.rs): across the line of sight, slices of voxels, or single footprints.
const ORDER_IMAGE_ALIGNED = 0u;
const ORDER_VOLUME_ALIGNED = 1u;
const ORDER_EVERY_FOOTPRINT = 2u;

override ORDER: u32 = 0u;

@group(1) @binding(5) var<uniform> bound_scatter: ScatterSlabUniform;
var<private> scatter: ScatterSlabUniform;
// Sums of density × footprint in units of 2⁻²⁴: integers, so that the order of summation does not matter.
@group(1) @binding(6) var<storage, read_write> sheets: array<atomic<i32>>;

// Fixed-point representation of 1: the resolution is far below that of 8- or 16-bit densities, with headroom for sums
// up to 128.
const FIXED_POINT_ONE = 16777216.0;

fn sheet_index(pixel: vec2u, k: u32) -> u32 {
    return (k % scatter.layers * scatter.frame.size.y + pixel.y) * scatter.frame.size.x + pixel.x;
}

// Index of another sum of the same pixel: channels 1 … 4 of SPLAT_MATERIAL.
fn channel_index(first: u32, channel: u32) -> u32 {
    return first + channel * scatter.layers * scatter.frame.size.x * scatter.frame.size.y;
}

// Slice of voxels of sheet k.
fn slice_of(k: f32) -> f32 {
    return scatter.first_slice + k * scatter.slice_step;
}

// Depth at which a ray crosses a sheet, and thickness of the sheet along the ray, in depth.
struct Crossing {
    depth: f32,
    thickness: f32,
}

fn crossing_of(ray: Ray, k: f32) -> Crossing {
    if (ORDER == ORDER_IMAGE_ALIGNED) {
        return Crossing(depth_of(scatter.frame, k), scatter.frame.slab);
    }
    let speed = dot(scatter.axis, ray.direction);
    let least = select(max(speed, 1e-3), min(speed, -1e-3), speed < 0.0);
    return Crossing((slice_of(k) - dot(scatter.axis, ray.origin)) / least, 1.0 / abs(least));
}

// Projection of an index-space point: (w·i, w·j, z).
fn project_to_sheets(p: vec3f) -> vec3f {
    let point = vec4f(p, 1.0);
    return vec3f(
        dot(scatter.sheets_from_index_x, point),
        dot(scatter.sheets_from_index_y, point),
        dot(scatter.sheets_from_index_z, point),
    );
}

// Brick that contains a point; outside the grid, the nearest at its border.
fn nearest_brick(p: vec3f) -> vec3i {
    return clamp(vec3i(floor(p / BRICK_EDGE)), vec3i(0), scatter.bricks - 1);
}

// Brick of a point within two voxels of the grid; −1 elsewhere.
fn brick_with_material(p: vec3f) -> vec3i {
    // Slack for faces exactly in the middle of a slab.
    if (any(p < vec3f(-2.00001)) || any(p > scatter.dims + 1.00001)) {
        return vec3i(-1);
    }
    return nearest_brick(p);
}
