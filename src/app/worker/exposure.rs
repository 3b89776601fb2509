//! Keeps previews as bright as pictures.
//!
//! A coarse light volume lets light into shadows and a stretched kernel thins material, so that a preview's
//! mean luminance is off by up to a third. What it is off by is known wherever a preview is followed by a
//! picture of the same, and hardly changes while something moves: previews are exposed for so much longer
//! or shorter.

/// What decides how far a preview's brightness is off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Kind {
    /// Window pixels per rendered pixel.
    pub scale: u32,
    /// Eye pass with the prefiltered kernel.
    pub quick_eye: bool,
    /// Data voxels per voxel of the coarsest light volume.
    pub light_divisor: usize,
}

/// Exposures are between ½ and 2: beyond that a preview shows something else.
const LIMITS: (f64, f64) = (0.5, 2.0);

/// What is known of the brightness of previews of one volume.
#[derive(Debug, Default)]
pub(crate) struct Exposures {
    known: Vec<(Kind, f64)>,
    /// Mean luminance of the last picture at full quality.
    settled: Option<f64>,
    /// The last preview and its mean luminance.
    last: Option<(Kind, f64)>,
}

impl Exposures {
    /// How long to expose a preview; `None` if none of the kind was seen.
    pub(crate) fn of(&self, kind: Kind) -> Option<f64> {
        self.known.iter().find(|(known, _)| *known == kind).map(|(_, exposure)| *exposure)
    }

    /// Learns the mean luminance of a preview, as it is without compensation. The first one of a kind is
    /// taken to be nearly the same as the picture that it follows, so that nothing jumps when a drag begins:
    /// returns its exposure.
    pub(crate) fn preview(&mut self, kind: Kind, mean: f64) -> Option<f64> {
        self.last = Some((kind, mean));
        if self.of(kind).is_some() {
            return None;
        }
        let exposure = ratio(self.settled?, mean)?;
        self.known.push((kind, exposure));
        Some(exposure)
    }

    /// Learns the mean luminance of a picture at full quality, which may be the same as the last preview's.
    pub(crate) fn settle(&mut self, mean: f64, is_of_last_preview: bool) {
        self.settled = Some(mean);
        let Some((kind, preview)) = self.last.take().filter(|_| is_of_last_preview) else { return };
        let Some(exposure) = ratio(mean, preview) else { return };
        self.known.retain(|(known, _)| *known != kind);
        self.known.push((kind, exposure));
    }
}

/// The exposure that makes a preview as bright as a picture; `None` where either is black.
fn ratio(whole: f64, preview: f64) -> Option<f64> {
    let ratio = whole / preview;
    (ratio.is_finite() && ratio > 0.0).then(|| ratio.clamp(LIMITS.0, LIMITS.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    const COARSE: Kind = Kind { scale: 2, quick_eye: true, light_divisor: 4 };
    const FINE: Kind = Kind { scale: 1, light_divisor: 1, ..COARSE };

    #[test]
    fn the_first_preview_is_as_bright_as_the_picture_before() {
        let mut exposures = Exposures::default();
        assert_eq!(exposures.preview(COARSE, 0.5), None, "nothing to compare it with");
        exposures.settle(0.4, false);
        assert_eq!(exposures.preview(COARSE, 0.5), Some(0.8));
        assert_eq!(exposures.preview(COARSE, 0.25), None, "later ones follow what moves");
        assert_eq!(exposures.of(COARSE), Some(0.8));
        assert_eq!(exposures.of(FINE), None);
    }

    #[test]
    fn a_picture_of_the_same_corrects_it() {
        let mut exposures = Exposures::default();
        exposures.settle(0.4, false);
        exposures.preview(COARSE, 0.5);
        exposures.settle(0.45, true);
        assert_eq!(exposures.of(COARSE), Some(0.9));
        exposures.settle(0.1, true);
        assert_eq!(exposures.of(COARSE), Some(0.9), "there was no preview since");
    }

    #[test]
    fn darkness_teaches_nothing() {
        let mut exposures = Exposures::default();
        exposures.settle(0.0, false);
        assert_eq!(exposures.preview(COARSE, 0.5), None);
        exposures.settle(0.4, false);
        assert_eq!(exposures.preview(COARSE, 0.0), None);
        assert_eq!(exposures.preview(COARSE, 1e-9), Some(2.0), "nor is it believed without bounds");
    }
}
