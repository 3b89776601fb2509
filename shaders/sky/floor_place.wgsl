// Position of the floor map's texels in block coordinates.

struct FloorSkyMapUniform {
    // Centre of texel (0, 0), and the steps to the next texel along both edges, in blocks.
    origin: vec3f,
    // Normalisation that makes C₀ of an open floor 1.
    share: f32,
    along_x: vec3f,
    size: u32,
    along_y: vec3f,
    pad0: f32,
    // Plane of the floor in block coordinates: dot(plane.xyz, p) = plane.w.
    plane: vec4f,
}

@group(0) @binding(5) var<uniform> bound_map: FloorSkyMapUniform;
var<private> map: FloorSkyMapUniform;
