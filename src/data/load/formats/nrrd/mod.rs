//! NRRD, "nearly raw raster data": a text header, and the voxels behind it or in other files.
//!
//! After the definition at <https://teem.sourceforge.net/nrrd/format.html>, versions 1 to 5. World space is
//! right-anterior-superior millimetres. A non-spatial axis holds components if it is the fastest, and time steps if
//! it is the slowest, unless its kind says that it holds components; an axis of kind `list` holds volumes, wherever
//! it stands.

mod bounds;
mod data;
mod files;
mod geometry;
mod header;
mod hints;
mod layout;
mod planes;
mod space;
#[cfg(test)]
mod tests;

use super::beside;
use super::input::stem;
use super::label_files;
use super::number::{Number, Part, Stored};
use super::placement::Parts;
use super::reader::{Reader, Source};
use super::samples::{Fault, Layout};
use super::voxels::Meant;
use super::{Dimension, Endian, LoadError, LoadOptions, Offer};
use crate::data::attempt::{Attempt, Extent, human_bytes};
use crate::data::{Meaning, Volume, plain};
use data::{Data, HELP, Place};
use geometry::Geometry;
use header::Header;
use layout::{Encoding, Storage};

/// Maximum number of time steps of one file.
const MOST_FRAMES: u64 = 1 << 16;

/// True if these bytes begin an NRRD file.
pub(super) fn is_nrrd(magic: &[u8]) -> bool {
    magic.starts_with(b"NRRD000")
}

pub(super) const READER: Reader =
    Reader { name: "NRRD", endings: &[".nrrd", ".nhdr"], recognises: |start| is_nrrd(start.stored()), load };

/// Loads an NRRD file, with its data files.
fn load(source: Source<'_>) -> Result<Volume, LoadError> {
    let Source { path, mut input, options, control, .. } = source;
    let attempt = Attempt { what: "read the NRRD volume", path };
    let header = Header::read(attempt, &mut input.reader)?;
    let storage = Storage::from_header(attempt, &header)?;
    let mut geometry = Geometry::from_header(attempt, &header)?;
    let mut hints = header.hints();
    let is_layered = hints.meaning == Meaning::Labels && geometry.components > 1;
    let (frame, part) = chosen(attempt, &geometry, storage.number, is_layered, options)?;
    // Text is parsed to little-endian bytes, and single bytes have no byte order.
    let endian = storage.endian.filter(|_| storage.encoding != Encoding::Text).unwrap_or(Endian::Little);
    // One of several component planes is read like a time step.
    let (frame, frames, stored) = match part {
        Part::Component(plane) if geometry.are_planes => {
            (plane as u64, geometry.components as u64, Stored::scalar(storage.number, endian))
        }
        _ => {
            let stored = Stored { number: storage.number, endian, components: geometry.components, part };
            (frame, geometry.frames, stored)
        }
    };
    let extent =
        Extent::checked(attempt, "sizes", geometry.dims, stored.voxel_type(), options.room(control))?;
    let bytes_of_frame = (extent.voxels as u64)
        .checked_mul(stored.bytes_of_voxel())
        .filter(|bytes| bytes.checked_mul(frames).is_some())
        .ok_or_else(|| attempt.limit("sizes", "all time steps have more than 2^64 bytes", HELP))?;

    let places = match files::names(attempt, &header, &geometry.sizes)? {
        None => vec![Place::Attached(path.to_owned(), header.data_start(attempt)?)],
        Some(names) => names
            .iter()
            .map(|name| beside::resolve(attempt, files::FIELD, name).map(Place::Detached))
            .collect::<Result<_, _>>()?,
    };
    let bytes_of_file = bytes_of_frame * frames / places.len() as u64;
    let mut data = Data::new(places, storage, bytes_of_file, control);
    let layout = Layout { extent, voxel_type: stored.voxel_type(), endian };
    let meant = Meant::as_stored(hints.padding);
    let voxels = if geometry.are_planes && stored.components > 1 {
        if bytes_of_frame > options.memory_budget_bytes {
            let what = format!(
                "{} of all components are more than there is memory",
                human_bytes(bytes_of_frame.into())
            );
            return Err(attempt.limit("sizes", what, "name one with --component"));
        }
        planes::side_by_side(&mut data, &stored, extent.voxels, control)
            .and_then(|bytes| stored.read_meant(&mut bytes.as_slice(), None, extent, &meant, control))
    } else {
        let read = data.skip(frame * bytes_of_frame).map_err(Fault::Io);
        read.and_then(|()| stored.read_meant(&mut data, Some(Data::leap), extent, &meant, control))
    };
    let voxels = voxels.map_err(|fault| match data.failure.take() {
        Some(failure) => failure,
        None => fault.into_error(attempt, &layout, "bytes", HELP),
    })?;

    if hints.labels.is_empty() && geometry.components == 1 && geometry.frames == 1 {
        label_files::add(attempt, READER.endings, voxels.in_file(), &mut hints);
    }
    let placement = &mut geometry.placement;
    if is_layered {
        let layers = geometry.components;
        placement.remarks.push(format!("its labels lie in {layers} layers: --component names one"));
    }
    placement.remarks.extend(part.remark().map(str::to_owned));
    let name = header.get("content").filter(|content| !content.is_empty());
    let name = name.map_or_else(|| stem(path), |content| plain(content, 120));
    Parts { name, extent, placement: geometry.placement, voxels, hints }.volume(attempt)
}

/// Determines the time step to read, from 0 for consecutive volumes, and the part of interleaved numbers that is
/// shown.
fn chosen(
    attempt: Attempt<'_>,
    geometry: &Geometry,
    number: Number,
    is_layered: bool,
    options: &LoadOptions,
) -> Result<(u64, Part), LoadError> {
    let components = geometry.components;
    // Volumes whose numbers are interleaved.
    let are_woven = geometry.are_times || (geometry.are_listed && !is_layered);
    // With time steps behind it, a list axis holds channels.
    let are_channels = are_woven && geometry.are_listed && geometry.frames > 1;
    let times = if are_woven && !are_channels { components as u64 } else { geometry.frames };
    if times > MOST_FRAMES || (geometry.are_times && geometry.frames > 1) {
        return Err(attempt.limit(
            "sizes",
            format!("there are more than {MOST_FRAMES} time steps, or times in two axes"),
            "extract some time steps (for example: unu crop)",
        ));
    }
    let offers = |count: usize| (0..count).map(|step| Offer::numbered(step, "", geometry.dims)).collect();
    let mut frame = 0;
    if times > 1 {
        frame = attempt.chosen(&options.choice, Dimension::Frame, offers(times as usize))?;
    }
    if are_channels {
        let channel = attempt.chosen(&options.choice, Dimension::Channel, offers(components))?;
        return Ok((frame as u64, Part::Component(channel)));
    }
    if are_woven {
        return Ok((0, Part::Component(frame)));
    }
    // Programs without a notion of colour write vectors of bytes.
    let is_color = geometry.is_color || (number == Number::U8 && (3..=4).contains(&components));
    // A magnitude of label numbers is meaningless; only segments of the first layer have names.
    let component = if is_layered {
        options.choice.layer_among(components).or(Some(0))
    } else {
        options.choice.component_among(components, is_color)
    };
    let part = Part::asked(attempt, component, components, is_color)?;
    Ok((frame as u64, part))
}
