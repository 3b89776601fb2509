// Light that material has scattered before (bounces/outcome.wgsl), as passes that shade look it up.
struct Bounces {
    // Index space to texture coordinates of the volume: (p + ½) × lookup.
    lookup: vec3f,
    // How far in front of a surface it is looked up, in scene units: what is closer is the surface itself.
    ahead: f32,
    // What is given back of it, as a share of the colour.
    share: f32,
    pad0: f32,
    pad1: f32,
    pad2: f32,
}
