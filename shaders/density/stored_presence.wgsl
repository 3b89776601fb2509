// Decoding of stored presence: signed bytes, so that a difference of exactly 0 can be represented.

// Presence, 0 … 1, from a texel that stores it as −1 … 1.
fn decode_presence(texel: vec4f) -> f32 {
    return 0.5 * texel.r + 0.5;
}
