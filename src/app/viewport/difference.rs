//! How much two pictures differ.

use eframe::egui::{Color32, ColorImage};

/// Differences are shown so many times as bright: one step in eight bits is just seen.
const AMPLIFIED: i32 = 8;

/// What lies between two pictures of one size.
#[derive(Debug, Clone)]
pub(super) struct Difference {
    /// The distance of every channel, amplified.
    pub image: ColorImage,
    /// Root of the mean square over pixels and channels, in steps of 8 bits.
    pub rmse: f64,
    /// The largest distance of any channel.
    pub largest: u8,
}

impl Difference {
    /// Compares two pictures, channel by channel as displayed.
    pub(super) fn of(left: &ColorImage, right: &ColorImage) -> Self {
        let (mut squares, mut largest) = (0u64, 0u8);
        let pixels = left
            .pixels
            .iter()
            .zip(&right.pixels)
            .map(|(a, b)| {
                let channel = |at: usize| a[at].abs_diff(b[at]);
                let steps = [channel(0), channel(1), channel(2)];
                for step in steps {
                    squares += u64::from(step) * u64::from(step);
                    largest = largest.max(step);
                }
                let [r, g, b] = steps.map(|step| (i32::from(step) * AMPLIFIED).min(255) as u8);
                Color32::from_rgb(r, g, b)
            })
            .collect();
        let count = (3 * left.pixels.len()).max(1);
        Self {
            image: ColorImage::new(left.size, pixels),
            rmse: (squares as f64 / count as f64).sqrt(),
            largest,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_measured_and_amplified() {
        let even = |grey: u8| ColorImage::new([2, 1], vec![Color32::from_gray(grey); 2]);
        let same = Difference::of(&even(90), &even(90));
        assert_eq!((same.rmse, same.largest), (0.0, 0));
        let mut other = even(90);
        other.pixels[1] = Color32::from_rgb(90, 90, 93);
        let found = Difference::of(&even(90), &other);
        assert!((found.rmse - (9.0f64 / 6.0).sqrt()).abs() < 1e-12, "{}", found.rmse);
        assert_eq!((found.largest, found.image.pixels[1]), (3, Color32::from_rgb(0, 0, 24)));
    }
}
