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

use super::content::FileContent;
use super::input::name_without_extension;
use super::label_tables;
use super::number::VoxelEncoding;
use super::placement::VolumeParts;
use super::reader::{FormatReader, VolumeSource};
use super::samples::{ReadFault, VoxelLayout, is_corruption};
use super::voxels::ValueMapping;
use super::{Endian, FileDimension, LoadControl, LoadError};
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::{FileLabelTable, GridExtent, LoadContext, ValueMeaning, ValueMetadata, Volume};
use header::{HEADER_BYTES, MghHeader, is_mgh};

const ENDINGS: &[&str] = &[".mgz", ".mgh", ".mgh.gz"];

pub(super) const READER: FormatReader =
    FormatReader { name: "MGH/MGZ", extensions: ENDINGS, recognises: |start| is_mgh(start.bytes()), load };

const HELP: &str = "check the header, or copy the file again";

/// Loads an MGH or MGZ file.
fn load(source: VolumeSource<'_>) -> Result<Volume, LoadError> {
    let context = LoadContext { operation: "read the MGH volume", path: source.path };
    let header = MghHeader::parse(context, source.start.bytes())?;
    let MghHeader { dims, frames, number, .. } = header;
    if dims[0] > 1 && dims[1] == 1 && dims[2] == 1 {
        return Err(context.bad_input_error(
            "width, height, depth",
            format!("its {} values lie in one row, as those at the vertices of a surface do", dims[0]),
            "open the volume that the surface was made from",
        ));
    }
    let frame =
        source.choose_numbered(context, FileDimension::Frame, frames, dims, |_| String::new())? as u64;
    let stored = VoxelEncoding::scalar(number, Endian::Big);
    let room = source.options.limits(source.control);
    let extent = GridExtent::checked(context, "width, height, depth", dims, stored.voxel_type(), room)?;
    let layout = VoxelLayout { extent, voxel_type: stored.voxel_type(), endian: stored.endian };

    let frame_bytes = (extent.voxels as u64).saturating_mul(stored.voxel_bytes());
    let frame_offset = |frame: u64| frame_bytes.saturating_mul(frame).saturating_add(HEADER_BYTES as u64);
    let control = source.control;
    let mut content = FileContent::new(source.input, source.start.is_gzip());
    content.check_length(context, "nframes", frame_offset(frame), u128::from(frame_bytes))?;
    let read = content
        .seek_forward(frame_offset(frame), control)
        .and_then(|()| content.voxels(&stored, extent, &ValueMapping::identity(None), control))
        .and_then(|voxels| Ok((voxels, read_footer_labels(&mut content, frame_offset(frames), control)?)));
    let (voxels, labels) = read.map_err(|fault| fault.into_error(context, &layout, "bytes", HELP))?;

    let mut hints = ValueMetadata::default();
    if header.are_labels {
        hints.meaning = ValueMeaning::Labels;
    }
    if labels.is_empty() {
        label_tables::add_label_table(context, ENDINGS, voxels.stored_numbers(), &mut hints);
    } else if label_tables::all_integers(voxels.stored_numbers()) {
        (hints.labels, hints.meaning) = (labels, ValueMeaning::Labels);
    }
    let name = sanitised(&name_without_extension(context.path, ENDINGS), 120);
    VolumeParts { name, extent, placement: header.placement(), voxels, hints }.into_volume(context, control)
}

/// Reads the labels from the tags behind all voxels. A file may end there, or right after the voxels that were
/// requested.
fn read_footer_labels(
    content: &mut FileContent,
    end: u64,
    control: &LoadControl,
) -> Result<FileLabelTable, ReadFault> {
    match content.seek_forward(end, control) {
        Ok(()) => {}
        Err(ReadFault::Short { .. }) => return Ok(FileLabelTable::default()),
        Err(fault) => return Err(fault),
    }
    let mut footer = Vec::new();
    match content.take(color_table::MAX_FOOTER_BYTES).read_to_end(&mut footer) {
        Ok(_) => Ok(color_table::parse_labels(&footer)),
        Err(error) if is_corruption(&error) => Err(ReadFault::Corrupt(error)),
        Err(error) => Err(ReadFault::Io(error)),
    }
}
