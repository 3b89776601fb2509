//! MRC and CCP4: density maps of molecules, and images of electron microscopes. A header of 1024 bytes, and an
//! optional extended header, precede the voxels.
//!
//! After the definition at <https://www.ccpem.ac.uk/mrc_format/mrc2014.php>, with IMOD's extensions
//! (<https://bio3d.colorado.edu/imod/doc/mrc_format.txt>).

mod header;
#[cfg(test)]
mod tests;
mod unit_cell;

use super::input::stem;
use super::number::{FileNumberType, VoxelEncoding};
use super::placement::VolumeParts;
use super::reader::{FileStart, FormatReader, TrailingData, VolumeSource};
use super::{FileDimension, LoadError};
use chiaroscuro_volume::{GridExtent, LoadContext, Modality, ValueMeaning, ValueMetadata, Volume};
use header::{HEADER_BYTES, MrcHeader};

pub(super) const READER: FormatReader = FormatReader {
    name: "MRC/CCP4",
    extensions: &[
        ".mrc", ".mrc.gz", ".map", ".map.gz", ".ccp4", ".ccp4.gz", ".rec", ".rec.gz", ".st", ".st.gz",
    ],
    recognises: is_mrc,
    load,
};

/// Checks the magic bytes `MAP ` at byte 208. Some programs end them with a zero.
fn is_mrc(start: &FileStart) -> bool {
    start.has_at(b"MAP ", 208) || start.has_at(b"MAP\0", 208)
}

const HELP: &str = "copy or download the file again";

/// Loads an MRC or CCP4 file.
fn load(mut source: VolumeSource<'_>) -> Result<Volume, LoadError> {
    let context = LoadContext { operation: "read the MRC volume", path: source.path };
    let header = MrcHeader::parse(context, source.start.bytes())?;
    let [x, y, all_z] = header.dims(context)?;
    let mode = mode_from_header(context, &header)?;
    let part = source.scalar_reduction(context, mode.components, mode.is_color)?;
    let stored = VoxelEncoding {
        number: mode.number,
        endian: header.endian,
        components: mode.components,
        reduction: part,
    };

    let per_volume = header.sections_per_volume(all_z);
    let count = all_z / per_volume;
    let dims = [x, y, per_volume];
    let frame = source.choose_numbered(context, FileDimension::Frame, count, dims, |_| String::new())?;
    let extent = GridExtent::checked(
        context,
        "NX, NY, NZ",
        dims,
        stored.voxel_type(),
        source.options.limits(source.control),
    )?;
    let preceding_bytes =
        (extent.voxels as u64).saturating_mul(stored.voxel_bytes()).saturating_mul(frame as u64);
    let at = (HEADER_BYTES as u64 + header.extension_bytes(context)?).saturating_add(preceding_bytes);
    let voxels = source.voxels(context, at, (&stored, extent), TrailingData::Allowed, HELP)?;

    let remark = if mode.is_complex && source.options.choice.component.is_none() {
        Some("complex numbers are shown as their magnitude")
    } else {
        part.remark()
    };
    let stack = (header.is_image_stack() && all_z > 1)
        .then_some("the file calls itself a stack of images: they are shown as slices");
    let placement = unit_cell::placement(&header).with_remark(remark).with_remark(stack);
    let mut hints = ValueMetadata::default();
    hints.modality = Modality::ElectronMicroscopy;
    // Maps hold real numbers. Integers are a detector's counts, which mostly fall where there is more material.
    if mode.is_map && !header.is_image_stack() {
        hints.meaning = ValueMeaning::PositiveDensity;
    }
    hints.set_acquisition(&header.label());
    VolumeParts { name: stem(source.path), extent, placement, voxels, hints }
        .into_volume(context, source.control)
}

/// Storage of the voxels of a mode.
struct MrcMode {
    number: FileNumberType,
    components: usize,
    is_color: bool,
    is_complex: bool,
    /// True for the modes in which density maps are written: 2 and 12.
    is_map: bool,
}

fn mode_from_header(context: LoadContext<'_>, header: &MrcHeader) -> Result<MrcMode, LoadError> {
    let plain = |number| MrcMode { number, components: 1, is_color: false, is_complex: false, is_map: false };
    Ok(match header.mode() {
        0 if header.bytes_are_signed() => plain(FileNumberType::I8),
        0 => plain(FileNumberType::U8),
        1 => plain(FileNumberType::I16),
        2 => MrcMode { is_map: true, ..plain(FileNumberType::F32) },
        3 => MrcMode { components: 2, is_complex: true, ..plain(FileNumberType::I16) },
        4 => MrcMode { components: 2, is_complex: true, ..plain(FileNumberType::F32) },
        6 => plain(FileNumberType::U16),
        12 => MrcMode { is_map: true, ..plain(FileNumberType::F16) },
        // IMOD's mode for RGB colours.
        16 => MrcMode { components: 3, is_color: true, ..plain(FileNumberType::U8) },
        101 => {
            return Err(context.bad_input_error(
                "MODE",
                "its voxels have 4 bits each (mode 101), which is not supported",
                "write it again with 8 bits, for example with IMOD's newstack -mode 0",
            ));
        }
        other => {
            return Err(context.bad_input_error(
                "MODE",
                format!("mode {other} is unknown; 0, 1, 2, 3, 4, 6, 12 and 16 are supported"),
                "check that the file is an MRC file, or copy it again",
            ));
        }
    })
}
