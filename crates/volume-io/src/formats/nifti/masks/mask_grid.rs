//! Grid of a mask: the voxels of all masks of a segmentation lie at the same places.

use std::path::Path;

use glam::DVec3;

use super::super::super::LoadError;
use super::super::super::input::InputFile;
use super::super::super::placement::GridPlacement;
use super::super::super::reader::FileStart;
use super::super::dimensions::NiftiGrid;
use super::super::geometry;
use super::super::header::{NiftiHeader, NiftiVersion};
use super::super::number_type::NiftiNumberType;
use super::HELP;
use chiaroscuro_volume::{LoadContext, quoted};

/// Largest distance between the corners of equal grids, in voxels: headers of equal grids differ by rounding, as
/// quaternions have 32-bit numbers.
const TOLERANCE: f64 = 0.02;

/// Size and placement of a mask's grid.
#[derive(Debug)]
pub(super) struct MaskGrid {
    pub(super) dims: [u64; 3],
    pub(super) placement: GridPlacement,
}

impl MaskGrid {
    /// Reads the grid of a file from its header.
    ///
    /// # Errors
    /// `BadInput` where it is no `NIfTI` file, or has more than one number for each voxel.
    pub(super) fn read(context: LoadContext<'_>) -> Result<Self, LoadError> {
        let mut input = InputFile::open(context)?;
        let start = FileStart::read(&mut input).map_err(|error| context.io_error(error))?;
        let Some(version) = NiftiVersion::detect(start.bytes()) else {
            let why = "it is not a mask: it has no NIfTI header";
            return Err(context.bad_input_error("header", why, HELP));
        };
        let header = NiftiHeader::parse(context, version, start.bytes())?;
        let number_type = NiftiNumberType::from_header(context, &header)?;
        let grid = NiftiGrid::parse(context, &header)?;
        let numbers = grid.frames.max(grid.components).max(number_type.components);
        if numbers > 1 {
            let why = format!("it is not a mask: one number was expected for each voxel, it has {numbers}");
            return Err(context.bad_input_error("dim", why, HELP));
        }
        Ok(Self { dims: grid.dims, placement: geometry::placement(&header, grid.dims) })
    }

    /// Creates the grid of a mask whose voxels have been read.
    pub(super) fn from_placement(dims: [usize; 3], placement: GridPlacement) -> Self {
        Self { dims: dims.map(|n| n as u64), placement }
    }

    /// Checks that this grid equals `model`, the grid of the file `first`.
    ///
    /// # Errors
    /// `BadInput` with the field in which they differ.
    pub(super) fn check_equals(
        &self,
        context: LoadContext<'_>,
        model: &Self,
        first: &Path,
    ) -> Result<(), LoadError> {
        let first = quoted(&first.file_name().unwrap_or_default().to_string_lossy());
        if self.dims != model.dims {
            let [[a, b, c], [x, y, z]] = [self.dims, model.dims];
            let why = format!("it has {a} x {b} x {c} voxels, {x} x {y} x {z} were expected, as in {first}");
            return Err(context.bad_input_error("dim", why, HELP));
        }
        if !self.has_placement_of(model) {
            let why = format!("its voxels do not lie where those of {first} do, as was expected");
            return Err(context.bad_input_error("sform, qform, pixdim", why, HELP));
        }
        Ok(())
    }

    /// Returns true if the voxels of two grids of equal size lie at the same places.
    fn has_placement_of(&self, model: &Self) -> bool {
        let [own, expected] = [self, model].map(|grid| grid.placement.world_from_index);
        let axes = expected.matrix3;
        let voxel = [axes.x_axis, axes.y_axis, axes.z_axis].map(DVec3::length).into_iter();
        let most = TOLERANCE * voxel.fold(f64::INFINITY, f64::min);
        let [x, y, z] = model.dims.map(|n| n as f64);
        let corners = [DVec3::ZERO, DVec3::X * x, DVec3::Y * y, DVec3::Z * z];
        self.placement.is_anatomical == model.placement.is_anatomical
            && corners.into_iter().all(|corner| {
                own.transform_point3(corner).distance(expected.transform_point3(corner)) <= most
            })
    }
}
