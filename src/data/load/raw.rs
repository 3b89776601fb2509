//! RAW: voxels and nothing else, x fastest; the file's name says how many and of which type.
//!
//! `NAME_XxYxZ_TYPE.raw` or `.raw.gz`, as in the `OpenSciVis` datasets: `skull_256x256x256_uint8.raw`.

use glam::DVec3;

use super::input::stem;
use super::reader::{Reader, Source};
use super::samples::{Layout, read_binary, read_gzip};
use super::{Endian, LoadError};
use crate::data::attempt::{Attempt, quoted};
use crate::data::attempt::{Extent, is_usable_spacing, unlike_spacings};
use crate::data::plain;
use crate::data::{Volume, VoxelType};

/// How a RAW file is stored. What is given overrides what the file's name says.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RawFormat {
    /// Voxels along x, y, z (`--dims`).
    pub dims: Option<[usize; 3]>,
    /// The number type (`--type`).
    pub voxel_type: Option<VoxelType>,
    /// Distance between voxel centres along x, y, z in millimetres (`--spacing`), else 1.
    pub spacing_mm: Option<[f64; 3]>,
    /// The byte order (`--endian`), else little.
    pub endian: Option<Endian>,
    /// Bytes before the first voxel, after inflating (`--offset`), else 0.
    pub offset: Option<u64>,
}

/// A header longer than this is not a header: the suggestion of `--offset` would mislead.
const LONGEST_HEADER_BYTES: u64 = 1 << 20;

/// What the name of a RAW file says.
#[derive(Debug, PartialEq)]
struct NamedFormat {
    name: String,
    dims: [u64; 3],
    voxel_type: VoxelType,
}

pub(super) const READER: Reader =
    Reader { name: "RAW", endings: &[".raw", ".raw.gz"], recognises: |_| false, load };

/// Loads a RAW file.
fn load(source: Source<'_>) -> Result<Volume, LoadError> {
    let Source { path, mut input, start, options, control } = source;
    let attempt = Attempt { what: "read the RAW volume", path };
    let format = options.raw;
    let file_name = path.file_name().unwrap_or_default().to_string_lossy();
    let named = parse_name(&file_name);
    let (dims, dims_field) = match (format.dims, &named) {
        (Some(dims), _) => (dims.map(|n| n as u64), "--dims"),
        (None, Some(named)) => (named.dims, "file name"),
        (None, None) => {
            return Err(attempt.bad_input(
                "file name",
                format!("the name {} does not say the dimensions and the type", quoted(&file_name)),
                "give --dims and --type, or name it like skull_256x256x256_uint8.raw",
            ));
        }
    };
    let Some(voxel_type) = format.voxel_type.or(named.as_ref().map(|named| named.voxel_type)) else {
        return Err(attempt.bad_input(
            "--type",
            "neither the options nor the file name say the type of the voxels",
            "give --type: uint8, int8, uint16, int16, uint32, int32, float32 or float64",
        ));
    };
    let spacing_mm = format.spacing_mm.unwrap_or([1.0; 3]);
    if !spacing_mm.into_iter().all(is_usable_spacing) {
        return Err(attempt.bad_input(
            "--spacing",
            format!("{spacing_mm:?} mm cannot be distances between voxels"),
            "give three lengths in millimetres, each above 0",
        ));
    }
    if let Some(why) = unlike_spacings(spacing_mm) {
        return Err(attempt.bad_input("--spacing", why, "give the three lengths in one unit, millimetres"));
    }
    let extent = Extent::checked(attempt, dims_field, dims, voxel_type, options.memory_budget_bytes)?;
    let layout = Layout { extent, voxel_type, endian: format.endian.unwrap_or(Endian::Little) };
    let offset = format.offset.unwrap_or(0);

    // Voxels may begin with gzip's magic by chance: a file of the right size is not compressed.
    let fits_exactly = offset.checked_add(extent.bytes) == Some(input.len);
    let zipped_name = file_name.to_lowercase().ends_with(".gz");
    let samples = if start.is_gzip() && (zipped_name || !fits_exactly) {
        read_gzip(input.reader, offset, &layout, control).map_err(|fault| {
            fault.into_error(attempt, &layout, "bytes", "check the dimensions, the type and --offset")
        })?
    } else {
        check_length(attempt, &layout, input.len, format.offset)?;
        input.seek(offset).map_err(|error| attempt.io(error))?;
        read_binary(&mut input.reader, &layout, control).map_err(|fault| {
            fault.into_error(attempt, &layout, "bytes", "the file has changed meanwhile: load it again")
        })?
    };
    let name = named.map_or_else(|| stem(path), |named| plain(&named.name, 120));
    Volume::with_spacing(name, extent.dims, DVec3::from_array(spacing_mm), samples)
        .map_err(|error| attempt.bad_input("data", error.to_string(), "check --dims, --type and --endian"))
}

/// Checks that a file of `len` bytes holds the voxels and nothing but them and the offset.
fn check_length(
    attempt: Attempt<'_>,
    layout: &Layout,
    len: u64,
    offset: Option<u64>,
) -> Result<(), LoadError> {
    let Extent { dims: [x, y, z], voxels, bytes } = layout.extent;
    let expected = offset.unwrap_or(0).checked_add(bytes);
    if expected == Some(len) {
        return Ok(());
    }
    let after = offset.map_or(String::new(), |offset| format!(" after an offset of {offset}"));
    let why = format!(
        "{} bytes were expected for {x} x {y} x {z} voxels of {}{after}, {len} were found",
        expected.map_or("more than 2^64".to_owned(), |expected| expected.to_string()),
        layout.voxel_type.name()
    );
    let excess = len.saturating_sub(bytes);
    let fitting =
        VoxelType::ALL.into_iter().find(|t| (voxels as u64).checked_mul(t.bytes() as u64) == Some(len));
    let help = match (offset, fitting) {
        (None, Some(fitting)) => {
            format!("the length fits {}-byte voxels: try --type {}", fitting.bytes(), fitting.name())
        }
        (_, _) if excess > 0 && excess <= LONGEST_HEADER_BYTES => {
            format!("if the file begins with a header of {excess} bytes, give --offset {excess}")
        }
        _ => "check the dimensions and the type, or copy the file again".to_owned(),
    };
    Err(attempt.bad_input("file size", why, help))
}

/// Takes `NAME_XxYxZ_TYPE.raw[.gz]` apart.
fn parse_name(file_name: &str) -> Option<NamedFormat> {
    let base = strip_ending(file_name, ".gz").unwrap_or(file_name);
    let base = strip_ending(base, ".raw")?;
    let (base, voxel_type) = base.rsplit_once('_')?;
    let (name, dims) = base.rsplit_once('_')?;
    let voxel_type = VoxelType::ALL.into_iter().find(|t| t.name().eq_ignore_ascii_case(voxel_type))?;
    let mut numbers = dims.split(['x', 'X']).map(parse_digits);
    let dims = [numbers.next()??, numbers.next()??, numbers.next()??];
    (numbers.next().is_none() && !name.is_empty()).then(|| NamedFormat {
        name: name.to_owned(),
        dims,
        voxel_type,
    })
}

/// A number of digits only; a number too large for 64 bits is too large for anything.
fn parse_digits(digits: &str) -> Option<u64> {
    let all_digits = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
    all_digits.then(|| digits.parse().unwrap_or(u64::MAX))
}

/// `name` without an ASCII `ending`, in any case.
fn strip_ending<'a>(name: &'a str, ending: &str) -> Option<&'a str> {
    let start = name.len().checked_sub(ending.len())?;
    let (base, found) = name.split_at_checked(start)?;
    found.eq_ignore_ascii_case(ending).then_some(base)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_say_the_format() {
        let named = parse_name("head_cropped_256x128x64_UInt16.raw.gz").unwrap();
        assert_eq!((named.name.as_str(), named.dims), ("head_cropped", [256, 128, 64]));
        assert_eq!(named.voxel_type, VoxelType::U16);
        for voxel_type in VoxelType::ALL {
            let name = format!("a_1x2x3_{}.RAW", voxel_type.name());
            assert_eq!(parse_name(&name).map(|named| named.voxel_type), Some(voxel_type));
        }
        let huge = parse_name("a_99999999999999999999999x1x1_int8.raw").unwrap();
        assert_eq!(huge.dims[0], u64::MAX);
    }

    #[test]
    fn other_names_say_nothing() {
        for name in [
            "_1x2x3_uint8.raw",
            "a_1x2_uint8.raw",
            "a_1x2x3x4_uint8.raw",
            "a_1x+2x3_uint8.raw",
            "a_1xx3_uint8.raw",
            "a_1x2x3_uint64.raw",
            "a_1x2x3.raw",
            "a_1x2x3_uint8.dat",
            "é.raw",
            "raw",
            "",
        ] {
            assert_eq!(parse_name(name), None, "{name}");
        }
    }
}
