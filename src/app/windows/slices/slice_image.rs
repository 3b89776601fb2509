//! Rendering of slices as images: in greys, or in the colours of the transfer function.

use eframe::egui::ecolor::gamma_u8_from_linear_f32;
use eframe::egui::{Color32, ColorImage, Vec2};

use super::plane::SlicePlane;
use chiaroscuro_scene::TransferFunction;
use chiaroscuro_volume::{ValueRange, Volume};

/// Number of steps of the lookup table from densities to colours: four times as many greys as can be told apart.
pub(super) const LOOKUP_STEPS: usize = 1024;

/// Grey window: values that are shown black and white.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct GreyWindow {
    /// Value that is black, as are all below it.
    pub black: f64,
    /// Value that is white, as are all above it.
    pub white: f64,
}

impl GreyWindow {
    /// Clamps the window near a range of values, with black below white.
    pub(crate) fn clamped(self, ValueRange { low, high }: ValueRange) -> Self {
        let span = (high - low).max(f64::MIN_POSITIVE);
        let black = self.black.clamp(low - span, high + span);
        Self { black, white: self.white.clamp(black + span * 1e-3, high + 3.0 * span) }
    }

    /// Window level: the value that is middle grey.
    pub(crate) fn level(self) -> f64 {
        f64::midpoint(self.black, self.white)
    }

    /// Window width: distance in values from black to white.
    pub(crate) fn width(self) -> f64 {
        self.white - self.black
    }

    /// Creates a window from its level and width, in data units.
    pub(crate) fn from_level_and_width(level: f64, width: f64) -> Self {
        Self { black: level - width / 2.0, white: level + width / 2.0 }
    }

    /// Changes the window by a drag, as radiology viewers do: to the right for less contrast, up for a brighter
    /// slice. `by` is in shares of a slice.
    pub(crate) fn drag(&mut self, by: Vec2, range: ValueRange) {
        let level = self.level() + f64::from(by.y) * (range.high - range.low);
        let width = self.width() * f64::from(by.x * 2.0).exp();
        *self = Self::from_level_and_width(level, width).clamped(range);
    }
}

/// Lookup table of colours for densities from 0 to 1. With a transfer function (of settings as they are drawn), its
/// colours are blended over the greys by its opacity.
pub(crate) fn color_table(
    volume: &Volume,
    grey: GreyWindow,
    transfer: Option<&TransferFunction>,
) -> Vec<Color32> {
    let color = |step: usize| {
        let density = step as f64 / LOOKUP_STEPS as f64;
        let value = volume.value_of(density);
        let level = ((value - grey.black) / (grey.white - grey.black)).clamp(0.0, 1.0) as f32;
        let Some(transfer) = transfer else { return Color32::from_gray((level * 255.0).round() as u8) };
        let place = volume.table_range().value_at(density);
        let opacity = transfer.opacity_at(place) as f32;
        let shown = displayed_color(transfer.sample(place).color);
        let [r, g, b] = shown.map(|c| (level * 255.0 + (c - level * 255.0) * opacity).round() as u8);
        Color32::from_rgb(r, g, b)
    };
    (0..=LOOKUP_STEPS).map(color).collect()
}

/// Returns a linear colour as the screen shows it, 0 … 255.
pub(super) fn displayed_color(linear: [f64; 3]) -> [f32; 3] {
    linear.map(|c| f32::from(gamma_u8_from_linear_f32(c as f32)))
}

/// Renders the slice of a plane at an index across it, through a lookup table; missing voxels are black.
pub(crate) fn render_slice(volume: &Volume, plane: &SlicePlane, at: usize, table: &[Color32]) -> ColorImage {
    let dims = volume.dims();
    let color = |density: f64| table[((density * LOOKUP_STEPS as f64) as usize).min(LOOKUP_STEPS)];
    let pixel = |voxel: [usize; 3]| volume.density_at(voxel).map_or(Color32::BLACK, color);
    let pixels = plane.voxels(dims, at).map(pixel).collect();
    ColorImage::new([plane.right.axis, plane.up.axis].map(|axis| dims[axis]), pixels)
}

#[cfg(test)]
mod tests {
    use eframe::egui::vec2;
    use glam::DVec3;

    use super::super::plane::ScreenAxis;
    use super::*;
    use chiaroscuro_scene::ControlPoint;
    use chiaroscuro_volume::Samples;

    /// Volume with the values x + 10 y + 100 z.
    fn volume() -> Volume {
        let values = (0..2 * 3 * 4).map(|at| (at % 2 + 10 * (at / 2 % 3) + 100 * (at / 6)) as u16).collect();
        Volume::with_spacing("steps", [2, 3, 4], DVec3::ONE, Samples::U16(values)).unwrap()
    }

    #[test]
    fn slices_show_their_voxels_the_right_way_up() {
        let volume = volume();
        let table = color_table(&volume, GreyWindow { black: 0.0, white: 321.0 }, None);
        let grey = |value: f64| {
            let found = table[(volume.density_of(value) * LOOKUP_STEPS as f64) as usize];
            assert!((f64::from(found.r()) - value / 321.0 * 255.0).abs() <= 1.0, "{value}: {found:?}");
            found
        };
        for (axis, size, top_left, bottom_right) in
            [(0, [3, 4], 301.0, 21.0), (1, [2, 4], 310.0, 11.0), (2, [2, 3], 120.0, 101.0)]
        {
            let plane = SlicePlane::across_axis(axis);
            let image = render_slice(&volume, &plane, 1, &table);
            assert_eq!(image.size, size, "across axis {axis}");
            assert_eq!(image.pixels[0], grey(top_left), "across axis {axis}");
            assert_eq!(*image.pixels.last().unwrap(), grey(bottom_right), "across axis {axis}");
            // Rotated by 180°.
            let [right, up] = [plane.right, plane.up].map(|run| ScreenAxis { is_reversed: true, ..run });
            let turned = render_slice(&volume, &SlicePlane { right, up, ..plane }, 1, &table);
            assert_eq!(turned.size, size);
            assert!(turned.pixels.iter().eq(image.pixels.iter().rev()), "across axis {axis}");
        }
    }

    #[test]
    fn grey_levels_are_dragged_and_stay_in_order() {
        let mut grey = GreyWindow { black: 20.0, white: 60.0 };
        grey.drag(vec2(0.0, 0.1), ValueRange::new(0.0, 100.0));
        assert!((grey.black - 30.0).abs() < 1e-4 && (grey.white - 70.0).abs() < 1e-4, "{grey:?}");
        grey.drag(vec2(0.2, 0.0), ValueRange::new(0.0, 100.0));
        assert!(grey.black < 30.0 && grey.white > 70.0);
        for _ in 0..50 {
            grey.drag(vec2(-0.9, 0.9), ValueRange::new(0.0, 100.0));
        }
        assert!(grey.white > grey.black && grey.black <= 200.0);
        let window = GreyWindow::from_level_and_width(40.0, 400.0);
        assert_eq!(
            (window.black, window.white, window.level(), window.width()),
            (-160.0, 240.0, 40.0, 400.0)
        );
        let turned = GreyWindow { black: 9.0, white: 1.0 }.clamped(ValueRange::new(0.0, 10.0));
        assert!(turned.white > turned.black);
    }

    #[test]
    fn colors_come_where_the_transfer_function_is_opaque() {
        let volume = volume();
        let point = ControlPoint::new(5.0, [1.0, 0.0, 0.0], 0.0);
        let mut transfer = TransferFunction { points: vec![point], ..TransferFunction::default() };
        let grey = GreyWindow { black: 0.0, white: 321.0 };
        assert_eq!(color_table(&volume, grey, Some(&transfer)), color_table(&volume, grey, None));
        transfer.points[0].opacity = 1.0;
        let red = color_table(&volume, grey, Some(&transfer));
        assert!(
            red.iter().all(|color| color.r() > 230 && color.g() < 25),
            "{:?} … {:?}",
            red[0],
            red[LOOKUP_STEPS]
        );
    }
}
