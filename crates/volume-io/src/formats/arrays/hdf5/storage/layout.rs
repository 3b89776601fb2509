//! Layouts of an array's elements (section IV.A.2.i).

use super::super::container::{FieldCursor, ParseResult};
use super::chunk_index::ChunkIndex;

/// Largest slice that is read at once, in bytes, where elements lie one after another.
const SLICE_BYTES: u64 = 16 << 20;

/// Layout of an array's elements.
#[derive(Debug, Clone)]
pub(crate) enum DataLayout {
    /// Elements in the header.
    Compact(Vec<u8>),
    /// Elements one after another; without an address where nothing was written.
    Contiguous { address: Option<u64> },
    /// Blocks of one shape, found through an index.
    Chunks { shape: Vec<u64>, index: ChunkIndex },
    /// Elements of other arrays.
    Virtual,
}

impl DataLayout {
    /// Parses the message of an array with the given shape and bytes of an element.
    pub(super) fn parse(
        cursor: &mut FieldCursor<'_>,
        (shape, element): (&[u64], usize),
    ) -> ParseResult<Self> {
        let version = cursor.byte()?;
        match version {
            1 | 2 => Self::parse_old(cursor, (shape, element)),
            3..=5 => {
                let class = cursor.byte()?;
                match class {
                    0 => {
                        let size = cursor.number(2)?;
                        Ok(Self::Compact(cursor.take_stored(size)?.to_vec()))
                    }
                    1 => Ok(Self::Contiguous { address: cursor.address()? }),
                    2 if version == 3 => {
                        let rank = cursor.byte()?.into();
                        let address = cursor.address()?;
                        let chunk = chunk_shape(cursor, rank, 4, (shape, element))?;
                        Ok(Self::Chunks { shape: chunk, index: ChunkIndex::old_tree(address) })
                    }
                    2 => {
                        let (flags, rank) = (cursor.byte()?, cursor.byte()?.into());
                        let width = cursor.byte()?.into();
                        let chunk = chunk_shape(cursor, rank, width, (shape, element))?;
                        let index = ChunkIndex::parse(cursor, version, flags)?;
                        Ok(Self::Chunks { shape: chunk, index })
                    }
                    3 => Ok(Self::Virtual),
                    other => Err(format!("class {other} of layouts is unknown").into()),
                }
            }
            _ => Err(format!("version {version} of layouts is unknown, 1 to 5 are supported").into()),
        }
    }

    fn parse_old(cursor: &mut FieldCursor<'_>, array: (&[u64], usize)) -> ParseResult<Self> {
        let (rank, class) = (usize::from(cursor.byte()?), cursor.byte()?);
        cursor.take(5)?;
        let address = if class == 0 { None } else { cursor.address()? };
        match class {
            0 => {
                cursor.take(4 * rank)?;
                let size = cursor.number(4)?;
                Ok(Self::Compact(cursor.take_stored(size)?.to_vec()))
            }
            1 => Ok(Self::Contiguous { address }),
            2 => {
                let shape = chunk_shape(cursor, rank, 4, array)?;
                Ok(Self::Chunks { shape, index: ChunkIndex::old_tree(address) })
            }
            other => Err(format!("class {other} of layouts is unknown").into()),
        }
    }

    /// Adds whether chunks pass through filters, which changes the records of their index.
    pub(super) fn with_filters(mut self, are_filtered: bool) -> Self {
        if let Self::Chunks { index, .. } = &mut self {
            index.are_filtered = are_filtered;
        }
        self
    }

    /// Reason why elements of this layout cannot be read, with what helps.
    pub(super) fn refusal(&self) -> Option<(String, String)> {
        matches!(self, Self::Virtual).then(|| {
            (
                "it is put together from other arrays (a virtual dataset), which is not supported".to_owned(),
                "write it as an array of its own: python -c \"import h5py; f = h5py.File('IN'); \
                 h5py.File('OUT.h5', 'w')['data'] = f['NAME'][()]\""
                    .to_owned(),
            )
        })
    }
}

/// Parses the shape of chunks, after whose dimensions the bytes of an element follow.
fn chunk_shape(
    cursor: &mut FieldCursor<'_>,
    rank: usize,
    width: usize,
    (array, element): (&[u64], usize),
) -> ParseResult<Vec<u64>> {
    if rank != array.len() + 1 || !(1..=8).contains(&width) {
        let found = rank.saturating_sub(1);
        return Err(format!("chunks of {found} dimensions for an array of {}", array.len()).into());
    }
    let mut shape = (0..rank).map(|_| cursor.number(width)).collect::<ParseResult<Vec<u64>>>()?;
    let size = shape.pop().unwrap_or(0);
    if size != element as u64 {
        return Err(format!("chunks of elements of {size} bytes, where they have {element}").into());
    }
    let bytes = shape.iter().try_fold(size, |product, &n| product.checked_mul(n).filter(|&bytes| bytes > 0));
    if bytes.is_none_or(|bytes| bytes > u64::MAX / 4) {
        return Err("the shape of its chunks is impossible".into());
    }
    Ok(shape)
}

/// Shape of the blocks in which elements are read that lie one after another: rows, or slices where they are small.
pub(super) fn row_block(shape: &[u64], element: usize) -> Vec<u64> {
    let mut block = vec![1; shape.len()];
    let mut bytes = element as u64;
    for (at, (&length, block)) in shape.iter().zip(&mut block).rev().take(2).enumerate() {
        bytes = bytes.saturating_mul(length);
        if at > 0 && bytes > SLICE_BYTES {
            break;
        }
        *block = length.max(1);
    }
    block
}
