//! Antialiasing: the mean of rays through places in a pixel, at edges.

use crate::Reference;
use crate::back_project::AttenuationVolume;
use chiaroscuro_render::plan::PixelRay;

/// Contrast from which dark colours, and transmittance, have an edge.
const MIN_DARK_CONTRAST: [f64; 4] = [2.5e-4, 2.5e-4, 2.5e-4, 1e-3];

impl Reference<'_> {
    /// Renders the picture with `count` rays through the pixels at edges: linear, premultiplied RGBA before tone
    /// mapping, row by row from the top left.
    pub fn antialiased_picture(
        &self,
        size: [u32; 2],
        attenuations: &[Option<AttenuationVolume>],
        count: u32,
    ) -> Vec<[f64; 4]> {
        let frame = self.eye_frame(size);
        let middles = self.picture_in(&frame, attenuations);
        let pictures: Vec<_> = PixelRay::set(count)
            .into_iter()
            .map(|ray| self.picture_in(&frame.for_pixel_ray(ray, self.settings), attenuations))
            .collect();
        let mean = |pixel: usize| -> [f64; 4] {
            let sum = |channel: usize| -> f64 { pictures.iter().map(|rays| rays[pixel][channel]).sum() };
            std::array::from_fn(|channel| sum(channel) / pictures.len() as f64)
        };
        let pixels = 0..middles.len();
        let contrast = 1.0 / (4.0 * f64::from(count));
        let is_edge = |pixel: usize| !pictures.is_empty() && has_edge(&middles, size, pixel, contrast);
        pixels.map(|pixel| if is_edge(pixel) { mean(pixel) } else { middles[pixel] }).collect()
    }
}

/// Returns true if light or transmittance bends at a pixel by more than a contrast, as a share of the light, along its row or its
/// column, and is no parabola there; the picture continues evenly beyond its border.
fn has_edge(light: &[[f64; 4]], [width, height]: [u32; 2], pixel: usize, contrast: f64) -> bool {
    let (width, height) = (width as isize, height as isize);
    let (i, j) = (pixel as isize % width, pixel as isize / width);
    let value = |[i, j]: [isize; 2], channel: usize| {
        let texel = light[(i.clamp(0, width - 1) + j.clamp(0, height - 1) * width) as usize];
        if channel == 3 { 1.0 - texel[3] } else { texel[channel] }
    };
    let is_edge = |[across, down]: [isize; 2], channel: usize| {
        let along = [-2, -1, 0, 1, 2].map(|k| value([i + k * across, j + k * down], channel));
        let [far, before, middle, behind, beyond] = along;
        let bend = (before - 2.0 * middle + behind).abs();
        let sharpness = (far - 4.0 * before + 6.0 * middle - 4.0 * behind + beyond).abs();
        let brightest = before.max(middle).max(behind);
        bend.min(sharpness / 3.0) > (contrast * brightest).max(MIN_DARK_CONTRAST[channel])
    };
    [[1, 0], [0, 1]].into_iter().any(|along| (0..4).any(|channel| is_edge(along, channel)))
}
