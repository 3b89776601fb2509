//! Categorical colours for labels: each is as different as possible from all before it (Glasbey, van der Heijden, Toh
//! & Gray 2007), in Oklab, and all are nearly equally light.

use std::sync::OnceLock;

use crate::{lab_from_lch, linear_from_oklab, oklab_from_linear, srgb_from_lch};

/// Number of different colours; they repeat for larger label numbers. The closest two are 0.015 apart in Oklab (a
/// test measures it), which is hardly distinguishable side by side: more would be indistinguishable.
const COLOR_COUNT: usize = 256;

/// Mean lightness, about that of the other palettes in their middle, and the deviation of some colours, which allows
/// for more of them: less than the difference between light and a shadow with the ambient share of 0.15.
const LIGHTNESS: f64 = 0.76;
const LIGHTNESS_SPREAD: f64 = 0.07;

/// Chroma of the strongest colours, which sRGB has at this lightness for some hues only; colours outside the gamut
/// are left out.
const MAX_CHROMA: f64 = 0.17;

/// Returns the colour of a label, which depends only on its number.
pub fn label_color(number: i64) -> [f32; 3] {
    static COLORS: OnceLock<Vec<[f32; 3]>> = OnceLock::new();
    let colors = COLORS.get_or_init(|| farthest_point_colors().into_iter().map(srgb_from_lch).collect());
    // Zero is background: labels begin at one.
    let index = (number - 1).rem_euclid(COLOR_COUNT as i64) as usize;
    colors.get(index).copied().unwrap_or([0.8; 3])
}

/// Returns colours as lightness, chroma and hue, by farthest-point selection.
fn farthest_point_colors() -> Vec<[f64; 3]> {
    // Two hundred hues, eight chromas and five lightnesses are a finer grid than the distance of any two colours.
    let candidates: Vec<[f64; 3]> = (0..5)
        .flat_map(|l| (0..8).flat_map(move |c| (0..200).map(move |h| (l, c, h))))
        .map(|(l, c, h)| {
            let lightness = LIGHTNESS + LIGHTNESS_SPREAD * (f64::from(l) / 2.0 - 1.0);
            [lightness, MAX_CHROMA * f64::from(c) / 7.0, 1.8 * f64::from(h)]
        })
        .filter(|&lch| is_in_gamut(lch))
        .collect();
    let labs: Vec<[f64; 3]> = candidates.iter().map(|&lch| lab_from_lch(lch)).collect();
    let mut nearest = vec![f64::INFINITY; labs.len()];
    // The first is a light blue, which is not mistaken for a light or for flesh.
    let first =
        candidates.iter().map(|lch| (lch[2] - 245.0).abs() - 100.0 * lch[1] + (lch[0] - LIGHTNESS).abs());
    let mut at = first.enumerate().min_by(|(_, a), (_, b)| a.total_cmp(b)).map_or(0, |(at, _)| at);
    let mut chosen = Vec::new();
    while chosen.len() < COLOR_COUNT.min(labs.len()) {
        chosen.push(candidates[at]);
        for (distance, lab) in nearest.iter_mut().zip(&labs) {
            let apart = (0..3).map(|i| (lab[i] - labs[at][i]).powi(2)).sum::<f64>();
            *distance = distance.min(apart);
        }
        let farthest = nearest.iter().enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b));
        at = farthest.map_or(0, |(at, _)| at);
    }
    chosen
}

/// Returns true if a colour lies in the sRGB gamut: clipping changes it by less than a thousandth, far less than the
/// distance of any two colours.
fn is_in_gamut(lch: [f64; 3]) -> bool {
    let lab = lab_from_lch(lch);
    let back = oklab_from_linear(linear_from_oklab(lab));
    lab.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-3)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
        let (a, b) = (lab_from_lch(a), lab_from_lch(b));
        (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
    }

    #[test]
    fn labels_are_told_apart_and_equally_light() {
        let colors = farthest_point_colors();
        assert_eq!(colors.len(), COLOR_COUNT);
        for (count, least) in [(8, 0.13), (16, 0.08), (40, 0.045), (COLOR_COUNT, 0.015)] {
            let nearest = (0..count)
                .flat_map(|a| (0..a).map(move |b| (a, b)))
                .map(|(a, b)| apart(colors[a], colors[b]))
                .fold(f64::INFINITY, f64::min);
            assert!(nearest > least, "{count} colours: {nearest}");
        }
        assert!(colors.iter().all(|lch| (lch[0] - LIGHTNESS).abs() < LIGHTNESS_SPREAD + 1e-9));
    }

    #[test]
    fn numbers_have_their_colors() {
        assert_eq!(label_color(5), label_color(5));
        assert_ne!(label_color(1), label_color(2));
        for number in [i64::MIN + 1, -1, 0, 1 << 40, i64::MAX] {
            assert!(label_color(number).iter().all(|c| (0.0..=1.0).contains(c)));
        }
    }
}
