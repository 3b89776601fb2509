//! Application of corrections to a volume, which shares its voxels with the opened one where values are unaffected.

use std::sync::Arc;

use super::rescale::{rescaled, rescaled_metadata};
use super::{Corrections, PaddingValue};
use crate::load_context::memory_budget_bytes;
use crate::math::SceneSpace;
use crate::volume::{Volume, VolumeError};

/// Corrections of a volume, together with the volume as opened: later corrections are applied to that one.
#[derive(Debug)]
pub(crate) struct AppliedCorrections {
    corrections: Corrections,
    opened: Volume,
}

impl Volume {
    /// Returns the volume as opened, without any corrections.
    pub fn as_opened(&self) -> &Self {
        self.correction.as_ref().map_or(self, |applied| &applied.opened)
    }

    /// Returns the corrections that were applied to the opened volume.
    pub fn corrections(&self) -> &Corrections {
        self.correction.as_ref().map_or(&Corrections::NONE, |applied| &applied.corrections)
    }

    /// Returns the content id of the opened volume: see [`Self::content_id`].
    pub fn opened_id(&self) -> u64 {
        self.as_opened().content_id
    }

    /// Returns true if both volumes share their voxels in memory and treat the same ones as missing.
    pub(crate) fn shares_voxels(&self, other: &Self) -> bool {
        self.voxels.shares_samples(&other.voxels)
    }

    /// Applies corrections to the opened volume, replacing any earlier ones. Takes no time and no memory if they
    /// leave the values unchanged.
    ///
    /// # Errors
    /// Fails if all voxels become missing, values or positions degenerate, or memory is short.
    pub fn corrected(&self, by: &Corrections) -> Result<Self, VolumeError> {
        let opened = self.as_opened();
        if by.is_none() {
            return Ok(opened.clone());
        }
        let grid = opened.grid.corrected(by)?;
        let mut volume = if by.keeps_values() {
            opened.clone()
        } else if self.correction.is_some() && self.corrections().corrects_values_like(by) {
            self.with_density_mapping(self.ranges().robust)
        } else {
            opened.with_corrected_values(by)?
        };
        volume.grid = grid;
        if let Some(threshold) = by.hidden_table {
            volume = volume.without_table(threshold)?;
        }
        // Scaled with the object, so that opacities stay the same for every share of it.
        let longer = volume.scene().mm_per_unit / opened.scene().mm_per_unit;
        volume.voxels.opacity_unit_mm = opened.opacity_unit_mm().map(|unit| unit * longer);
        // Derived facts differ with every correction, and caches are keyed by this id, so it depends on all of them.
        let words = format!("{by:?}");
        volume.content_id = words.bytes().fold(opened.content_id, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
        });
        volume.correction = Some(Arc::new(AppliedCorrections { corrections: *by, opened: opened.clone() }));
        Ok(volume)
    }

    /// Returns the scene space that the grid would have with these corrections.
    pub fn corrected_scene(&self, by: &Corrections) -> SceneSpace {
        let opened = &self.as_opened().grid;
        SceneSpace::new(opened.dims(), opened.corrected_affine(by))
    }

    /// Returns the volume with rescaled values and another padding value.
    fn with_corrected_values(&self, by: &Corrections) -> Result<Self, VolumeError> {
        let scale = by.value_scale;
        let samples = if scale.is_none() {
            self.voxels.shared_samples()
        } else {
            Arc::new(rescaled(self.samples(), scale, memory_budget_bytes())?)
        };
        let name = self.name().to_owned();
        let volume = Self::from_shared_samples(name, self.dims(), self.world_from_index(), samples)?;
        let padding = match by.padding_value {
            PaddingValue::InFile => self.padding_value().map(|number| scale.value_from_number(number)),
            PaddingValue::Nothing => None,
            PaddingValue::Value(value) => Some(value),
        };
        let volume = match padding {
            Some(padding) => volume.with_padding(padding)?,
            None => volume,
        };
        let metadata = self.metadata();
        let metadata = if scale.is_none() { metadata.clone() } else { rescaled_metadata(metadata, scale) };
        let provenance = Arc::clone(&self.provenance);
        Ok(Self { provenance, ..volume.with_metadata(metadata) })
    }
}
