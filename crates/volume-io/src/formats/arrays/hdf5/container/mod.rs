//! Container of an HDF5 file: objects with messages and attributes, in groups.
//!
//! After the file format specification 3.0 (<https://support.hdfgroup.org/documentation/hdf5/latest/_f_m_t3.html>),
//! whose sections are named at each part. Only the metadata that are asked for are read, block by block; no length in
//! the file leads to an allocation that is longer than the file.

mod attribute;
mod dataspace;
mod datatype;
mod field_cursor;
mod heaps;
mod links;
mod object;
mod record_tree;
mod superblock;

use std::cell::Cell;
use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom};

use crate::reading::input::InputFile;
pub(super) use attribute::Hdf5Attribute;
use chiaroscuro_files::fault;
use chiaroscuro_volume::LoadContext;
use chiaroscuro_volume::{LoadControl, LoadError};
pub(super) use dataspace::{Dataspace, parse_dataspace};
pub(super) use datatype::Hdf5Type;
pub(super) use field_cursor::{FieldCursor, FieldWidths, ParseResult, text_before_zero};
pub(super) use links::{Hdf5Link, LinkTarget};
pub(super) use object::{Hdf5Object, MessageKind};
pub(super) use record_tree::RecordTree;
pub(super) use superblock::SIGNATURE;
use superblock::Superblock;

/// Help for files that are damaged.
pub(super) const HELP: &str = "copy or download the file again, or write it anew with h5repack IN OUT";

/// Maximum length of a block of metadata, in bytes.
const MAX_BLOCK_BYTES: u64 = 64 << 20;

/// Metadata that may be read of a file in all: as often as its length, and as much beside it. Blocks that refer to each
/// other in circles end there.
const METADATA_READS: u64 = 16;
const METADATA_BYTES: u64 = 64 << 20;

/// Cost of one read, in bytes: so many are read in the time that a call of the system takes.
const READ_COST: u64 = 256;

/// HDF5 file, of which metadata and data are read by address.
pub(super) struct Hdf5File<'a> {
    context: LoadContext<'a>,
    control: &'a LoadControl,
    file: File,
    /// Length of the file, in bytes.
    length: u64,
    superblock: Superblock,
    /// Metadata that may still be read, in bytes.
    allowance: Cell<u64>,
}

impl<'a> Hdf5File<'a> {
    /// Reads the superblock of a file.
    pub(super) fn open(
        context: LoadContext<'a>,
        control: &'a LoadControl,
        input: &InputFile,
    ) -> Result<Self, LoadError> {
        let file = input.reader.get_ref().try_clone().map_err(|error| context.io_error(error))?;
        let superblock = Superblock::default();
        let allowance = Cell::new(input.len.saturating_mul(METADATA_READS).saturating_add(METADATA_BYTES));
        let mut opened = Self { context, control, file, length: input.len, superblock, allowance };
        opened.superblock = Superblock::find(&opened)?;
        Ok(opened)
    }

    pub(super) fn context(&self) -> LoadContext<'a> {
        self.context
    }

    pub(super) fn control(&self) -> &'a LoadControl {
        self.control
    }

    /// Length of the file, in bytes.
    pub(super) fn length(&self) -> u64 {
        self.length
    }

    pub(super) fn widths(&self) -> FieldWidths {
        self.superblock.widths
    }

    /// Returns the root group.
    pub(super) fn root(&self) -> Result<Hdf5Object, LoadError> {
        Hdf5Object::read(self, self.superblock.root)
    }

    /// Byte of the file at which an address lies.
    pub(super) fn position(&self, address: u64) -> u64 {
        address.saturating_add(self.superblock.base)
    }

    /// Error for a file that is damaged.
    pub(super) fn broken(&self, field: &str, why: impl Into<String>) -> LoadError {
        self.context.bad_input_error(field, why, HELP)
    }

    /// Reads a block of metadata.
    pub(super) fn read_block(&self, address: u64, count: u64, field: &str) -> Result<Vec<u8>, LoadError> {
        let cost = count.saturating_add(READ_COST);
        let Some(left) = self.allowance.get().checked_sub(cost) else {
            return Err(self.broken(field, "its metadata refer to each other in circles"));
        };
        if count > MAX_BLOCK_BYTES {
            let why = format!("a block of {count} bytes is longer than any, {MAX_BLOCK_BYTES} are allowed");
            return Err(self.broken(field, why));
        }
        self.allowance.set(left);
        self.read_data(address, count, field)
    }

    /// Reads bytes at an address; they must lie within the file, which is checked before memory is allocated.
    pub(super) fn read_data(&self, address: u64, count: u64, field: &str) -> Result<Vec<u8>, LoadError> {
        self.control.check()?;
        let at = self.position(address);
        let end = at.saturating_add(count);
        let Some(length) = usize::try_from(count).ok().filter(|_| end <= self.length) else {
            let why = format!("bytes {at} to {end} were expected, the file has {}", self.length);
            return Err(self.broken(field, format!("the file is truncated: {why}")));
        };
        let mut bytes = Vec::new();
        if bytes.try_reserve_exact(length).is_err() {
            let why = format!("there is not enough memory for {count} bytes");
            return Err(self.context.limit_error(field, why, "close other programs"));
        }
        let io = |error| self.context.io_error(error);
        if fault::is_due(fault::FaultEvent::BlockRead, fault::InjectedFault::ReadError) {
            return Err(io(std::io::Error::other("a fault was injected")));
        }
        let mut file = &self.file;
        file.seek(SeekFrom::Start(at)).map_err(io)?;
        file.take(count).read_to_end(&mut bytes).map_err(io)?;
        if bytes.len() < length {
            let why = format!("{count} bytes were expected at byte {at}, {} found", bytes.len());
            return Err(self.broken(field, format!("the file is truncated: {why}")));
        }
        Ok(bytes)
    }

    /// Parses bytes, and reports a failure as an error about `field`.
    pub(super) fn parse<'b, T>(
        &self,
        bytes: &'b [u8],
        field: &str,
        parse: impl FnOnce(&mut FieldCursor<'b>) -> ParseResult<T>,
    ) -> Result<T, LoadError> {
        let parsed = parse(&mut FieldCursor::new(bytes, self.widths()));
        parsed.map_err(|why| self.broken(field, format!("the {field} is broken: {why}")))
    }
}
