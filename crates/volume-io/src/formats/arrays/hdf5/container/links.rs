//! Links of a group to its members: in a symbol table of old groups, in the header, or in a heap of large groups.

use std::cmp::Ordering;
use std::collections::BTreeSet;

use super::Hdf5File;
use super::field_cursor::{FieldCursor, ParseResult, text_before_zero};
use super::heaps::{FractalHeap, LocalHeap};
use super::object::{Hdf5Object, MessageKind};
use super::record_tree::RecordTree;
use chiaroscuro_volume::LoadError;

const FIELD: &str = "group";

/// Maximum number of members of a group.
const MAX_LINKS: usize = 1 << 18;

/// Target of a link.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum LinkTarget {
    /// Object at an address.
    Object(u64),
    /// Path within the file.
    Path(String),
    /// Object in another file, which is not followed.
    OtherFile,
}

/// Link of a group to a member.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Hdf5Link {
    pub(crate) name: String,
    pub(crate) target: LinkTarget,
}

impl Hdf5Object {
    /// Returns the links of a group, in the order of the file; none for other objects.
    pub(crate) fn links(&self, file: &Hdf5File<'_>) -> Result<Vec<Hdf5Link>, LoadError> {
        let mut found = Vec::new();
        for table in self.own_messages(MessageKind::SYMBOL_TABLE) {
            let places = file
                .parse(table, FIELD, |cursor| Ok((cursor.present_address()?, cursor.present_address()?)))?;
            table_links(file, places, &mut found)?;
        }
        for message in self.own_messages(MessageKind::LINK) {
            found.extend(file.parse(message, FIELD, parse_link)?);
        }
        for info in self.own_messages(MessageKind::LINK_INFO) {
            let places = file.parse(info, FIELD, |cursor| {
                cursor.byte()?;
                let flags = cursor.byte()?;
                cursor.take(if flags & 1 != 0 { 8 } else { 0 })?;
                Ok((cursor.address()?, cursor.address()?))
            })?;
            let (Some(heap), Some(tree)) = places else { continue };
            let heap = FractalHeap::open(file, heap)?;
            let mut records = RecordTree::open(file, tree)?.records(file, MAX_LINKS, &|_| Ordering::Equal)?;
            // Each record has a hash of the name, by which it is sorted, before the place in the heap.
            for record in &mut records {
                let id = record.get(4..).unwrap_or_default();
                if let Some(message) = heap.object(file, id)? {
                    found.extend(file.parse(&message, FIELD, parse_link)?);
                }
            }
            found.sort_by(|one, other| one.name.cmp(&other.name));
        }
        found.truncate(MAX_LINKS);
        Ok(found)
    }
}

/// Parses a link message (section IV.A.2.g); `None` for links of a kind that only some programs know.
fn parse_link(cursor: &mut FieldCursor<'_>) -> ParseResult<Option<Hdf5Link>> {
    let (version, flags) = (cursor.byte()?, cursor.byte()?);
    if version != 1 {
        return Err(format!("version {version} of links is unknown").into());
    }
    let kind = if flags & 8 != 0 { cursor.byte()? } else { 0 };
    let order = if flags & 4 != 0 { 8 } else { 0 };
    cursor.take(order + usize::from(flags & 0x10 != 0))?;
    let length = cursor.number(1 << (flags & 3))?;
    let name = String::from_utf8_lossy(cursor.take_stored(length)?).into_owned();
    let target = match kind {
        0 => LinkTarget::Object(cursor.present_address()?),
        1 => {
            let length = cursor.number(2)?;
            LinkTarget::Path(String::from_utf8_lossy(cursor.take_stored(length)?).into_owned())
        }
        64 => LinkTarget::OtherFile,
        _ => return Ok(None),
    };
    Ok(Some(Hdf5Link { name, target }))
}

/// Reads the links of a symbol table: a tree of version 1, whose leaves name members in a local heap (sections III.A,
/// III.B and III.C).
fn table_links(
    file: &Hdf5File<'_>,
    (tree, heap): (u64, u64),
    found: &mut Vec<Hdf5Link>,
) -> Result<(), LoadError> {
    let heap = LocalHeap::open(file, heap)?;
    let (address, length) = (file.widths().address, file.widths().length);
    let mut waiting = vec![(tree, u8::MAX)];
    let mut visited = BTreeSet::new();
    while let Some((node, level)) = waiting.pop() {
        if !visited.insert(node) {
            return Err(file.broken(FIELD, "the tree of a group refers to itself"));
        }
        let head = file.read_block(node, 8, FIELD)?;
        if head.starts_with(b"SNOD") {
            let count = u64::from(u16::from_le_bytes([head[6], head[7]]));
            let bytes = file.read_block(node.saturating_add(8), count * (2 * address as u64 + 24), FIELD)?;
            for entry in bytes.chunks_exact(2 * address + 24) {
                found.push(file.parse(entry, FIELD, |cursor| parse_entry(cursor, &heap))?);
            }
            continue;
        }
        let (depth, children) = file.parse(&head, FIELD, |cursor| {
            cursor.require_signature(*b"TREE")?;
            let (kind, depth) = (cursor.byte()?, cursor.byte()?);
            if kind != 0 || depth >= level {
                return Err("a node of a tree has another kind or level than its parent states".into());
            }
            Ok((depth, cursor.number(2)?))
        })?;
        let start = node.saturating_add(8 + 2 * address as u64);
        let bytes = file.read_block(start, children * (length + address) as u64, FIELD)?;
        let mut below = file.parse(&bytes, FIELD, |cursor| {
            let child = |_| {
                cursor.length()?;
                Ok((cursor.present_address()?, depth))
            };
            (0..children).map(child).collect::<ParseResult<Vec<_>>>()
        })?;
        below.reverse();
        waiting.append(&mut below);
    }
    Ok(())
}

/// Parses an entry of a symbol table (section III.C).
fn parse_entry(cursor: &mut FieldCursor<'_>, heap: &LocalHeap) -> ParseResult<Hdf5Link> {
    let name = heap.text(cursor.present_address()?)?;
    let object = cursor.address()?;
    let cache = cursor.number(4)?;
    cursor.take(4)?;
    let target = if cache == 2 {
        LinkTarget::Path(heap.text(cursor.number(4)?)?)
    } else {
        LinkTarget::Object(object.ok_or("an address is missing")?)
    };
    Ok(Hdf5Link { name, target })
}

impl LocalHeap {
    /// Text at an offset of the heap.
    fn text(&self, at: u64) -> ParseResult<String> {
        let bytes = usize::try_from(at).ok().and_then(|at| self.bytes.get(at..));
        Ok(text_before_zero(bytes.ok_or("a name lies beyond its heap")?))
    }
}
