//! Presence pyramids of volumes with missing or hidden voxels, for the eye and for light.

use crate::field::DensityField;
use crate::field::classified::TransferSide;
use crate::field::pyramid::Pyramid;
use crate::{ReferenceOptions, kernel_width};
use chiaroscuro_volume::{Observer, Volume};

/// Presence pyramids: the share of kernels that lies on present voxels.
#[derive(Debug, Clone)]
pub(crate) struct PresencePyramids {
    eye: Pyramid,
    light: Pyramid,
    /// Differences of the eye's presence along x, y and z, if it is rounded as stored.
    pub(super) changes: Option<[Pyramid; 3]>,
}

impl PresencePyramids {
    /// Creates the pyramids of a volume, among whose missing voxels only hidden ones are absent unless
    /// `counts_missing`; `None` if all voxels are present.
    pub(crate) fn from_volume(
        volume: &Volume,
        counts_missing: bool,
        options: ReferenceOptions,
    ) -> Option<Self> {
        let pyramid = |observer: Observer| {
            let field = DensityField::from_presence(volume, observer, counts_missing)?;
            Some(Pyramid::new(&field, kernel_width(options.fault), None))
        };
        let (eye, light) = (pyramid(Observer::Eye)?, pyramid(Observer::Light)?);
        if options.rounding.is_none() {
            return Some(Self { eye, light, changes: None });
        }
        // Stored as signed bytes, whose full range presence uses.
        let changes = [0, 1, 2].map(|axis| eye.central_differences(axis).quantised(127.0));
        let [eye, light] = [eye, light].map(|presence| presence.quantised(254.0));
        Some(Self { eye, light, changes: Some(changes) })
    }

    /// Returns the presence for the side of a transfer function.
    pub(crate) fn for_side(&self, side: TransferSide) -> &Pyramid {
        match side {
            TransferSide::Eye => &self.eye,
            TransferSide::Lighting | TransferSide::Indirect => &self.light,
        }
    }
}
