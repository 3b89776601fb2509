//! Volumes as a user knows them better than their files: made from what was opened, with which they share the voxels.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::scaled::{scaled, scaled_hints};
use super::{Corrections, Orientation, PaddingValue, SpacingUnit};
use crate::data::attempt::{is_usable_affine, memory_budget_bytes};
use crate::data::volume::{Volume, VolumeError};
use crate::math::SceneSpace;

/// What a volume was made from.
#[derive(Debug, Clone)]
pub(in crate::data::volume) struct Corrected {
    by: Corrections,
    opened: Volume,
}

/// No corrections, for volumes without.
static NONE: std::sync::LazyLock<Corrections> = std::sync::LazyLock::new(Corrections::default);

/// Distances between voxels, and whether they are lengths at all.
struct Distances {
    along_axes: [f64; 3],
    /// What is left of an origin in the file's unit.
    of_origin: f64,
}

impl Volume {
    /// The volume as it was opened, whatever has been corrected since.
    pub fn as_opened(&self) -> &Self {
        self.corrected.as_ref().map_or(self, |corrected| &corrected.opened)
    }

    /// How it differs from the volume that was opened.
    pub fn corrections(&self) -> &Corrections {
        self.corrected.as_ref().map_or(&NONE, |corrected| &corrected.by)
    }

    /// Identifies what was opened: see [`Self::content_id`].
    pub fn opened_id(&self) -> u64 {
        self.as_opened().content_id
    }

    /// Whether another volume has the voxels of this one in the same memory, with the same ones missing.
    pub(in crate::data) fn shares_voxels(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.samples, &other.samples) && self.padding_value == other.padding_value
    }

    /// The volume that was opened, corrected: whatever has been corrected before does not count. Where the values stay,
    /// it takes no time and no memory.
    ///
    /// # Errors
    /// When no voxels are left that hold something, values or places cannot be told apart, or the memory is not there.
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
            Some(known) if known.by.has_values_of(by) => self.showing(self.ranges.robust),
            _ => opened.with_values(by)?,
        };
        volume.world_from_index = world_from_index;
        // Opacities refer to the same share of the object.
        let longer = volume.scene().mm_per_unit / opened.scene().mm_per_unit;
        volume.unit_mm = opened.unit_mm.map(|unit| unit * longer);
        volume.is_anatomical = match by.orientation {
            None => opened.is_anatomical,
            Some(orientation) => orientation != Orientation::Unknown,
        };
        volume.length_unit = match by.unit {
            None if opened.has_unknown_scale() && by.spacing.is_some() => SpacingUnit::Mm,
            None => opened.length_unit,
            Some(unit) => unit,
        };
        // What is said of a volume differs with all of them, and whatever is kept of it goes with what identifies it.
        let words = format!("{by:?}");
        volume.content_id = words.bytes().fold(opened.content_id, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
        });
        volume.corrected = Some(Arc::new(Corrected { by: *by, opened: opened.clone() }));
        Ok(volume)
    }

    /// How the grid would lie in scene space.
    pub fn corrected_scene(&self, by: &Corrections) -> SceneSpace {
        let opened = self.as_opened();
        SceneSpace::new(opened.dims, opened.corrected_affine(by))
    }

    /// Distances between the voxels of the file, of which one of the volume may be the mean of several.
    pub fn file_spacing_mm(&self) -> DVec3 {
        self.spacing_mm() / self.block.steps()
    }

    /// The same volume with other values.
    fn with_values(&self, by: &Corrections) -> Result<Self, VolumeError> {
        let scale = by.value_scale;
        let samples = if scale.is_none() {
            Arc::clone(&self.samples)
        } else {
            Arc::new(scaled(&self.samples, scale, memory_budget_bytes())?)
        };
        let volume = Self::sharing(self.name.clone(), self.dims, self.world_from_index, samples)?;
        let padding = match by.padding_value {
            PaddingValue::InFile => self.padding_value.map(|number| scale.value(number)),
            PaddingValue::Nothing => None,
            PaddingValue::Value(value) => Some(value),
        };
        let volume = match padding {
            Some(padding) => volume.with_padding(padding)?,
            None => volume,
        };
        let hints = if scale.is_none() { self.hints.clone() } else { scaled_hints(&self.hints, scale) };
        Ok(Self {
            file_dims: self.file_dims,
            block: self.block,
            remarks: self.remarks.clone(),
            held: std::sync::Arc::clone(&self.held),
            hints,
            ..volume
        })
    }

    /// Where voxels lie.
    fn corrected_affine(&self, by: &Corrections) -> DAffine3 {
        let Corrections { spacing, unit, flip, axis_order, orientation, padding_value: _, value_scale: _ } =
            by;
        let is_moved = spacing.is_some()
            || unit.is_some()
            || orientation.is_some_and(|orientation| orientation != Orientation::Unknown)
            || flip.axes().contains(&true)
            || axis_order.places() != [0, 1, 2];
        if !is_moved {
            return self.world_from_index;
        }
        // Of the voxels in the file, of which a volume may have one for several.
        let file_from_index = self.block.file_from_index();
        let world_from_file = match file_from_index {
            Some(file_from_index) => self.world_from_index * file_from_index.inverse(),
            None => self.world_from_index,
        };
        let axes = world_from_file.matrix3;
        let axes = [axes.x_axis, axes.y_axis, axes.z_axis];
        let distances = Distances::of(axes.map(DVec3::length), *spacing, *unit);
        let directions = match orientation {
            Some(Orientation::Towards(headings)) => headings.directions(),
            _ => axes.map(|axis| axis / axis.length()),
        };
        let places = axis_order.places();
        let mut columns = [0, 1, 2].map(|axis| directions[places[axis]] * distances.along_axes[axis]);
        let mut origin = world_from_file.translation * distances.of_origin;
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

impl Distances {
    /// Those of a file, or those that somebody gives instead, in a unit.
    fn of(in_file: [f64; 3], given: Option<[f64; 3]>, unit: Option<SpacingUnit>) -> Self {
        let unit_mm = unit.map_or(1.0, SpacingUnit::mm);
        // Where only the unit was wrong, it was of the origin, too.
        let of_origin = if given.is_some() { 1.0 } else { unit_mm };
        Self { along_axes: given.unwrap_or(in_file).map(|length| length * unit_mm), of_origin }
    }
}
