//! Coloured shadows: matter lets light of its own hue through, so that light has three transmittances (P §5: a spectral
//! transmission function).

use super::BakedTransfer;

/// The colours of light, each of which has a transmittance of its own where shadows are coloured.
pub const COLORS: usize = 3;

/// Colours whose largest component is darker than this have less of a hue, and black has none: a twentieth of white.
const DARK: f64 = 0.05;

/// By how much more of each component than of the least a linear colour consists: 0 of grey, 1 of a component beside which
/// another is nothing.
fn hue([r, g, b]: [f64; 3]) -> [f64; 3] {
    let (least, largest) = (r.min(g).min(b), r.max(g).max(b));
    [r, g, b].map(|c| (c - least) / largest.max(DARK))
}

/// The shares of the extinction of matter of a linear colour that red, green and blue light meet: 1 − t·(c − min) / max.
///
/// The component that the colour has least of meets all of it, so that grey matter attenuates all light alike, and a share
/// `transmission` (t, 0 … 1) of what a pure colour lets through is let through.
pub(super) fn met_shares(color: [f64; 3], transmission: f64) -> [f64; 3] {
    hue(color).map(|share| 1.0 - transmission * share)
}

impl BakedTransfer {
    /// The table with, in place of colours, the [shares](met_shares) of its extinction that each colour of light meets.
    pub(crate) fn transmitting(&self, transmission: f64) -> Self {
        let shares = |&[r, g, b, extinction]: &[f32; 4]| {
            let [r, g, b] = met_shares([r, g, b].map(f64::from), transmission).map(|share| share as f32);
            [r, g, b, extinction]
        };
        Self::new(self.entries.iter().map(shares).collect())
    }

    /// What one of the colours of light meets of such a table.
    pub(crate) fn met_by(&self, color: usize) -> Self {
        Self::new(self.entries.iter().map(|&entry| [1.0, 1.0, 1.0, entry[3] * entry[color]]).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grey_meets_all_and_pure_colours_what_is_not_theirs() {
        for grey in [0.0, 0.01, 0.5, 1.0] {
            assert_eq!(met_shares([grey; 3], 1.0), [1.0; 3]);
        }
        assert_eq!(met_shares([1.0, 0.0, 0.0], 1.0), [0.0, 1.0, 1.0]);
        assert_eq!(met_shares([0.0, 0.4, 0.2], 0.5), [1.0, 0.5, 0.75]);
        // Any three extinctions can be had: here 0.1, 1 and 3 of 3.
        let [r, g, b] = met_shares([29.0 / 30.0, 2.0 / 3.0, 0.0], 29.0 / 30.0).map(|share| 3.0 * share);
        assert!((r - 0.1).abs() < 1e-9 && (g - 1.0).abs() < 1e-9 && b == 3.0, "{r} {g} {b}");
        // What is nearly black has nearly no hue.
        assert!(met_shares([0.001, 0.0, 0.0], 1.0)[0] > 0.97);
    }

    #[test]
    fn nothing_transmitted_is_all_of_the_extinction() {
        for color in [[0.2, 0.7, 0.1], [1.0, 0.0, 0.3]] {
            assert_eq!(met_shares(color, 0.0), [1.0; 3]);
        }
    }
}
