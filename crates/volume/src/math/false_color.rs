//! False-colour map: scalar values of 0 … 1 as sRGB colours.

/// sRGB anchors at equal steps, dark to bright. Luminance rises evenly, so that the map is readable in greyscale; the
/// hue goes from blue over green to yellow, which most colour-blind people can tell apart.
const ANCHORS: [[f64; 3]; 6] = [
    [0.05, 0.03, 0.15],
    [0.16, 0.18, 0.45],
    [0.12, 0.42, 0.55],
    [0.22, 0.62, 0.46],
    [0.67, 0.77, 0.26],
    [1.00, 0.93, 0.62],
];

/// Returns the colour of a value as sRGB bytes; values are clamped to 0 … 1.
pub fn false_color(value: f32) -> [u8; 3] {
    let last = ANCHORS.len() - 1;
    // NaN gets the darkest colour.
    let value = if value.is_nan() { 0.0 } else { f64::from(value) };
    let at = value.clamp(0.0, 1.0) * last as f64;
    let low = (at as usize).min(last - 1);
    std::array::from_fn(|channel| {
        let [a, b] = [ANCHORS[low][channel], ANCHORS[low + 1][channel]];
        ((a + (b - a) * (at - low as f64)) * 255.0).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brightness_rises_all_the_way() {
        let luma = |value: f32| {
            let [r, g, b] = false_color(value).map(f64::from);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        let steps: Vec<f64> = (0..=64).map(|step| luma(step as f32 / 64.0)).collect();
        assert!(steps.windows(2).all(|pair| pair[1] > pair[0]), "{steps:?}");
        assert_eq!(false_color(f32::NAN), false_color(0.0));
        assert_eq!(false_color(7.0), false_color(1.0));
    }
}
