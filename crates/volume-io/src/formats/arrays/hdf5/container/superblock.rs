//! Superblock (section II.A): versions, widths of fields, and the address of the root group.

use super::Hdf5File;
use super::field_cursor::{FieldCursor, FieldWidths, ParseResult};
use chiaroscuro_volume::LoadError;

/// Signature at the beginning of a superblock.
pub(crate) const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";

/// Longest user block before the superblock that is looked behind; longer ones are not written.
const MAX_USER_BLOCK: u64 = 1 << 20;

const FIELD: &str = "superblock";

/// Facts of the superblock.
#[derive(Debug, Clone, Copy)]
pub(super) struct Superblock {
    /// Byte of the file to which addresses are relative: that of the superblock.
    pub(super) base: u64,
    pub(super) widths: FieldWidths,
    /// Address of the root group's object header.
    pub(super) root: u64,
}

impl Default for Superblock {
    fn default() -> Self {
        Self { base: 0, widths: FieldWidths { address: 8, length: 8 }, root: 0 }
    }
}

impl Superblock {
    /// Finds and reads the superblock: at byte 0, 512, 1024 and so on.
    pub(super) fn find(file: &Hdf5File<'_>) -> Result<Self, LoadError> {
        let mut base = 0;
        while base <= MAX_USER_BLOCK && base.saturating_add(SIGNATURE.len() as u64) <= file.length() {
            if file.read_block(base, SIGNATURE.len() as u64, FIELD)? == SIGNATURE {
                let count = (file.length() - base).min(256);
                let bytes = file.read_block(base, count, FIELD)?;
                return file.parse(&bytes, FIELD, |cursor| Self::parse(cursor, base));
            }
            base = if base == 0 { 512 } else { base * 2 };
        }
        Err(file.context().bad_input_error(
            "superblock",
            "it is no HDF5 file: the signature of HDF5 is missing",
            "check that the file is complete, or name it by its own format",
        ))
    }

    fn parse(cursor: &mut FieldCursor<'_>, base: u64) -> ParseResult<Self> {
        cursor.take(SIGNATURE.len())?;
        let version = cursor.byte()?;
        if version > 3 {
            return Err(format!("version {version} is unknown, 0 to 3 are supported").into());
        }
        let is_old = version < 2;
        if is_old {
            cursor.take(4)?;
        }
        let widths = FieldWidths { address: cursor.byte()?.into(), length: cursor.byte()?.into() };
        let is_usable = |width| matches!(width, 2 | 4 | 8);
        if !is_usable(widths.address) || !is_usable(widths.length) {
            let FieldWidths { address, length } = widths;
            return Err(
                format!("addresses of {address} bytes and lengths of {length} are not supported").into()
            );
        }
        let mut cursor = FieldCursor::new(cursor.rest(), widths);
        // Reserved; sizes of nodes, which nodes state themselves; flags.
        cursor.take(match version {
            0 => 9,
            1 => 13,
            _ => 1,
        })?;
        // Base address, free space or extension, end of the file, driver information; the first is where the
        // superblock was written, which another user block has moved.
        let before_root = if is_old { 4 } else { 3 };
        for _ in 0..before_root {
            cursor.address()?;
        }
        if is_old {
            // Offset of the root group's name.
            cursor.address()?;
        }
        Ok(Self { base, widths, root: cursor.present_address()? })
    }
}
