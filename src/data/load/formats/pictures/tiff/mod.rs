//! TIFF and `BigTIFF`: pages of pixels, which are the slices of a volume.
//!
//! After TIFF 6.0 (Adobe, 1992), the technical notes 1 and 3 that followed it, and the design of `BigTIFF`
//! (<https://www.awaresystems.be/imaging/tiff/bigtiff.html>). The metadata of microscope software are read: OME-TIFF,
//! `ImageJ`, LSM. World axes are those of the grid: TIFF has no anatomical orientation.

mod fault;
mod file;
mod gaps;
mod plain;
mod said;
mod single;
mod stack;
#[cfg(test)]
mod tests;

use crate::data::Volume;
use crate::data::attempt::Attempt;
use crate::data::load::reading::input::{Input, Witness};
use crate::data::load::reading::reader::{Reader, Source};
use crate::data::load::{LoadControl, LoadError, LoadOptions};
use file::Tiff;
use file::page::tag;
use said::palette::Palette;
use said::{imagej, lsm, ome, shaped};
use stack::Stack;

pub(in crate::data::load) use single::Picture;

/// Returns true if the first bytes are those of a TIFF file: byte order, and version 42 or, for `BigTIFF`, 43.
pub(super) fn is_tiff(magic: &[u8]) -> bool {
    [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"].iter().any(|mark| magic.starts_with(*mark))
}

pub(in crate::data::load) const READER: Reader = Reader {
    name: "TIFF",
    endings: &[".tif", ".tiff", ".btf", ".tf8", ".lsm"],
    recognises: |start| is_tiff(start.stored()),
    load,
};

/// Reader of OME-XML in a file of its own, which describes the pages of TIFF files beside it.
pub(in crate::data::load) const COMPANION: Reader = Reader {
    name: "OME-TIFF set",
    endings: &[".companion.ome", ".ome"],
    recognises: |start| ome::is_ome(&String::from_utf8_lossy(start.stored())),
    load: load_companion,
};

/// Action named in error messages.
const WHAT: &str = "read the TIFF volume";

/// Loads a TIFF file.
fn load(source: Source<'_>) -> Result<Volume, LoadError> {
    let Source { path, input, start, options, control } = source;
    let attempt = Attempt { what: WHAT, path };
    if !is_tiff(start.stored()) {
        return Err(attempt.bad_input("header", "it does not begin as TIFF files do", fault::HELP));
    }
    let mut tiff = Tiff::open(attempt, input, control)?;
    let description = tiff.text(tag::DESCRIPTION, ome::MOST_XML_BYTES).unwrap_or_default();
    let choice = &options.choice;
    let stack = if ome::is_ome(&description) {
        ome::stack(attempt, &tiff, &description, choice)?
    } else if imagej::is_imagej(&description) {
        imagej::stack(attempt, &mut tiff, &description, choice)?
    } else if let Some(info) = lsm::Info::of(&mut tiff) {
        info.stack(attempt, &tiff, choice)?
    } else if let Some(stack) = shaped::stack(attempt, &mut tiff, choice)? {
        stack
    } else {
        plain::stack(attempt, &tiff, choice)?
    };
    volume(attempt, tiff, stack, options, control)
}

/// Loads the volume of an OME-XML file that lies beside its TIFF files.
#[expect(clippy::needless_pass_by_value, reason = "as all readers are called")]
fn load_companion(source: Source<'_>) -> Result<Volume, LoadError> {
    let Source { path, options, control, .. } = source;
    let attempt = Attempt { what: "read the OME-XML of the volume", path };
    let xml = ome::companion_text(attempt)?;
    let first = ome::first_file(attempt, &xml, &options.choice)?;
    let of_first = Attempt { what: WHAT, path: &first };
    let input = Input::open(of_first)?;
    let witness = Witness::of(of_first, &input)?;
    let tiff = Tiff::open(of_first, input, control)?;
    let stack = ome::stack(of_first, &tiff, &xml, &options.choice)?;
    witness.vouch(of_first, volume(of_first, tiff, stack, options, control))
}

/// Reads the volume of a stack, with the padding value and the palette of the first page.
fn volume(
    attempt: Attempt<'_>,
    mut tiff: Tiff,
    mut stack: Stack,
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Volume, LoadError> {
    // Enough for any number.
    let no_data = tiff.text(tag::NO_DATA, 64).unwrap_or_default();
    if let Ok(stored) = no_data.trim().parse::<f64>() {
        let [slope, intercept] = stack.scale;
        stack.hints.set_padding(slope.mul_add(stored, intercept));
    }
    let palette = Palette::of(&mut tiff);
    let volume = stack.volume(attempt, tiff, options, control)?;
    Ok(match palette {
        Some(palette) => palette.on(volume),
        None => volume,
    })
}
