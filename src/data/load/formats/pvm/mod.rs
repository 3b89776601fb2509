//! PVM, the volume format of Stefan Röttger's library: a few lines of text, then voxels of one or two bytes,
//! big-endian. Mostly the whole file is packed, which `dds` undoes.
//!
//! After the description of the formats at <http://schorsch.efi.fh-nuernberg.de/data/volume/>.

mod dds;
mod header;
#[cfg(test)]
mod tests;

use super::input::stem;
use super::number::{Number, Stored};
use super::placement::Parts;
use super::reader::{After, Reader, Source};
use super::samples::Layout;
use super::{Endian, LoadError};
use crate::data::Volume;
use crate::data::attempt::{Attempt, Extent};
use header::{Header, MOST_BYTES};

pub(super) const READER: Reader = Reader {
    name: "PVM",
    endings: &[".pvm", ".pvm.gz"],
    recognises: |start| dds::is_packed(start.bytes()) || header::is_pvm(start.bytes()),
    load,
};

const HELP: &str = "copy or download the file again";

/// Loads a PVM file.
fn load(mut source: Source<'_>) -> Result<Volume, LoadError> {
    let attempt = Attempt { what: "read the PVM volume", path: source.path };
    let control = source.control;
    let budget = source.options.memory_budget_bytes;
    // The size of packed data is unknown before they are unpacked.
    let unpacked = if dds::is_packed(source.start.bytes()) {
        let most = budget.saturating_add(MOST_BYTES as u64);
        Some(dds::unpack(attempt, &mut source.content(), most, control)?)
    } else {
        None
    };
    let header = Header::of(attempt, unpacked.as_deref().unwrap_or(source.start.bytes()))?;
    let (number, components) = match header.components {
        2 => (Number::U16, 1),
        n => (Number::U8, n),
    };
    let part = source.part(attempt, components, components > 1)?;
    let stored = Stored { number, endian: Endian::Big, components, part };
    // Packed data are unpacked as a whole, within the budget.
    let room = source.options.room(source.control);
    let extent = Extent::checked(attempt, "dimensions", header.dims, stored.voxel_type(), room)?;
    let (voxels, after) = match unpacked {
        None => {
            let at = header.bytes as u64;
            (source.voxels(attempt, at, (&stored, extent), After::More, HELP)?, Vec::new())
        }
        Some(bytes) => {
            let needed = (extent.voxels as u64).saturating_mul(stored.bytes_of_voxel());
            let mut data = &bytes[header.bytes.min(bytes.len())..];
            if (data.len() as u64) < needed {
                return Err(attempt.bad_input(
                    "data",
                    format!("the data are truncated: {needed} bytes expected, {} found", data.len()),
                    HELP,
                ));
            }
            let layout = Layout { extent, voxel_type: stored.voxel_type(), endian: stored.endian };
            let voxels = stored
                .read(&mut data, extent, control)
                .map_err(|fault| fault.into_error(attempt, &layout, "bytes", HELP))?;
            (voxels, data.to_vec())
        }
    };
    let (placement, hints) = (header.placement(part), header.hints(&after));
    Parts { name: stem(source.path), extent, placement, voxels, hints }.volume(attempt)
}
