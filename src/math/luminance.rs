//! How bright a colour is.

/// Linear luminance of linear RGB (Rec. 709).
pub fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}
