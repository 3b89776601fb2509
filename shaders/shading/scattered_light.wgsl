// Scattered light (scattered_light/result.wgsl), as shading passes look it up.
struct ScatteredLightUniform {
    // Scale from index space to texture coordinates: (p + ½) × lookup.
    lookup: vec3f,
    // Distance in front of a surface at which light is looked up, in scene units: nearer blocks contain the surface
    // itself.
    lookup_distance: f32,
    // Reflected fraction, multiplied by the colour.
    share: f32,
    pad0: f32,
    pad1: f32,
    pad2: f32,
}
