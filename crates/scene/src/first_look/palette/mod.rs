//! Colour palettes by domain. All are about equally light, so that shading conveys the shape, and colour the
//! material.

mod covering_layers;
mod empty_channel;
pub(super) mod further_layers;

use super::domain::DataDomain;
use crate::srgb_from_lch;

/// Colour in Oklab: lightness, chroma, hue in degrees.
type Lch = [f64; 3];

/// Colours from the beginning of an object to its brightest parts, at equal steps.
pub(super) struct DomainPalette(&'static [Lch]);

/// Lightness range of palettes: within it, shading is distinguishable from colour (white paper has 0.97, terracotta
/// 0.55).
#[cfg(test)]
const LIGHTNESS: std::ops::RangeInclusive<f64> = 0.6..=0.96;

/// Palette for unknown data: the red of fired clay where material is thin or faint, sand, and porcelain for what is
/// densest.
const UNKNOWN: DomainPalette = DomainPalette(&[
    [0.65, 0.09, 40.0],
    [0.75, 0.08, 64.0],
    [0.83, 0.045, 80.0],
    [0.9, 0.008, 90.0],
    [0.94, 0.018, 235.0],
]);

/// Palette for soft tissue: muscle to fat.
const SOFT_TISSUE: DomainPalette =
    DomainPalette(&[[0.62, 0.115, 30.0], [0.74, 0.085, 48.0], [0.88, 0.055, 80.0]]);

/// Palette for bone: the red of marrow and of vessels with contrast agent, then ivory.
const BONE: DomainPalette =
    DomainPalette(&[[0.66, 0.11, 34.0], [0.77, 0.075, 60.0], [0.87, 0.045, 82.0], [0.95, 0.02, 94.0]]);

/// Palette for magnetic resonance: muscle to fat, paler than in life.
const MAGNETIC_RESONANCE: DomainPalette =
    DomainPalette(&[[0.68, 0.07, 34.0], [0.78, 0.055, 54.0], [0.88, 0.045, 80.0], [0.94, 0.025, 92.0]]);

/// Palette for vessels in magnetic resonance.
const VESSELS: DomainPalette =
    DomainPalette(&[[0.61, 0.13, 26.0], [0.7, 0.12, 32.0], [0.82, 0.085, 50.0], [0.89, 0.05, 70.0]]);

/// Palette for metal: steel, hardly blue, and brass for what is densest.
const METAL: DomainPalette = DomainPalette(&[
    [0.68, 0.028, 255.0],
    [0.77, 0.014, 250.0],
    [0.84, 0.004, 245.0],
    [0.86, 0.03, 80.0],
    [0.87, 0.07, 82.0],
]);

/// Palette for fluorescence: the green of the most common dye.
const FLUORESCENCE: DomainPalette =
    DomainPalette(&[[0.66, 0.13, 150.0], [0.78, 0.125, 148.0], [0.92, 0.075, 140.0]]);

/// Palette for molecules: cool white, and gold for what is densest.
const MOLECULE: DomainPalette = DomainPalette(&[
    [0.72, 0.055, 248.0],
    [0.82, 0.035, 240.0],
    [0.88, 0.004, 230.0],
    [0.9, 0.035, 85.0],
    [0.89, 0.075, 85.0],
]);

/// Palette for simulations: blue over green to yellow, in even steps of hue and lightness.
const SIMULATION: DomainPalette = DomainPalette(&[
    [0.66, 0.105, 256.0],
    [0.71, 0.09, 222.0],
    [0.76, 0.095, 182.0],
    [0.81, 0.11, 144.0],
    [0.86, 0.13, 110.0],
    [0.9, 0.125, 94.0],
]);

/// Palettes for negative and positive values: blue, and red of the same lightness and chroma; pale near zero, which
/// is hidden.
const NEGATIVE: DomainPalette =
    DomainPalette(&[[0.8, 0.05, 250.0], [0.71, 0.12, 252.0], [0.64, 0.155, 256.0]]);
const POSITIVE: DomainPalette = DomainPalette(&[[0.8, 0.05, 40.0], [0.71, 0.125, 32.0], [0.64, 0.17, 28.0]]);

/// Light neutral colour for masks, which have no values.
pub(super) const MASK_COLOR: [f64; 3] = [0.86, 0.02, 80.0];

impl DomainPalette {
    pub(super) fn for_domain(domain: DataDomain) -> &'static Self {
        match domain {
            DataDomain::Unknown => &UNKNOWN,
            DataDomain::SoftTissue => &SOFT_TISSUE,
            DataDomain::Bone => &BONE,
            DataDomain::MagneticResonance => &MAGNETIC_RESONANCE,
            DataDomain::Vessels => &VESSELS,
            DataDomain::Metal => &METAL,
            DataDomain::Fluorescence => &FLUORESCENCE,
            DataDomain::Molecule => &MOLECULE,
            DataDomain::Simulation => &SIMULATION,
        }
    }

    /// Returns the palette of negative or of positive values, from zero outwards.
    pub(super) fn diverging(is_negative: bool) -> &'static Self {
        if is_negative { &NEGATIVE } else { &POSITIVE }
    }

    /// Returns the sRGB colour at a position from 0 to 1, mixed in Oklab along lightness, chroma and hue.
    pub(super) fn color_at(&self, place: f64) -> [f32; 3] {
        srgb_from_lch(self.lch_at(place))
    }

    fn lch_at(&self, place: f64) -> Lch {
        let last = self.0.len() - 1;
        let place = place.clamp(0.0, 1.0) * last as f64;
        let low = (place as usize).min(last.saturating_sub(1));
        let t = place - low as f64;
        std::array::from_fn(|i| self.0[low][i] + (self.0[(low + 1).min(last)][i] - self.0[low][i]) * t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{lab_from_lch, lch_from_lab, linear_from_srgb, oklab_from_linear};

    fn shown(srgb: [f32; 3]) -> Lch {
        lch_from_lab(oklab_from_linear(srgb.map(|c| linear_from_srgb(f64::from(c)))))
    }

    #[test]
    fn palettes_are_about_equally_light() {
        let palettes =
            DataDomain::ALL.map(DomainPalette::for_domain).into_iter().chain([&NEGATIVE, &POSITIVE]);
        for palette in palettes {
            let mut sum = 0.0;
            for step in 0..=50 {
                let place = f64::from(step) / 50.0;
                let (wanted, found) = (palette.lch_at(place), shown(palette.color_at(place)));
                assert!(LIGHTNESS.contains(&found[0]), "{found:?}");
                // The colour is in the display's gamut: nothing was clipped.
                assert!(
                    (wanted[0] - found[0]).abs() < 0.01 && (wanted[1] - found[1]).abs() < 0.01,
                    "{wanted:?} {found:?}"
                );
                sum += found[0] / 51.0;
            }
            assert!((0.68..=0.86).contains(&sum), "a mean of {sum}");
            let ends = [0.0, 1.0].map(|place| palette.lch_at(place)[0]);
            assert!((ends[0] - ends[1]).abs() < 0.3, "{ends:?}");
        }
        assert!(LIGHTNESS.contains(&MASK_COLOR[0]));
    }

    #[test]
    fn both_sides_of_zero_are_equally_light() {
        for step in 0..=20 {
            let [below, above] =
                [true, false].map(|side| DomainPalette::diverging(side).lch_at(f64::from(step) / 20.0));
            assert!((below[0] - above[0]).abs() < 1e-9 && (below[1] - above[1]).abs() < 0.02);
        }
    }

    #[test]
    fn sequences_are_even() {
        // Equal steps of the value are nearly equal steps of the colour.
        let steps: Vec<f64> = (0..50)
            .map(|step| {
                let lab = |step: i32| lab_from_lch(SIMULATION.lch_at(f64::from(step) / 50.0));
                let (a, b) = (lab(step), lab(step + 1));
                (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
            })
            .collect();
        let (least, most) = steps.iter().fold((f64::INFINITY, 0.0f64), |(a, b), &s| (a.min(s), b.max(s)));
        assert!(most < 2.0 * least, "{least} to {most}");
        // Lightness increases throughout.
        assert!((0..50).all(
            |s| SIMULATION.lch_at(f64::from(s) / 50.0)[0] < SIMULATION.lch_at(f64::from(s + 1) / 50.0)[0]
        ));
    }
}
