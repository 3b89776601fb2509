// Leaping over bricks of 8³ voxels that hold nothing (src/data/bricks.rs).
#import "common/volume.wgsl"

fn brick_of(p: vec3f) -> vec3i {
    return clamp(vec3i(floor(p / 8.0)), vec3i(0), grid.bricks - 1);
}

// The first slab beyond the cube of bricks around `brick` that is known to be empty. `empty` counts
// the layers of that cube: 1 is the brick alone. Never steps over a slab outside the cube.
fn leap(frame: SheetFrame, ray: Ray, k: i32, brick: vec3i, empty: i32) -> i32 {
    let first = brick - (empty - 1);
    let last = brick + empty;
    // What lies beyond the grid belongs to the bricks at its border.
    let low = select(vec3f(first * 8), vec3f(-1e6), first <= vec3i(0));
    let high = select(vec3f(last * 8), vec3f(1e6), last >= grid.bricks);
    let parallel_to = abs(ray.direction) < vec3f(1e-12);
    let direction = select(ray.direction, vec3f(1e-12), parallel_to);
    let exits = (select(low, high, direction > vec3f(0.0)) - ray.origin) / direction;
    let exit = (min(min(exits.x, exits.y), exits.z) - frame.first_depth) / frame.slab - 0.5;
    // A thousandth of a slab early: visiting one more slab of the cube is harmless.
    return max(k + 1, i32(ceil(min(exit, 1e6) - 1e-3)));
}

// Whether a sample at p, at a depth of the frame, can see anything: `empty` is its brick's distance to the
// nearest that shows something, and a bit for each of the brick's octants says whether that does. The
// octants speak for samples at one point whose kernels are not stretched.
fn can_see(frame: SheetFrame, depth: f32, p: vec3f, brick: vec3i, empty: i32, octants: u32) -> bool {
    // A slab of slack for the second of two points.
    let pitch = frame.pitch * (1.0 + (depth + frame.slab) * frame.inverse_distance);
    let stretched = STRETCH && pitch > frame.voxel_edge;
    let octant = clamp(vec3i(floor(p / 4.0)) - 2 * brick, vec3i(0), vec3i(1));
    let bit = octants >> u32(octant.x + 2 * octant.y + 4 * octant.z) & 1u;
    return empty <= select(0, grid.dilation, stretched) && (bit == 1u || QUADRATURE == 2u || stretched);
}
