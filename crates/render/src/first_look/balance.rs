//! Brightness of a first look: the balance of lights, which compensates for shadows, and the exposure.

use super::image_statistics::{automatic_exposure, mean_luminance};
use crate::{GpuError, RenderOptions, Renderer, WorkOptions};
use chiaroscuro_scene::{
    RenderEngine, SceneAxis, Settings, ShadowAlgorithm,
    first_look::{self, FirstLookOptions},
};
use chiaroscuro_volume::Dataset;

/// Size of the pictures from which brightness is measured and lights are chosen, in pixels: means over some thousand of
/// them. With 160 × 120 pixels twelve of fourteen volumes get the same light, and the others one that is worth as much
/// within 0.3 bits; with 80 × 60 pixels seven get another.
pub(super) const MEASURED_SIZE: [u32; 2] = [120, 90];

/// Range of the balance; results outside it are due to the settings, not to shadows.
const BALANCE_RANGE: (f64, f64) = (0.1, 20.0);

/// Returns the automatic settings of a volume, without the slower steps ([`super::complete_first_look`]).
///
/// Lights are balanced so that shadows do not darken the picture, and the picture is exposed. Uploads the volume and
/// fills the light volumes.
///
/// # Errors
/// Returns an error if the device fails or memory is exhausted.
pub fn first_look(renderer: &mut Renderer, dataset: &Dataset) -> Result<Settings, GpuError> {
    first_look_upright(renderer, dataset, None)
}

/// Returns the automatic settings like [`first_look()`], with the axis `up` of the scene pointing up, unless the file
/// of the volume gives an orientation; `None` for the axis that the object suggests.
///
/// # Errors
/// Returns an error if the device fails or memory is exhausted.
pub fn first_look_upright(
    renderer: &mut Renderer,
    dataset: &Dataset,
    up: Option<SceneAxis>,
) -> Result<Settings, GpuError> {
    let wishes = FirstLookOptions { up, ..FirstLookOptions::default() };
    let mut settings = first_look::first_settings_with(dataset.volume(), dataset.histogram(), wishes);
    let pictures = BrightnessPictures::draw(renderer, dataset, &settings)?;
    settings.shadows.balance = pictures.balance();
    settings.output.exposure = pictures.exposure(&settings);
    settings.sanitise();
    Ok(settings)
}

/// Returns the factor for lights that makes the picture with shadows as bright as without.
///
/// # Errors
/// Returns an error if the device fails or memory is exhausted.
pub fn measure_balance(
    renderer: &mut Renderer,
    dataset: &Dataset,
    settings: &Settings,
) -> Result<f64, GpuError> {
    Ok(BrightnessPictures::draw(renderer, dataset, settings)?.balance())
}

/// Returns the factor of [`measure_balance`], measured with the fastest shadow algorithm and engine, on which
/// brightness hardly depends.
///
/// # Errors
/// Returns an error if the device fails or memory is exhausted.
pub fn measure_balance_fast(
    renderer: &mut Renderer,
    dataset: &Dataset,
    settings: &Settings,
) -> Result<f64, GpuError> {
    measure_balance(renderer, dataset, &with_fast_shadows(settings))
}

/// Returns the settings with light volumes for shadows, and with the gathering engine.
pub(super) fn with_fast_shadows(settings: &Settings) -> Settings {
    let mut measured = settings.clone();
    measured.sampling.engine = RenderEngine::Gather;
    if !measured.shadows.algorithm.has_volume() {
        measured.shadows.algorithm = ShadowAlgorithm::Splat;
    }
    measured
}

/// Linear light of three small pictures, from which the parts of the light follow.
pub(super) struct BrightnessPictures {
    /// Picture with shadows and a balance of 1.
    shadowed: Vec<[f32; 4]>,
    /// Picture without shadows.
    pub(super) unshadowed: Vec<[f32; 4]>,
    /// Picture without lights.
    pub(super) unlit: Vec<[f32; 4]>,
}

impl BrightnessPictures {
    /// Draws the three pictures of a volume with these settings.
    pub(super) fn draw(
        renderer: &mut Renderer,
        dataset: &Dataset,
        settings: &Settings,
    ) -> Result<Self, GpuError> {
        let settings = &*settings.as_lit();
        let mut unlit_settings = settings.clone();
        (unlit_settings.shading.diffuse, unlit_settings.shading.specular) = (0.0, 0.0);
        // Lights without colour do not contribute scattered light, either.
        unlit_settings.lights.iter_mut().for_each(|light| light.color = [0.0; 3]);
        let unlit = draw_small_picture(renderer, dataset, &unlit_settings)?;
        Self::draw_lit(renderer, dataset, settings, unlit)
    }

    /// Draws the pictures with and without shadows; `unlit` is the known picture without lights.
    pub(super) fn draw_lit(
        renderer: &mut Renderer,
        dataset: &Dataset,
        settings: &Settings,
        unlit: Vec<[f32; 4]>,
    ) -> Result<Self, GpuError> {
        let mut shadowed = settings.as_lit().into_owned();
        shadowed.shadows.balance = 1.0;
        let unshadowed = without_shadows(&shadowed);
        let with = draw_small_picture(renderer, dataset, &shadowed)?;
        let without = draw_small_picture(renderer, dataset, &unshadowed)?;
        Ok(Self { shadowed: with, unshadowed: without, unlit })
    }

    /// Returns the factor for lights that makes the picture with shadows as bright as without. Mean linear luminance
    /// over visible pixels is `ambient + factor · direct`; the plain ratio of both would be too small by the ambient
    /// share.
    pub(super) fn balance(&self) -> f64 {
        let [with, without, unlit] =
            [&self.shadowed, &self.unshadowed, &self.unlit].map(|light| mean_luminance(light));
        let factor = (without - unlit) / (with - unlit);
        if factor.is_finite() { factor.clamp(BALANCE_RANGE.0, BALANCE_RANGE.1) } else { 1.0 }
    }

    /// Returns the automatic exposure of these pictures with the balance of `settings`; 1 for colours that no light
    /// changes, which are shown as they are.
    pub(super) fn exposure(&self, settings: &Settings) -> f64 {
        let shading = &settings.shading;
        if shading.diffuse == 0.0 && shading.specular == 0.0 {
            return 1.0;
        }
        automatic_exposure(&self.with_balance(settings.shadows.balance))
    }

    /// Returns the picture with shadows and a balance.
    pub(super) fn with_balance(&self, balance: f64) -> Vec<[f32; 4]> {
        let factor = balance as f32;
        let texels = self.shadowed.iter().zip(&self.unlit);
        texels
            .map(|(with, unlit)| {
                std::array::from_fn(
                    |c| if c < 3 { unlit[c] + factor * (with[c] - unlit[c]) } else { with[c] },
                )
            })
            .collect()
    }
}

/// Returns the settings without shadows, with the same pipelines where possible: each takes about a second to compile
/// on software adapters, and nothing else needs it.
fn without_shadows(settings: &Settings) -> Settings {
    let mut unshadowed = settings.clone();
    // Scattered light depends on shadows.
    unshadowed.scattering.bounces = 0;
    // Light volumes also contain the cones of lights.
    if settings.lights.iter().any(|light| light.hood.on) {
        unshadowed.shadows.algorithm = ShadowAlgorithm::Off;
    } else {
        unshadowed.shadows.strength = 0.0;
    }
    unshadowed
}

/// Returns the linear light of a small picture without the floor. Drawn as a preview, so that it can reuse the light
/// volumes of larger pictures, and from samples at points, so that it uses their shaders, too: on software adapters
/// each takes up to half a second to compile.
fn draw_small_picture(
    renderer: &mut Renderer,
    dataset: &Dataset,
    settings: &Settings,
) -> Result<Vec<[f32; 4]>, GpuError> {
    let options =
        RenderOptions::from(WorkOptions { preview: true, point_samples: true, ..WorkOptions::default() });
    let mut settings = settings.clone();
    settings.floor.on = false;
    renderer.draw(dataset, &settings, MEASURED_SIZE, &options)?;
    renderer.read_light()
}
