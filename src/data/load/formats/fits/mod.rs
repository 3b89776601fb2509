//! FITS, the image and cube format of astronomy: units of a text header and the data behind it.
//!
//! After the FITS standard, version 4.0 (<https://fits.gsfc.nasa.gov/fits_standard.html>), whose sections and tables
//! are cited in this module. The first pixel is shown at the lower left, as in other programs: rows are reordered
//! from the top down, and keep their positions in the world.

mod header;
mod layout;
mod rows;
mod spacing;
#[cfg(test)]
mod tests;
mod units;

use super::content::Content;
use super::input::{Input, stem};
use super::number::Stored;
use super::placement::Parts;
use super::reader::{Reader, Source};
use super::rescaled::rescaled;
use super::samples;
use super::voxels::Meant;
use super::{Dimension, Endian, LoadError};
use crate::data::attempt::{Attempt, Extent, Thinning};
use crate::data::{Hints, Volume, plain};
use header::Header;
use units::Units;

pub(super) const READER: Reader = Reader {
    name: "FITS",
    endings: &[".fits", ".fits.gz", ".fit", ".fit.gz", ".fts", ".fts.gz"],
    recognises: |start| start.has(b"SIMPLE  =", 0),
    load,
};

const HELP: &str = "check the header, or copy the file again";

/// Loads a FITS file: the chosen array, and the chosen volume of it.
fn load(source: Source<'_>) -> Result<Volume, LoadError> {
    let attempt = Attempt { what: "read the FITS file", path: source.path };
    let (options, control) = (source.options, source.control);
    if !source.start.has(b"SIMPLE  =", 0) {
        let why = "it does not begin with the keyword SIMPLE, as FITS files do";
        return Err(attempt.bad_input("header", why, "check the file's name and format"));
    }
    // A gzip stream cannot be rewound: the file is opened a second time for the data.
    let is_gzip = source.start.is_gzip();
    let mut units = Units::read(attempt, &mut Content::of(Input::open(attempt)?, is_gzip), is_gzip, control)?;
    let remark = units.remark();
    if units.images.is_empty() {
        return Err(units.without_images(attempt));
    }
    let offers = units.images.iter().map(units::Image::offer).collect();
    let chosen = attempt.chosen(&options.choice, Dimension::Array, offers)?;
    let units::Image { header, data_start, layout, .. } = units.images.swap_remove(chosen);

    let (dimension, name) = layout.dimension(&header);
    let count = layout.outer.map_or(1, |(_, count)| count);
    let frame = source.numbered(attempt, dimension, count, layout.dims, name)? as u64;
    let stored = Stored::scalar(layout.number, Endian::Big);
    // Blocks for averaging begin at the top row of the image, so the data are averaged after the rows are reversed.
    let is_averaged =
        options.choice.portion.is_some_and(|portion| matches!(portion.thinning, Thinning::Average(_)));
    let checked = if is_averaged { Extent::checked_whole } else { Extent::checked };
    let extent = checked(attempt, "NAXIS", layout.dims, stored.voxel_type(), options.room(control))?;
    let in_file = Extent { read: rows::kept_in_file(extent.read), ..extent };
    let grid = samples::Layout { extent, voxel_type: stored.voxel_type(), endian: stored.endian };
    let of_frame = (extent.voxels as u64).saturating_mul(stored.bytes_of_voxel());
    let at = data_start.saturating_add(of_frame.saturating_mul(frame));
    let values = |samples| rescaled(attempt, samples, layout.scale, options.memory_budget_bytes);
    let meant = Meant { padding: layout.blank, values: &values };
    let mut content = Content::of(source.input, is_gzip);
    content.check_room(attempt, "NAXIS", at, u128::from(of_frame))?;
    let voxels = content.go_to(at, control).and_then(|()| content.voxels(&stored, in_file, &meant, control));
    let mut voxels = voxels.map_err(|fault| fault.into_error(attempt, &grid, "bytes", HELP))?;
    rows::reverse(&mut voxels.samples, extent.read.dims());

    let mut placement = spacing::placement(&header, &layout).remarked(remark);
    placement.world_from_index *= rows::file_from_index(layout.dims[1]);
    let mut hints = hints(&header);
    hints.padding = layout.blank;
    let name = match header.text("EXTNAME") {
        "" => stem(source.path),
        array => plain(&format!("{} {array}", stem(source.path)), 120),
    };
    Parts { name, extent, placement, voxels, hints }.volume(attempt)
}

/// Collects the hints that a header gives on values: unit, instrument and object.
fn hints(header: &Header) -> Hints {
    let mut hints = Hints::default();
    hints.set_unit(header.text("BUNIT"));
    let words = ["TELESCOP", "INSTRUME", "OBJECT"].map(|keyword| header.text(keyword));
    let said: Vec<&str> = words.into_iter().filter(|word| !word.is_empty()).collect();
    hints.set_acquisition(&said.join(" "));
    hints
}
