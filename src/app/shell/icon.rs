//! The window's icon.

use eframe::egui;

/// A ball half in the light.
pub(crate) fn icon() -> egui::IconData {
    const SIZE: u32 = 64;
    let texel = |i: u32| {
        let at = |n: u32| (f64::from(n) + 0.5) / f64::from(SIZE) * 2.2 - 1.1;
        let (x, y) = (at(i % SIZE), at(i / SIZE));
        let depth = 1.0 - x * x - y * y;
        if depth <= 0.0 {
            return [0; 4];
        }
        let light = (0.75 * (-0.65 * x - 0.6 * y + 0.47 * depth.sqrt())).max(0.0) + 0.08;
        [255.0, 222.0, 176.0]
            .map(|c: f64| (c * light.min(1.0).powf(1.0 / 2.2)) as u8)
            .into_iter()
            .chain([255])
            .collect::<Vec<_>>()
            .try_into()
            .unwrap_or([0; 4])
    };
    egui::IconData { rgba: (0..SIZE * SIZE).flat_map(texel).collect(), width: SIZE, height: SIZE }
}
