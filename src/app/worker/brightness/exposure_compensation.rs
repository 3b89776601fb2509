//! Exposure compensation that keeps previews as bright as full-quality pictures.
//!
//! A coarse light volume leaks light into shadows and a stretched kernel thins material, so a preview's mean
//! luminance is off by up to a third. The error is known wherever a preview was followed by the full-quality picture
//! of the same request, and hardly changes during a movement: previews are multiplied by the inverse ratio.

use chiaroscuro_scene::LightSimplification;

/// Class of previews that share a brightness error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PreviewClass {
    /// Window pixels per rendered pixel along each axis.
    pub scale: u32,
    /// True if the eye pass uses the prefiltered kernel.
    pub quick_eye: bool,
    /// Parts of the light that are left out.
    pub simplification: LightSimplification,
    /// Data voxels per voxel of the coarsest light volume, along each axis.
    pub light_divisor: usize,
}

/// Limits of the exposure factor: beyond them a preview shows different content.
const EXPOSURE_LIMITS: (f64, f64) = (0.5, 2.0);

/// Learnt exposure factors for the previews of one volume.
#[derive(Debug, Default)]
pub(crate) struct ExposureCompensation {
    factors: Vec<(PreviewClass, f64)>,
    /// Mean luminance of the last full-quality picture.
    full_quality_luminance: Option<f64>,
    /// Class of the last preview, and its mean luminance.
    last_preview: Option<(PreviewClass, f64)>,
}

impl ExposureCompensation {
    /// Returns the exposure factor for a class of previews; `None` if none was seen yet.
    pub(crate) fn factor(&self, kind: PreviewClass) -> Option<f64> {
        self.factors.iter().find(|(known, _)| *known == kind).map(|(_, exposure)| *exposure)
    }

    /// Learns the uncompensated mean luminance of a preview. The first preview of a class is assumed to be nearly as
    /// bright as the picture that it follows, so that brightness does not jump when a drag begins: returns its
    /// exposure factor.
    pub(crate) fn learn_preview(&mut self, kind: PreviewClass, mean: f64) -> Option<f64> {
        self.last_preview = Some((kind, mean));
        if self.factor(kind).is_some() {
            return None;
        }
        let exposure = exposure_ratio(self.full_quality_luminance?, mean)?;
        self.factors.push((kind, exposure));
        Some(exposure)
    }

    /// Learns the mean luminance of a full-quality picture; `is_of_last_preview` if it has the last preview's
    /// request.
    pub(crate) fn learn_full_quality(&mut self, mean: f64, is_of_last_preview: bool) {
        self.full_quality_luminance = Some(mean);
        let Some((kind, preview)) = self.last_preview.take().filter(|_| is_of_last_preview) else { return };
        let Some(exposure) = exposure_ratio(mean, preview) else { return };
        self.factors.retain(|(known, _)| *known != kind);
        self.factors.push((kind, exposure));
    }
}

/// Returns the exposure factor that makes a preview as bright as a picture; `None` if either is black.
fn exposure_ratio(whole: f64, preview: f64) -> Option<f64> {
    let ratio = whole / preview;
    (ratio.is_finite() && ratio > 0.0).then(|| ratio.clamp(EXPOSURE_LIMITS.0, EXPOSURE_LIMITS.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    const COARSE: PreviewClass = PreviewClass {
        scale: 2,
        quick_eye: true,
        simplification: LightSimplification::ALL,
        light_divisor: 4,
    };
    const FINE: PreviewClass = PreviewClass { scale: 1, light_divisor: 1, ..COARSE };

    #[test]
    fn the_first_preview_is_as_bright_as_the_picture_before() {
        let mut exposures = ExposureCompensation::default();
        assert_eq!(exposures.learn_preview(COARSE, 0.5), None, "nothing to compare it with");
        exposures.learn_full_quality(0.4, false);
        assert_eq!(exposures.learn_preview(COARSE, 0.5), Some(0.8));
        assert_eq!(exposures.learn_preview(COARSE, 0.25), None, "later ones follow what moves");
        assert_eq!(exposures.factor(COARSE), Some(0.8));
        assert_eq!(exposures.factor(FINE), None);
    }

    #[test]
    fn a_picture_of_the_same_corrects_it() {
        let mut exposures = ExposureCompensation::default();
        exposures.learn_full_quality(0.4, false);
        exposures.learn_preview(COARSE, 0.5);
        exposures.learn_full_quality(0.45, true);
        assert_eq!(exposures.factor(COARSE), Some(0.9));
        exposures.learn_full_quality(0.1, true);
        assert_eq!(exposures.factor(COARSE), Some(0.9), "there was no preview since");
    }

    #[test]
    fn darkness_teaches_nothing() {
        let mut exposures = ExposureCompensation::default();
        exposures.learn_full_quality(0.0, false);
        assert_eq!(exposures.learn_preview(COARSE, 0.5), None);
        exposures.learn_full_quality(0.4, false);
        assert_eq!(exposures.learn_preview(COARSE, 0.0), None);
        assert_eq!(exposures.learn_preview(COARSE, 1e-9), Some(2.0), "nor is it believed without bounds");
    }
}
