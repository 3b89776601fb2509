//! Model of a VTK image that both file formats share: the grid, the arrays of point or cell values, and the chosen
//! array.

use std::io::{self, BufRead, BufReader, Read, Seek as _};

use glam::{DAffine3, DMat3, DVec3};

use super::super::input::stem;
use super::super::number::{FileNumberType, ScalarReduction, VoxelEncoding};
use super::super::placement::{GridPlacement, VolumeParts};
use super::super::reader::VolumeSource;
use super::super::samples::{ReadFault, VoxelLayout};
use super::super::voxels::ReadVoxels;
use super::super::{Endian, FileDimension, LoadControl, LoadError, LoadOptions, VolumeOffer};
use chiaroscuro_volume::{GridExtent, LoadContext, Modality, ValueMetadata, Volume};

/// Maximum number of arrays that a file may offer: more than simulations have.
pub(super) const MAX_ARRAYS: usize = 4096;

/// Maximum number of components of an array: tensors have nine.
pub(super) const MAX_COMPONENTS: usize = 1 << 10;

/// Regular grid of a VTK image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct VtkGrid {
    /// Points along the axes, none of them 0.
    pub(super) points: [u64; 3],
    /// Index of the first point; the point with index 0 is at the origin.
    pub(super) first: [f64; 3],
    pub(super) origin: DVec3,
    pub(super) spacing: DVec3,
    pub(super) direction: DMat3,
    /// True if the file gives the spacing of points.
    pub(super) has_spacing: bool,
}

impl VtkGrid {
    /// Creates a grid from the first and last index along each axis; `None` where a last index is below the first.
    pub(super) fn from_extent(extent: [i64; 6]) -> Option<Self> {
        let [x, xx, y, yy, z, zz] = extent;
        let points = |first: i64, last: i64| {
            u64::try_from(i128::from(last) - i128::from(first) + 1).ok().filter(|&points| points > 0)
        };
        Some(Self {
            points: [points(x, xx)?, points(y, yy)?, points(z, zz)?],
            first: [x, y, z].map(|first| first as f64),
            origin: DVec3::ZERO,
            spacing: DVec3::ONE,
            direction: DMat3::IDENTITY,
            has_spacing: false,
        })
    }

    /// Voxels along the axes. An axis with a single point has one layer of flat cells.
    pub(super) fn dims(&self, of_cells: bool) -> [u64; 3] {
        self.points.map(|points| if of_cells { (points - 1).max(1) } else { points })
    }

    /// Number of voxels, saturating at 64 bits.
    pub(super) fn count(&self, of_cells: bool) -> u64 {
        self.dims(of_cells).iter().fold(1u64, |product, &dim| product.saturating_mul(dim))
    }

    /// Placement of the voxels of an array: cell values are at the centres of cells.
    fn placement(&self, of_cells: bool) -> GridPlacement {
        if !self.has_spacing {
            return GridPlacement::unknown();
        }
        let shift = |axis: usize| if of_cells && self.points[axis] > 1 { 0.5 } else { 0.0 };
        let first = DVec3::from_array([0, 1, 2].map(|axis| self.first[axis] + shift(axis)));
        // VTK reverses such axes; in other programs the sign has no meaning.
        let remark = self.spacing.cmplt(DVec3::ZERO).any().then(|| {
            let [x, y, z] = self.spacing.to_array();
            format!("a spacing of {x} x {y} x {z}: axes with a negative spacing run backwards")
        });
        let axes = self.direction * DMat3::from_diagonal(self.spacing);
        let affine = DAffine3 { matrix3: axes, translation: self.origin + axes * first };
        GridPlacement::from_ras_affine(affine).without_anatomy().with_remark(remark)
    }
}

/// Array of values in a file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct VtkArray<P> {
    pub(super) name: String,
    pub(super) number: FileNumberType,
    pub(super) components: usize,
    /// True for cell data, false for point data.
    pub(super) is_cell_data: bool,
    pub(super) is_color: bool,
    /// Location of the values in the file.
    pub(super) location: P,
}

/// Chosen array, with the storage of its values and the part to read.
pub(super) struct ChosenVtkArray<P> {
    pub(super) array: VtkArray<P>,
    pub(super) stored: VoxelEncoding,
    pub(super) extent: GridExtent,
    /// True if the file has other arrays.
    is_one_of_several: bool,
}

impl<P> ChosenVtkArray<P> {
    /// Bytes of all values in binary encoding.
    pub(super) fn stored_bytes(&self) -> u64 {
        (self.extent.voxels as u64).saturating_mul(self.stored.voxel_bytes())
    }

    /// Number of numbers of all voxels, counting components.
    pub(super) fn numbers(&self) -> u64 {
        (self.extent.voxels as u64).saturating_mul(self.array.components as u64)
    }

    /// Reads the selected values; the reader is positioned at their beginning.
    ///
    /// # Errors
    /// `BadInput` also for errors of the reader about invalid or truncated data, since it decodes the file's content.
    pub(super) fn read(
        &self,
        context: LoadContext<'_>,
        reader: &mut impl Read,
        endian: Endian,
        control: &LoadControl,
    ) -> Result<ReadVoxels, LoadError> {
        const HELP: &str = "copy the file again, or write it again with another program";
        let stored = VoxelEncoding { endian, ..self.stored };
        let layout = VoxelLayout { extent: self.extent, voxel_type: stored.voxel_type(), endian };
        stored.read(reader, self.extent, control).map_err(|fault| match fault {
            ReadFault::Io(error) if is_content_error(&error) => {
                context.bad_input_error(&self.array.name, error.to_string(), HELP)
            }
            ReadFault::Io(error) if error.kind() == io::ErrorKind::OutOfMemory => {
                ReadFault::NoMemory.into_error(context, &layout, "bytes", HELP)
            }
            fault => fault.into_error(context, &layout, "bytes", HELP),
        })
    }

    /// Assembles the volume from the values.
    pub(super) fn volume(
        self,
        context: LoadContext<'_>,
        grid: &VtkGrid,
        voxels: ReadVoxels,
        title: &str,
        control: &LoadControl,
    ) -> Result<Volume, LoadError> {
        let mut placement = grid.placement(self.array.is_cell_data);
        placement.remarks.extend(self.stored.reduction.remark().map(str::to_owned));
        let file = stem(context.path);
        let name = if self.is_one_of_several { format!("{file} {}", self.array.name) } else { file };
        let mut hints = ValueMetadata::default();
        hints.modality = Modality::from_description(title);
        VolumeParts { name, extent: self.extent, placement, voxels, hints }.into_volume(context, control)
    }
}

/// Selects the array and its component by the user's choice.
pub(super) fn choose_array<P>(
    context: LoadContext<'_>,
    grid: &VtkGrid,
    mut arrays: Vec<VtkArray<P>>,
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<ChosenVtkArray<P>, LoadError> {
    if arrays.is_empty() {
        return Err(context.bad_input_error(
            "arrays",
            "it holds no array of numbers with a value for each point or cell",
            "write it again with the values as point data",
        ));
    }
    let is_one_of_several = arrays.len() > 1;
    let offers: Vec<VolumeOffer> = arrays
        .iter()
        .enumerate()
        .map(|(at, array)| VolumeOffer::with_number(at, &array.name, grid.dims(array.is_cell_data)))
        .collect();
    let choice = options.choice.with_only_scalar_array(&offers, |at| arrays[at].components == 1);
    let array = arrays.swap_remove(context.resolve_choice(&choice, FileDimension::Array, offers)?);
    let components = array.components;
    let component = options.choice.resolve_component(components, array.is_color);
    let part = ScalarReduction::require(context, component, components, array.is_color)?;
    // The byte order is set when values are read.
    let stored = VoxelEncoding { number: array.number, endian: Endian::Little, components, reduction: part };
    let dims = grid.dims(array.is_cell_data);
    let extent =
        GridExtent::checked(context, "dimensions", dims, stored.voxel_type(), options.limits(control))?;
    Ok(ChosenVtkArray { array, stored, extent, is_one_of_several })
}

/// Refuses truncated data before memory is allocated for them.
pub(super) fn check_available(
    context: LoadContext<'_>,
    field: &str,
    needed: u64,
    found: u64,
    unit: &str,
) -> Result<(), LoadError> {
    if needed <= found {
        return Ok(());
    }
    Err(context.bad_input_error(
        field,
        format!("the data are truncated: {needed} {unit} expected, at most {found} found"),
        "copy the file again",
    ))
}

/// Returns true if an error concerns the content of a file, not the disk.
pub(super) fn is_content_error(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::InvalidInput | io::ErrorKind::InvalidData | io::ErrorKind::UnexpectedEof
    )
}

/// Creates an error about the content of a file.
pub(super) fn invalid_data(why: impl Into<String>) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, why.into())
}

/// Opens the content of a file from offset `at` on, inflated where it is compressed.
pub(super) fn open_content_at<'a>(
    context: LoadContext<'_>,
    source: &'a mut VolumeSource<'_>,
    at: u64,
) -> Result<Box<dyn BufRead + 'a>, LoadError> {
    if !source.start.is_gzip() {
        source.input.seek(at).map_err(|error| context.io_error(error))?;
        return Ok(Box::new(&mut source.input.reader));
    }
    source.input.reader.rewind().map_err(|error| context.io_error(error))?;
    let control = source.control;
    let mut content = source.content();
    let mut left = at;
    // Bytes between two checks for cancellation.
    const BLOCK_BYTES: u64 = 1 << 20;
    while left > 0 {
        control.check()?;
        let want = left.min(BLOCK_BYTES);
        let got = io::copy(&mut content.by_ref().take(want), &mut io::sink())
            .map_err(|error| content_error(context, error))?;
        if got == 0 {
            break;
        }
        left -= got;
    }
    Ok(Box::new(BufReader::new(content)))
}

/// Converts an I/O error of a reader: `BadInput` where it concerns the content.
pub(super) fn content_error(context: LoadContext<'_>, error: io::Error) -> LoadError {
    if is_content_error(&error) {
        context.bad_input_error("content", format!("the file is broken: {error}"), "copy the file again")
    } else {
        context.io_error(error)
    }
}
