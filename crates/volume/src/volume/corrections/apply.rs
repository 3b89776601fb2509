//! Application of corrections to a volume, which shares its voxels with the opened one where values are unaffected.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::rescale::{rescaled, rescaled_metadata};
use super::{Corrections, Orientation, PaddingValue, SpacingUnit};
use crate::load_context::{is_usable_affine, memory_budget_bytes};
use crate::math::SceneSpace;
use crate::volume::{Volume, VolumeError};

/// Corrections of a volume, and the opened volume they were applied to.
#[derive(Debug, Clone)]
pub(crate) struct AppliedCorrections {
    corrections: Corrections,
    opened: Volume,
}

/// Default corrections, for volumes without any.
static NO_CORRECTIONS: std::sync::LazyLock<Corrections> = std::sync::LazyLock::new(Corrections::default);

/// Corrected voxel spacings in mm, and the scale of the origin.
struct CorrectedSpacing {
    along_axes: [f64; 3],
    /// Factor that converts the origin from the file's unit to mm.
    origin_scale: f64,
}

impl Volume {
    /// Returns the volume as opened, without any corrections.
    pub fn as_opened(&self) -> &Self {
        self.corrected.as_ref().map_or(self, |corrected| &corrected.opened)
    }

    /// Returns the corrections that were applied to the opened volume.
    pub fn corrections(&self) -> &Corrections {
        self.corrected.as_ref().map_or(&NO_CORRECTIONS, |corrected| &corrected.corrections)
    }

    /// Returns the content id of the opened volume: see [`Self::content_id`].
    pub fn opened_id(&self) -> u64 {
        self.as_opened().content_id
    }

    /// Returns true if both volumes share their voxels in memory and treat the same ones as missing.
    pub(crate) fn shares_voxels(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.samples, &other.samples) && self.padding_value == other.padding_value
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
        let world_from_index = opened.corrected_affine(by);
        if !is_usable_affine(&world_from_index) {
            let what = format!("axes {:?}", world_from_index.matrix3);
            return Err(VolumeError::BadGeometry { what });
        }
        let mut volume = match &self.corrected {
            _ if by.keeps_values() => opened.clone(),
            Some(known) if known.corrections.corrects_values_like(by) => {
                self.with_density_mapping(self.ranges.robust)
            }
            _ => opened.with_corrected_values(by)?,
        };
        volume.world_from_index = world_from_index;
        // Scaled with the object, so that opacities stay the same for every share of it.
        let longer = volume.scene().mm_per_unit / opened.scene().mm_per_unit;
        volume.opacity_unit_mm = opened.opacity_unit_mm.map(|unit| unit * longer);
        volume.is_anatomical = match by.orientation {
            None => opened.is_anatomical,
            Some(orientation) => orientation != Orientation::Unknown,
        };
        volume.length_unit = match by.unit {
            None if opened.has_unknown_scale() && by.spacing.is_some() => SpacingUnit::Mm,
            None => opened.length_unit,
            Some(unit) => unit,
        };
        // Derived facts differ with every correction, and caches are keyed by this id, so it depends on all of them.
        let words = format!("{by:?}");
        volume.content_id = words.bytes().fold(opened.content_id, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
        });
        volume.corrected = Some(Arc::new(AppliedCorrections { corrections: *by, opened: opened.clone() }));
        Ok(volume)
    }

    /// Returns the scene space that the grid would have with these corrections.
    pub fn corrected_scene(&self, by: &Corrections) -> SceneSpace {
        let opened = self.as_opened();
        SceneSpace::new(opened.dims, opened.corrected_affine(by))
    }

    /// Returns the spacings of the file's voxels in mm; a voxel of the volume may be the mean of several of them.
    pub fn file_spacing_mm(&self) -> DVec3 {
        self.spacing_mm() / self.file_grid.steps()
    }

    /// Returns the volume with rescaled values and another padding value.
    fn with_corrected_values(&self, by: &Corrections) -> Result<Self, VolumeError> {
        let scale = by.value_scale;
        let samples = if scale.is_none() {
            Arc::clone(&self.samples)
        } else {
            Arc::new(rescaled(&self.samples, scale, memory_budget_bytes())?)
        };
        let volume = Self::from_shared_samples(self.name.clone(), self.dims, self.world_from_index, samples)?;
        let padding = match by.padding_value {
            PaddingValue::InFile => self.padding_value.map(|number| scale.value_from_number(number)),
            PaddingValue::Nothing => None,
            PaddingValue::Value(value) => Some(value),
        };
        let volume = match padding {
            Some(padding) => volume.with_padding(padding)?,
            None => volume,
        };
        let hints = if scale.is_none() { self.hints.clone() } else { rescaled_metadata(&self.hints, scale) };
        Ok(Self {
            file_dims: self.file_dims,
            file_grid: self.file_grid,
            remarks: self.remarks.clone(),
            contents: std::sync::Arc::clone(&self.contents),
            hints,
            ..volume
        })
    }

    /// Computes the corrected transform from index space to world space.
    fn corrected_affine(&self, by: &Corrections) -> DAffine3 {
        let Corrections { spacing, unit, flip, axis_order, orientation, padding_value: _, value_scale: _ } =
            by;
        let is_moved = spacing.is_some()
            || unit.is_some()
            || orientation.is_some_and(|orientation| orientation != Orientation::Unknown)
            || flip.axes().contains(&true)
            || axis_order.permutation() != [0, 1, 2];
        if !is_moved {
            return self.world_from_index;
        }
        // Corrections refer to the voxels of the file; a voxel of the volume may stand for a block of them.
        let file_from_index = self.file_grid.file_from_index();
        let world_from_file = match file_from_index {
            Some(file_from_index) => self.world_from_index * file_from_index.inverse(),
            None => self.world_from_index,
        };
        let axes = world_from_file.matrix3;
        let axes = [axes.x_axis, axes.y_axis, axes.z_axis];
        let distances = CorrectedSpacing::new(axes.map(DVec3::length), *spacing, *unit);
        let directions = match orientation {
            Some(Orientation::Anatomical(headings)) => headings.directions(),
            _ => axes.map(|axis| axis / axis.length()),
        };
        let places = axis_order.permutation();
        let mut columns = [0, 1, 2].map(|axis| directions[places[axis]] * distances.along_axes[axis]);
        let mut origin = world_from_file.translation * distances.origin_scale;
        for (axis, is_flipped) in flip.axes().into_iter().enumerate() {
            if is_flipped {
                origin += (self.file_dims[axis] as f64 - 1.0) * columns[axis];
                columns[axis] = -columns[axis];
            }
        }
        let [x, y, z] = columns;
        let moved = DAffine3 { matrix3: DMat3::from_cols(x, y, z), translation: origin };
        file_from_index.map_or(moved, |file_from_index| moved * file_from_index)
    }
}

impl CorrectedSpacing {
    /// Computes spacings from those of the file, or those given instead, in a unit.
    fn new(in_file: [f64; 3], given: Option<[f64; 3]>, unit: Option<SpacingUnit>) -> Self {
        let unit_mm = unit.map_or(1.0, SpacingUnit::mm);
        // If only the unit was wrong, it was wrong for the origin, too.
        let of_origin = if given.is_some() { 1.0 } else { unit_mm };
        Self { along_axes: given.unwrap_or(in_file).map(|length| length * unit_mm), origin_scale: of_origin }
    }
}
