//! Coloured shadows: material transmits light of its own hue, so that light has three transmittances (P §5: a
//! spectral transmission function).

use super::BakedTransfer;

/// Number of colours of light with separate transmittances in coloured shadows.
pub const LIGHT_COLORS: usize = 3;

/// Largest component below which a colour's hue fades out, since black has none: a twentieth of white.
const MIN_HUE_BRIGHTNESS: f64 = 0.05;

/// Returns the excess of each component of a linear colour over the smallest, relative to the largest: 0 for grey, 1
/// for a component of a fully saturated colour.
fn hue_excess([r, g, b]: [f64; 3]) -> [f64; 3] {
    let (least, largest) = (r.min(g).min(b), r.max(g).max(b));
    [r, g, b].map(|c| (c - least) / largest.max(MIN_HUE_BRIGHTNESS))
}

/// Returns the shares of a material's extinction that apply to red, green and blue light: 1 − t·(c − min) / max.
///
/// The smallest component of the colour gets the full extinction, so that grey material attenuates all light alike,
/// and pure colours transmit a share `transmission` (t, 0 … 1) of their own light.
pub(super) fn extinction_shares(color: [f64; 3], transmission: f64) -> [f64; 3] {
    hue_excess(color).map(|share| 1.0 - transmission * share)
}

impl BakedTransfer {
    /// Returns the table with its colours replaced by the [shares](extinction_shares) of extinction for each colour of
    /// light.
    pub(crate) fn with_extinction_shares(&self, transmission: f64) -> Self {
        let shares = |&[r, g, b, extinction]: &[f32; 4]| {
            let [r, g, b] =
                extinction_shares([r, g, b].map(f64::from), transmission).map(|share| share as f32);
            [r, g, b, extinction]
        };
        Self::new(self.entries.iter().map(shares).collect())
    }

    /// Returns the extinction table for one colour of light, from a table of shares.
    pub fn for_light_color(&self, color: usize) -> Self {
        let entries = self.entries.iter().map(|&entry| [1.0, 1.0, 1.0, entry[3] * entry[color]]).collect();
        // Integrals of the curve itself keep peaks that are narrower than an entry.
        let integrals = self.integrals.iter().map(|integral| [integral[color]; 4]).collect();
        Self { integrals, ..Self::new(entries) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grey_meets_all_and_pure_colours_what_is_not_theirs() {
        for grey in [0.0, 0.01, 0.5, 1.0] {
            assert_eq!(extinction_shares([grey; 3], 1.0), [1.0; 3]);
        }
        assert_eq!(extinction_shares([1.0, 0.0, 0.0], 1.0), [0.0, 1.0, 1.0]);
        assert_eq!(extinction_shares([0.0, 0.4, 0.2], 0.5), [1.0, 0.5, 0.75]);
        // Any three extinctions are possible: here 0.1, 1 and 3 of 3.
        let [r, g, b] =
            extinction_shares([29.0 / 30.0, 2.0 / 3.0, 0.0], 29.0 / 30.0).map(|share| 3.0 * share);
        assert!((r - 0.1).abs() < 1e-9 && (g - 1.0).abs() < 1e-9 && b == 3.0, "{r} {g} {b}");
        // A colour close to black has hardly any hue.
        assert!(extinction_shares([0.001, 0.0, 0.0], 1.0)[0] > 0.97);
    }

    #[test]
    fn nothing_transmitted_is_all_of_the_extinction() {
        for color in [[0.2, 0.7, 0.1], [1.0, 0.0, 0.3]] {
            assert_eq!(extinction_shares(color, 0.0), [1.0; 3]);
        }
    }
}
