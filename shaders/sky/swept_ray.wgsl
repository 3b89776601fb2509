// Range of slices in which a ray of a sweep is followed: near the grid, and where it is attenuated or looked up.
#import "common/sizes.wgsl"
#import "sky/rays.wgsl"

// Range of slices for each tile of rays: the first, and from bit 16 on the exclusive end
// (crates/render/src/plan/geometry/sweep_tiles.rs).
@group(0) @binding(4) var<storage, read> tiles: array<u32>;

// First and last slice in which a ray is less than a block from the grid, along one axis across the slices.
fn slices_near_grid(start: f32, drift: f32, blocks: f32, last: f32) -> vec2f {
    let speed = select(drift, 1e-6, abs(drift) < 1e-6);
    let a = (-1.0 - start) / speed;
    let b = (blocks - start) / speed;
    return clamp(vec2f(floor(min(a, b)), ceil(max(a, b))), vec2f(0.0, -1.0), vec2f(last + 1.0, last));
}

// First and last slice of a ray that crosses the first slice at `start`, in a grid of `size` blocks, turned to the
// rays. Empty if the first is larger.
fn slices_of_ray(rays: SweepRaysUniform, ray: vec2u, start: vec2f, size: vec3f) -> vec2f {
    let u = slices_near_grid(start.x, rays.drift.x, size.y, size.x - 1.0);
    let v = slices_near_grid(start.y, rays.drift.y, size.z, size.x - 1.0);
    let tile = ray / TILE_EDGE;
    let columns = (rays.size.x + TILE_EDGE - 1u) / TILE_EDGE;
    let entry = tiles[rays.first_tile + tile.y * columns + tile.x];
    let first = f32(entry & ((1u << END_SLICE_BIT) - 1u));
    let end = f32(entry >> END_SLICE_BIT);
    return vec2f(max(max(u.x, v.x), first), min(min(u.y, v.y), end - 1.0));
}
