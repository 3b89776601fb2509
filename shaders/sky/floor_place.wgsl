// Where texels of a floor's map lie among blocks.

struct FloorMap {
    // In blocks: the middle of texel (0, 0), and how far it is to the next along both edges.
    origin: vec3f,
    // What makes an open floor's C₀ be 1.
    share: f32,
    along_x: vec3f,
    size: u32,
    along_y: vec3f,
    pad0: f32,
    // In blocks: the floor is where dot(plane.xyz, p) = plane.w.
    plane: vec4f,
}

@group(0) @binding(5) var<uniform> bound_map: FloorMap;
var<private> map: FloorMap;
