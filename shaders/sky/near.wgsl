// Where rays of a sky are near the grid.
#import "sky/rays.wgsl"

// Slices in which a ray is less than a block from the grid, along one axis across them: first, and last.
fn slices_near(start: f32, drift: f32, blocks: f32, last: f32) -> vec2f {
    let speed = select(drift, 1e-6, abs(drift) < 1e-6);
    let a = (-1.0 - start) / speed;
    let b = (blocks - start) / speed;
    return clamp(vec2f(floor(min(a, b)), ceil(max(a, b))), vec2f(0.0, -1.0), vec2f(last + 1.0, last));
}

// The same along both, of a ray that crosses the first slice at `start`; of a grid of blocks, turned to the rays. None
// where the first is larger.
fn slices_of_ray(rays: SkyRays, start: vec2f, size: vec3f) -> vec2f {
    let u = slices_near(start.x, rays.drift.x, size.y, size.x - 1.0);
    let v = slices_near(start.y, rays.drift.y, size.z, size.x - 1.0);
    return vec2f(max(u.x, v.x), min(u.y, v.y));
}
