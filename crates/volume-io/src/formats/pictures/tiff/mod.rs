//! TIFF and `BigTIFF`: pages of pixels, which are the slices of a volume.
//!
//! After TIFF 6.0 (Adobe, 1992), the technical notes 1 and 3 that followed it, and the design of `BigTIFF`
//! (<https://www.awaresystems.be/imaging/tiff/bigtiff.html>). The metadata of microscope software are read: OME-TIFF,
//! `ImageJ`, LSM. World axes are those of the grid: TIFF has no anatomical orientation.

mod file;
mod messages;
mod metadata;
mod single;
mod stack;
#[cfg(test)]
mod tests;
mod undescribed;

use crate::LoadOptions;
use crate::reading::input::{FileChangeGuard, InputFile};
use crate::reading::reader::{FormatReader, VolumeSource};
use chiaroscuro_volume::{LoadContext, LoadControl, LoadError, Volume};
use file::TiffFile;
use file::page::tag;
use metadata::palette::TiffPalette;
use metadata::{imagej, lsm, ome, shaped};
use stack::TiffStack;

pub(crate) use single::SingleSlice;

/// Returns true if the first bytes are those of a TIFF file: byte order, and version 42 or, for `BigTIFF`, 43.
pub(super) fn is_tiff(magic: &[u8]) -> bool {
    [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"].iter().any(|mark| magic.starts_with(*mark))
}

pub(crate) const READER: FormatReader = FormatReader {
    name: "TIFF",
    extensions: &[".tif", ".tiff", ".btf", ".tf8", ".lsm"],
    recognises: |start| is_tiff(start.stored()),
    load,
};

/// Reader of OME-XML in a file of its own, which describes the pages of TIFF files beside it.
pub(crate) const COMPANION: FormatReader = FormatReader {
    name: "OME-TIFF set",
    extensions: &[".companion.ome", ".ome"],
    recognises: |start| ome::is_ome(&String::from_utf8_lossy(start.stored())),
    load: load_companion,
};

/// Action named in error messages.
const WHAT: &str = "read the TIFF volume";

/// Loads a TIFF file.
fn load(source: VolumeSource<'_>) -> Result<Volume, LoadError> {
    let VolumeSource { path, input, start, options, control } = source;
    let context = LoadContext { operation: WHAT, path };
    if !is_tiff(start.stored()) {
        return Err(context.bad_input_error(
            "header",
            "its first bytes are not those of a TIFF file",
            messages::HELP,
        ));
    }
    let mut tiff = TiffFile::open(context, input, control)?;
    let description = tiff.text_entry(tag::DESCRIPTION, ome::MAX_XML_BYTES).unwrap_or_default();
    let choice = &options.choice;
    let stack = if ome::is_ome(&description) {
        ome::stack(context, &tiff, &description, choice, control)?
    } else if imagej::is_imagej(&description) {
        imagej::stack(context, &mut tiff, &description, choice)?
    } else if let Some(info) = lsm::LsmInfo::read(&mut tiff) {
        info.stack(context, &tiff, choice)?
    } else if let Some(stack) = shaped::stack_of_shapes(context, &mut tiff, choice)? {
        stack
    } else {
        undescribed::stack_of_pages(context, &tiff, choice)?
    };
    volume(context, tiff, stack, options, control)
}

/// Loads the volume of an OME-XML file that lies beside its TIFF files.
#[expect(clippy::needless_pass_by_value, reason = "as all readers are called")]
fn load_companion(source: VolumeSource<'_>) -> Result<Volume, LoadError> {
    let VolumeSource { path, options, control, .. } = source;
    let context = LoadContext { operation: "read the OME-XML of the volume", path };
    let xml = ome::companion_text(context, control)?;
    let first = ome::first_file(context, &xml, &options.choice)?;
    let of_first = LoadContext { operation: WHAT, path: &first };
    let input = InputFile::open(of_first)?;
    let guard = FileChangeGuard::new(of_first, &input, control)?;
    let tiff = TiffFile::open(of_first, input, control)?;
    let stack = ome::stack(of_first, &tiff, &xml, &options.choice, control)?;
    guard.check_unchanged(of_first, volume(of_first, tiff, stack, options, control))
}

/// Reads the volume of a stack, with the padding value and the palette of the first page.
fn volume(
    context: LoadContext<'_>,
    mut tiff: TiffFile,
    mut stack: TiffStack,
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Volume, LoadError> {
    // Enough for any number.
    let no_data = tiff.text_entry(tag::NO_DATA, 64).unwrap_or_default();
    if let Ok(stored) = no_data.trim().parse::<f64>() {
        let [slope, intercept] = stack.scale;
        stack.hints.set_padding(slope.mul_add(stored, intercept));
    }
    let palette = TiffPalette::read(&mut tiff);
    let volume = stack.into_volume(context, tiff, options, control)?;
    Ok(match palette {
        Some(palette) => palette.apply(volume),
        None => volume,
    })
}
