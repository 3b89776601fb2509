//! Affine transform that lies beside a volume in an archive: an array `affine` of 4 x 4 numbers, as nibabel has it.
//!
//! It takes indices along the first three axes of the array, whatever their order in memory, to
//! right-anterior-superior millimetres (<https://nipy.org/nibabel/coordinate_systems.html>).

use std::io::Read as _;

use glam::{DAffine3, DMat4, DVec3};

use super::super::input::InputFile;
use super::super::placement::GridPlacement;
use super::super::zip::{ZipEntry, open_entry};
use super::grid::NumpyGrid;
use super::header::NumpyHeader;
use chiaroscuro_volume::{LoadContext, is_usable_affine, spacing_ratio_error};

/// Name of the array, in any case of letters.
const NAME: &str = "affine";

/// Numbers of the transform, rows first.
const COUNT: usize = 16;

/// Tolerance of the last row, which is 0, 0, 0, 1.
const ROW_TOLERANCE: f64 = 1e-9;

/// Transform of an archive: from the indices along the first three axes of its volumes to millimetres, or the reason
/// why it cannot be used.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ArchiveAffine(Result<DAffine3, &'static str>);

impl ArchiveAffine {
    /// Returns true if an array holds the transform, by its name and its shape.
    pub(super) fn is_held_by(name: &str, header: &NumpyHeader) -> bool {
        name.eq_ignore_ascii_case(NAME) && header.shape == [4, 4]
    }

    /// Reads the transform from such an array.
    pub(super) fn read(
        context: LoadContext<'_>,
        input: &mut InputFile,
        entry: &ZipEntry,
        header: &NumpyHeader,
        grid: &NumpyGrid,
    ) -> Self {
        let size = grid.number.bytes();
        let mut bytes = Vec::new();
        let read = open_entry(context, input, entry).ok().and_then(|mut content| {
            let skipped =
                std::io::copy(&mut content.by_ref().take(header.bytes), &mut std::io::sink()).ok()?;
            content.take((COUNT * size) as u64).read_to_end(&mut bytes).ok()?;
            Some(skipped == header.bytes && bytes.len() == COUNT * size)
        });
        if read != Some(true) {
            return Self(Err("it cannot be read"));
        }
        if grid.components != 1 {
            return Self(Err("its numbers are not real"));
        }
        let mut numbers = [0.0; COUNT];
        for (number, bytes) in numbers.iter_mut().zip(bytes.chunks_exact(size)) {
            *number = grid.number.value(bytes, grid.endian);
        }
        let matrix = DMat4::from_cols_array(&numbers);
        // Rows follow each other in memory, unless the first axis is the fastest.
        Self::from_matrix(if header.is_fortran { matrix } else { matrix.transpose() })
    }

    fn from_matrix(matrix: DMat4) -> Self {
        if !matrix.is_finite() {
            return Self(Err("its numbers are not finite"));
        }
        let last = matrix.row(3);
        if (last - glam::DVec4::W).abs().max_element() > ROW_TOLERANCE {
            return Self(Err("its last row is not 0, 0, 0, 1"));
        }
        let affine = DAffine3::from_mat4(matrix);
        let axes = affine.matrix3;
        let lengths = [axes.x_axis, axes.y_axis, axes.z_axis].map(DVec3::length);
        if !is_usable_affine(&affine) || spacing_ratio_error(lengths).is_some() {
            return Self(Err("it is singular, or nearly so"));
        }
        Self(Ok(affine))
    }

    /// Placement of a volume whose axes x, y and z are these axes of its array; `None` for axes that the array lacks.
    pub(super) fn placement(&self, array_axes: [Option<usize>; 3]) -> GridPlacement {
        let unused = |why: &str| {
            let remark = format!("the transform in the array \"{NAME}\" is not used: {why}");
            GridPlacement::unknown().with_remark(Some(remark))
        };
        let affine = match self.0 {
            Ok(affine) => affine,
            Err(why) => return unused(why),
        };
        let mut sorted = array_axes;
        sorted.sort_unstable();
        if sorted != [Some(0), Some(1), Some(2)] {
            return unused("the first three axes of the array are not those of the volume");
        }
        let column = |axis: Option<usize>| affine.matrix3.col(axis.unwrap_or(0));
        let [x, y, z] = array_axes.map(column);
        GridPlacement::from_ras_affine(DAffine3 {
            matrix3: glam::DMat3::from_cols(x, y, z),
            translation: affine.translation,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_follow_the_axes_of_the_array() {
        let matrix = DMat4::from_cols_array(&[
            2.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.5, 4.0, 0.0, -7.0, -8.0, 9.0, 1.0,
        ]);
        let found = ArchiveAffine::from_matrix(matrix);
        let same = found.placement([Some(0), Some(1), Some(2)]);
        assert_eq!(same.world_from_index, DAffine3::from_mat4(matrix));
        assert!(same.is_anatomical && same.is_scale_known && same.remarks.is_empty());
        let turned = found.placement([Some(2), Some(1), Some(0)]).world_from_index;
        assert_eq!(turned.matrix3.x_axis, DVec3::new(0.0, 0.5, 4.0));
        assert_eq!(
            (turned.matrix3.z_axis, turned.translation),
            (DVec3::X * 2.0, DVec3::new(-7.0, -8.0, 9.0))
        );
        for axes in [[Some(3), Some(2), Some(1)], [Some(0), Some(1), None], [Some(0), Some(0), Some(1)]] {
            let placed = found.placement(axes);
            assert!(!placed.is_scale_known && placed.remarks[0].contains("not those of the volume"));
        }
    }

    #[test]
    fn what_is_no_transform_is_told() {
        let with = |at: usize, value: f64| {
            let mut numbers = DMat4::IDENTITY.to_cols_array();
            numbers[at] = value;
            ArchiveAffine::from_matrix(DMat4::from_cols_array(&numbers)).0
        };
        assert_eq!(with(12, f64::NAN), Err("its numbers are not finite"));
        assert_eq!(with(0, f64::INFINITY), Err("its numbers are not finite"));
        assert_eq!(with(0, 0.0), Err("it is singular, or nearly so"));
        assert_eq!(with(0, 1e300), Err("it is singular, or nearly so"));
        assert_eq!(with(3, 1.0), Err("its last row is not 0, 0, 0, 1"));
        assert!(with(12, 1e3).is_ok());
    }
}
