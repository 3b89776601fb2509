//! PVM, the volume format of Stefan Röttger's library: a few lines of text, then voxels of one or two bytes,
//! big-endian. Mostly the whole file is packed, which `dds` undoes.
//!
//! After the description of the formats at <http://schorsch.efi.fh-nuernberg.de/data/volume/>.

mod dds;
mod header;
#[cfg(test)]
mod tests;

use super::input::stem;
use super::number::{FileNumberType, VoxelEncoding};
use super::placement::VolumeParts;
use super::reader::{FormatReader, TrailingData, VolumeSource};
use super::samples::VoxelLayout;
use super::{Endian, LoadError};
use chiaroscuro_volume::{GridExtent, LoadContext, Volume};
use header::{MAX_BYTES, PvmHeader};

pub(super) const READER: FormatReader = FormatReader {
    name: "PVM",
    extensions: &[".pvm", ".pvm.gz"],
    recognises: |start| dds::is_packed(start.bytes()) || header::is_pvm(start.bytes()),
    load,
};

const HELP: &str = "copy or download the file again";

/// Loads a PVM file.
fn load(mut source: VolumeSource<'_>) -> Result<Volume, LoadError> {
    let context = LoadContext { operation: "read the PVM volume", path: source.path };
    let control = source.control;
    let budget = source.options.memory_budget_bytes;
    // The size of packed data is unknown before they are unpacked.
    let unpacked = if dds::is_packed(source.start.bytes()) {
        let most = budget.saturating_add(MAX_BYTES as u64);
        Some(dds::unpack(context, &mut source.content(), most, control)?)
    } else {
        None
    };
    let header = PvmHeader::parse(context, unpacked.as_deref().unwrap_or(source.start.bytes()))?;
    let (number, components) = match header.components {
        2 => (FileNumberType::U16, 1),
        n => (FileNumberType::U8, n),
    };
    let part = source.scalar_reduction(context, components, components > 1)?;
    let stored = VoxelEncoding { number, endian: Endian::Big, components, reduction: part };
    // Packed data are unpacked as a whole, within the budget.
    let room = source.options.limits(source.control);
    let extent = GridExtent::checked(context, "dimensions", header.dims, stored.voxel_type(), room)?;
    let (voxels, after) = match unpacked {
        None => {
            let at = header.bytes as u64;
            (source.voxels(context, at, (&stored, extent), TrailingData::Allowed, HELP)?, Vec::new())
        }
        Some(bytes) => {
            let needed = (extent.voxels as u64).saturating_mul(stored.voxel_bytes());
            let mut data = &bytes[header.bytes.min(bytes.len())..];
            if (data.len() as u64) < needed {
                return Err(context.bad_input_error(
                    "data",
                    format!("the data are truncated: {needed} bytes expected, {} found", data.len()),
                    HELP,
                ));
            }
            let layout = VoxelLayout { extent, voxel_type: stored.voxel_type(), endian: stored.endian };
            let voxels = stored
                .read(&mut data, extent, control)
                .map_err(|fault| fault.into_error(context, &layout, "bytes", HELP))?;
            (voxels, data.to_vec())
        }
    };
    let (placement, hints) = (header.placement(part), header.hints(&after));
    VolumeParts { name: stem(source.path), extent, placement, voxels, hints }.into_volume(context, control)
}
