//! Luminance of linear RGB colours.

/// Returns the relative luminance of linear RGB (Rec. 709 weights).
pub fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}
