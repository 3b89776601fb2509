//! Scale bar: a round length, and its label.

use super::layer::{INK, MarksLayer, OUTLINE_INK};

/// Maximum length of the bar, relative to the picture's width.
const MAX_WIDTH_SHARE: f64 = 0.25;

/// Round length that fits into a picture, with its label in a suitable unit.
#[derive(Debug, Clone, PartialEq)]
pub struct ScaleBar {
    /// Length in millimetres, or in voxels if their size is unknown.
    pub length_mm: f64,
    /// Label of the length, with its unit.
    pub label: String,
}

/// Returns the scale bar for a picture whose width at the view's target is given; `None` if the width is not positive
/// and finite.
pub fn scale_bar(width_mm: f64, has_unknown_scale: bool) -> Option<ScaleBar> {
    let longest_mm = MAX_WIDTH_SHARE * width_mm;
    if !(longest_mm.is_finite() && longest_mm > 0.0) {
        return None;
    }
    // Chooses 1, 2 or 5 times a power of ten.
    let power = 10f64.powf(longest_mm.log10().floor());
    let step = [5.0, 2.0, 1.0].into_iter().find(|step| step * power <= longest_mm).unwrap_or(1.0);
    let length_mm = step * power;
    let (value, unit) = match length_mm {
        length if has_unknown_scale => (length, "voxels"),
        length if length >= 1e6 => (length * 1e-6, "km"),
        length if length >= 1e3 => (length * 1e-3, "m"),
        length if length >= 10.0 => (length / 10.0, "cm"),
        length if length >= 1.0 => (length, "mm"),
        length if length >= 1e-3 => (length * 1e3, "µm"),
        length => (length * 1e6, "nm"),
    };
    // There is at most one non-zero digit, so rounding is not visible.
    Some(ScaleBar { length_mm, label: format!("{} {unit}", (value * 1e3).round() / 1e3) })
}

impl ScaleBar {
    /// Draws the bar at the bottom left, `pixels` long.
    pub(super) fn draw(&self, layer: &mut MarksLayer, pixels: f64, [_, height]: [f64; 2], letters: f64) {
        let (left, bottom) = (letters, height - letters);
        let thick = (letters / 8.0).round().max(1.0);
        let tick = (letters / 2.0).round().max(3.0);
        for (edge, ink) in [(thick, OUTLINE_INK), (0.0, INK)] {
            let long = [pixels + 2.0 * edge, thick + 2.0 * edge];
            layer.fill([left - edge, bottom - thick - edge], long, ink, 255);
            for end in [left, left + pixels - thick] {
                layer.fill(
                    [end - edge, bottom - tick - edge],
                    [thick + 2.0 * edge, tick + 2.0 * edge],
                    ink,
                    255,
                );
            }
        }
        layer.write(&self.label, [left + pixels / 2.0, bottom - tick - thick], [0.5, 1.0], letters);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_have_round_lengths_and_units_that_suit_them() {
        for (longest, length, text) in [
            (7.3, 5.0, "5 mm"),
            (49.0, 20.0, "2 cm"),
            (1.0, 1.0, "1 mm"),
            (0.0042, 0.002, "2 µm"),
            (2.6e3, 2e3, "2 m"),
            (9.9e-5, 5e-5, "50 nm"),
        ] {
            let found = scale_bar(longest / MAX_WIDTH_SHARE * (1.0 + 1e-12), false).unwrap();
            assert!((found.length_mm / length - 1.0).abs() < 1e-9, "{longest}: {found:?}");
            assert_eq!(found.label, text);
        }
        let voxels = scale_bar(2.6e3 / MAX_WIDTH_SHARE, true).unwrap();
        assert_eq!((voxels.length_mm, voxels.label.as_str()), (2e3, "2000 voxels"));
        assert_eq!(scale_bar(f64::NAN, false), None);
        assert_eq!(scale_bar(0.0, false), None);
    }
}
