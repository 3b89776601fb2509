//! Icon of the window: a ball lit from one side.

use eframe::{egui, icon_data};

/// Decodes the icon from its PNG file.
pub(crate) fn icon() -> egui::IconData {
    // An unreadable icon leaves the window without one; a test reads it.
    icon_data::from_png_bytes(include_bytes!("../../../assets/icon.png")).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Colour of the ball at a point; its radius is 1, and the edge of the icon is 2.2.
    fn texel(x: f64, y: f64) -> [u8; 4] {
        let depth = 1.0 - x * x - y * y;
        if depth <= 0.0 {
            return [0; 4];
        }
        let light = (0.75 * (-0.65 * x - 0.6 * y + 0.47 * depth.sqrt())).max(0.0) + 0.08;
        let [r, g, b] = [255.0, 222.0, 176.0].map(|c: f64| (c * light.min(1.0).powf(1.0 / 2.2)) as u8);
        [r, g, b, 255]
    }

    #[test]
    fn the_icon_is_a_ball_half_in_the_light() {
        let icon = icon();
        assert_eq!([icon.width, icon.height], [64; 2]);
        for (i, found) in icon.rgba.chunks(4).enumerate() {
            let [x, y] = [i % 64, i / 64].map(|n| (n as f64 + 0.5) / 64.0 * 2.2 - 1.1);
            let expected = texel(x, y);
            // The rounding of `powf` differs between libraries.
            assert!(
                found.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 1),
                "{i}: {found:?} {expected:?}"
            );
        }
    }
}
