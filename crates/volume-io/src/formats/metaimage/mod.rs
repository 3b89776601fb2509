//! `MetaImage`: a text header, and the voxels behind it, in a second file or in one file per slice.
//!
//! After the definition at <https://itk.org/Wiki/MetaIO/Documentation>, and the behaviour of `MetaIO` where that is
//! silent. World space is left-posterior-superior millimetres.

mod data_files;
mod data_stream;
mod geometry;
mod header;
mod hints;
mod layout;
#[cfg(test)]
mod tests;

use super::input::name_without_extension;
use super::placement::VolumeParts;
use super::reader::{FormatReader, VolumeSource};
use super::rescale::rescale;
use super::samples::{ReadFault, VoxelLayout};
use super::voxels::ValueMapping;
use super::{LoadError, label_tables};
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::{FileDimension, GridExtent, LoadContext, Volume, VolumeOffer};
use data_files::DataFiles;
use data_stream::{DataDescription, DataStream};
use header::MetaImageHeader;
use layout::MetaImageStorage;

const ENDINGS: &[&str] = &[".mha", ".mhd"];

pub(super) const READER: FormatReader = FormatReader {
    name: "MetaImage",
    extensions: ENDINGS,
    recognises: |start| header::is_metaimage(start.stored()),
    load,
};

/// Loads a `MetaImage` file, with its data files.
fn load(source: VolumeSource<'_>) -> Result<Volume, LoadError> {
    let VolumeSource { path, mut input, options, control, .. } = source;
    let context = LoadContext { operation: "read the MetaImage volume", path };
    let header = MetaImageHeader::read(context, &mut input.reader)?;
    let grid = layout::MetaImageGrid::parse(context, &header)?;
    let storage = MetaImageStorage::parse(context, &header, &options.choice)?;
    let mut placement = geometry::placement(context, &header, &grid)?;

    let offers = (0..grid.frames).map(|frame| VolumeOffer::with_number(frame, "", grid.dims)).collect();
    let frame = context.resolve_choice(&options.choice, FileDimension::Frame, offers)?;
    let stored = storage.stored;
    let voxel_type = stored.voxel_type();
    let extent = GridExtent::checked(context, "DimSize", grid.dims, voxel_type, options.limits(control))?;
    let files = DataFiles::parse(context, &header, &grid)?;
    let described =
        DataDescription { grid: &grid, storage: &storage, files: &files, data_start: header.data_start };
    let mut pieces = DataStream::open(context, input, described, frame, control)?;

    let mut hints = hints::hints_from_header(&header);
    let scale = |name, default| header.number(name).unwrap_or(default);
    let scale = [scale(layout::SLOPE, 1.0), scale(layout::INTERCEPT, 0.0)];
    let is_single = stored.components == 1;
    let values = |samples| {
        if is_single { rescale(context, samples, scale, options.memory_budget_bytes) } else { Ok(samples) }
    };
    let meant = ValueMapping { padding: hints.padding, map: &values };
    let voxels =
        stored.read_values(&mut pieces, None, extent, &meant, control).map_err(ReadFault::into_decoder_fault);
    let voxels = voxels.and_then(|voxels| pieces.finish().map(|()| voxels));
    let voxels = voxels.map_err(|fault| match (pieces.failure(), fault) {
        (Some(error), _) => error,
        (None, ReadFault::Corrupt(error)) if storage.is_text => context.bad_input_error(
            "data",
            error.to_string(),
            "check ElementType and that the data are plain numbers",
        ),
        (None, ReadFault::Corrupt(error)) => context.bad_input_error(
            "data",
            format!("the compressed data are broken or truncated: {error}"),
            "copy or download the file again",
        ),
        (None, fault) => {
            let layout = VoxelLayout { extent, voxel_type, endian: stored.endian };
            fault.into_error(
                context,
                &layout,
                "bytes",
                "check DimSize and ElementType, or copy the file again",
            )
        }
    })?;

    placement.remarks.extend(stored.reduction.remark().map(str::to_owned));
    if is_single {
        label_tables::add_label_table(context, ENDINGS, voxels.stored_numbers(), &mut hints);
    }
    let name = header.get("Name").filter(|name| !name.is_empty());
    let name = sanitised(&name.map_or_else(|| name_without_extension(path, ENDINGS), str::to_owned), 120);
    VolumeParts { name, extent, placement, voxels, hints }.into_volume(context, control)
}
