//! MGH and MGZ, the volumes of `FreeSurfer`: a header of 284 bytes, the voxels, and tags behind them; often gzipped
//! as a whole.
//!
//! After <https://surfer.nmr.mgh.harvard.edu/fswiki/FsTutorial/MghFormat> and `mghRead` of `FreeSurfer`'s
//! `mriio.cpp`. World space is right-anterior-superior millimetres. Several volumes of one file count as time steps,
//! as the format does not say how they differ.

mod color_table;
mod header;
#[cfg(test)]
mod tests;

use std::io::Read as _;

use super::content::Content;
use super::input::bare_name;
use super::label_files;
use super::number::Stored;
use super::placement::Parts;
use super::reader::{Reader, Source};
use super::samples::{Fault, Layout, is_corruption};
use super::voxels::Meant;
use super::{Dimension, Endian, LoadControl, LoadError};
use crate::data::attempt::{Attempt, Extent};
use crate::data::{Hints, Labels, Meaning, Volume, plain};
use header::{HEADER_BYTES, Header, is_mgh};

const ENDINGS: &[&str] = &[".mgz", ".mgh", ".mgh.gz"];

pub(super) const READER: Reader =
    Reader { name: "MGH/MGZ", endings: ENDINGS, recognises: |start| is_mgh(start.bytes()), load };

const HELP: &str = "check the header, or copy the file again";

/// Loads an MGH or MGZ file.
fn load(source: Source<'_>) -> Result<Volume, LoadError> {
    let attempt = Attempt { what: "read the MGH volume", path: source.path };
    let header = Header::parse(attempt, source.start.bytes())?;
    let Header { dims, frames, number, .. } = header;
    if dims[0] > 1 && dims[1] == 1 && dims[2] == 1 {
        return Err(attempt.bad_input(
            "width, height, depth",
            format!("its {} values lie in one row, as those at the vertices of a surface do", dims[0]),
            "open the volume that the surface was made from",
        ));
    }
    let frame = source.numbered(attempt, Dimension::Frame, frames, dims, |_| String::new())? as u64;
    let stored = Stored::scalar(number, Endian::Big);
    let room = source.options.room(source.control);
    let extent = Extent::checked(attempt, "width, height, depth", dims, stored.voxel_type(), room)?;
    let layout = Layout { extent, voxel_type: stored.voxel_type(), endian: stored.endian };

    let of_frame = (extent.voxels as u64).saturating_mul(stored.bytes_of_voxel());
    let place = |frame: u64| of_frame.saturating_mul(frame).saturating_add(HEADER_BYTES as u64);
    let control = source.control;
    let mut content = Content::of(source.input, source.start.is_gzip());
    content.check_room(attempt, "nframes", place(frame), u128::from(of_frame))?;
    let read = content
        .go_to(place(frame), control)
        .and_then(|()| content.voxels(&stored, extent, &Meant::as_stored(None), control))
        .and_then(|voxels| Ok((voxels, labels_behind(&mut content, place(frames), control)?)));
    let (voxels, labels) = read.map_err(|fault| fault.into_error(attempt, &layout, "bytes", HELP))?;

    let mut hints = Hints::default();
    if header.are_labels {
        hints.meaning = Meaning::Labels;
    }
    if labels.is_empty() {
        label_files::add(attempt, ENDINGS, voxels.in_file(), &mut hints);
    } else if label_files::is_whole(voxels.in_file()) {
        (hints.labels, hints.meaning) = (labels, Meaning::Labels);
    }
    let name = plain(&bare_name(attempt.path, ENDINGS), 120);
    Parts { name, extent, placement: header.placement(), voxels, hints }.volume(attempt)
}

/// Reads the labels from the tags behind all voxels. A file may end there, or right after the voxels that were
/// requested.
fn labels_behind(content: &mut Content, end: u64, control: &LoadControl) -> Result<Labels, Fault> {
    match content.go_to(end, control) {
        Ok(()) => {}
        Err(Fault::Short { .. }) => return Ok(Labels::default()),
        Err(fault) => return Err(fault),
    }
    let mut footer = Vec::new();
    match content.take(color_table::MOST_BYTES).read_to_end(&mut footer) {
        Ok(_) => Ok(color_table::labels(&footer)),
        Err(error) if is_corruption(&error) => Err(Fault::Corrupt(error)),
        Err(error) => Err(Fault::Io(error)),
    }
}
