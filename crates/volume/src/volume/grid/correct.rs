//! Corrections of a grid: spacing and its unit, flips, order of axes and orientation.

use glam::{DAffine3, DMat3, DVec3};

use super::VoxelGrid;
use crate::load_context::is_usable_affine;
use crate::volume::corrections::{Corrections, Orientation, SpacingUnit};
use crate::volume::error::VolumeError;

/// Corrected voxel spacings in mm, and the scale of the origin.
struct CorrectedSpacing {
    along_axes: [f64; 3],
    /// Factor that converts the origin from the file's unit to mm.
    origin_scale: f64,
}

impl VoxelGrid {
    /// Applies corrections to the grid as its file describes it; those of values have no effect here.
    ///
    /// # Errors
    /// Fails if positions degenerate.
    pub(crate) fn corrected(&self, by: &Corrections) -> Result<Self, VolumeError> {
        let world_from_index = self.corrected_affine(by);
        if !is_usable_affine(&world_from_index) {
            let what = format!("axes {:?}", world_from_index.matrix3);
            return Err(VolumeError::BadGeometry { what });
        }
        let is_anatomical = match by.orientation {
            None => self.is_anatomical,
            Some(orientation) => orientation != Orientation::Unknown,
        };
        let length_unit = match by.unit {
            None if self.has_unknown_scale() && by.spacing.is_some() => SpacingUnit::Mm,
            None => self.length_unit,
            Some(unit) => unit,
        };
        Ok(Self { world_from_index, is_anatomical, length_unit, ..*self })
    }

    /// Computes the corrected transform from index space to world space.
    pub(crate) fn corrected_affine(&self, by: &Corrections) -> DAffine3 {
        let Corrections {
            spacing,
            unit,
            flip,
            axis_order,
            orientation,
            padding_value: _,
            value_scale: _,
            hidden_table: _,
        } = by;
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
