//! Lighting score: rates a picture by the variety of tones, visible shadows, and the absence of black areas.

use super::image_statistics::{
    automatic_exposure, dark_fraction, is_visible, material_luminance, shadowed_fraction,
};
use chiaroscuro_scene::srgb_from_linear;

/// Number of bins for displayed luminance: four of 255 steps each, the smallest difference that is noticed in
/// pictures.
const TONE_BINS: usize = 64;

/// Corners of the score of shadowed area: none, best, and too much. All shadows convey shape; for objects that cast
/// few, some are better than none.
const SHADOW_FRACTIONS: [f64; 3] = [0.0, 0.22, 0.40];

/// Weight of shadows with the best area, in bits: half the entropy of a typical picture's tones.
const SHADOW_WEIGHT_BITS: f64 = 3.0;

/// Cost of nearly black area beyond the first two hundredths, in bits per unit of area: another 5 % cancel 1 bit of
/// tones.
const DARKNESS_COST_BITS: f64 = 20.0;
const FREE_DARKNESS: f64 = 0.02;

/// Weight of edges, in bits, if all edges of the unlit picture are preserved.
const EDGE_WEIGHT_BITS: f64 = 0.5;

/// Parts of the lighting score of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightingScore {
    /// Entropy of displayed luminance, in bits (Gumhold 2002).
    pub tones: f64,
    /// Fraction of visible pixels that shadows darken by 30 % or more.
    pub shadowed_fraction: f64,
    /// Fraction of visible pixels that are nearly black.
    pub dark_fraction: f64,
    /// Fraction of the unlit picture's edge contrast that is preserved.
    pub edges: f64,
}

impl LightingScore {
    /// Scores a picture with shadows, given the ones without shadows and without lights: linear light of equal size,
    /// the first two with equal mean brightness.
    pub(super) fn new(with: &[[f32; 4]], without: &[[f32; 4]], unlit: &[[f32; 4]], width: usize) -> Self {
        let exposure = automatic_exposure(with);
        let shown = |light: &[[f32; 4]], exposure: f64| -> Vec<Option<f64>> {
            light
                .iter()
                .map(|texel| is_visible(texel).then(|| displayed_luminance(texel, exposure)))
                .collect()
        };
        let lit = shown(with, exposure);
        Self {
            tones: entropy(&tone_histogram(lit.iter().flatten().copied())),
            shadowed_fraction: shadowed_fraction(with, without),
            dark_fraction: dark_fraction(with, exposure),
            edges: preserved_edges(&lit, &shown(unlit, mean_matching_exposure(unlit)), width),
        }
    }

    /// Returns the total score in bits; higher is better.
    pub fn total(&self) -> f64 {
        self.tones + SHADOW_WEIGHT_BITS * triangle(self.shadowed_fraction, SHADOW_FRACTIONS)
            - DARKNESS_COST_BITS * (self.dark_fraction - FREE_DARKNESS).max(0.0)
            + EDGE_WEIGHT_BITS * self.edges
    }
}

/// Returns the displayed luminance of a pixel's material, 0 … 1.
fn displayed_luminance(texel: &[f32; 4], exposure: f64) -> f64 {
    srgb_from_linear((exposure * material_luminance(texel)).clamp(0.0, 1.0))
}

/// Returns the exposure that brings the mean of an unlit picture, lit by ambient light only, to that of lit ones, so
/// that edges can be compared.
fn mean_matching_exposure(unlit: &[[f32; 4]]) -> f64 {
    let seen = unlit.iter().filter(|texel| is_visible(texel)).map(material_luminance);
    let (sum, count) = seen.fold((0.0, 0usize), |(sum, count), y| (sum + y, count + 1));
    if sum > 0.0 { 0.2 * count as f64 / sum } else { 1.0 }
}

/// Returns the histogram of displayed luminance.
fn tone_histogram(displayed: impl Iterator<Item = f64>) -> [usize; TONE_BINS] {
    let mut counts = [0; TONE_BINS];
    for value in displayed {
        counts[((value * TONE_BINS as f64) as usize).min(TONE_BINS - 1)] += 1;
    }
    counts
}

/// Returns the entropy of a histogram, in bits.
pub(super) fn entropy(counts: &[usize]) -> f64 {
    let total: usize = counts.iter().sum();
    let share = |&count: &usize| count as f64 / total.max(1) as f64;
    counts.iter().map(share).filter(|&p| p > 0.0).map(|p| -p * p.log2()).sum()
}

/// Triangle function: 0 up to the first corner, 1 at the second, 0 from the third on.
pub(super) fn triangle(x: f64, [from, best, to]: [f64; 3]) -> f64 {
    ((x - from) / (best - from)).min((to - x) / (to - best)).clamp(0.0, 1.0)
}

/// Returns the fraction of the unlit picture's contrast between neighbours that the lit one preserves; 1 if there is
/// none. Pairs with an invisible pixel are ignored, because outlines are always visible.
pub(super) fn preserved_edges(lit: &[Option<f64>], unlit: &[Option<f64>], width: usize) -> f64 {
    let (mut kept, mut all) = (0.0, 0.0);
    let mut compare = |a: usize, b: usize| {
        if let (Some(la), Some(lb), Some(ua), Some(ub)) = (lit[a], lit[b], unlit[a], unlit[b]) {
            let (there, wanted) = ((la - lb).abs(), (ua - ub).abs());
            kept += there.min(wanted);
            all += wanted;
        }
    };
    let count = lit.len().min(unlit.len());
    for at in 0..count {
        if (at + 1) % width != 0 && at + 1 < count {
            compare(at, at + 1);
        }
        if at + width < count {
            compare(at, at + width);
        }
    }
    if all > 0.0 { kept / all } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entropy_of_even_counts_is_the_logarithm_of_how_many_there_are() {
        for classes in [1usize, 2, 8, 64] {
            let expected = (classes as f64).log2();
            assert!((entropy(&vec![7; classes]) - expected).abs() < 1e-12, "{classes}");
        }
        assert_eq!(entropy(&[0, 5, 0]), 0.0);
        assert_eq!(entropy(&[]), 0.0);
        // A quarter and three quarters.
        let expected = 0.25 * 2.0 + 0.75 * (4.0f64 / 3.0).log2();
        assert!((entropy(&[1, 3]) - expected).abs() < 1e-12);
    }

    #[test]
    fn triangles_have_their_corners() {
        let corners = [0.10, 0.20, 0.35];
        for (x, expected) in
            [(0.0, 0.0), (0.10, 0.0), (0.15, 0.5), (0.20, 1.0), (0.275, 0.5), (0.35, 0.0), (1.0, 0.0)]
        {
            assert!((triangle(x, corners) - expected).abs() < 1e-12, "{x}");
        }
    }

    #[test]
    fn edges_are_kept_as_far_as_they_are_seen() {
        // Two rows of three: a step from 0.2 to 0.6 between the second and the third column.
        let step = |low: f64, high: f64| [low, low, high, low, low, high].map(Some);
        assert_eq!(preserved_edges(&step(0.2, 0.6), &step(0.2, 0.6), 3), 1.0);
        assert_eq!(preserved_edges(&step(0.0, 0.0), &step(0.2, 0.6), 3), 0.0);
        assert!((preserved_edges(&step(0.1, 0.2), &step(0.2, 0.6), 3) - 0.25).abs() < 1e-12);
        assert_eq!(preserved_edges(&step(0.0, 1.0), &step(0.2, 0.6), 3), 1.0, "more is not better");
        assert_eq!(preserved_edges(&step(0.0, 1.0), &step(0.4, 0.4), 3), 1.0, "nothing to lose");
        // The ends of rows are no edges, and neither are the borders of invisible pixels.
        let mut gone = step(0.2, 0.6);
        (gone[2], gone[5]) = (None, None);
        assert_eq!(preserved_edges(&step(0.0, 0.0), &gone, 3), 1.0);
    }

    #[test]
    fn the_parts_add_up() {
        let score = LightingScore { tones: 5.0, shadowed_fraction: 0.11, dark_fraction: 0.04, edges: 0.8 };
        assert!((score.total() - (5.0 + 3.0 * 0.5 - 20.0 * 0.02 + 0.5 * 0.8)).abs() < 1e-12);
        let flat = LightingScore { tones: 5.0, shadowed_fraction: 0.0, dark_fraction: 0.02, edges: 1.0 };
        assert!((flat.total() - 5.5).abs() < 1e-12);
    }

    #[test]
    fn shadows_of_the_best_share_win() {
        let grey = |value: f64| [value as f32, value as f32, value as f32, 1.0];
        // Ramp of light, with half the light removed from a fraction of the pixels.
        let without: Vec<_> = (0..400).map(|at| grey(0.1 + 0.4 * f64::from(at % 20) / 20.0)).collect();
        let shadowed = |share: f64, left: f32| -> Vec<[f32; 4]> {
            let dark = |at: usize| (at * 7919 % 400) < (share * 400.0) as usize;
            let texels = without.iter().enumerate();
            texels
                .map(|(at, t)| if dark(at) { [t[0] * left, t[1] * left, t[2] * left, 1.0] } else { *t })
                .collect()
        };
        let total = |share: f64, left: f32| {
            LightingScore::new(&shadowed(share, left), &without, &vec![grey(0.15); 400], 20).total()
        };
        assert!(total(0.2, 0.5) > total(0.02, 0.5) + 1.0);
        assert!(total(0.2, 0.5) > total(0.5, 0.5) + 1.0);
        assert!(total(0.2, 0.5) > total(0.2, 0.0), "black shadows hide what is in them");
    }
}
