//! TIFF and `BigTIFF`: pages of pixels, which are the slices of a volume.
//!
//! After TIFF 6.0 (Adobe, 1992), the technical notes 1 and 3 that followed it, and the design of `BigTIFF`
//! (<https://www.awaresystems.be/imaging/tiff/bigtiff.html>). What programs for microscopes say of their pages is
//! understood: OME-TIFF, `ImageJ`, LSM. World space is as the voxels lie: the file does not say which way a body does.

mod fault;
mod file;
mod plain;
mod said;
mod single;
mod stack;
#[cfg(test)]
mod tests;

use crate::data::Volume;
use crate::data::attempt::Attempt;
use crate::data::load::LoadError;
use crate::data::load::reading::reader::{Reader, Source};
use file::Tiff;
use file::page::tag;
use said::palette::Palette;
use said::{imagej, lsm, ome};

pub(in crate::data::load) use single::Picture;

/// How a file begins: byte order, and 42 or, of `BigTIFF`, 43.
pub(super) fn is_tiff(magic: &[u8]) -> bool {
    [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"].iter().any(|mark| magic.starts_with(*mark))
}

pub(in crate::data::load) const READER: Reader = Reader {
    name: "TIFF",
    endings: &[".tif", ".tiff", ".btf", ".tf8", ".lsm"],
    recognises: |start| is_tiff(start.stored()),
    load,
};

/// Loads a TIFF file.
fn load(source: Source<'_>) -> Result<Volume, LoadError> {
    let Source { path, input, start, options, control } = source;
    let attempt = Attempt { what: "read the TIFF volume", path };
    if !is_tiff(start.stored()) {
        return Err(attempt.bad_input("header", "it does not begin as TIFF files do", fault::HELP));
    }
    let mut tiff = Tiff::open(attempt, input, control)?;
    let description = tiff.text(tag::DESCRIPTION, ome::MOST_XML_BYTES).unwrap_or_default();
    let choice = &options.choice;
    let mut stack = if ome::is_ome(&description) {
        ome::stack(attempt, &tiff, &description, choice)?
    } else if imagej::is_imagej(&description) {
        imagej::stack(attempt, &mut tiff, &description, choice)?
    } else if let Some(info) = lsm::Info::of(&mut tiff) {
        info.stack(attempt, &tiff, choice)?
    } else {
        plain::stack(attempt, &tiff, choice)?
    };
    // A number needs no more.
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
