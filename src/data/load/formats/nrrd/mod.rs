//! NRRD, "nearly raw raster data": a text header, and the voxels behind it or in a second file.
//!
//! After the definition at <https://teem.sourceforge.net/nrrd/format.html>, versions 1 to 5.
//! Encodings raw, gzip and text. World space is right-anterior-superior millimetres.

mod files;
mod geometry;
mod header;
mod hints;
mod layout;
mod space;
#[cfg(test)]
mod tests;

use super::beside;
use super::input::{Input, Witness, stem};
use super::reader::{Reader, Source};
use super::samples::{Layout, read_binary, read_gzip, read_text};
use super::{Endian, LoadControl, LoadError};
use crate::data::attempt::Attempt;
use crate::data::attempt::Extent;
use crate::data::{Samples, ValueRange, Volume, VoxelType, plain};
use geometry::Geometry;
use header::Header;
use layout::{Encoding, Storage};

/// Whether a file that begins like this is an NRRD file.
pub(super) fn is_nrrd(magic: &[u8]) -> bool {
    magic.starts_with(b"NRRD000")
}

pub(super) const READER: Reader =
    Reader { name: "NRRD", endings: &[".nrrd", ".nhdr"], recognises: |start| is_nrrd(start.stored()), load };

/// Loads an NRRD file.
fn load(source: Source<'_>) -> Result<Volume, LoadError> {
    let Source { path, mut input, options, control, .. } = source;
    let attempt = Attempt { what: "read the NRRD volume", path };
    let header = Header::read(attempt, &mut input.reader)?;
    let storage = Storage::from_header(attempt, &header)?;
    let geometry = Geometry::from_header(attempt, &header)?;
    let extent =
        Extent::checked(attempt, "sizes", geometry.dims, storage.voxel_type, options.memory_budget_bytes)?;
    // Text has no byte order and one-byte voxels need none.
    let endian = storage.endian.unwrap_or(Endian::Little);
    let layout = Layout { extent, voxel_type: storage.voxel_type, endian };

    let samples = match header.get("data file") {
        None => {
            let start = header.data_start(attempt)?;
            input.seek(start).map_err(|error| attempt.io(error))?;
            read_data(attempt, input, start, &storage, &layout, control)?
        }
        Some(name) => {
            files::check_single(attempt, name)?;
            let data_path = beside::resolve(attempt, files::FIELD, name)?;
            let attempt = Attempt { what: "read the NRRD volume's data file", path: &data_path };
            let input = Input::open(attempt)?;
            let witness = Witness::of(attempt, &input)?;
            witness.vouch(attempt, read_data(attempt, input, 0, &storage, &layout, control))?
        }
    };
    let name = header.get("content").filter(|content| !content.is_empty());
    let name = name.map_or_else(|| stem(path), |content| plain(content, 120));
    Volume::new(name, extent.dims, geometry.world_from_index, samples)
        .map(|volume| volume.with_anatomy(geometry.is_anatomical).with_hints(header.hints()))
        .and_then(|volume| match volume.hints().padding {
            // A volume of padding alone is shown as it is.
            Some(padding) if volume.value_range() != ValueRange::new(padding, padding) => {
                volume.with_padding(padding)
            }
            _ => Ok(volume),
        })
        .map_err(|error| attempt.bad_input("data", error.to_string(), "check the header against the data"))
}

/// Reads the voxels from `input`, whose data begin at byte `start`, before any skipping.
fn read_data(
    attempt: Attempt<'_>,
    mut input: Input,
    start: u64,
    storage: &Storage,
    layout: &Layout,
    control: &LoadControl,
) -> Result<Samples, LoadError> {
    const HELP: &str = "check sizes, type and the skips in the header, or copy the file again";
    let Some(skipped) = input.skip_lines(attempt, storage.line_skip, control)? else {
        return Err(attempt.bad_input(
            "line skip",
            format!("the data end before {} lines have been skipped", storage.line_skip),
            HELP,
        ));
    };
    let start = start + skipped;
    let available = input.len.saturating_sub(start);
    match storage.encoding {
        Encoding::Raw => {
            let bytes = layout.extent.bytes;
            let skip = match storage.byte_skip {
                Some(skip) => skip,
                None => available.saturating_sub(bytes),
            };
            let found = available.saturating_sub(skip);
            if found < bytes {
                let [x, y, z] = layout.extent.dims;
                let name = layout.voxel_type.name();
                return Err(attempt.bad_input(
                    "sizes",
                    format!(
                        "the data are truncated: {bytes} bytes expected for {x} x {y} x {z} voxels of {name}, \
                         {found} found"
                    ),
                    HELP,
                ));
            }
            if found > bytes {
                // Legal: several headers can point into one file.
                attempt.warn(format_args!("{} bytes after the voxels are ignored", found - bytes));
            }
            input.seek(start + skip).map_err(|error| attempt.io(error))?;
            read_binary(&mut input.reader, layout, control)
                .map_err(|fault| fault.into_error(attempt, layout, "bytes", HELP))
        }
        Encoding::Gzip => {
            // The skipped bytes of compressed data are counted after inflating.
            read_gzip(input.reader, storage.byte_skip.unwrap_or(0), layout, control)
                .map_err(|fault| fault.into_error(attempt, layout, "bytes", HELP))
        }
        Encoding::Text => {
            let skip = storage.byte_skip.unwrap_or(0);
            // A digit each and a space between: less cannot hold the voxels, and nothing is allocated.
            let voxels = layout.extent.voxels as u64;
            let most = available.saturating_sub(skip).div_ceil(2);
            if most < voxels {
                return Err(attempt.bad_input(
                    "sizes",
                    format!("the data are truncated: {voxels} numbers expected, room for {most} found"),
                    HELP,
                ));
            }
            input.seek(start + skip).map_err(|error| attempt.io(error))?;
            read_text(&mut input.reader, layout, control)
                .map_err(|fault| fault.into_error(attempt, layout, "numbers", HELP))
        }
    }
}

/// Whether binary voxels of this type need a byte order.
fn needs_endian(voxel_type: VoxelType) -> bool {
    voxel_type.bytes() > 1
}
