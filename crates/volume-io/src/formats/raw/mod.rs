//! RAW files: voxels without a header, x fastest. Their number and type are given by options, by a companion file, or
//! by the file name.

mod bytes;
mod layout;
mod layout_detection;
mod middle_slices;
mod name;
mod name_hints;
mod sidecar;
mod storage;

use std::path::Path;

use super::input::stem;
use super::number::FileNumberType;
use super::placement::GridPlacement;
use super::reader::{FormatReader, VolumeSource};
use super::{Endian, LoadError, LoadOptions};
pub use bytes::RawBytes;
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::{LoadContext, Volume, VoxelType, is_usable_spacing, quoted, spacing_ratio_error};
pub use layout::{RawGuess, RawLayout};
pub use layout_detection::{LayoutEvidence, LayoutProposal, propose_layouts};
pub use middle_slices::{MiddleSlices, PreviewSlice, read_middle_slices};
pub use name_hints::RawNameHints;
pub(super) use sidecar::{DAT, INI, IVF};
use storage::RawStorage;

/// Options for the layout of a RAW file. They override the file name and a companion file.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RawFormat {
    /// Voxels along x, y and z (`--dims`).
    pub dims: Option<[usize; 3]>,
    /// Number type of the voxels (`--type`).
    pub voxel_type: Option<VoxelType>,
    /// Distance between voxel centres along x, y and z, in millimetres (`--spacing`); unknown if not given.
    pub spacing_mm: Option<[f64; 3]>,
    /// Byte order (`--endian`); little-endian if not given.
    pub endian: Option<Endian>,
    /// Bytes before the first voxel, in the uncompressed file (`--offset`); 0 if not given.
    pub offset: Option<u64>,
}

pub(super) const READER: FormatReader = FormatReader {
    name: "RAW",
    extensions: &[".raw", ".raw.gz", ".dat", ".dat.gz"],
    recognises: |_| false,
    load,
};

const HELP: &str = "check --dims, --type and --endian";

/// Returns true if the name of a file, or a companion file, describes its voxels.
pub(super) fn is_described(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name::parse_file_name(&name, None).is_some() || sidecar::find_description(path).is_some()
}

/// Loads a RAW file.
fn load(source: VolumeSource<'_>) -> Result<Volume, LoadError> {
    let path = source.path;
    let context = LoadContext { operation: "read the RAW volume", path };
    let file_name = path.file_name().unwrap_or_default().to_string_lossy();
    let named = name::parse_file_name(&file_name, unpacked_length(&source));
    let (form, name) = if let Some(form) = storage_from_companion(context, &source, named.is_some())? {
        (form, stem(path))
    } else {
        let name = named.as_ref().map(|named| named.name.clone()).filter(|name| !name.is_empty());
        let form = storage_from_options(context, source.options, named, &file_name)?;
        (form, name.map_or_else(|| stem(path), |name| sanitised(&name, 120)))
    };
    with_overrides(context, form, &source.options.raw)?.read(source, context, name, HELP)
}

/// Number of bytes of voxels, unless the file is compressed.
fn unpacked_length(source: &VolumeSource<'_>) -> Option<u64> {
    let offset = source.options.raw.offset.unwrap_or(0);
    (!source.start.is_gzip()).then(|| source.input.len.checked_sub(offset)).flatten()
}

/// Layout by a companion file, unless the options give the dimensions.
fn storage_from_companion(
    context: LoadContext<'_>,
    source: &VolumeSource<'_>,
    is_named: bool,
) -> Result<Option<RawStorage>, LoadError> {
    if source.options.raw.dims.is_some() {
        return Ok(None);
    }
    match sidecar::find_description(source.path) {
        Some(Ok(form)) => Ok(Some(form)),
        Some(Err(error)) if is_named => {
            context.warn(format_args!("the description beside it is not used: {error}"));
            Ok(None)
        }
        Some(Err(error)) => Err(error),
        None => Ok(None),
    }
}

/// Layout by the options and the file name.
fn storage_from_options(
    context: LoadContext<'_>,
    options: &LoadOptions,
    named: Option<name::RawFileName>,
    file_name: &str,
) -> Result<RawStorage, LoadError> {
    let format = &options.raw;
    let (dims, dims_field) = match (format.dims, &named) {
        (Some(dims), _) => (dims.map(|n| n as u64), "--dims"),
        (None, Some(named)) => (named.dims, "file name"),
        (None, None) => {
            return Err(context.bad_input_error(
                "file name",
                format!("the name {} does not state the dimensions and the type", quoted(file_name)),
                "give --dims and --type, or name it like skull_256x256x256_uint8.raw",
            ));
        }
    };
    let named_type = named.as_ref().and_then(|named| named.voxel_type);
    let Some(voxel_type) = format.voxel_type.or(named_type) else {
        return Err(context.bad_input_error(
            "--type",
            "neither the options nor the file name state the voxel type",
            "give --type: uint8, int8, uint16, int16, uint32, int32, float32 or float64",
        ));
    };
    let is_guessed = format.voxel_type.is_none() && named.as_ref().is_some_and(|named| named.is_type_guessed);
    let remark = is_guessed.then(|| {
        format!("its name does not state the voxel type: by the file size it is {}", voxel_type.name())
    });
    let mut form = RawStorage::new(dims, dims_field, FileNumberType::from_voxel_type(voxel_type));
    form.placement = GridPlacement::unknown().with_remark(remark);
    form.endian = named.and_then(|named| named.endian).unwrap_or(Endian::Little);
    Ok(form)
}

/// Replaces properties of a layout by the options that are given.
fn with_overrides(
    context: LoadContext<'_>,
    mut form: RawStorage,
    format: &RawFormat,
) -> Result<RawStorage, LoadError> {
    if let Some(dims) = format.dims {
        (form.dims, form.dims_source) = (dims.map(|n| n as u64), "--dims");
    }
    if let Some(voxel_type) = format.voxel_type {
        (form.number, form.components, form.is_color) =
            (FileNumberType::from_voxel_type(voxel_type), 1, false);
    }
    form.endian = format.endian.unwrap_or(form.endian);
    form.offset = format.offset.or(form.offset);
    if let Some(spacing_mm) = format.spacing_mm {
        if !spacing_mm.into_iter().all(is_usable_spacing) {
            return Err(context.bad_input_error(
                "--spacing",
                format!("{spacing_mm:?} mm is not a usable voxel spacing"),
                "give three lengths in millimetres, each above 0",
            ));
        }
        if let Some(why) = spacing_ratio_error(spacing_mm) {
            let help = "give the three lengths in one unit, millimetres";
            return Err(context.bad_input_error("--spacing", why, help));
        }
        let remarks = std::mem::take(&mut form.placement.remarks);
        form.placement = GridPlacement { remarks, ..GridPlacement::from_spacing(spacing_mm) };
    }
    Ok(form)
}

/// Compares the file name of a path with a name that may have folders, ignoring case, since some systems do.
fn is_same_file_name(path: &Path, name: &str) -> bool {
    let last = name.rsplit(['/', '\\']).next().unwrap_or(name);
    path.file_name().is_some_and(|file| file.to_string_lossy().eq_ignore_ascii_case(last))
}
