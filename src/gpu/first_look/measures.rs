//! Figures of pictures: of linear, premultiplied light, over the pixels that show something.

/// Opacity from which a pixel counts as seen.
const SEEN: f32 = 0.5;

/// Linear luminance below which material counts as nearly black: a tenth of the way to white as displayed (25 of 255),
/// where details can no longer be told apart beside bright parts.
const NEARLY_BLACK: f64 = 0.01;

/// Share of its light that a pixel must have lost to shadows to count as shadowed.
const SHADOWED: f64 = 0.3;

/// The luminance that an automatic exposure gives half of what is seen: a little above the 18 % that photographers
/// expose for, as volumes lie before a dark background.
const USUAL_MEDIAN: f64 = 0.20;

/// How far an automatic exposure goes for that: half a stop down, not quite one up. Beyond that the look is at fault, and
/// what is dark on purpose stays dark.
const EXPOSURE_RANGE: (f64, f64) = (0.7, 1.8);

/// The share of what is seen that an automatic exposure keeps below a luminance just before the tone map's shoulder ends
/// all differences.
const BRIGHT_SHARE: f64 = 0.98;
const BRIGHT: f64 = 0.9;

/// Linear luminance (Rec. 709) of a texel.
pub(super) fn luminance([r, g, b, _]: &[f32; 4]) -> f64 {
    0.2126 * f64::from(*r) + 0.7152 * f64::from(*g) + 0.0722 * f64::from(*b)
}

/// Whether a pixel shows something.
pub(super) fn is_seen(texel: &[f32; 4]) -> bool {
    texel[3] > SEEN
}

/// Luminance of the material in a pixel: however much of the background is seen through it.
pub(super) fn material_luminance(texel: &[f32; 4]) -> f64 {
    luminance(texel) / f64::from(texel[3]).max(1e-6)
}

/// Mean linear luminance (Rec. 709) of the pixels that show something; 0 when none does.
pub fn mean_luminance(light: &[[f32; 4]]) -> f64 {
    mean(light, luminance)
}

/// The share of the pixels that show something in which that is nearly black with an exposure; 0 when none shows any.
pub fn dark_share(light: &[[f32; 4]], exposure: f64) -> f64 {
    mean(light, |texel| f64::from(u8::from(exposure * material_luminance(texel) < NEARLY_BLACK)))
}

/// The share of a picture's pixels that show something.
pub fn seen_share(light: &[[f32; 4]]) -> f64 {
    let seen = light.iter().filter(|texel| is_seen(texel)).count();
    seen as f64 / light.len().max(1) as f64
}

/// Of the pixels that show something, the share that shadows darken by 30 % or more: `with` and `without` them.
pub fn shadowed_share(with: &[[f32; 4]], without: &[[f32; 4]]) -> f64 {
    let seen = with.iter().zip(without).filter(|(texel, _)| is_seen(texel));
    let (dark, count) = seen.fold((0usize, 0usize), |(dark, count), (with, without)| {
        let is_dark = luminance(with) < (1.0 - SHADOWED) * luminance(without);
        (dark + usize::from(is_dark), count + 1)
    });
    dark as f64 / count.max(1) as f64
}

/// The exposure that gives what is seen in a picture its usual brightness, as far as nothing becomes too bright; 1 when
/// nothing is seen, or only black.
pub fn exposure_for(light: &[[f32; 4]]) -> f64 {
    let mut seen: Vec<f64> = light
        .iter()
        .filter(|texel| is_seen(texel))
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
    let (median, bright) = (at(0.5), at(BRIGHT_SHARE));
    if bright <= 0.0 {
        return 1.0;
    }
    let wanted = (USUAL_MEDIAN / median).clamp(EXPOSURE_RANGE.0, EXPOSURE_RANGE.1);
    wanted.min(BRIGHT / bright)
}

/// The mean over the pixels that show something.
fn mean(light: &[[f32; 4]], value: impl Fn(&[f32; 4]) -> f64) -> f64 {
    let seen = light.iter().filter(|texel| is_seen(texel));
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
        assert!((shadowed_share(&with, &without) - 1.0 / 3.0).abs() < 1e-12);
        assert!((seen_share(&with) - 0.75).abs() < 1e-12);
        assert_eq!(shadowed_share(&[], &[]), 0.0);
    }

    #[test]
    fn darkness_is_the_share_of_what_is_seen() {
        let texel = |grey: f32, alpha: f32| [grey * alpha, grey * alpha, grey * alpha, alpha];
        // Lit, dark, dark but hardly there, lit haze, nothing.
        let light = [texel(0.5, 1.0), texel(0.009, 0.9), texel(0.0, 0.4), texel(0.3, 0.6), [0.0; 4]];
        assert!((dark_share(&light, 1.0) - 1.0 / 3.0).abs() < 1e-12);
        assert_eq!(dark_share(&light, 1.2), 0.0, "exposed a little longer");
        assert_eq!(dark_share(&[[0.0; 4]; 3], 1.0), 0.0);
        assert_eq!(
            dark_share(&[texel(0.011, 0.9)], 1.0),
            0.0,
            "it is the material's darkness, not its thinness"
        );
    }

    #[test]
    fn exposures_bring_the_median_to_its_place() {
        let even = |value: f32| vec![grey(value); 99];
        assert!((exposure_for(&even(0.2)) - 1.0).abs() < 1e-6);
        assert!((exposure_for(&even(0.16)) - 1.25).abs() < 1e-6);
        assert!((exposure_for(&even(0.25)) - 0.8).abs() < 1e-6);
        assert_eq!(exposure_for(&even(0.01)), 1.8, "what is dark is not made up");
        assert_eq!(exposure_for(&even(0.9)), 0.7);
        // A tenth is bright: not beyond 0.9, whatever the median.
        let mut bright = even(0.12);
        bright.iter_mut().take(10).for_each(|texel| *texel = grey(0.75));
        assert!((exposure_for(&bright) - 1.2).abs() < 1e-6);
        // What is hardly there does not count, nor does the background that is seen through the rest.
        let mut half = vec![[0.12, 0.12, 0.12, 0.6]; 9];
        half.extend(vec![[0.4, 0.4, 0.4, 0.4]; 90]);
        assert!((exposure_for(&half) - 1.0).abs() < 1e-6);
        assert_eq!((exposure_for(&[]), exposure_for(&even(0.0))), (1.0, 1.0));
    }
}
