//! Difference image of two pictures, and their distance.

use eframe::egui::{Color32, ColorImage};

use chiaroscuro_render::PictureDistance;

/// Amplification of the displayed difference: makes one step in eight bits just visible.
const AMPLIFICATION: i32 = 8;

/// Difference of two pictures of equal size.
#[derive(Debug, Clone)]
pub(crate) struct PictureDifference {
    /// Absolute difference of every channel, amplified.
    pub image: ColorImage,
    /// Measured distance of the two pictures.
    pub distance: PictureDistance,
}

impl PictureDifference {
    /// Compares two pictures, channel by channel as displayed.
    pub(crate) fn between(left: &ColorImage, right: &ColorImage) -> Self {
        let pixels = left
            .pixels
            .iter()
            .zip(&right.pixels)
            .map(|(a, b)| {
                let [r, g, b] =
                    [0, 1, 2].map(|at| (i32::from(a[at].abs_diff(b[at])) * AMPLIFICATION).min(255) as u8);
                Color32::from_rgb(r, g, b)
            })
            .collect();
        Self {
            image: ColorImage::new(left.size, pixels),
            distance: PictureDistance::between_bytes(left.as_raw(), right.as_raw()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_measured_and_amplified() {
        let even = |grey: u8| ColorImage::new([2, 1], vec![Color32::from_gray(grey); 2]);
        let same = PictureDifference::between(&even(90), &even(90));
        assert_eq!(same.distance, PictureDistance { rmse: 0.0, max: 0.0 });
        let mut other = even(90);
        other.pixels[1] = Color32::from_rgb(90, 90, 93);
        let found = PictureDifference::between(&even(90), &other);
        assert_eq!((found.distance.max, found.image.pixels[1]), (3.0, Color32::from_rgb(0, 0, 24)));
    }
}
