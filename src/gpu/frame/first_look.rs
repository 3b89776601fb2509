//! What happens once when a volume is opened: automatic settings, and *Balance*.

use crate::data::Dataset;
use crate::gpu::{GpuError, RenderOptions, Renderer};
use crate::model::auto::{self, Wishes};
use crate::model::{Engine, SceneAxis, Settings, ShadowAlgorithm};

/// Size of the pictures from which brightness is measured: means over some thousand pixels.
const MEASURED_SIZE: [u32; 2] = [160, 120];

/// Opacity from which a pixel counts as seen.
const SEEN: f32 = 0.5;

/// Balance stays within this factor: beyond it the settings are at fault, not the shadows.
const BALANCE_RANGE: (f64, f64) = (0.1, 20.0);

/// Settings for a volume that nobody has touched: automatic, and balanced so that shadows do not
/// make the picture darker. Uploads the volume and fills the light volumes on the way.
///
/// # Errors
/// When the GPU cannot do it.
pub fn first_look(renderer: &mut Renderer, dataset: &Dataset) -> Result<Settings, GpuError> {
    first_look_upright(renderer, dataset, SceneAxis::default())
}

/// As [`first_look`], of a volume of which an axis of the scene points up, unless its file says what does.
///
/// # Errors
/// When the GPU cannot do it.
pub fn first_look_upright(
    renderer: &mut Renderer,
    dataset: &Dataset,
    up: SceneAxis,
) -> Result<Settings, GpuError> {
    let mut settings =
        auto::first_settings_with(dataset.volume(), dataset.histogram(), Wishes { up, ..Wishes::default() });
    settings.shadows.balance = balance(renderer, dataset, &settings)?;
    Ok(settings)
}

/// The factor for the lights that makes the picture with shadows as bright as without.
///
/// Mean linear luminance over what is seen is `ambient + factor · direct`; three small pictures
/// give the parts: with shadows, without, and without lights. The plain ratio of the first two
/// would fall short by the ambient share.
///
/// # Errors
/// When the GPU cannot do it.
pub fn balance(renderer: &mut Renderer, dataset: &Dataset, settings: &Settings) -> Result<f64, GpuError> {
    let mut shadowed = settings.clone();
    shadowed.shadows.balance = 1.0;
    let mut unshadowed = shadowed.clone();
    unshadowed.shadows.algorithm = ShadowAlgorithm::Off;
    let mut dark = unshadowed.clone();
    for light in &mut dark.lights {
        light.intensity = 0.0;
    }
    let mut brightness = |settings: &Settings| -> Result<f64, GpuError> {
        // As a preview, it makes do with the light volumes of larger pictures.
        let options = RenderOptions { preview: true, ..RenderOptions::default() };
        let picture = renderer.render(dataset, settings, MEASURED_SIZE, &options)?;
        Ok(mean_luminance(&picture.light))
    };
    let with = brightness(&shadowed)?;
    let (without, ambient) = (brightness(&unshadowed)?, brightness(&dark)?);
    let factor = (without - ambient) / (with - ambient);
    Ok(if factor.is_finite() { factor.clamp(BALANCE_RANGE.0, BALANCE_RANGE.1) } else { 1.0 })
}

/// As [`balance`], by the quickest way to light and picture, whichever the settings go: how bright a picture is hardly
/// depends on it.
///
/// # Errors
/// When the GPU cannot do it.
pub fn balance_quickly(
    renderer: &mut Renderer,
    dataset: &Dataset,
    settings: &Settings,
) -> Result<f64, GpuError> {
    let mut measured = settings.clone();
    measured.sampling.engine = Engine::Gather;
    if !measured.shadows.algorithm.has_volume() {
        measured.shadows.algorithm = ShadowAlgorithm::Splat;
    }
    balance(renderer, dataset, &measured)
}

/// Linear luminance below which material counts as nearly black: a tenth of the way to white as
/// displayed (25 of 255), where details can no longer be told apart beside bright parts.
const NEARLY_BLACK: f64 = 0.01;

/// Mean linear luminance (Rec. 709) of the pixels that show something; 0 when none does.
pub fn mean_luminance(light: &[[f32; 4]]) -> f64 {
    mean(light, luminance)
}

/// The share of the pixels that show something in which that is nearly black; 0 when none shows any.
pub fn dark_share(light: &[[f32; 4]]) -> f64 {
    mean(light, |texel| f64::from(u8::from(luminance(texel) < NEARLY_BLACK * f64::from(texel[3]))))
}

/// The share of a picture's pixels that show something.
pub fn seen_share(light: &[[f32; 4]]) -> f64 {
    let seen = light.iter().filter(|texel| texel[3] > SEEN).count();
    seen as f64 / light.len().max(1) as f64
}

/// Share of its light that a pixel must have lost to shadows to count as shadowed.
const SHADOWED: f64 = 0.3;

/// Of the pixels that show something, the share that shadows darken by 30 % or more: `with` and `without` them.
pub fn shadowed_share(with: &[[f32; 4]], without: &[[f32; 4]]) -> f64 {
    let seen = with.iter().zip(without).filter(|(texel, _)| texel[3] > SEEN);
    let (dark, count) = seen.fold((0usize, 0usize), |(dark, count), (with, without)| {
        let is_dark = luminance(with) < (1.0 - SHADOWED) * luminance(without);
        (dark + usize::from(is_dark), count + 1)
    });
    dark as f64 / count.max(1) as f64
}

/// The mean over the pixels that show something.
fn mean(light: &[[f32; 4]], value: impl Fn(&[f32; 4]) -> f64) -> f64 {
    let seen = light.iter().filter(|texel| texel[3] > SEEN);
    let (sum, count) = seen.fold((0.0, 0usize), |(sum, count), texel| (sum + value(texel), count + 1));
    if count == 0 { 0.0 } else { sum / count as f64 }
}

fn luminance([r, g, b, _]: &[f32; 4]) -> f64 {
    0.2126 * f64::from(*r) + 0.7152 * f64::from(*g) + 0.0722 * f64::from(*b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shadows_are_the_share_that_they_darken() {
        let grey = |value: f32| [value, value, value, 1.0];
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
        assert!((dark_share(&light) - 1.0 / 3.0).abs() < 1e-12);
        assert_eq!(dark_share(&[[0.0; 4]; 3]), 0.0);
        assert_eq!(dark_share(&[texel(0.011, 0.9)]), 0.0, "it is the material's darkness, not its thinness");
    }
}
