//! MRC and CCP4: density maps of molecules, and images of electron microscopes. A header of 1024 bytes, and an
//! optional extended header, precede the voxels.
//!
//! After the definition at <https://www.ccpem.ac.uk/mrc_format/mrc2014.php>, with IMOD's extensions
//! (<https://bio3d.colorado.edu/imod/doc/mrc_format.txt>).

mod cell;
mod header;
#[cfg(test)]
mod tests;

use super::input::stem;
use super::number::{Number, Stored};
use super::placement::Parts;
use super::reader::{After, Reader, Source, Start};
use super::{Dimension, LoadError};
use crate::data::attempt::{Attempt, Extent};
use crate::data::{Hints, Meaning, Modality, Volume};
use header::{HEADER_BYTES, Header};

pub(super) const READER: Reader = Reader {
    name: "MRC/CCP4",
    endings: &[".mrc", ".mrc.gz", ".map", ".map.gz", ".ccp4", ".ccp4.gz", ".rec", ".rec.gz", ".st", ".st.gz"],
    recognises: is_mrc,
    load,
};

/// Checks the magic bytes `MAP ` at byte 208. Some programs end them with a zero.
fn is_mrc(start: &Start) -> bool {
    start.has(b"MAP ", 208) || start.has(b"MAP\0", 208)
}

const HELP: &str = "copy or download the file again";

/// Loads an MRC or CCP4 file.
fn load(mut source: Source<'_>) -> Result<Volume, LoadError> {
    let attempt = Attempt { what: "read the MRC volume", path: source.path };
    let header = Header::of(attempt, source.start.bytes())?;
    let [x, y, all_z] = header.dims(attempt)?;
    let mode = mode_of(attempt, &header)?;
    let part = source.part(attempt, mode.components, mode.is_color)?;
    let stored = Stored { number: mode.number, endian: header.endian, components: mode.components, part };

    let per_volume = header.slices_of_a_volume(all_z);
    let count = all_z / per_volume;
    let dims = [x, y, per_volume];
    let frame = source.numbered(attempt, Dimension::Frame, count, dims, |_| String::new())?;
    let extent = Extent::checked(
        attempt,
        "NX, NY, NZ",
        dims,
        stored.voxel_type(),
        source.options.room(source.control),
    )?;
    let before = (extent.voxels as u64).saturating_mul(stored.bytes_of_voxel()).saturating_mul(frame as u64);
    let at = (HEADER_BYTES as u64 + header.extension_bytes(attempt)?).saturating_add(before);
    let voxels = source.voxels(attempt, at, (&stored, extent), After::More, HELP)?;

    let remark = if mode.is_complex && source.options.choice.component.is_none() {
        Some("complex numbers are shown by their length")
    } else {
        part.remark()
    };
    let stack = (header.is_image_stack() && all_z > 1)
        .then_some("the file calls itself a stack of images: they are shown as slices");
    let placement = cell::placement(&header).remarked(remark).remarked(stack);
    let mut hints = Hints::default();
    hints.modality = Modality::ElectronMicroscopy;
    // Maps hold real numbers. Integers are a detector's counts, which mostly fall where there is more material.
    if mode.is_map && !header.is_image_stack() {
        hints.meaning = Meaning::PositiveDensity;
    }
    hints.set_acquisition(&header.label());
    Parts { name: stem(source.path), extent, placement, voxels, hints }.volume(attempt)
}

/// Storage of the voxels of a mode.
struct Mode {
    number: Number,
    components: usize,
    is_color: bool,
    is_complex: bool,
    /// True for the modes in which density maps are written: 2 and 12.
    is_map: bool,
}

fn mode_of(attempt: Attempt<'_>, header: &Header) -> Result<Mode, LoadError> {
    let plain = |number| Mode { number, components: 1, is_color: false, is_complex: false, is_map: false };
    Ok(match header.mode() {
        0 if header.bytes_are_signed() => plain(Number::I8),
        0 => plain(Number::U8),
        1 => plain(Number::I16),
        2 => Mode { is_map: true, ..plain(Number::F32) },
        3 => Mode { components: 2, is_complex: true, ..plain(Number::I16) },
        4 => Mode { components: 2, is_complex: true, ..plain(Number::F32) },
        6 => plain(Number::U16),
        12 => Mode { is_map: true, ..plain(Number::F16) },
        // IMOD's mode for RGB colours.
        16 => Mode { components: 3, is_color: true, ..plain(Number::U8) },
        101 => {
            return Err(attempt.bad_input(
                "MODE",
                "its voxels have 4 bits each (mode 101), which are not read",
                "write it again with 8 bits, for example with IMOD's newstack -mode 0",
            ));
        }
        other => {
            return Err(attempt.bad_input(
                "MODE",
                format!("there is no mode {other}; 0, 1, 2, 3, 4, 6, 12 and 16 are read"),
                "check that the file is an MRC file, or copy it again",
            ));
        }
    })
}
