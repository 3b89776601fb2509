//! Grid and voxel storage of a `MetaImage`: dimensions, number type, byte order, compression.

use super::super::number::{FileNumberType, ScalarReduction, VoxelEncoding};
use super::super::{Endian, LoadError, VolumeChoice};
use super::header::MetaImageHeader;
use chiaroscuro_volume::{LoadContext, quoted};

/// Fields with the slope and intercept from stored numbers to values.
pub(super) const SLOPE: &str = "ElementToIntensityFunctionSlope";
pub(super) const INTERCEPT: &str = "ElementToIntensityFunctionOffset";

/// Maximum number of selectable volumes in a file: longer than any scanner's series.
const MAX_FRAMES: u64 = 1 << 16;

/// Maximum number of components of a voxel: real files have three, or the coefficients of a model.
const MAX_COMPONENTS: usize = 1 << 10;

/// Grid of voxels and number of volumes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct MetaImageGrid {
    /// Lengths of all 2 to 4 dimensions.
    pub(super) sizes: Vec<u64>,
    /// Number of voxels along x, y, z.
    pub(super) dims: [u64; 3],
    /// Length of the fourth dimension: number of volumes.
    pub(super) frames: usize,
}

impl MetaImageGrid {
    pub(super) fn parse(context: LoadContext<'_>, header: &MetaImageHeader) -> Result<Self, LoadError> {
        let text = header.require(context, "NDims", "write NDims = 3")?;
        let Some(count) = text.parse::<usize>().ok().filter(|count| (2..=4).contains(count)) else {
            return Err(context.bad_input_error(
                "NDims",
                format!("2 to 4 dimensions were expected, {} was found", quoted(text)),
                "write it again with three dimensions",
            ));
        };
        let text = header.require(context, "DimSize", "write the numbers of voxels along all axes")?;
        let sizes: Option<Vec<u64>> =
            text.split_whitespace().take(count + 1).map(|word| word.parse().ok()).collect();
        let Some(sizes) = sizes.filter(|sizes| sizes.len() == count) else {
            return Err(context.bad_input_error(
                "DimSize",
                format!("{count} numbers of voxels were expected, {} was found", quoted(text)),
                "correct the header",
            ));
        };
        let size = |axis: usize| sizes.get(axis).copied().unwrap_or(1);
        let (dims, frames) = ([size(0), size(1), size(2)], size(3));
        match frames {
            0 => Err(context.bad_input_error(
                "DimSize",
                format!("{} holds no voxels", quoted(text)),
                "every dimension must be at least 1",
            )),
            1..=MAX_FRAMES => Ok(Self { dims, frames: frames as usize, sizes }),
            _ => Err(context.limit_error(
                "DimSize",
                format!("{frames} volumes are too many: at most {MAX_FRAMES} are supported"),
                "split the file",
            )),
        }
    }

    /// Returns the number of voxels of a volume, saturating.
    pub(super) fn voxels(&self) -> u64 {
        self.dims.iter().fold(1, |product, &n| product.saturating_mul(n))
    }
}

/// Storage of the voxels: number type, encoding and header size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct MetaImageStorage {
    pub(super) stored: VoxelEncoding,
    pub(super) is_compressed: bool,
    pub(super) is_text: bool,
    /// Bytes to skip before the voxels of each file; `None` if the voxels are the last bytes (`HeaderSize = -1`).
    pub(super) header_bytes: Option<u64>,
}

impl MetaImageStorage {
    pub(super) fn parse(
        context: LoadContext<'_>,
        header: &MetaImageHeader,
        choice: &VolumeChoice,
    ) -> Result<Self, LoadError> {
        let text = header.require(context, "ElementType", "write for example MET_SHORT")?;
        let number = number_from_name(text).ok_or_else(|| {
            context.bad_input_error(
                "ElementType",
                format!(
                    "a type like MET_UCHAR, MET_SHORT or MET_FLOAT was expected, {} was found",
                    quoted(text)
                ),
                "write it again with one of these types",
            )
        })?;
        let text = header.get("ElementNumberOfChannels").unwrap_or("1");
        let Some(components) = text.parse().ok().filter(|count| (1..=MAX_COMPONENTS).contains(count)) else {
            return Err(context.bad_input_error(
                "ElementNumberOfChannels",
                format!("1 to {MAX_COMPONENTS} channels were expected, {} was found", quoted(text)),
                "correct the header",
            ));
        };
        // The format has no flag for colour, but three or four bytes per voxel are nearly always one.
        let is_color = number == FileNumberType::U8 && matches!(components, 3 | 4);
        let part = ScalarReduction::require(
            context,
            choice.resolve_component(components, is_color),
            components,
            is_color,
        )?;
        let is_text = header.flag(&["BinaryData"]) == Some(false);
        let is_big = header.flag(&["BinaryDataByteOrderMSB", "ElementByteOrderMSB"]) == Some(true);
        // Numbers in text have no byte order: the parser emits little-endian bytes.
        let endian = if is_big && !is_text { Endian::Big } else { Endian::Little };
        let is_compressed = header.flag(&["CompressedData"]) == Some(true);
        let text = header.get("HeaderSize").unwrap_or("0");
        let header_bytes = match (text, text.parse()) {
            (_, Ok(bytes)) => Some(bytes),
            ("-1", _) if !is_compressed && !is_text => None,
            ("-1", _) => {
                return Err(context.bad_input_error(
                    "HeaderSize",
                    "-1 (the voxels are the last bytes) is possible with plain binary data only",
                    "give the number of bytes to skip",
                ));
            }
            _ => {
                return Err(context.bad_input_error(
                    "HeaderSize",
                    format!("a number of bytes or -1 was expected, {} was found", quoted(text)),
                    "correct the header",
                ));
            }
        };
        let stored = VoxelEncoding { number, endian, components, reduction: part };
        Ok(Self { stored, is_compressed, is_text, header_bytes })
    }
}

/// Maps `ElementType` to a number type. A `LONG` has four bytes, whatever machine wrote it.
fn number_from_name(text: &str) -> Option<FileNumberType> {
    let name = text.strip_prefix("MET_")?;
    Some(match name.strip_suffix("_ARRAY").unwrap_or(name) {
        "CHAR" | "ASCII_CHAR" => FileNumberType::I8,
        "UCHAR" => FileNumberType::U8,
        "SHORT" => FileNumberType::I16,
        "USHORT" => FileNumberType::U16,
        "INT" | "LONG" => FileNumberType::I32,
        "UINT" | "ULONG" => FileNumberType::U32,
        "LONG_LONG" => FileNumberType::I64,
        "ULONG_LONG" => FileNumberType::U64,
        "FLOAT" => FileNumberType::F32,
        "DOUBLE" => FileNumberType::F64,
        _ => return None,
    })
}
