//! FITS, the image and cube format of astronomy: units of a text header and the data behind it.
//!
//! After the FITS standard, version 4.0 (<https://fits.gsfc.nasa.gov/fits_standard.html>), whose sections and tables
//! are cited in this module. The first pixel is shown at the lower left, as in other programs: rows are reordered
//! from the top down, and keep their positions in the world.

mod hdus;
mod header;
mod layout;
mod row_order;
mod spacing;
#[cfg(test)]
mod tests;

use super::content::FileContent;
use super::input::{InputFile, stem};
use super::number::VoxelEncoding;
use super::placement::VolumeParts;
use super::reader::{FormatReader, VolumeSource};
use super::rescale::rescale;
use super::samples;
use super::voxels::ValueMapping;
use super::{Endian, FileDimension, LoadError};
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::{Downsampling, GridExtent, LoadContext, ValueMetadata, Volume};
use hdus::FitsUnits;
use header::FitsHeader;

pub(super) const READER: FormatReader = FormatReader {
    name: "FITS",
    extensions: &[".fits", ".fits.gz", ".fit", ".fit.gz", ".fts", ".fts.gz"],
    recognises: |start| start.has_at(b"SIMPLE  =", 0),
    load,
};

const HELP: &str = "check the header, or copy the file again";

/// Loads a FITS file: the chosen array, and the chosen volume of it.
fn load(source: VolumeSource<'_>) -> Result<Volume, LoadError> {
    let context = LoadContext { operation: "read the FITS file", path: source.path };
    let (options, control) = (source.options, source.control);
    if !source.start.has_at(b"SIMPLE  =", 0) {
        let why = "it does not begin with the keyword SIMPLE, as FITS files do";
        return Err(context.bad_input_error("header", why, "check the file's name and format"));
    }
    // A gzip stream cannot be rewound: the file is opened a second time for the data.
    let is_gzip = source.start.is_gzip();
    let mut units = FitsUnits::read(
        context,
        &mut FileContent::new(InputFile::open(context)?, is_gzip),
        is_gzip,
        control,
    )?;
    let remark = units.remark();
    if units.images.is_empty() {
        return Err(units.no_image_error(context));
    }
    let offers = units.images.iter().map(hdus::FitsImage::offer).collect();
    let chosen = context.resolve_choice(&options.choice, FileDimension::Array, offers)?;
    let hdus::FitsImage { header, data_start, layout, .. } = units.images.swap_remove(chosen);

    let (dimension, name) = layout.dimension(&header);
    let count = layout.series_axis.map_or(1, |(_, count)| count);
    let frame = source.choose_numbered(context, dimension, count, layout.dims, name)? as u64;
    let stored = VoxelEncoding::scalar(layout.number, Endian::Big);
    // Blocks for averaging begin at the top row of the image, so the data are averaged after the rows are reversed.
    let is_averaged =
        options.choice.portion.is_some_and(|portion| matches!(portion.thinning, Downsampling::Average(_)));
    let checked = if is_averaged { GridExtent::checked_whole } else { GridExtent::checked };
    let extent = checked(context, "NAXIS", layout.dims, stored.voxel_type(), options.limits(control))?;
    let in_file = GridExtent { read: row_order::kept_in_file_order(extent.read), ..extent };
    let grid = samples::VoxelLayout { extent, voxel_type: stored.voxel_type(), endian: stored.endian };
    let of_frame = (extent.voxels as u64).saturating_mul(stored.voxel_bytes());
    let at = data_start.saturating_add(of_frame.saturating_mul(frame));
    let values = |samples| rescale(context, samples, layout.scale, options.memory_budget_bytes);
    let meant = ValueMapping { padding: layout.blank, map: &values };
    let mut content = FileContent::new(source.input, is_gzip);
    content.check_length(context, "NAXIS", at, u128::from(of_frame))?;
    let voxels =
        content.seek_forward(at, control).and_then(|()| content.voxels(&stored, in_file, &meant, control));
    let mut voxels = voxels.map_err(|fault| fault.into_error(context, &grid, "bytes", HELP))?;
    row_order::reverse_rows(&mut voxels.samples, extent.read.dims());

    let mut placement = spacing::placement(&header, &layout).with_remark(remark);
    placement.world_from_index *= row_order::file_from_index(layout.dims[1]);
    let mut hints = hints(&header);
    hints.padding = layout.blank;
    let name = match header.text("EXTNAME") {
        "" => stem(source.path),
        array => sanitised(&format!("{} {array}", stem(source.path)), 120),
    };
    VolumeParts { name, extent, placement, voxels, hints }.into_volume(context, control)
}

/// Collects the hints that a header gives on values: unit, instrument and object.
fn hints(header: &FitsHeader) -> ValueMetadata {
    let mut hints = ValueMetadata::default();
    hints.set_unit(header.text("BUNIT"));
    let words = ["TELESCOP", "INSTRUME", "OBJECT"].map(|keyword| header.text(keyword));
    let said: Vec<&str> = words.into_iter().filter(|word| !word.is_empty()).collect();
    hints.set_acquisition(&said.join(" "));
    hints
}
