//! Interpretation of the axes of a NumPy array: the three fastest are a volume, those before count volumes.

use super::super::number::FileNumberType;
use super::super::volume_axes::{VolumeAxes, has_color_axis, is_likely_table};
use super::super::{Endian, FileDimension, LoadError};
use super::header::NumpyHeader;
use chiaroscuro_volume::{LoadContext, quoted};

/// Array as one or several volumes.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct NumpyGrid {
    /// Dimensions that count volumes, with their lengths, slowest first.
    pub(super) outer: Vec<(FileDimension, u64)>,
    /// Voxels along x, y and z.
    pub(super) dims: [u64; 3],
    /// Index of the array's axis along x, y and z; `None` for the depth of a picture.
    pub(super) array_axes: [Option<usize>; 3],
    pub(super) number: FileNumberType,
    pub(super) endian: Endian,
    pub(super) components: usize,
    pub(super) is_color: bool,
}

impl NumpyGrid {
    /// Interprets the axes. Axes of length 1 are dropped while there are more than three.
    pub(super) fn from_header(context: LoadContext<'_>, header: &NumpyHeader) -> Result<Self, LoadError> {
        let (number, endian, mut components) = parse_type_code(&header.descr).ok_or_else(|| {
            context.bad_input_error(
                "descr",
                format!("elements of type {} are not supported", quoted(&header.descr)),
                "convert the array to whole or real numbers of at most 64 bits, for example with astype(numpy.float32)",
            )
        })?;
        // Slowest first, as in the file.
        let shape = &header.shape;
        let mut axes: Vec<usize> = (0..shape.len()).collect();
        if header.is_fortran {
            axes.reverse();
        }
        let is_color = has_color_axis(number, axes.iter().map(|&axis| shape[axis]));
        if is_color {
            components = axes.pop().map_or(1, |axis| shape[axis]) as usize;
        }
        let VolumeAxes { outer, axes } = VolumeAxes::from_axes(shape, axes, false).map_err(|count| {
            context.bad_input_error(
                "shape",
                format!("an array of {count} axes is not a volume"),
                "save an array of two or three axes (z, y, x), or of four or five: time, channel, z, y, x",
            )
        })?;
        let outer: Vec<(FileDimension, u64)> =
            outer.iter().map(|axis| (axis.dimension, axis.count)).collect();
        let dims = axes.map(|axis| axis.map_or(1, |axis| shape[axis]));
        if let Some((dimension, _)) = outer.iter().find(|(_, count)| *count == 0) {
            return Err(context.bad_input_error(
                "shape",
                format!("the array has no {}", dimension.plural()),
                "every axis must have at least one element",
            ));
        }
        Ok(Self { outer, dims, array_axes: axes, number, endian, components, is_color })
    }
}

impl NumpyGrid {
    /// Returns true if the array, which has so many axes, is likely no image.
    pub(super) fn is_likely_table(&self, axes: usize) -> bool {
        is_likely_table([self.dims[0], self.dims[1]], axes == 2)
    }
}

/// Parses a type code: number type, byte order, and number of components per element.
fn parse_type_code(descr: &str) -> Option<(FileNumberType, Endian, usize)> {
    let (endian, code) = match descr.split_at_checked(1)? {
        (">", code) => (Endian::Big, code),
        ("<" | "|" | "=", code) => (Endian::Little, code),
        _ => (Endian::Little, descr),
    };
    let (number, components) = match code {
        "b1" | "u1" => (FileNumberType::U8, 1),
        "i1" => (FileNumberType::I8, 1),
        "u2" => (FileNumberType::U16, 1),
        "i2" => (FileNumberType::I16, 1),
        "u4" => (FileNumberType::U32, 1),
        "i4" => (FileNumberType::I32, 1),
        "u8" => (FileNumberType::U64, 1),
        "i8" => (FileNumberType::I64, 1),
        "f2" => (FileNumberType::F16, 1),
        "f4" => (FileNumberType::F32, 1),
        "f8" => (FileNumberType::F64, 1),
        "c8" => (FileNumberType::F32, 2),
        "c16" => (FileNumberType::F64, 2),
        _ => return None,
    };
    Some((number, endian, components))
}
