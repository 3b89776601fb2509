//! Quality controller: chooses how coarse a preview must be to keep up with the user.
//!
//! Pure arithmetic: it predicts milliseconds from the measured times of earlier batches and chooses the finest level
//! that fits the frame budget; the render worker carries it out.

use super::missing_light_volumes::MissingLightVolumes;
use chiaroscuro_render::plan::preview_slab;
use chiaroscuro_scene::{
    LightSimplification, LightVolumeResolution, ReconstructionKernel, RenderEngine, Settings, SlabMode,
};
use chiaroscuro_volume::math::SceneSpace;

/// Time budget of a preview during interaction, in milliseconds: a frame at 30 Hz.
const PREVIEW_BUDGET_MS: f64 = 33.0;
/// Time budget of a frame with a preview on a software adapter, in milliseconds; the window shares its processors.
const SOFTWARE_BUDGET_MS: f64 = 66.0;
/// Time that the window itself takes of each frame on a software adapter, in milliseconds.
const SOFTWARE_UI_MS: f64 = 26.0;
/// Number of bands into which a picture is divided on a software adapter, where one may take seconds: between bands
/// the render thread checks for new requests.
const SOFTWARE_BANDS: u32 = 16;
/// Pixels per band on a graphics card: far below the limits of driver watchdogs.
const BAND_PIXELS: u32 = 1 << 18;

/// Level of quality at which a request is rendered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct QualityLevel {
    /// Window pixels per rendered pixel along each axis.
    pub scale: u32,
    /// Resolution of light volumes that are not filled yet; `None` for the full one.
    pub light_resolution: Option<LightVolumeResolution>,
    /// True if the eye pass uses the prefiltered kernel.
    pub prefiltered_eye: bool,
    /// True if the light pass uses the prefiltered kernel.
    pub prefiltered_light: bool,
    /// True if edges are antialiased, as the look says.
    pub antialiased: bool,
    /// Parts of the light that are left out.
    pub simplification: LightSimplification,
}

impl QualityLevel {
    /// Full quality, except that edges are not antialiased.
    pub(crate) const FULL: Self = Self {
        scale: 1,
        light_resolution: None,
        prefiltered_eye: false,
        prefiltered_light: false,
        antialiased: false,
        simplification: LightSimplification::NONE,
    };
    /// Full quality with antialiased edges, as in exports.
    pub(crate) const ANTIALIASED: Self = Self { antialiased: true, ..Self::FULL };

    /// Returns true for full quality, whether or not edges are antialiased.
    pub(crate) fn is_full(self) -> bool {
        Self { antialiased: false, ..self } == Self::FULL
    }

    /// Returns the number of pixels to render for a viewport, along each axis.
    pub(crate) fn size(self, viewport: [u32; 2]) -> [u32; 2] {
        viewport.map(|n| n.div_ceil(self.scale).max(1))
    }

    /// Returns the settings with which a look is rendered at this level.
    pub(crate) fn settings(self, look: &Settings, scene: &SceneSpace, viewport: [u32; 2]) -> Settings {
        let mut settings = self.simplification.apply(look);
        if !self.is_full() {
            // The scattering engine is too slow during interaction.
            settings.sampling.engine = RenderEngine::Gather;
        }
        if self.prefiltered_eye {
            settings.sampling.kernel = ReconstructionKernel::Prefiltered;
            // Uniform slabs of that thickness would show stripes in thin parts.
            let slab = settings.equivalent_even_slab();
            settings.sampling.slabs = SlabMode::Preintegrated;
            settings.sampling.slab = preview_slab(&settings.camera, scene, self.size(viewport), slab);
        }
        if self.prefiltered_light {
            settings.shadows.kernel = ReconstructionKernel::Prefiltered;
        }
        settings
    }
}

/// Running estimate of a duration; the first measurement replaces the guess.
#[derive(Debug, Clone, Copy)]
struct DurationEstimate {
    ms: f64,
    measured: bool,
}

impl DurationEstimate {
    const fn guess(ms: f64) -> Self {
        Self { ms, measured: false }
    }

    fn scale(&mut self, factor: f64) {
        let factor = factor.clamp(0.02, 50.0);
        // Averages logarithms: an outlier changes little, a trend prevails.
        self.ms = (self.ms * if self.measured { factor.sqrt() } else { factor }).clamp(1e-9, 1e5);
        self.measured = true;
    }

    fn observe(&mut self, ms: f64) {
        self.scale(ms / self.ms);
    }
}

/// Controller that learns rendering times and chooses quality levels.
#[derive(Debug, Clone)]
pub(crate) struct QualityController {
    software: bool,
    /// Time budget per frame that the user has set, in milliseconds.
    frame_ms: Option<f64>,
    /// Time to fill a light volume, in milliseconds: by resolution (full, half, quarter), then exact or quick kernel.
    light_build: [[DurationEstimate; 2]; 3],
    /// Milliseconds per pixel of whole pictures: exact or quick kernel, then scale. In small pictures neighbouring
    /// rays share fewer of their reads, so their pixels cost more.
    eye_pixel: [[DurationEstimate; 3]; 2],
    /// True once a first picture was rendered, exact and quick: the first one's time includes compilation.
    warm: [bool; 2],
}

fn resolution_index(coarse: Option<LightVolumeResolution>) -> usize {
    match coarse.unwrap_or(LightVolumeResolution::Full) {
        LightVolumeResolution::Full => 0,
        LightVolumeResolution::Half => 1,
        LightVolumeResolution::Quarter => 2,
    }
}

fn scale_index(scale: u32) -> usize {
    scale.ilog2().min(2) as usize
}

impl QualityController {
    /// Creates a controller with cautious guesses for an adapter.
    pub(crate) fn new(software: bool) -> Self {
        let slow = if software { 20.0 } else { 1.0 };
        let build = |ms: f64| [DurationEstimate::guess(ms * slow), DurationEstimate::guess(ms * slow * 0.4)];
        Self {
            software,
            frame_ms: None,
            light_build: [build(400.0), build(60.0), build(10.0)],
            eye_pixel: [[1.0, 1.5, 2.3], [0.4, 0.6, 0.9]]
                .map(|row| row.map(|ms| DurationEstimate::guess(ms * slow * 2e-5))),
            warm: [false; 2],
        }
    }

    /// Discards all estimates, after a change of volume.
    pub(crate) fn reset(&mut self) {
        *self = Self { frame_ms: self.frame_ms, ..Self::new(self.software) };
    }

    /// Sets the time budget per frame during interaction, in milliseconds; `None` for the adapter's default.
    pub(crate) fn set_frame_ms(&mut self, frame_ms: Option<f64>) {
        self.frame_ms = frame_ms;
    }

    /// Returns the time budget of a preview, in milliseconds.
    fn budget_ms(&self) -> f64 {
        let usual = if self.software { SOFTWARE_BUDGET_MS } else { PREVIEW_BUDGET_MS };
        let window = if self.software { SOFTWARE_UI_MS } else { 0.0 };
        (self.frame_ms.unwrap_or(usual) - window).max(1.0)
    }

    /// Returns the number of pieces into which a chunk of the light pass is divided.
    pub(crate) fn light_parts(&self, quality: QualityLevel) -> u32 {
        // On a software adapter, half a chunk of a 256³ volume takes about 20 ms.
        if quality.is_full() && self.software { 2 } else { 1 }
    }

    /// Returns the number of rows per band for a picture of the given size.
    pub(crate) fn band_rows(&self, quality: QualityLevel, [width, height]: [u32; 2]) -> u32 {
        // Previews run to completion, so they need no bands.
        let whole = if self.software && quality.is_full() { height.div_ceil(SOFTWARE_BANDS) } else { height };
        whole.min(BAND_PIXELS / width.max(1)).max(1)
    }

    /// Learns the duration of the eye pass of a whole picture.
    pub(crate) fn learn_picture(&mut self, quality: QualityLevel, pixels: f64, ms: f64) {
        let quick = usize::from(quality.prefiltered_eye);
        let warm = std::mem::replace(&mut self.warm[quick], true);
        if !(warm && ms.is_finite() && pixels > 0.0) {
            return;
        }
        let at = scale_index(quality.scale);
        let before = self.eye_pixel[quick][at].ms;
        self.eye_pixel[quick][at].observe(ms.max(0.05) / pixels);
        let factor = self.eye_pixel[quick][at].ms / before;
        // A new view or transfer function changes the cost of pictures of all sizes alike.
        for (other, estimate) in self.eye_pixel[quick].iter_mut().enumerate() {
            if other != at {
                estimate.ms = (estimate.ms * factor).clamp(1e-9, 1e5);
            }
        }
    }

    /// Learns the total time to fill one light volume.
    pub(crate) fn learn_build(&mut self, quality: QualityLevel, ms: f64) {
        let quick = usize::from(quality.prefiltered_light);
        let at = resolution_index(quality.light_resolution);
        self.light_build[at][quick].observe(ms.max(0.05));
        // Extrapolation to resolutions that were never tried: eight times the voxels take somewhat less than eight
        // times as long.
        for finer in (0..at).rev() {
            if !self.light_build[finer][quick].measured {
                self.light_build[finer][quick].ms = self.light_build[finer + 1][quick].ms * 6.0;
            }
        }
    }

    /// Chooses the quality level of a preview: the finest that keeps the frame budget.
    pub(crate) fn preview_level(&self, viewport: [u32; 2], missing: MissingLightVolumes) -> QualityLevel {
        let budget = self.budget_ms();
        let pixels = f64::from(viewport[0]) * f64::from(viewport[1]);
        let quick_light = self.software && missing.count > 0 && !missing.has_usable;
        let (mut coarse, mut light_ms) = (None, 0.0);
        if missing.count > 0 {
            // Up to two thirds of the frame are spent on moving lights.
            let room = budget * 0.66;
            for choice in [None, Some(LightVolumeResolution::Half), Some(LightVolumeResolution::Quarter)] {
                coarse = choice;
                let quick = usize::from(quick_light && choice.is_some());
                light_ms = self.light_build[resolution_index(choice)][quick].ms * missing.count as f64;
                if light_ms <= room {
                    break;
                }
            }
        }
        let exact_ms = self.eye_pixel[0][0].ms * pixels;
        let simplification = if self.software { missing.simplification } else { LightSimplification::NONE };
        let is_complete = simplification == LightSimplification::NONE;
        if coarse.is_none() && is_complete && exact_ms + light_ms <= budget {
            return QualityLevel::FULL;
        }
        let quick_eye = self.software;
        let eye = &self.eye_pixel[usize::from(quick_eye)];
        let eye_ms = |scale: u32| eye[scale_index(scale)].ms * pixels / f64::from(scale * scale);
        let fits = |scale: u32| eye_ms(scale) + light_ms <= budget;
        let scale = [1, 2].into_iter().find(|&scale| fits(scale)).unwrap_or(4);
        // A cached light volume of full resolution may have been evicted: a coarse one is the fallback.
        let fallback =
            if self.software { LightVolumeResolution::Quarter } else { LightVolumeResolution::Half };
        let quick_light = quick_light && coarse.is_some();
        QualityLevel {
            simplification,
            scale,
            light_resolution: coarse.or((missing.count == 0).then_some(fallback)),
            prefiltered_eye: quick_eye,
            prefiltered_light: quick_light,
            antialiased: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measured(software: bool, eye_ms_per_megapixel: f64, full_build_ms: f64) -> QualityController {
        let mut controller = QualityController::new(software);
        for quality in [QualityLevel::FULL, QualityLevel { prefiltered_eye: true, ..QualityLevel::FULL }] {
            let factor = if quality.prefiltered_eye { 0.3 } else { 1.0 };
            for _ in 0..8 {
                controller.learn_picture(quality, 1e6, eye_ms_per_megapixel * factor);
            }
        }
        for (coarse, share) in [
            (None, 1.0),
            (Some(LightVolumeResolution::Half), 0.15),
            (Some(LightVolumeResolution::Quarter), 0.03),
        ] {
            controller.learn_build(
                QualityLevel { light_resolution: coarse, ..QualityLevel::FULL },
                full_build_ms * share,
            );
            controller.learn_build(
                QualityLevel { light_resolution: coarse, prefiltered_light: true, ..QualityLevel::FULL },
                full_build_ms * share * 0.4,
            );
        }
        controller
    }

    const ONE: MissingLightVolumes =
        MissingLightVolumes { count: 1, has_usable: false, simplification: LightSimplification::ALL };

    #[test]
    fn quick_previews_have_preintegrated_slabs() {
        let scene = SceneSpace::new([64; 3], glam::DAffine3::IDENTITY);
        let look = Settings::default();
        let sampling = |quick_eye| {
            let quality = QualityLevel { scale: 4, prefiltered_eye: quick_eye, ..QualityLevel::FULL };
            quality.settings(&look, &scene, [940, 720]).sampling
        };
        assert_eq!((sampling(true).slabs, sampling(true).slab), (SlabMode::Preintegrated, 1.0));
        assert_eq!(sampling(false), look.sampling);
    }

    #[test]
    fn a_fast_card_previews_at_full_quality() {
        let refine = measured(false, 2.0, 5.0);
        assert_eq!(refine.preview_level([1000, 1000], ONE), QualityLevel::FULL);
    }

    #[test]
    fn a_slow_one_goes_coarse_in_steps() {
        let refine = measured(false, 20.0, 60.0);
        let still = refine.preview_level([1000, 1000], MissingLightVolumes::NONE);
        assert_eq!((still.scale, still.prefiltered_eye), (1, false));
        let moving = refine.preview_level([1000, 1000], ONE);
        assert_eq!(moving.light_resolution, Some(LightVolumeResolution::Half));
        let software = measured(true, 600.0, 1000.0);
        let moving = software.preview_level([1000, 700], ONE);
        assert_eq!(moving.light_resolution, Some(LightVolumeResolution::Quarter));
        assert!(moving.prefiltered_eye && moving.prefiltered_light && moving.scale >= 2, "{moving:?}");
    }

    #[test]
    fn only_slow_adapters_simplify_the_light() {
        let missing = MissingLightVolumes { simplification: LightSimplification::ALL, ..ONE };
        let level = |software| measured(software, 600.0, 1000.0).preview_level([1000, 700], missing);
        assert_eq!(level(true).simplification, LightSimplification::ALL);
        assert_eq!(level(false).simplification, LightSimplification::NONE);
        // However quick it is, a picture with simplified light is not complete.
        let quick = measured(true, 0.1, 0.1);
        let first = MissingLightVolumes { count: 0, ..missing };
        assert!(!quick.preview_level([100, 70], first).is_full());
        assert!(quick.preview_level([100, 70], MissingLightVolumes::NONE).is_full());
    }

    #[test]
    fn a_larger_budget_makes_sharper_previews() {
        let mut software = measured(true, 600.0, 1000.0);
        let usual = software.preview_level([1000, 700], ONE);
        software.set_frame_ms(Some(400.0));
        let sharp = software.preview_level([1000, 700], ONE);
        assert!(sharp.scale < usual.scale, "{sharp:?}");
        software.set_frame_ms(Some(5.0));
        assert_eq!(software.preview_level([1000, 700], ONE).scale, 4, "as little as there is");
        software.set_frame_ms(None);
        assert_eq!(software.preview_level([1000, 700], ONE), usual);
    }

    #[test]
    fn a_usable_light_volume_keeps_its_kernel() {
        let software = measured(true, 600.0, 1000.0);
        assert!(
            !software
                .preview_level([800, 600], MissingLightVolumes { has_usable: true, ..ONE })
                .prefiltered_light
        );
        assert!(!software.preview_level([800, 600], MissingLightVolumes::NONE).prefiltered_light);
    }

    #[test]
    fn estimates_follow_what_is_measured() {
        let mut refine = QualityController::new(false);
        for _ in 0..20 {
            refine.learn_picture(QualityLevel::FULL, 1e6, 200.0);
            refine.learn_build(QualityLevel::FULL, 500.0);
        }
        let slow = refine.preview_level([1000, 1000], ONE);
        assert!(slow.scale > 1 && slow.light_resolution.is_some(), "{slow:?}");
        for _ in 0..20 {
            refine.learn_picture(QualityLevel::FULL, 1e6, 2.0);
            refine.learn_build(QualityLevel::FULL, 1.0);
        }
        assert_eq!(refine.preview_level([1000, 1000], ONE), QualityLevel::FULL);
        refine.learn_picture(QualityLevel::FULL, 1e6, f64::INFINITY);
        assert_eq!(
            refine.preview_level([1000, 1000], ONE),
            QualityLevel::FULL,
            "a lost device teaches nothing"
        );
    }

    #[test]
    fn bands_cover_pictures_and_respect_watchdogs() {
        for software in [false, true] {
            let refine = QualityController::new(software);
            for size in [[1, 1], [800, 600], [7680, 4320], [32768, 10]] {
                let rows = refine.band_rows(QualityLevel::FULL, size);
                assert!(rows >= 1 && (rows == 1 || rows * size[0] <= BAND_PIXELS), "{size:?}: {rows}");
            }
        }
    }
}
