//! Objects of a file: a header with messages (section IV.A), in version 1 or 2.

use std::collections::VecDeque;

use super::Hdf5File;
use super::field_cursor::{FieldCursor, ParseResult};
use chiaroscuro_volume::LoadError;

const FIELD: &str = "object header";

/// Maximum number of messages of an object.
const MAX_MESSAGES: usize = 1 << 16;

/// Bytes of a block with one message.
const MIN_BLOCK: u64 = 8;

/// Number of the message types that are read (section IV.A.2).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct MessageKind(u16);

impl MessageKind {
    pub(crate) const DATASPACE: Self = Self(0x01);
    pub(crate) const LINK_INFO: Self = Self(0x02);
    pub(crate) const DATATYPE: Self = Self(0x03);
    pub(crate) const OLD_FILL_VALUE: Self = Self(0x04);
    pub(crate) const FILL_VALUE: Self = Self(0x05);
    pub(crate) const LINK: Self = Self(0x06);
    pub(crate) const EXTERNAL_FILES: Self = Self(0x07);
    pub(crate) const LAYOUT: Self = Self(0x08);
    pub(crate) const FILTERS: Self = Self(0x0b);
    pub(crate) const ATTRIBUTE: Self = Self(0x0c);
    const CONTINUATION: Self = Self(0x10);
    pub(crate) const SYMBOL_TABLE: Self = Self(0x11);
    pub(crate) const ATTRIBUTE_INFO: Self = Self(0x15);
}

/// Message of an object header.
#[derive(Debug, Clone)]
struct HeaderMessage {
    kind: MessageKind,
    /// True if the data are a reference to the message in another object.
    is_shared: bool,
    data: Vec<u8>,
}

/// Object of a file: a group, a dataset or a named datatype.
#[derive(Debug, Clone)]
pub(crate) struct Hdf5Object {
    /// Address of its header, which identifies it.
    pub(crate) address: u64,
    messages: Vec<HeaderMessage>,
}

impl Hdf5Object {
    /// Reads the header at an address.
    pub(crate) fn read(file: &Hdf5File<'_>, address: u64) -> Result<Self, LoadError> {
        let start = file.read_block(address, 4, FIELD)?;
        let mut object = Self { address, messages: Vec::new() };
        let is_new = start == b"OHDR";
        let (body, length, head) = if is_new {
            let prefix = file.read_block(
                address,
                34.min(file.length().saturating_sub(file.position(address))),
                FIELD,
            )?;
            file.parse(&prefix, FIELD, |cursor| {
                cursor.take(4)?;
                let (version, flags) = (cursor.byte()?, cursor.byte()?);
                if version != 2 {
                    return Err(format!("version {version} is unknown").into());
                }
                cursor
                    .take(if flags & 0x20 != 0 { 16 } else { 0 } + if flags & 0x10 != 0 { 4 } else { 0 })?;
                let length = cursor.number(1 << (flags & 3))?;
                Ok(((prefix.len() - cursor.rest().len()) as u64, length, if flags & 4 != 0 { 6 } else { 4 }))
            })?
        } else {
            let prefix = file.read_block(address, 12, FIELD)?;
            file.parse(&prefix, FIELD, |cursor| {
                let version = cursor.byte()?;
                if version != 1 {
                    return Err(format!("version {version} is unknown, 1 and 2 are supported").into());
                }
                cursor.take(7)?;
                Ok((16, cursor.number(4)?, 8))
            })?
        };
        let mut blocks = VecDeque::from([(address.saturating_add(body), length, false)]);
        let mut read = 0u64;
        while let Some((at, length, is_continuation)) = blocks.pop_front() {
            // Blocks share no bytes, so that all together are not longer than the file.
            read = read.saturating_add(length.max(MIN_BLOCK));
            if read > file.length() {
                return Err(file.broken(FIELD, "an object header continues in circles"));
            }
            let bytes = file.read_block(at, length, FIELD)?;
            let found = file.parse(&bytes, FIELD, |cursor| {
                if is_new { new_messages(cursor, head, is_continuation) } else { old_messages(cursor) }
            })?;
            for message in found {
                if message.kind == MessageKind::CONTINUATION {
                    let next = file.parse(&message.data, FIELD, |cursor| {
                        Ok((cursor.present_address()?, cursor.length()?, true))
                    })?;
                    blocks.push_back(next);
                } else if object.messages.len() < MAX_MESSAGES {
                    object.messages.push(message);
                }
            }
        }
        Ok(object)
    }

    /// Returns true if the header has a message of a kind.
    pub(crate) fn has(&self, kind: MessageKind) -> bool {
        self.messages.iter().any(|message| message.kind == kind)
    }

    /// Returns true if the object is an array.
    pub(crate) fn is_dataset(&self) -> bool {
        self.has(MessageKind::DATASPACE) && self.has(MessageKind::LAYOUT)
    }

    /// Data of the messages of a kind that are stored in this header.
    pub(super) fn own_messages(&self, kind: MessageKind) -> impl Iterator<Item = &[u8]> {
        let own = move |message: &&HeaderMessage| message.kind == kind && !message.is_shared;
        self.messages.iter().filter(own).map(|message| message.data.as_slice())
    }

    /// Returns the data of the first message of a kind, also where they are shared with another object.
    pub(crate) fn message(
        &self,
        file: &Hdf5File<'_>,
        kind: MessageKind,
    ) -> Result<Option<Vec<u8>>, LoadError> {
        let Some(found) = self.messages.iter().find(|message| message.kind == kind) else { return Ok(None) };
        if found.is_shared {
            shared_message(file, &found.data, kind).map(Some)
        } else {
            Ok(Some(found.data.clone()))
        }
    }
}

/// Reads a message that another object holds (section IV.A.2: shared messages).
pub(super) fn shared_message(
    file: &Hdf5File<'_>,
    reference: &[u8],
    kind: MessageKind,
) -> Result<Vec<u8>, LoadError> {
    let address = file.parse(reference, FIELD, |cursor| {
        let (version, place) = (cursor.byte()?, cursor.byte()?);
        if version == 1 {
            cursor.take(6)?;
        } else if version > 2 && place != 2 {
            return Err("messages that are shared in a heap are not supported".into());
        }
        cursor.present_address()
    })?;
    let holder = Hdf5Object::read(file, address)?;
    let found = holder.own_messages(kind).next().map(<[u8]>::to_vec);
    found.ok_or_else(|| file.broken(FIELD, "a shared message is missing"))
}

/// Messages of a block of a header in version 1.
fn old_messages(cursor: &mut FieldCursor<'_>) -> ParseResult<Vec<HeaderMessage>> {
    let mut found = Vec::new();
    while cursor.rest().len() >= 8 {
        let (kind, length) = (cursor.number(2)?, cursor.number(2)?);
        let flags = cursor.byte()?;
        cursor.take(3)?;
        let data = cursor.take_stored(length)?.to_vec();
        found.push(HeaderMessage { kind: MessageKind(kind as u16), is_shared: flags & 2 != 0, data });
    }
    Ok(found)
}

/// Messages of a block of a header in version 2, each with `head` bytes before its data; after the first block each has a
/// signature and a checksum.
fn new_messages(
    cursor: &mut FieldCursor<'_>,
    head: usize,
    is_continuation: bool,
) -> ParseResult<Vec<HeaderMessage>> {
    let mut checksum = 0;
    if is_continuation {
        cursor.require_signature(*b"OCHK")?;
        checksum = 4;
    }
    let mut found = Vec::new();
    while cursor.rest().len() >= head + checksum {
        let (kind, length) = (cursor.byte()?, cursor.number(2)?);
        let flags = cursor.byte()?;
        cursor.take(head - 4)?;
        let data = cursor.take_stored(length)?.to_vec();
        found.push(HeaderMessage { kind: MessageKind(kind.into()), is_shared: flags & 2 != 0, data });
    }
    Ok(found)
}
