//! How bright a picture is: *Balance*, which makes it as bright as without shadows, and the exposure of a first look.

use super::measures::{exposure_for, mean_luminance};
use crate::data::Dataset;
use crate::gpu::{GpuError, RenderOptions, Renderer};
use crate::model::auto::{self, Wishes};
use crate::model::{Engine, SceneAxis, Settings, ShadowAlgorithm};

/// Size of the pictures from which brightness is measured: means over some thousand pixels.
pub(super) const MEASURED_SIZE: [u32; 2] = [160, 120];

/// Balance stays within this factor: beyond it the settings are at fault, not the shadows.
const BALANCE_RANGE: (f64, f64) = (0.1, 20.0);

/// Settings for a volume that nobody has touched, but for what takes longer ([`super::finish_look`]).
///
/// They are automatic, balanced so that shadows do not make the picture darker, and exposed. Uploads the volume and fills
/// the light volumes on the way.
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
    let wishes = Wishes { up, ..Wishes::default() };
    let mut settings = auto::first_settings_with(dataset.volume(), dataset.histogram(), wishes);
    let seen = SmallPictures::of(renderer, dataset, &settings)?;
    settings.shadows.balance = seen.balance();
    settings.output.exposure = exposure_for(&seen.balanced(settings.shadows.balance));
    settings.sanitise();
    Ok(settings)
}

/// The factor for the lights that makes the picture with shadows as bright as without.
///
/// # Errors
/// When the GPU cannot do it.
pub fn balance(renderer: &mut Renderer, dataset: &Dataset, settings: &Settings) -> Result<f64, GpuError> {
    Ok(SmallPictures::of(renderer, dataset, settings)?.balance())
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
    balance(renderer, dataset, &with_quick_shadows(settings))
}

/// The settings with light volumes for shadows, and gathered sheets.
pub(super) fn with_quick_shadows(settings: &Settings) -> Settings {
    let mut measured = settings.clone();
    measured.sampling.engine = Engine::Gather;
    if !measured.shadows.algorithm.has_volume() {
        measured.shadows.algorithm = ShadowAlgorithm::Splat;
    }
    measured
}

/// Linear light of three small pictures, which give its parts.
pub(super) struct SmallPictures {
    /// With shadows as they are without a balance.
    with: Vec<[f32; 4]>,
    /// Without shadows.
    pub(super) without: Vec<[f32; 4]>,
    /// Without lights.
    pub(super) unlit: Vec<[f32; 4]>,
}

impl SmallPictures {
    /// Of a look of a volume.
    pub(super) fn of(
        renderer: &mut Renderer,
        dataset: &Dataset,
        settings: &Settings,
    ) -> Result<Self, GpuError> {
        let mut dark = settings.clone();
        (dark.shading.diffuse, dark.shading.specular) = (0.0, 0.0);
        // Nor does their light bounce.
        dark.lights.iter_mut().for_each(|light| light.color = [0.0; 3]);
        let unlit = small_picture(renderer, dataset, &dark)?;
        Self::before(renderer, dataset, settings, unlit)
    }

    /// Of a look of a volume of which it is known what it is like without lights.
    pub(super) fn before(
        renderer: &mut Renderer,
        dataset: &Dataset,
        settings: &Settings,
        unlit: Vec<[f32; 4]>,
    ) -> Result<Self, GpuError> {
        let mut shadowed = settings.clone();
        shadowed.shadows.balance = 1.0;
        let unshadowed = without_shadows(&shadowed);
        let with = small_picture(renderer, dataset, &shadowed)?;
        let without = small_picture(renderer, dataset, &unshadowed)?;
        Ok(Self { with, without, unlit })
    }

    /// The factor for the lights that makes the first as bright as the second. Mean linear luminance over what is seen
    /// is `ambient + factor · direct`; the plain ratio of the two would fall short by the ambient share.
    pub(super) fn balance(&self) -> f64 {
        let [with, without, unlit] =
            [&self.with, &self.without, &self.unlit].map(|light| mean_luminance(light));
        let factor = (without - unlit) / (with - unlit);
        if factor.is_finite() { factor.clamp(BALANCE_RANGE.0, BALANCE_RANGE.1) } else { 1.0 }
    }

    /// The picture with shadows and a balance.
    pub(super) fn balanced(&self, balance: f64) -> Vec<[f32; 4]> {
        let factor = balance as f32;
        let texels = self.with.iter().zip(&self.unlit);
        texels
            .map(|(with, unlit)| {
                std::array::from_fn(
                    |c| if c < 3 { unlit[c] + factor * (with[c] - unlit[c]) } else { with[c] },
                )
            })
            .collect()
    }
}

/// The look without shadows; by the pipelines of the look itself, if that is so of them: each takes about a second to
/// compile on software adapters, and nothing else needs it.
fn without_shadows(settings: &Settings) -> Settings {
    let mut unshadowed = settings.clone();
    // What bounces comes out of shadows.
    unshadowed.scattering.bounces = 0;
    // Light volumes hold hoods, too.
    if settings.lights.iter().any(|light| light.hood.on) {
        unshadowed.shadows.algorithm = ShadowAlgorithm::Off;
    } else {
        unshadowed.shadows.strength = 0.0;
    }
    unshadowed
}

/// Linear light of a small picture, of which the floor is no part. As a preview, it makes do with the light volumes of
/// larger pictures.
fn small_picture(
    renderer: &mut Renderer,
    dataset: &Dataset,
    settings: &Settings,
) -> Result<Vec<[f32; 4]>, GpuError> {
    let options = RenderOptions { preview: true, ..RenderOptions::default() };
    let mut settings = settings.clone();
    settings.floor.on = false;
    renderer.draw(dataset, &settings, MEASURED_SIZE, &options)?;
    renderer.read_light()
}
