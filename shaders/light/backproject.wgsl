// Back-projection, the second half of the light pass (P §3.5, eq. 10): splats the sheets back into the grid. In
// gather form, one thread per voxel sums deposit × kernel over the sheet pixels under its footprint and divides by
// the sum of kernel weights.
//
// A voxel is written when the last sheet that it needs has been marched (the paper's rolling normalisation); voxels
// of other chunks are skipped.
#import "common/sizes.wgsl"
#import "density/kernel.wgsl"
#import "sheets/sheet_frame.wgsl"
#import "common/listed_bricks.wgsl"

struct BackprojectionUniform {
    frame: SheetFrameUniform,
    // Index space to light axes at the anchor, x and y in pixels of the anchor plane, z in scene units: three rows of
    // an affine map.
    light_from_index_x: vec4f,
    light_from_index_y: vec4f,
    light_from_index_z: vec4f,
    first_pixel: vec2f,
    // Width of the reverse kernel along the axis: one voxel of the light volume, in scene units.
    kernel_edge: f32,
    // Number of data voxels per voxel of the light volume, along an axis.
    voxel_step: f32,
    dims: vec3u,
    // 1 if the view is a cube face, which covers only the quarter-space around its axis.
    cube_face: u32,
    begin: u32,
    end: u32,
    // Number of layers in the ring.
    layers: u32,
    // Number of bricks listed for this chunk.
    bricks: u32,
    // One over the ring's columns and rows, which may exceed those of the sheets.
    ring_scale: vec2f,
    pad0: f32,
    pad1: f32,
}

@group(0) @binding(0) var<uniform> bound_view: BackprojectionUniform;
var<private> view: BackprojectionUniform;
@group(0) @binding(1) var<storage, read> bricks: array<vec4u>;
// Ring with four slabs per texel.
@group(0) @binding(2) var ring: texture_2d_array<f32>;
@group(0) @binding(3) var ring_sampler: sampler;
@group(0) @binding(4) var attenuation: texture_storage_3d<TARGET_FORMAT, write>;

// Takes the deposit of the first sheet that touches a voxel (the paper's mode without weight volume).
override FIRST_TOUCH: bool = false;
// Set if the kernel is wider than a pixel or a slab anywhere, or for cube faces.
override WIDE: bool = false;

// Width of the kernel across the sheets: minimum in voxels, maximum in pixels
// (crates/render/src/plan/geometry/light_frame.rs).
const MIN_KERNEL_VOXELS = 0.3125;
const MAX_KERNEL_PIXELS = 4.0;

// Deposits of the four slabs 4·layer … 4·layer + 3.
fn four_sheets(pixel: vec2f, layer: i32) -> vec4f {
    return textureSampleLevel(ring, ring_sampler, (pixel + 0.5) * view.ring_scale, ring_layer(layer, view.layers), 0.0);
}

// Weights of four consecutive slabs, the first at `place` in its texel: split into those of this texel and of the
// next.
fn weights_in_texel(weights: vec4f, place: i32) -> vec4f {
    let moved = select(vec4f(0.0, weights.xyz), vec4f(0.0, 0.0, weights.xy), place == 2);
    return select(select(moved, vec4f(0.0, 0.0, 0.0, weights.x), place == 3), weights, place == 0);
}

fn weights_in_next_texel(weights: vec4f, place: i32) -> vec4f {
    let moved = select(vec4f(weights.w, 0.0, 0.0, 0.0), vec4f(weights.zw, 0.0, 0.0), place == 2);
    return select(select(moved, vec4f(weights.yzw, 0.0), place == 3), vec4f(0.0), place == 0);
}

// Sums a kernel one pixel wide and one slab deep: four pixels and four slabs. Across, two linear fetches per axis (as
// in volume/field.wgsl), or one if the kernel is a tent.
fn gather_narrow(pixel: vec2f, slab: f32) -> f32 {
    let cell = vec3f(floor(pixel), floor(slab));
    let f = vec3f(pixel, slab) - cell;
    let first = i32(cell.z) - 1;
    let place = first & 3;
    let layer = first >> 2u;
    if (KERNEL == KERNEL_PREFILTERED) {
        let wz = vec4f(0.0, 1.0 - f.z, f.z, 0.0);
        return dot(weights_in_texel(wz, place), four_sheets(pixel, layer))
            + dot(weights_in_next_texel(wz, place), four_sheets(pixel, layer + 1));
    }
    let wx = kernel_weights(f.x);
    let wy = kernel_weights(f.y);
    let wz = kernel_weights(f.z);
    let low = vec2f(wx.x + wx.y, wy.x + wy.y);
    let high = 1.0 - low;
    let a = cell.xy + vec2f(wx.y, wy.y) / low - 1.0;
    let b = cell.xy + vec2f(wx.w, wy.w) / high + 1.0;
    let near = low.y * (low.x * four_sheets(vec2f(a.x, a.y), layer) + high.x * four_sheets(vec2f(b.x, a.y), layer))
        + high.y * (low.x * four_sheets(vec2f(a.x, b.y), layer) + high.x * four_sheets(vec2f(b.x, b.y), layer));
    let next = layer + 1;
    let far = low.y * (low.x * four_sheets(vec2f(a.x, a.y), next) + high.x * four_sheets(vec2f(b.x, a.y), next))
        + high.y * (low.x * four_sheets(vec2f(a.x, b.y), next) + high.x * four_sheets(vec2f(b.x, b.y), next));
    return dot(weights_in_texel(wz, place), near) + dot(weights_in_next_texel(wz, place), far);
}

// Two neighbouring pixels as one linear fetch: x is the position between them, y the sum of their weights.
fn pixel_pair(first: i32, count: i32, at: f32, width: f32) -> vec2f {
    let a = select(0.0, kernel_at((f32(first) - at) / width), first >= 0 && first < count);
    let b = select(0.0, kernel_at((f32(first + 1) - at) / width), first + 1 >= 0 && first + 1 < count);
    return vec2f(b / max(a + b, 1e-20), a + b);
}

// Distance of the quadrature points from the middle of a slab, in slabs.
fn point_offset() -> f32 {
    return select(0.0, 0.28867513, QUADRATURE == 2u);
}

// Kernel averaged over a slab at a distance in slabs.
fn slab_kernel(distance: f32, slabs: f32) -> f32 {
    let offset = point_offset();
    return 0.5 * (kernel_at((distance - offset) / slabs) + kernel_at((distance + offset) / slabs));
}

// Weights of the four slabs from `first` on.
fn slab_weights(first: i32, count: i32, at: f32, slabs: f32) -> vec4f {
    let k = vec4i(first) + vec4i(0, 1, 2, 3);
    let d = vec4f(k) - at;
    let weights = vec4f(
        slab_kernel(d.x, slabs),
        slab_kernel(d.y, slabs),
        slab_kernel(d.z, slabs),
        slab_kernel(d.w, slabs),
    );
    return select(vec4f(0.0), weights, k >= vec4i(0) & k < vec4i(count));
}

// Sums a kernel of any width: pairs of pixels and groups of four slabs over the whole footprint, divided by the sum
// of their weights. The kernel is separable: its weights along the projection are the same for every pixel, and
// twelve of them, which suffice unless slabs are thin, are kept while pixels are visited.
fn gather_wide(pixel: vec2f, slab: f32, pixels: f32, slabs: f32) -> f32 {
    let reach = kernel_radius() * vec3f(pixels, pixels, slabs) + vec3f(0.0, 0.0, point_offset());
    let first = vec3i(ceil(vec3f(pixel, slab) - reach));
    let last = vec3i(floor(vec3f(pixel, slab) + reach));
    let size = vec3i(vec2i(view.frame.size), i32(view.frame.slab_count));
    var sum = 0.0;
    var weights = 0.0;
    for (var k = max(first.z, 0) & ~3; k <= last.z; k += 12) {
        let z0 = slab_weights(k, size.z, slab, slabs);
        let z1 = slab_weights(k + 4, size.z, slab, slabs);
        let z2 = slab_weights(k + 8, size.z, slab, slabs);
        let along = dot(z0 + z1 + z2, vec4f(1.0));
        for (var i = first.x; i <= last.x; i += 2) {
            let x = pixel_pair(i, size.x, pixel.x, pixels);
            for (var j = first.y; j <= last.y; j += 2) {
                let y = pixel_pair(j, size.y, pixel.y, pixels);
                let at = vec2f(f32(i) + x.x, f32(j) + y.x);
                let weight = x.y * y.y;
                weights += weight * along;
                for (var c = 0; c < 3 && k + 4 * c <= last.z; c += 1) {
                    let z = select(select(z0, z1, c == 1), z2, c == 2);
                    sum += weight * dot(z, four_sheets(at, (k >> 2u) + c));
                }
            }
        }
    }
    return select(1.0, sum / weights, weights > 1e-12);
}

// Footprint of a light voxel in the sheets.
struct Footprint {
    pixel: vec2f,
    slab: f32,
    // Radius-one widths of the kernel.
    pixels: f32,
    slabs: f32,
    // Last sheet under the kernel: the chunk that marches it completes the voxel. Assumes radius 2 for every kernel,
    // so that the chunk does not depend on it.
    final_slab: i32,
    // Set if the voxel belongs to this view, and does not lie in the plane of the light.
    is_visible: bool,
}

fn footprint_of(voxel: vec3u) -> Footprint {
    let p = vec4f((vec3f(voxel) + 0.5) * view.voxel_step - 0.5, 1.0);
    let across = vec2f(dot(view.light_from_index_x, p), dot(view.light_from_index_y, p));
    let depth = dot(view.light_from_index_z, p);
    let spread = 1.0 + depth * view.frame.inverse_distance;
    let limit = spread / max(view.frame.inverse_distance * view.frame.pitch, 1e-20);
    let owned = (spread > 0.0 && all(abs(across) <= vec2f(limit * 1.00001))) | (view.cube_face == 0u);
    // Tested in WIDE variants only, which include all cube faces, because all lanes wait for the store.
    if (WIDE && (owned & !(spread > 1e-3) & (view.begin == 0u)) && all(voxel < view.dims)) {
        // In the plane of the light and part of this view: at the light itself, inside the cube.
        textureStore(attenuation, voxel, vec4f(1.0));
    }
    let pitch = view.frame.pitch * spread;
    let pixels = clamp(MIN_KERNEL_VOXELS * view.kernel_edge / pitch, 1.0, MAX_KERNEL_PIXELS);
    let slabs = view.kernel_edge / view.frame.slab;
    let slab = (depth - view.frame.first_depth) / view.frame.slab - 0.5;
    let last_slab = i32(view.frame.slab_count) - 1;
    let final_slab = clamp(i32(floor(slab + 2.0 * slabs + point_offset())), 0, last_slab);
    let is_visible = owned && spread > 1e-3 && all(voxel < view.dims);
    return Footprint(across / spread - view.first_pixel, slab, pixels, slabs, final_slab, is_visible);
}

// Voxel that the chunk completes, and the cells of its brick that the lane has yet to process.
struct CompletedVoxel {
    is_due: bool,
    remaining_cells: vec2u,
    voxel: vec3u,
    found: Footprint,
}

// Voxel of the lane in the next of its cells that the chunk completes.
fn next_completed_voxel(brick: u32, lane: u32, cells: vec2u) -> CompletedVoxel {
    let in_cell = vec3u(lane, lane >> 1u, lane >> 2u) & vec3u(1u);
    var next: CompletedVoxel;
    next.remaining_cells = cells;
    loop {
        let remaining = next.remaining_cells;
        if (all(remaining == vec2u(0u))) {
            break;
        }
        let low = remaining.x != 0u;
        let cell = select(firstTrailingBit(remaining.y) + 32u, firstTrailingBit(remaining.x), low);
        next.remaining_cells = select(vec2u(remaining.x, remaining.y & (remaining.y - 1u)), vec2u(remaining.x & (remaining.x - 1u), remaining.y), low);
        let place = vec3u(cell, cell >> 2u, cell >> 4u) & vec3u(3u);
        next.voxel = unpack_coordinates(brick) * BRICK_EDGE + place * CELL_EDGE + in_cell;
        let found = footprint_of(next.voxel);
        next.found = found;
        next.is_due = found.is_visible && found.final_slab >= i32(view.begin) && found.final_slab < i32(view.end);
        if (next.is_due) {
            break;
        }
    }
    return next;
}

// Number of voxels in a cell, with one lane each.
const CELL_VOXELS = CELL_EDGE * CELL_EDGE * CELL_EDGE;

// Number of lanes that share a brick, a power of two from 8 to 64 (crates/render/src/light/backproject.rs).
override LANES: u32 = 64u;

// Eight lanes per cell of 2³ voxels; the same lanes stride over the other cells of the brick.
@compute @workgroup_size(LANES)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    view = bound_view;
    let listed = group.y * LISTED_PER_ROW + group.x;
    if (listed >= view.bricks) {
        return;
    }
    let brick = bricks[listed];
    // Mask with one bit set in every LANES / 8 bits.
    let every = 0xffffffffu / ((1u << (LANES / CELL_VOXELS)) - 1u);
    var next = next_completed_voxel(brick.x, lane, brick.yz & vec2u(every << (lane / CELL_VOXELS)));
    // Software drivers run a loop's body to its end before they test if any lane is active, so breaks are placed at
    // the end, not in the middle.
    loop {
        if (!next.is_due) {
            break;
        }
        let found = next.found;
        var value: f32;
        if (FIRST_TOUCH) {
            let first = clamp(i32(ceil(found.slab - 2.0 * found.slabs)), 0, i32(view.frame.slab_count) - 1);
            value = four_sheets(found.pixel, first >> 2u)[first & 3];
        } else if (WIDE) {
            value = gather_wide(found.pixel, found.slab, found.pixels, found.slabs);
        } else {
            value = gather_narrow(found.pixel, found.slab);
        }
        textureStore(attenuation, next.voxel, vec4f(value));
        next = next_completed_voxel(brick.x, lane, next.remaining_cells);
        if (!next.is_due) {
            break;
        }
    }
}
