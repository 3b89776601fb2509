// Ray of a sweep: the slices in which it is followed, which are near the grid and where it is attenuated or looked up,
// and the blocks that it passes there.
#import "common/sizes.wgsl"
#import "sky/rays.wgsl"

// Range of slices for each tile of rays: the first, and from bit 16 on the exclusive end
// (crates/render/src/plan/geometry/sweep_tiles.rs).
@group(0) @binding(4) var<storage, read> tiles: array<u32>;

// First and last slice in which a ray is less than `margin` blocks from the grid, along one axis across the slices.
fn slices_near_grid(start: f32, drift: f32, blocks: f32, last: f32, margin: f32) -> vec2f {
    let speed = select(drift, 1e-6, abs(drift) < 1e-6);
    let a = (-margin - start) / speed;
    let b = (blocks - 1.0 + margin - start) / speed;
    return clamp(vec2f(floor(min(a, b)), ceil(max(a, b))), vec2f(0.0, -1.0), vec2f(last + 1.0, last));
}

// First and last slice of a ray that crosses the first slice at `start`, in a grid of `size` blocks, turned to the
// rays, and that is looked up less than `margin` blocks from the grid. Empty if the first is larger.
fn slices_of_ray(rays: SweepRaysUniform, ray: vec2u, start: vec2f, size: vec3f, margin: f32) -> vec2f {
    let u = slices_near_grid(start.x, rays.drift.x, size.y, size.x - 1.0, margin);
    let v = slices_near_grid(start.y, rays.drift.y, size.z, size.x - 1.0, margin);
    let tile = ray / TILE_EDGE;
    let columns = (rays.size.x + TILE_EDGE - 1u) / TILE_EDGE;
    let entry = tiles[rays.first_tile + tile.y * columns + tile.x];
    let first = f32(entry & ((1u << END_SLICE_BIT) - 1u));
    let end = f32(entry >> END_SLICE_BIT);
    return vec2f(max(max(u.x, v.x), first), min(min(u.y, v.y), end - 1.0));
}

// Ray of a sweep on its way through the slices.
struct SweptRay {
    // Position where the ray crosses the first slice.
    start: vec2f,
    // Number of the grid's last slice.
    last: f32,
    // First and last slice in which the ray is followed.
    span: vec2f,
}

// Rays that are interpolated at a place are less than a block from it in some slice next to it, so a ray is followed
// as far as it is less than `margin` blocks from the grid: 1 if only blocks look it up, and more if other places do.
fn swept_ray(rays: SweepRaysUniform, ray: vec2u, margin: f32) -> SweptRay {
    let size = to_sweep_axes(rays, vec3f(sweep.dims));
    let start = vec2f(ray) + rays.first;
    return SweptRay(start, size.x - 1.0, slices_of_ray(rays, ray, start, size, margin));
}

// Place in slice n of a ray, as texture coordinates of the blocks with their border.
fn place_in_blocks(rays: SweepRaysUniform, ray: SweptRay, n: f32) -> vec3f {
    let slice = select(ray.last - n, n, rays.is_ascending == 1u);
    let block = from_sweep_axes(rays, vec3f(slice, ray.start + rays.drift * n));
    return (block + 1.5) * sweep.block_scale;
}
