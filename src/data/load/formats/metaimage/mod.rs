//! `MetaImage`: a text header, and the voxels behind it, in a second file or in one file per slice.
//!
//! After the definition at <https://itk.org/Wiki/MetaIO/Documentation>, and the behaviour of `MetaIO` where that is
//! silent. World space is left-posterior-superior millimetres.

mod files;
mod geometry;
mod header;
mod hints;
mod layout;
mod pieces;
#[cfg(test)]
mod tests;

use super::input::bare_name;
use super::placement::Parts;
use super::reader::{Reader, Source};
use super::rescaled::rescaled;
use super::samples::{Fault, Layout};
use super::voxels::Meant;
use super::{LoadError, label_files};
use crate::data::attempt::{Attempt, Dimension, Extent, Offer};
use crate::data::{Volume, plain};
use files::Files;
use header::Header;
use layout::Storage;
use pieces::{Described, Pieces};

const ENDINGS: &[&str] = &[".mha", ".mhd"];

pub(super) const READER: Reader = Reader {
    name: "MetaImage",
    endings: ENDINGS,
    recognises: |start| header::is_metaimage(start.stored()),
    load,
};

/// Loads a `MetaImage` file, with its data files.
fn load(source: Source<'_>) -> Result<Volume, LoadError> {
    let Source { path, mut input, options, control, .. } = source;
    let attempt = Attempt { what: "read the MetaImage volume", path };
    let header = Header::read(attempt, &mut input.reader)?;
    let grid = layout::Grid::of(attempt, &header)?;
    let storage = Storage::of(attempt, &header, &options.choice)?;
    let mut placement = geometry::placement(attempt, &header, &grid)?;

    let offers = (0..grid.frames).map(|frame| Offer::numbered(frame, "", grid.dims)).collect();
    let frame = attempt.chosen(&options.choice, Dimension::Frame, offers)?;
    let stored = storage.stored;
    let voxel_type = stored.voxel_type();
    let extent = Extent::checked(attempt, "DimSize", grid.dims, voxel_type, options.room(control))?;
    let files = Files::of(attempt, &header, &grid)?;
    let described =
        Described { grid: &grid, storage: &storage, files: &files, data_start: header.data_start };
    let mut pieces = Pieces::of(attempt, input, described, frame, control)?;

    let mut hints = hints::of(&header);
    let scale = |name, default| header.number(name).unwrap_or(default);
    let scale = [scale(layout::SLOPE, 1.0), scale(layout::INTERCEPT, 0.0)];
    let is_single = stored.components == 1;
    let values = |samples| {
        if is_single { rescaled(attempt, samples, scale, options.memory_budget_bytes) } else { Ok(samples) }
    };
    let meant = Meant { padding: hints.padding, values: &values };
    let voxels = stored.read_meant(&mut pieces, None, extent, &meant, control).map_err(Fault::of_stream);
    let voxels = voxels.and_then(|voxels| pieces.finish(control).map(|()| voxels));
    let voxels = voxels.map_err(|fault| match (pieces.failure(), fault) {
        (Some(error), _) => error,
        (None, Fault::Corrupt(error)) if storage.is_text => attempt.bad_input(
            "data",
            error.to_string(),
            "check ElementType and that the data are plain numbers",
        ),
        (None, Fault::Corrupt(error)) => attempt.bad_input(
            "data",
            format!("the compressed data are broken or truncated: {error}"),
            "copy or download the file again",
        ),
        (None, fault) => {
            let layout = Layout { extent, voxel_type, endian: stored.endian };
            fault.into_error(
                attempt,
                &layout,
                "bytes",
                "check DimSize and ElementType, or copy the file again",
            )
        }
    })?;

    placement.remarks.extend(stored.part.remark().map(str::to_owned));
    if is_single {
        label_files::add(attempt, ENDINGS, voxels.in_file(), &mut hints);
    }
    let name = header.get("Name").filter(|name| !name.is_empty());
    let name = plain(&name.map_or_else(|| bare_name(path, ENDINGS), str::to_owned), 120);
    Parts { name, extent, placement, voxels, hints }.volume(attempt)
}
