// Presence as it is stored where voxels are missing: signed bytes, so that a change may be exactly none.

// The share of kernels on voxels that are there, from a texel that has it from −1 for none to 1.
fn share_stored(texel: vec4f) -> f32 {
    return 0.5 * texel.r + 0.5;
}
