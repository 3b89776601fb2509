//! Attributes of objects (section IV.A.2.m), in the header or in a heap.

use super::Hdf5File;
use super::dataspace::parse_dataspace;
use super::datatype::Hdf5Type;
use super::field_cursor::{FieldCursor, ParseResult, text_before_zero};
use super::heaps::{FractalHeap, global_object};
use super::object::{Hdf5Object, MessageKind, shared_message};
use super::record_tree::RecordTree;
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::LoadError;

const FIELD: &str = "attribute";

/// Maximum number of attributes of an object, and of elements of one that are read.
const MAX_ATTRIBUTES: usize = 4096;
const MAX_ELEMENTS: usize = 1 << 16;

/// Maximum length of text that is read of an attribute.
const MAX_TEXT: usize = 4096;

/// Attribute of an object: a name with one value or several.
#[derive(Debug, Clone)]
pub(crate) struct Hdf5Attribute {
    pub(crate) name: String,
    element_type: Hdf5Type,
    element_bytes: usize,
    data: Vec<u8>,
}

impl Hdf5Attribute {
    /// Bytes of each element.
    fn elements(&self) -> impl Iterator<Item = &[u8]> {
        self.data.chunks_exact(self.element_bytes.max(1)).take(MAX_ELEMENTS)
    }

    /// Numbers of the attribute; none if it holds something else.
    pub(crate) fn numbers(&self) -> Vec<f64> {
        match self.element_type {
            Hdf5Type::Number(number, endian) if number.bytes() == self.element_bytes => {
                self.elements().map(|bytes| number.value(bytes, endian)).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Texts of the attribute; none if it holds something else.
    pub(crate) fn texts(&self, file: &Hdf5File<'_>) -> Result<Vec<String>, LoadError> {
        match self.element_type {
            Hdf5Type::Text => {
                Ok(self.elements().map(|bytes| sanitised(&text_before_zero(bytes), MAX_TEXT)).collect())
            }
            Hdf5Type::VariableText => {
                let text = |bytes| {
                    sequence(file, bytes, 1).map(|bytes| sanitised(&text_before_zero(&bytes), MAX_TEXT))
                };
                self.elements().map(text).collect()
            }
            _ => Ok(Vec::new()),
        }
    }

    /// Text of the attribute, of all its elements together: Imaris writes single letters.
    pub(crate) fn text(&self, file: &Hdf5File<'_>) -> Result<String, LoadError> {
        if self.element_type == Hdf5Type::Text && self.element_bytes == 1 {
            return Ok(sanitised(&text_before_zero(&self.data), MAX_TEXT));
        }
        Ok(self.texts(file)?.concat())
    }

    /// Addresses of objects, in one list for each element.
    pub(crate) fn references(&self, file: &Hdf5File<'_>) -> Result<Vec<Vec<u64>>, LoadError> {
        let width = file.widths().address;
        let addresses = |bytes: &[u8]| {
            let address = |bytes: &[u8]| file.parse(bytes, FIELD, |cursor| cursor.number(width));
            bytes.chunks_exact(width).map(address).collect::<Result<Vec<u64>, LoadError>>()
        };
        match self.element_type {
            Hdf5Type::Reference => self.elements().map(addresses).collect(),
            Hdf5Type::ReferenceList => {
                self.elements().map(|bytes| addresses(&sequence(file, bytes, width)?)).collect()
            }
            _ => Ok(Vec::new()),
        }
    }
}

/// Bytes of a list of any length: the element gives their number and their place in a global heap.
fn sequence(file: &Hdf5File<'_>, element: &[u8], width: usize) -> Result<Vec<u8>, LoadError> {
    let (count, address, index) = file.parse(element, FIELD, |cursor| {
        Ok((cursor.number(4)? as usize, cursor.address()?, cursor.number(4)?))
    })?;
    let Some(address) = address.filter(|&address| address != 0 && count > 0) else { return Ok(Vec::new()) };
    let mut bytes = global_object(file, address, index)?;
    bytes.truncate(count.saturating_mul(width));
    Ok(bytes)
}

impl Hdf5Object {
    /// Returns the attributes of the object; those that are damaged are left out.
    pub(crate) fn attributes(&self, file: &Hdf5File<'_>) -> Result<Vec<Hdf5Attribute>, LoadError> {
        let mut messages: Vec<Vec<u8>> =
            self.own_messages(MessageKind::ATTRIBUTE).take(MAX_ATTRIBUTES).map(<[u8]>::to_vec).collect();
        for info in self.own_messages(MessageKind::ATTRIBUTE_INFO) {
            let places = file.parse(info, FIELD, |cursor| {
                cursor.byte()?;
                let flags = cursor.byte()?;
                cursor.take(if flags & 1 != 0 { 2 } else { 0 })?;
                Ok((cursor.address()?, cursor.address()?))
            })?;
            let (Some(heap), Some(tree)) = places else { continue };
            let heap = FractalHeap::open(file, heap)?;
            let records = RecordTree::open(file, tree)?
                .records(file, MAX_ATTRIBUTES, &|_| std::cmp::Ordering::Equal)?;
            for record in records {
                messages.extend(heap.object(file, record.get(..8).unwrap_or_default())?);
            }
        }
        let mut found = Vec::new();
        for message in messages {
            // A damaged attribute is no reason to refuse the voxels.
            if let Ok(parts) = AttributeParts::parse(&mut FieldCursor::new(&message, file.widths())) {
                found.extend(parts.into_attribute(file)?);
            }
        }
        Ok(found)
    }
}

/// Parts of an attribute's message.
struct AttributeParts<'a> {
    name: String,
    datatype: &'a [u8],
    is_type_shared: bool,
    dataspace: &'a [u8],
    data: &'a [u8],
}

impl<'a> AttributeParts<'a> {
    fn parse(cursor: &mut FieldCursor<'a>) -> ParseResult<Self> {
        let (version, flags) = (cursor.byte()?, cursor.byte()?);
        if !(1..=3).contains(&version) {
            return Err(format!("version {version} of attributes is unknown").into());
        }
        let sizes = [cursor.number(2)?, cursor.number(2)?, cursor.number(2)?].map(|size| size as usize);
        if version == 3 {
            cursor.byte()?;
        }
        let mut part = |size: usize| {
            let bytes = cursor.take(if version == 1 { size.next_multiple_of(8) } else { size })?;
            Ok::<_, std::borrow::Cow<'static, str>>(&bytes[..size])
        };
        let (name, datatype, dataspace) = (part(sizes[0])?, part(sizes[1])?, part(sizes[2])?);
        let (name, is_type_shared) = (text_before_zero(name), version > 1 && flags & 1 != 0);
        Ok(Self { name, datatype, is_type_shared, dataspace, data: cursor.rest() })
    }

    fn into_attribute(self, file: &Hdf5File<'_>) -> Result<Option<Hdf5Attribute>, LoadError> {
        let shared;
        let mut datatype = self.datatype;
        if self.is_type_shared {
            shared = shared_message(file, datatype, MessageKind::DATATYPE)?;
            datatype = &shared;
        }
        let read = || {
            let cursor = |bytes| FieldCursor::new(bytes, file.widths());
            let (element_type, element_bytes) = Hdf5Type::parse(&mut cursor(datatype))?;
            let shape = parse_dataspace(&mut cursor(self.dataspace))?.shape;
            let count = shape.iter().fold(1u64, |product, &n| product.saturating_mul(n));
            let bytes = count.saturating_mul(element_bytes as u64);
            let data = FieldCursor::new(self.data, file.widths()).take_stored(bytes)?.to_vec();
            ParseResult::Ok(Hdf5Attribute { name: self.name.clone(), element_type, element_bytes, data })
        };
        Ok(read().ok())
    }
}
