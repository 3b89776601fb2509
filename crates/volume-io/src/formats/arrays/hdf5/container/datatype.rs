//! Datatypes (section IV.A.2.d): those that can be voxels, and those of attributes that are read.

use super::field_cursor::{FieldCursor, ParseResult};
use crate::Endian;
use crate::reading::number::FileNumberType;

/// Maximum depth of types within types.
const MAX_DEPTH: usize = 8;

/// Type of the elements of an array or attribute.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Hdf5Type {
    /// Numbers in a byte order.
    Number(FileNumberType, Endian),
    /// Complex numbers: two numbers each.
    Complex(FileNumberType, Endian),
    /// Text of a fixed length, in bytes.
    Text,
    /// Text of any length, in the global heap.
    VariableText,
    /// Address of an object.
    Reference,
    /// List of addresses in the global heap.
    ReferenceList,
    /// Type that is no voxel, by its name for messages.
    Other(&'static str),
}

impl Hdf5Type {
    /// Parses a datatype; returns it with the bytes of an element.
    pub(crate) fn parse(cursor: &mut FieldCursor<'_>) -> ParseResult<(Self, usize)> {
        Self::parse_nested(cursor, MAX_DEPTH)
    }

    fn parse_nested(cursor: &mut FieldCursor<'_>, depth: usize) -> ParseResult<(Self, usize)> {
        let Some(depth) = depth.checked_sub(1) else { return Err("types are nested too deep".into()) };
        let class = cursor.byte()?;
        let bits = cursor.number(3)?;
        let size = cursor.number(4)? as usize;
        if size == 0 {
            return Err("a type has no bytes".into());
        }
        let endian = if bits & 1 == 0 { Endian::Little } else { Endian::Big };
        let found = match class & 0x0f {
            0 => whole_number(cursor, size, bits & 8 != 0)?.map(|number| Self::Number(number, endian)),
            1 if bits & 0x40 == 0 => real_number(cursor, size)?.map(|number| Self::Number(number, endian)),
            1 => Some(Self::Other("floating-point numbers of a VAX")),
            2 => Some(Self::Other("times")),
            3 => Some(Self::Text),
            4 => Some(Self::Other("bit fields")),
            5 => Some(Self::Other("opaque bytes")),
            6 => Some(complex_number(cursor, class >> 4, (bits & 0xffff, size), depth)?),
            7 if bits % 16 == 0 => Some(Self::Reference),
            7 => Some(Self::Other("references to regions")),
            // Named numbers: of two names false and true, which programs store as signed bytes.
            8 => Some(match Self::parse_nested(cursor, depth)?.0 {
                Self::Number(FileNumberType::I8, endian) if bits & 0xffff == 2 => {
                    Self::Number(FileNumberType::U8, endian)
                }
                named => named,
            }),
            9 if bits % 16 == 1 => Some(Self::VariableText),
            9 => match Self::parse_nested(cursor, depth)?.0 {
                Self::Reference => Some(Self::ReferenceList),
                _ => Some(Self::Other("lists of any length")),
            },
            10 => Some(Self::Other("arrays within arrays")),
            11 => Some(match Self::parse_nested(cursor, depth)?.0 {
                Self::Number(number, endian) if number.bytes() * 2 == size => Self::Complex(number, endian),
                _ => Self::Other("complex numbers of another type"),
            }),
            other => return Err(format!("class {other} of types is unknown").into()),
        };
        Ok((found.unwrap_or(Self::Other("numbers of a width that is not supported")), size))
    }
}

/// Integer type with all bits in use.
fn whole_number(
    cursor: &mut FieldCursor<'_>,
    size: usize,
    is_signed: bool,
) -> ParseResult<Option<FileNumberType>> {
    let (first_bit, bits) = (cursor.number(2)?, cursor.number(2)?);
    if first_bit != 0 || bits as usize != size.saturating_mul(8) {
        return Ok(None);
    }
    Ok(match (size, is_signed) {
        (1, false) => Some(FileNumberType::U8),
        (1, true) => Some(FileNumberType::I8),
        (2, false) => Some(FileNumberType::U16),
        (2, true) => Some(FileNumberType::I16),
        (4, false) => Some(FileNumberType::U32),
        (4, true) => Some(FileNumberType::I32),
        (8, false) => Some(FileNumberType::U64),
        (8, true) => Some(FileNumberType::I64),
        _ => None,
    })
}

/// Floating-point type of IEEE 754.
fn real_number(cursor: &mut FieldCursor<'_>, size: usize) -> ParseResult<Option<FileNumberType>> {
    let (first_bit, bits) = (cursor.number(2)?, cursor.number(2)?);
    let parts = cursor.take(4)?;
    let bias = cursor.number(4)?;
    Ok(match (size, parts, bias) {
        _ if first_bit != 0 || bits as usize != size.saturating_mul(8) => None,
        (2, [10, 5, 0, 10], 15) => Some(FileNumberType::F16),
        (4, [23, 8, 0, 23], 127) => Some(FileNumberType::F32),
        (8, [52, 11, 0, 52], 1023) => Some(FileNumberType::F64),
        _ => None,
    })
}

/// Complex numbers, which are records of two numbers, or else the name of records.
fn complex_number(
    cursor: &mut FieldCursor<'_>,
    version: u8,
    (members, size): (u64, usize),
    depth: usize,
) -> ParseResult<Hdf5Type> {
    let other = Hdf5Type::Other("records");
    if members != 2 {
        return Ok(other);
    }
    let mut parts = [(0, other); 2];
    for part in &mut parts {
        let name = cursor.rest().iter().position(|&byte| byte == 0).ok_or("a name has no end")? + 1;
        cursor.take(if version < 3 { name.next_multiple_of(8) } else { name })?;
        // The offset has as many bytes as the size of the record needs.
        let width = if version < 3 { 4 } else { (size.ilog2() / 8 + 1) as usize };
        let offset = cursor.number(width)?;
        if version == 1 {
            cursor.take(28)?;
        }
        *part = (offset, Hdf5Type::parse_nested(cursor, depth)?.0);
        // Other members may be longer than what was parsed of them.
        if !matches!(part.1, Hdf5Type::Number(..)) {
            return Ok(other);
        }
    }
    Ok(match parts {
        [(0, Hdf5Type::Number(number, endian)), (second, imaginary)]
            if imaginary == Hdf5Type::Number(number, endian)
                && second == number.bytes() as u64
                && size == 2 * number.bytes()
                && matches!(number, FileNumberType::F32 | FileNumberType::F64) =>
        {
            Hdf5Type::Complex(number, endian)
        }
        _ => other,
    })
}
