//! Image statistics of linear, premultiplied light, over visible pixels.

/// Opacity from which a pixel counts as visible.
const VISIBLE_OPACITY: f32 = 0.5;

/// Linear luminance below which material counts as nearly black: a tenth of the displayed range (25 of 255), where
/// details can no longer be distinguished beside bright parts.
const NEARLY_BLACK: f64 = 0.01;

/// Fraction of its light that a pixel must lose to shadows to count as shadowed.
const SHADOWED_LOSS: f64 = 0.3;

/// Target of the automatic exposure for the median luminance: half a stop above the 18 % that photographers expose
/// for, because the background is dark.
const TARGET_MEDIAN: f64 = 0.26;

/// Range of the automatic exposure: half a stop down, not quite one up. Beyond that the settings are at fault, and
/// intentionally dark pictures stay dark.
const EXPOSURE_RANGE: (f64, f64) = (0.7, 1.8);

/// Fraction of visible pixels that the automatic exposure keeps below the luminance `MAX_BRIGHT_LUMINANCE`, above
/// which the shoulder of the tone map removes all differences.
const BRIGHT_QUANTILE: f64 = 0.98;
const MAX_BRIGHT_LUMINANCE: f64 = 0.9;

/// Returns the linear luminance (Rec. 709) of a texel.
pub(super) fn luminance([r, g, b, _]: &[f32; 4]) -> f64 {
    0.2126 * f64::from(*r) + 0.7152 * f64::from(*g) + 0.0722 * f64::from(*b)
}

/// Returns true if a pixel counts as visible.
pub(super) fn is_visible(texel: &[f32; 4]) -> bool {
    texel[3] > VISIBLE_OPACITY
}

/// Returns the luminance of the material in a pixel, without the share of the background.
pub(super) fn material_luminance(texel: &[f32; 4]) -> f64 {
    luminance(texel) / f64::from(texel[3]).max(1e-6)
}

/// Returns the mean linear luminance (Rec. 709) of the visible pixels; 0 if there are none.
pub fn mean_luminance(light: &[[f32; 4]]) -> f64 {
    visible_mean(light, luminance)
}

/// Returns the fraction of visible pixels that are nearly black with an exposure; 0 if none is visible.
pub fn dark_fraction(light: &[[f32; 4]], exposure: f64) -> f64 {
    visible_mean(light, |texel| f64::from(u8::from(exposure * material_luminance(texel) < NEARLY_BLACK)))
}

/// Returns the fraction of pixels that are visible.
pub fn visible_fraction(light: &[[f32; 4]]) -> f64 {
    let seen = light.iter().filter(|texel| is_visible(texel)).count();
    seen as f64 / light.len().max(1) as f64
}

/// Returns the fraction of visible pixels that shadows darken by 30 % or more, from pictures with and without
/// shadows.
pub fn shadowed_fraction(with: &[[f32; 4]], without: &[[f32; 4]]) -> f64 {
    let seen = with.iter().zip(without).filter(|(texel, _)| is_visible(texel));
    let (dark, count) = seen.fold((0usize, 0usize), |(dark, count), (with, without)| {
        let is_dark = luminance(with) < (1.0 - SHADOWED_LOSS) * luminance(without);
        (dark + usize::from(is_dark), count + 1)
    });
    dark as f64 / count.max(1) as f64
}

/// Returns the exposure that brings the median of the visible pixels to its target, unless the brightest would exceed
/// their limit; 1 if nothing is visible, or only black.
pub fn automatic_exposure(light: &[[f32; 4]]) -> f64 {
    let mut seen: Vec<f64> = light
        .iter()
        .filter(|texel| is_visible(texel))
        .map(material_luminance)
        .filter(|y| y.is_finite())
        .collect();
    if seen.is_empty() {
        return 1.0;
    }
    let mut at = |share: f64| {
        let place = (share * (seen.len() - 1) as f64).round() as usize;
        *seen.select_nth_unstable_by(place, f64::total_cmp).1
    };
    let (median, bright) = (at(0.5), at(BRIGHT_QUANTILE));
    if bright <= 0.0 {
        return 1.0;
    }
    let wanted = (TARGET_MEDIAN / median).clamp(EXPOSURE_RANGE.0, EXPOSURE_RANGE.1);
    wanted.min(MAX_BRIGHT_LUMINANCE / bright)
}

/// Returns the mean of a value over the visible pixels; 0 if there are none.
fn visible_mean(light: &[[f32; 4]], value: impl Fn(&[f32; 4]) -> f64) -> f64 {
    let seen = light.iter().filter(|texel| is_visible(texel));
    let (sum, count) = seen.fold((0.0, 0usize), |(sum, count), texel| (sum + value(texel), count + 1));
    if count == 0 { 0.0 } else { sum / count as f64 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(value: f32) -> [f32; 4] {
        [value, value, value, 1.0]
    }

    #[test]
    fn shadows_are_the_share_that_they_darken() {
        let without = [grey(0.5), grey(0.5), grey(0.5), [0.5, 0.5, 0.5, 0.1]];
        let with = [grey(0.5), grey(0.3), grey(0.4), [0.0, 0.0, 0.0, 0.1]];
        assert!((shadowed_fraction(&with, &without) - 1.0 / 3.0).abs() < 1e-12);
        assert!((visible_fraction(&with) - 0.75).abs() < 1e-12);
        assert_eq!(shadowed_fraction(&[], &[]), 0.0);
    }

    #[test]
    fn darkness_is_the_share_of_what_is_seen() {
        let texel = |grey: f32, alpha: f32| [grey * alpha, grey * alpha, grey * alpha, alpha];
        // Lit, dark, dark but barely opaque, lit haze, empty.
        let light = [texel(0.5, 1.0), texel(0.009, 0.9), texel(0.0, 0.4), texel(0.3, 0.6), [0.0; 4]];
        assert!((dark_fraction(&light, 1.0) - 1.0 / 3.0).abs() < 1e-12);
        assert_eq!(dark_fraction(&light, 1.2), 0.0, "exposed a little longer");
        assert_eq!(dark_fraction(&[[0.0; 4]; 3], 1.0), 0.0);
        assert_eq!(
            dark_fraction(&[texel(0.011, 0.9)], 1.0),
            0.0,
            "it is the material's darkness, not its thinness"
        );
    }

    #[test]
    fn exposures_bring_the_median_to_its_place() {
        let even = |value: f32| vec![grey(value); 99];
        assert!((automatic_exposure(&even(0.26)) - 1.0).abs() < 1e-6);
        assert!((automatic_exposure(&even(0.208)) - 1.25).abs() < 1e-6);
        assert!((automatic_exposure(&even(0.325)) - 0.8).abs() < 1e-6);
        assert_eq!(automatic_exposure(&even(0.01)), 1.8, "what is dark is not made up");
        assert_eq!(automatic_exposure(&even(0.9)), 0.7);
        // A tenth is bright: limited to 0.9, whatever the median.
        let mut bright = even(0.12);
        bright.iter_mut().take(10).for_each(|texel| *texel = grey(0.75));
        assert!((automatic_exposure(&bright) - 1.2).abs() < 1e-6);
        // Barely opaque pixels do not count, nor does the background seen through the others.
        let mut half = vec![[0.156, 0.156, 0.156, 0.6]; 9];
        half.extend(vec![[0.4, 0.4, 0.4, 0.4]; 90]);
        assert!((automatic_exposure(&half) - 1.0).abs() < 1e-6);
        assert_eq!((automatic_exposure(&[]), automatic_exposure(&even(0.0))), (1.0, 1.0));
    }
}
