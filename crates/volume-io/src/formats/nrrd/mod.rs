//! NRRD, "nearly raw raster data": a text header, and the voxels behind it or in other files.
//!
//! After the definition at <https://teem.sourceforge.net/nrrd/format.html>, versions 1 to 5. World space is
//! right-anterior-superior millimetres. A non-spatial axis holds components if it is the fastest, and time steps if
//! it is the slowest, unless its kind says that it holds components; an axis of kind `list` holds volumes, wherever
//! it stands.

mod axis_bounds;
mod data_files;
mod data_stream;
mod geometry;
mod header;
mod hints;
mod planar_components;
mod space;
mod storage;
#[cfg(test)]
mod tests;

use super::companion_path;
use super::input::stem;
use super::label_tables;
use super::number::{FileNumberType, ScalarReduction, VoxelEncoding};
use super::placement::VolumeParts;
use super::reader::{FormatReader, VolumeSource};
use super::samples::{ReadFault, VoxelLayout};
use super::voxels::ValueMapping;
use super::{Endian, FileDimension, LoadError, LoadOptions, VolumeOffer};
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::{GridExtent, LoadContext, ValueMeaning, Volume, human_bytes};
use data_stream::{DataLocation, HELP, NrrdDataStream};
use geometry::NrrdGeometry;
use header::NrrdHeader;
use storage::{NrrdEncoding, NrrdStorage};

/// Maximum number of time steps of one file.
const MAX_FRAMES: u64 = 1 << 16;

/// True if these bytes begin an NRRD file.
pub(super) fn is_nrrd(magic: &[u8]) -> bool {
    magic.starts_with(b"NRRD000")
}

pub(super) const READER: FormatReader = FormatReader {
    name: "NRRD",
    extensions: &[".nrrd", ".nhdr"],
    recognises: |start| is_nrrd(start.stored()),
    load,
};

/// Loads an NRRD file, with its data files.
fn load(source: VolumeSource<'_>) -> Result<Volume, LoadError> {
    let VolumeSource { path, mut input, options, control, .. } = source;
    let context = LoadContext { operation: "read the NRRD volume", path };
    let header = NrrdHeader::read(context, &mut input.reader)?;
    let storage = NrrdStorage::from_header(context, &header)?;
    let mut geometry = NrrdGeometry::from_header(context, &header)?;
    let mut hints = header.hints();
    let is_layered = hints.meaning == ValueMeaning::Labels && geometry.components > 1;
    let (frame, part) = selected_frame_and_part(context, &geometry, storage.number, is_layered, options)?;
    // Text is parsed to little-endian bytes, and single bytes have no byte order.
    let endian = storage.endian.filter(|_| storage.encoding != NrrdEncoding::Text).unwrap_or(Endian::Little);
    // One of several component planes is read like a time step.
    let (frame, frames, stored) = match part {
        ScalarReduction::Component(plane) if geometry.is_planar => {
            (plane as u64, geometry.components as u64, VoxelEncoding::scalar(storage.number, endian))
        }
        _ => {
            let stored = VoxelEncoding {
                number: storage.number,
                endian,
                components: geometry.components,
                reduction: part,
            };
            (frame, geometry.frames, stored)
        }
    };
    let extent =
        GridExtent::checked(context, "sizes", geometry.dims, stored.voxel_type(), options.limits(control))?;
    let bytes_of_frame = (extent.voxels as u64)
        .checked_mul(stored.voxel_bytes())
        .filter(|bytes| bytes.checked_mul(frames).is_some())
        .ok_or_else(|| context.limit_error("sizes", "all time steps have more than 2^64 bytes", HELP))?;

    let data_locations = match data_files::data_file_names(context, &header, &geometry.sizes)? {
        None => vec![DataLocation::Attached(path.to_owned(), header.data_start(context)?)],
        Some(names) => names
            .iter()
            .map(|name| companion_path::resolve(context, data_files::FIELD, name).map(DataLocation::Detached))
            .collect::<Result<_, _>>()?,
    };
    let bytes_of_file = bytes_of_frame * frames / data_locations.len() as u64;
    let mut data = NrrdDataStream::new(data_locations, storage, bytes_of_file, control);
    let layout = VoxelLayout { extent, voxel_type: stored.voxel_type(), endian };
    let meant = ValueMapping::identity(hints.padding);
    let voxels = if geometry.is_planar && stored.components > 1 {
        if bytes_of_frame > options.memory_budget_bytes {
            let what = format!(
                "all components together need {}, more than is allowed",
                human_bytes(bytes_of_frame.into())
            );
            return Err(context.limit_error("sizes", what, "select one with --component"));
        }
        planar_components::read_interleaved(&mut data, &stored, extent.voxels, control)
            .and_then(|bytes| stored.read_values(&mut bytes.as_slice(), None, extent, &meant, control))
    } else {
        let read = data.skip(frame * bytes_of_frame).map_err(ReadFault::Io);
        read.and_then(|()| {
            stored.read_values(&mut data, Some(NrrdDataStream::skip_forward), extent, &meant, control)
        })
    };
    let voxels = voxels.map_err(|fault| match data.failure.take() {
        Some(failure) => failure,
        None => fault.into_error(context, &layout, "bytes", HELP),
    })?;

    if hints.labels.is_empty() && geometry.components == 1 && geometry.frames == 1 {
        label_tables::add_label_table(context, READER.extensions, voxels.stored_numbers(), &mut hints);
    }
    let placement = &mut geometry.placement;
    if is_layered {
        let layers = geometry.components;
        placement.remarks.push(format!("its labels are in {layers} layers: --component selects one"));
    }
    placement.remarks.extend(part.remark().map(str::to_owned));
    let name = header.get("content").filter(|content| !content.is_empty());
    let name = name.map_or_else(|| stem(path), |content| sanitised(content, 120));
    VolumeParts { name, extent, placement: geometry.placement, voxels, hints }.into_volume(context, control)
}

/// Determines the time step to read, from 0 for consecutive volumes, and the part of interleaved numbers that is
/// shown.
fn selected_frame_and_part(
    context: LoadContext<'_>,
    geometry: &NrrdGeometry,
    number: FileNumberType,
    is_layered: bool,
    options: &LoadOptions,
) -> Result<(u64, ScalarReduction), LoadError> {
    let components = geometry.components;
    // Volumes whose numbers are interleaved.
    let is_interleaved = geometry.has_interleaved_times || (geometry.is_list && !is_layered);
    // With time steps behind it, a list axis holds channels.
    let are_channels = is_interleaved && geometry.is_list && geometry.frames > 1;
    let times = if is_interleaved && !are_channels { components as u64 } else { geometry.frames };
    if times > MAX_FRAMES || (geometry.has_interleaved_times && geometry.frames > 1) {
        return Err(context.limit_error(
            "sizes",
            format!("there are more than {MAX_FRAMES} time steps, or times in two axes"),
            "extract some time steps (for example: unu crop)",
        ));
    }
    let offers =
        |count: usize| (0..count).map(|step| VolumeOffer::with_number(step, "", geometry.dims)).collect();
    let mut frame = 0;
    if times > 1 {
        frame = context.resolve_choice(&options.choice, FileDimension::Frame, offers(times as usize))?;
    }
    if are_channels {
        let channel = context.resolve_choice(&options.choice, FileDimension::Channel, offers(components))?;
        return Ok((frame as u64, ScalarReduction::Component(channel)));
    }
    if is_interleaved {
        return Ok((0, ScalarReduction::Component(frame)));
    }
    // Programs without a notion of colour write vectors of bytes.
    let is_color = geometry.is_color || (number == FileNumberType::U8 && (3..=4).contains(&components));
    // A magnitude of label numbers is meaningless; only segments of the first layer have names.
    let component = if is_layered {
        options.choice.resolve_layer(components).or(Some(0))
    } else {
        options.choice.resolve_component(components, is_color)
    };
    let part = ScalarReduction::require(context, component, components, is_color)?;
    Ok((frame as u64, part))
}
