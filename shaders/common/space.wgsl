// Transforms between index space and scene space (crates/volume/src/math/scene.rs).
struct SpaceUniform {
    // Index space to scene space: three rows of an affine map.
    scene_from_index_x: vec4f,
    scene_from_index_y: vec4f,
    scene_from_index_z: vec4f,
    // Scene vectors to index vectors: three rows.
    index_from_scene_x: vec4f,
    index_from_scene_y: vec4f,
    index_from_scene_z: vec4f,
}

// Scene-space position of an index-space point.
fn scene_from_index(space: SpaceUniform, p: vec3f) -> vec3f {
    let point = vec4f(p, 1.0);
    return vec3f(
        dot(space.scene_from_index_x, point),
        dot(space.scene_from_index_y, point),
        dot(space.scene_from_index_z, point),
    );
}

// Index-space vector of a scene-space vector.
fn index_from_scene_vector(space: SpaceUniform, v: vec3f) -> vec3f {
    return vec3f(
        dot(space.index_from_scene_x.xyz, v),
        dot(space.index_from_scene_y.xyz, v),
        dot(space.index_from_scene_z.xyz, v),
    );
}

// Scene-space gradient of an index-space gradient: it transforms with (index ← scene)ᵀ.
fn gradient_to_scene(space: SpaceUniform, gradient: vec3f) -> vec3f {
    return space.index_from_scene_x.xyz * gradient.x + space.index_from_scene_y.xyz * gradient.y
        + space.index_from_scene_z.xyz * gradient.z;
}
