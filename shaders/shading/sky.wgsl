// A sky whose radiance is linear in the direction (src/model/settings/light/sky.rs): L(ω) = l₀ + l₁·ω.
struct Sky {
    // For each colour the slope l₁, in scene space, and the mean l₀.
    red: vec4f,
    green: vec4f,
    blue: vec4f,
    // Index space to texture coordinates of the volume.
    lookup: vec3f,
    // How far in front of a surface it is looked up, in scene units: what is closer is the surface itself.
    ahead: f32,
}
