// Rays of a stack of sheet buffers (crates/render/src/plan/geometry/sheet_frame.rs): at depth z along the axis of
// projection, pixel (i, j) sees the index-space point origin + z * direction. Depth is in scene units from the anchor
// plane; a parallel projection has inverse_distance 0.
struct SheetFrameUniform {
    origin: vec3f,
    first_depth: f32,
    origin_di: vec3f,
    slab: f32,
    origin_dj: vec3f,
    pitch: f32,
    direction: vec3f,
    inverse_distance: f32,
    direction_di: vec3f,
    voxel_edge: f32,
    direction_dj: vec3f,
    slab_count: u32,
    slope: vec2f,
    slope_di: vec2f,
    slope_dj: vec2f,
    size: vec2u,
}

struct Ray {
    origin: vec3f,
    direction: vec3f,
    // Path length per unit of depth, 1 / cos θ.
    obliquity: f32,
}

fn ray_of(frame: SheetFrameUniform, pixel: vec2f) -> Ray {
    let slope = frame.slope + frame.slope_di * pixel.x + frame.slope_dj * pixel.y;
    return Ray(
        frame.origin + frame.origin_di * pixel.x + frame.origin_dj * pixel.y,
        frame.direction + frame.direction_di * pixel.x + frame.direction_dj * pixel.y,
        sqrt(1.0 + dot(slope, slope)),
    );
}

// Depth of the middle of slab k.
fn depth_of(frame: SheetFrameUniform, k: f32) -> f32 {
    return frame.first_depth + (k + 0.5) * frame.slab;
}

// Coarsest level of the pyramid.
const MAX_STRETCH_LEVEL = 2.0;

// Pyramid level for the kernel's stretch, log2(pixel pitch / voxel edge): 0 where pixels are no wider than voxels.
fn stretch_level(frame: SheetFrameUniform, depth: f32) -> f32 {
    let stretch = frame.pitch * (1.0 + depth * frame.inverse_distance) / frame.voxel_edge;
    return clamp(log2(max(stretch, 1e-9)), 0.0, MAX_STRETCH_LEVEL);
}

// Index of a layer of four slabs in the ring: a modulo without integer division, which software drivers execute lane
// by lane.
fn ring_layer(layer: i32, layers: u32) -> i32 {
    let count = f32(layers);
    return i32(f32(layer) - count * floor((f32(layer) + 0.5) / count));
}
