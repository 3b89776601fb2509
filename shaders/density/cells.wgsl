// Empty-space skipping over cells of 2³ voxels in which nothing is visible (crates/volume/src/occupancy/cells.rs).
#import "common/sizes.wgsl"
#import "density/slab_field.wgsl"

// Ray in cell coordinates: position at slab 0, and step from slab to slab.
struct CellRay {
    origin: vec3f,
    step: vec3f,
    // Slabs per cell along each axis.
    inverse: vec3f,
}

fn cell_ray(frame: SheetFrameUniform, ray: Ray) -> CellRay {
    let origin = place_in_memory(ray.origin + ray.direction * depth_of(frame, 0.0)) / CELL_EDGE;
    let step = vector_in_memory(ray.direction) * frame.slab / CELL_EDGE;
    let parallel_to = abs(step) < vec3f(1e-9);
    return CellRay(origin, step, 1.0 / select(step, vec3f(1e-9), parallel_to));
}

// Cell that contains the middle of slab k; it may lie outside the grid.
fn cell_at(walk: CellRay, k: i32) -> vec3f {
    return floor(walk.origin + walk.step * f32(k));
}

// Distances of a cell to the nearest visible ones: x to any, y to those that attenuate light. Cells outside the grid
// take the values at its border: if the border is that far from any visible cell, so is everything outside it.
// Textures hold x, and the bits in which y differs: one channel suffices where they are the same everywhere.
fn cell_distances(distances: texture_3d<f32>, cell: vec3f) -> vec2i {
    let stored = vec2i(textureSampleLevel(distances, nearest, (cell + 0.5) * grid.cell_scale, 0.0).rg * 255.0 + 0.5);
    return vec2i(stored.x, stored.x ^ stored.y);
}

// First slab beyond the cube of empty cells around `cell`. `empty` is the number of layers of that cube: 1 is the
// cell alone. Never skips a slab outside the cube.
fn skip_empty_cells(walk: CellRay, k: i32, cell: vec3f, empty: i32) -> i32 {
    let middle = (cell + 0.5 - walk.origin) * walk.inverse;
    let exits = middle + abs(walk.inverse) * (f32(empty) - 0.5);
    // Rounded down by a thousandth of a slab: visiting one more slab of the cube is harmless.
    return max(k + 1, i32(ceil(min(min(exits.x, exits.y), min(exits.z, 1e6)) - 1e-3)));
}
