//! NumPy arrays: one in a file (`.npy`), or several in an archive (`.npz`).
//!
//! After the definition at <https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>, versions 1 to 3.

mod affine;
mod dictionary;
mod grid;
mod header;
#[cfg(test)]
mod tests;

use std::io::Read as _;

use flate2::CrcReader;

use super::input::stem;
use super::number::{ScalarReduction, VoxelEncoding};
use super::placement::{GridPlacement, VolumeParts};
use super::reader::{FormatReader, TrailingData, VolumeSource};
use super::samples::{ReadFault, VoxelLayout, is_corruption, skip_bytes};
use super::voxels::ReadVoxels;
use super::zip::{self, ZipDirectory, ZipEntry};
use super::{FileDimension, LoadError, VolumeOffer};
use affine::ArchiveAffine;
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::{GridExtent, LoadContext, ValueMetadata, Volume, quoted};
use grid::NumpyGrid;
use header::{MAGIC, NumpyHeader};

pub(crate) const NPY: FormatReader = FormatReader {
    name: "NumPy",
    extensions: &[".npy", ".npy.gz"],
    recognises: |start| start.has_at(MAGIC, 0),
    load: load_array,
};

pub(crate) const NPZ: FormatReader = FormatReader {
    name: "NumPy archive",
    extensions: &[".npz"],
    recognises: |start| zip::first_entry(start.stored()).is_some_and(|name| name.ends_with(ENDING)),
    load: load_archive,
};

/// Extension of arrays in an archive.
const ENDING: &str = ".npy";

const HELP: &str = "save the array again, or copy the file again";

/// Maximum number of arrays of an archive whose headers are read.
const MAX_ARRAYS: usize = 1024;

/// Selected volume of an array, and how it is stored.
struct ChosenNumpyArray {
    stored: VoxelEncoding,
    extent: GridExtent,
    /// Offset of its first voxel in the array's file, in bytes.
    at: u64,
    placement: GridPlacement,
}

/// Selects the volume of an array by the user's choice.
fn choose_volume(
    source: &VolumeSource<'_>,
    context: LoadContext<'_>,
    header: &NumpyHeader,
    grid: &NumpyGrid,
) -> Result<ChosenNumpyArray, LoadError> {
    let part = source.scalar_reduction(context, grid.components, grid.is_color)?;
    let stored = VoxelEncoding {
        number: grid.number,
        endian: grid.endian,
        components: grid.components,
        reduction: part,
    };
    let mut number = 0u64;
    for &(dimension, count) in &grid.outer {
        let chosen = source.choose_numbered(context, dimension, count, grid.dims, |_| String::new())?;
        number = number.saturating_mul(count).saturating_add(chosen as u64);
    }
    let extent = GridExtent::checked(
        context,
        "shape",
        grid.dims,
        stored.voxel_type(),
        source.options.limits(source.control),
    )?;
    let before = (extent.voxels as u64).saturating_mul(stored.voxel_bytes()).saturating_mul(number);
    let remark = match part {
        ScalarReduction::Magnitude => Some("complex numbers are shown as their magnitude"),
        other => other.remark(),
    };
    let placement = GridPlacement::unknown().with_remark(remark);
    Ok(ChosenNumpyArray { stored, extent, at: header.bytes.saturating_add(before), placement })
}

/// Loads a file of a single array.
fn load_array(mut source: VolumeSource<'_>) -> Result<Volume, LoadError> {
    let context = LoadContext { operation: "read the NumPy array", path: source.path };
    let header = NumpyHeader::read(context, &mut source.content())?;
    let grid = NumpyGrid::from_header(context, &header)?;
    let ChosenNumpyArray { stored, extent, at, placement } = choose_volume(&source, context, &header, &grid)?;
    let voxels = source.voxels(context, at, (&stored, extent), TrailingData::Allowed, HELP)?;
    let name = stem(source.path);
    VolumeParts { name, extent, placement, voxels, hints: ValueMetadata::default() }
        .into_volume(context, source.control)
}

/// Array in an archive that may be a volume.
struct ArchivedArray {
    entry: ZipEntry,
    header: NumpyHeader,
    grid: NumpyGrid,
}

impl ArchivedArray {
    /// Key by which it is chosen: its name.
    fn key(&self) -> String {
        sanitised(self.entry.name.trim_end_matches(ENDING), 80)
    }

    /// Returns true if it is likely no image: a matrix, a table or a list of points.
    fn is_table(&self) -> bool {
        self.grid.is_likely_table(self.header.shape.len())
    }
}

/// Loads an array of an archive.
fn load_archive(mut source: VolumeSource<'_>) -> Result<Volume, LoadError> {
    let context = LoadContext { operation: "read the NumPy archive", path: source.path };
    let mut directory = zip::read_central_directory(context, &mut source.input)?;
    let mut arrays: Vec<ArchivedArray> = Vec::new();
    let mut refused = Vec::new();
    let entries = std::mem::take(&mut directory.entries);
    for entry in entries.into_iter().filter(|entry| entry.name.ends_with(ENDING)).take(MAX_ARRAYS) {
        source.control.check()?;
        let header = zip::open_entry(context, &mut source.input, &entry)
            .and_then(|mut content| NumpyHeader::read(context, &mut content));
        match header.and_then(|header| NumpyGrid::from_header(context, &header).map(|grid| (header, grid))) {
            Ok((header, grid)) => arrays.push(ArchivedArray { entry, header, grid }),
            Err(error @ LoadError::Io { .. }) => return Err(error),
            Err(error) => refused.push(error),
        }
    }
    let affine = arrays.iter().find(|array| ArchiveAffine::is_held_by(&array.key(), &array.header));
    let affine = affine.map(|ArchivedArray { entry, header, grid }| {
        let read = ArchiveAffine::read(context, &mut source.input, entry, header, grid);
        (entry.name.clone(), read)
    });
    // Beside a volume, matrices and tables (an affine, directions, a list of points) are no images. One that the user
    // has named is still read.
    let named = source.options.choice.array.as_deref();
    if arrays.iter().any(|array| !array.is_table()) {
        arrays.retain(|array| !array.is_table() || named == Some(array.key().as_str()));
    }
    // Nor are one-dimensional arrays offered beside a volume; without any volume, the errors of the arrays are
    // reported.
    if arrays.is_empty() {
        return Err(no_array_error(context, &directory, refused));
    }
    let offers = arrays.iter().map(|array| {
        let key = array.key();
        VolumeOffer { name: key.clone(), key, dims: Some(array.grid.dims), color: None }
    });
    let offers: Vec<VolumeOffer> = offers.collect();
    let is_scalar = |at: usize| arrays[at].grid.components == 1 && arrays[at].grid.outer.is_empty();
    let choice = source.options.choice.with_only_scalar_array(&offers, is_scalar);
    let chosen = context.resolve_choice(&choice, FileDimension::Array, offers)?;
    let ArchivedArray { entry, header, grid } = arrays.swap_remove(chosen);
    let wanted = choose_volume(&source, context, &header, &grid)?;
    let voxels = read_entry(&mut source, context, &entry, &wanted)?;
    let ChosenNumpyArray { extent, mut placement, .. } = wanted;
    if let Some((_, affine)) = affine.filter(|(name, _)| *name != entry.name) {
        let mut placed = affine.placement(grid.array_axes);
        placed.remarks.append(&mut placement.remarks);
        placement = placed;
    }
    let name = sanitised(&format!("{} {}", stem(source.path), entry.name.trim_end_matches(ENDING)), 120);
    VolumeParts { name, extent, placement, voxels, hints: ValueMetadata::default() }
        .into_volume(context, source.control)
}

/// Error for an archive without a single array that is a volume: `refused` holds the errors of its arrays.
fn no_array_error(
    context: LoadContext<'_>,
    directory: &ZipDirectory,
    mut refused: Vec<LoadError>,
) -> LoadError {
    let count = refused.len();
    let arrays_among = |names: &[String]| names.iter().filter(|name| name.ends_with(ENDING)).count();
    let are = |count: usize| if count == 1 { "1 array is".to_owned() } else { format!("{count} arrays are") };
    let [encrypted, unsupported] =
        [&directory.encrypted, &directory.unsupported].map(|names| arrays_among(names));
    match refused.pop() {
        Some(only) if count == 1 => only,
        Some(_) => context.bad_input_error(
            "arrays",
            format!("none of its {count} arrays is a volume"),
            "save an array of numbers with three axes: z, y, x",
        ),
        None if encrypted > 0 => context.bad_input_error(
            "arrays",
            format!("{} encrypted, and cannot be read without a password", are(encrypted)),
            "unpack it with its password (`7z x FILE`), and open the array",
        ),
        None if unsupported > 0 => context.bad_input_error(
            "arrays",
            format!("{} compressed in a way that is not supported", are(unsupported)),
            "unpack it (`7z x FILE`) and open the array, or save it with numpy.savez_compressed",
        ),
        None => context.bad_input_error(
            "arrays",
            "it holds no arrays: no file in it ends in .npy",
            "save an array of numbers with three axes (z, y, x) with numpy.savez",
        ),
    }
}

/// Reads the selected volume of an archive entry.
fn read_entry(
    source: &mut VolumeSource<'_>,
    context: LoadContext<'_>,
    entry: &ZipEntry,
    wanted: &ChosenNumpyArray,
) -> Result<ReadVoxels, LoadError> {
    let ChosenNumpyArray { stored, extent, at, .. } = wanted;
    let needed = (extent.voxels as u64).saturating_mul(stored.voxel_bytes()).saturating_add(*at);
    // Before memory is allocated.
    if needed > entry.bytes {
        return Err(context.bad_input_error(
            "shape",
            format!(
                "the data of {} are truncated: {needed} bytes expected, {} found",
                quoted(&entry.name),
                entry.bytes
            ),
            HELP,
        ));
    }
    let control = source.control;
    let layout = VoxelLayout { extent: *extent, voxel_type: stored.voxel_type(), endian: stored.endian };
    let mut content = CrcReader::new(zip::open_entry(context, &mut source.input, entry)?);
    let mut read = || {
        if skip_bytes(&mut content, *at, control)? < *at {
            return Err(ReadFault::Short { got: 0 });
        }
        stored.read(&mut content, *extent, control)
    };
    let voxels = read().map_err(|fault| match fault {
        ReadFault::Io(error) if is_corruption(&error) => {
            broken_entry_error(context, entry, &format!("they cannot be decompressed: {error}"))
        }
        fault => fault.into_error(context, &layout, "bytes", HELP),
    })?;
    // The checksum covers the whole array, and can be verified only if all of it was read.
    let is_all = needed == entry.bytes && content.by_ref().read(&mut [0]).is_ok_and(|more| more == 0);
    if is_all && content.crc().sum() != entry.checksum {
        return Err(broken_entry_error(context, entry, "their checksum does not match"));
    }
    Ok(voxels)
}

fn broken_entry_error(context: LoadContext<'_>, entry: &ZipEntry, why: &str) -> LoadError {
    context.bad_input_error("data", format!("the data of {} are broken: {why}", quoted(&entry.name)), HELP)
}
