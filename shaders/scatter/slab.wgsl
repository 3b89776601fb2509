// Splatting as the paper has it (P §3.5, figure 3): what all its passes know about the slab at hand.
#import "common/sizes.wgsl"
#import "sheets/sheet_frame.wgsl"

struct Scatter {
    frame: SheetFrame,
    // Index space to (w·i, w·j, z) with w = 1 + z · inverse_distance, which is linear: three rows.
    sheets_from_index_x: vec4f,
    sheets_from_index_y: vec4f,
    sheets_from_index_z: vec4f,
    // Half the extents of a kernel in (w·i, w·j, z).
    half: vec3f,
    // How many times wider the kernel is than in index space.
    stretch: f32,
    // Voxels.
    dims: vec3f,
    // The slab.
    k: u32,
    bricks: vec3i,
    // Layers of the ring of sheets.
    layers: u32,
    // First of the bricks listed for this slab …
    first: u32,
    // … and how many there are.
    count: u32,
    // Weight of a pixel in the grid: pixels per voxel face.
    pixel_share: f32,
    // Data voxels per voxel of the light volume.
    voxel_step: f32,
    // Voxels of the light volume.
    light_dims: vec3u,
    // 1 when the view owns only the quarter-space around its axis.
    cube_face: u32,
    first_pixel: vec2f,
    // Sheets of the stack.
    sheet_count: u32,
    // Sheets along the volume: slice k is first_slice + k · slice_step …
    first_slice: f32,
    // … along this axis of index space.
    axis: vec3f,
    slice_step: f32,
    // The largest extinction that there is: sums of extinctions are in units of it.
    extinction_unit: f32,
    pad0: f32,
    pad1: f32,
    pad2: f32,
}

// What is splatted: densities; extinctions of voxels, for lights; or densities and, for the eye, colours
// and extinctions of voxels.
const SPLAT_DENSITY = 0u;
const SPLAT_EXTINCTION = 1u;
const SPLAT_MATERIAL = 2u;

override SPLAT: u32 = 0u;

// What the sheets are, src/model/settings/mod.rs: across the line of sight, slices of voxels, or single
// footprints.
const ORDER_IMAGE_ALIGNED = 0u;
const ORDER_VOLUME_ALIGNED = 1u;
const ORDER_EVERY_FOOTPRINT = 2u;

override ORDER: u32 = 0u;

@group(1) @binding(5) var<uniform> bound_scatter: Scatter;
var<private> scatter: Scatter;
// Sums of density × footprint in units of 2⁻²⁴: integers, so that their order does not matter.
@group(1) @binding(6) var<storage, read_write> sheets: array<atomic<i32>>;

// One, as sums hold it: far below what 8 or 16 bits of density show, and room for sums up to 128.
const UNIT = 16777216.0;

fn sheet_index(pixel: vec2u, k: u32) -> u32 {
    return (k % scatter.layers * scatter.frame.size.y + pixel.y) * scatter.frame.size.x + pixel.x;
}

// A further sum of the same pixel: of SPLAT_MATERIAL 1 … 4.
fn channel_index(first: u32, channel: u32) -> u32 {
    return first + channel * scatter.layers * scatter.frame.size.x * scatter.frame.size.y;
}

// The slice of voxels that is sheet k.
fn slice_of(k: f32) -> f32 {
    return scatter.first_slice + k * scatter.slice_step;
}

// Where a ray meets a sheet, in depth, and how much of the ray's depth the sheet stands for.
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

// Where an index-space point is seen.
fn locate(p: vec3f) -> vec3f {
    let point = vec4f(p, 1.0);
    return vec3f(
        dot(scatter.sheets_from_index_x, point),
        dot(scatter.sheets_from_index_y, point),
        dot(scatter.sheets_from_index_z, point),
    );
}

// The brick of a point; what lies beyond the grid belongs to the bricks at its border.
fn brick_near(p: vec3f) -> vec3i {
    return clamp(vec3i(floor(p / BRICK_EDGE)), vec3i(0), scatter.bricks - 1);
}

// The brick of a point in the grid or up to two voxels around it; −1 elsewhere.
fn brick_with_material(p: vec3f) -> vec3i {
    // Some slack for faces that lie exactly in the middle of a slab.
    if (any(p < vec3f(-2.00001)) || any(p > scatter.dims + 1.00001)) {
        return vec3i(-1);
    }
    return brick_near(p);
}
