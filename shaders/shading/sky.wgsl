// Sky whose radiance is linear in the direction (crates/scene/src/settings/light/sky.rs): L(ω) = l₀ + l₁·ω.

#option SKY: the sky gives light: 1 if it is not occluded, 2 if its visibility is looked up in a volume

struct SkyUniform {
    // Slope l₁, in scene space, and mean l₀ for each colour.
    red: vec4f,
    green: vec4f,
    blue: vec4f,
    // Scale from index space to texture coordinates of the sky volume.
    lookup: vec3f,
    // Distance in front of a surface at which visibility is looked up, in scene units: nearer blocks contain the
    // surface itself.
    lookup_distance: f32,
}
