//! Dataspaces (section IV.A.2.b): the shape of an array or attribute.

use super::field_cursor::{FieldCursor, ParseResult};

/// Maximum number of dimensions.
const MAX_RANK: u8 = 32;

/// Shape of an array or attribute, slowest dimension first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Dataspace {
    pub(crate) shape: Vec<u64>,
    /// Lengths to which the dimensions may grow; `None` without a limit.
    pub(crate) limits: Vec<Option<u64>>,
}

/// Parses a dataspace; one without elements has a single dimension of length 0.
pub(crate) fn parse_dataspace(cursor: &mut FieldCursor<'_>) -> ParseResult<Dataspace> {
    let (version, rank, flags) = (cursor.byte()?, cursor.byte()?, cursor.byte()?);
    let mut is_null = false;
    match version {
        1 => drop(cursor.take(5)?),
        2 => is_null = cursor.byte()? == 2,
        _ => return Err(format!("version {version} of dataspaces is unknown").into()),
    }
    if rank > MAX_RANK {
        return Err(format!("{rank} dimensions were found, at most {MAX_RANK} are possible").into());
    }
    if is_null {
        return Ok(Dataspace { shape: vec![0], limits: vec![Some(0)] });
    }
    let shape = (0..rank).map(|_| cursor.length()).collect::<ParseResult<Vec<u64>>>()?;
    let limits = if flags & 1 == 0 {
        shape.iter().copied().map(Some).collect()
    } else {
        (0..rank).map(|_| cursor.optional_length()).collect::<ParseResult<Vec<Option<u64>>>>()?
    };
    Ok(Dataspace { shape, limits })
}
