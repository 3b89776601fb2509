//! Filters through which chunks pass when they are written (section IV.A.2.l), and their reversal.

mod fletcher32;
mod lz4_blocks;
mod lzf;

use super::super::container::{FieldCursor, ParseResult, text_before_zero};
use crate::reading::chunk_codecs::{decode_blosc, decode_bzip2, decode_zlib, decode_zstd, unshuffle};
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::{LoadControl, LoadError};

/// Maximum number of filters of an array: each has a bit of a mask.
const MAX_FILTERS: u8 = 32;

/// Bytes that a filter may add to a chunk: a checksum.
const ADDED_BYTES: usize = 64;

/// Failure of a filter.
#[derive(Debug)]
pub(crate) enum FilterFault {
    /// The bytes are not what the filter writes.
    Broken(String),
    /// The load was cancelled.
    Stopped(LoadError),
}

impl From<String> for FilterFault {
    fn from(why: String) -> Self {
        Self::Broken(why)
    }
}

/// Kinds of filters, by their registered numbers (<https://github.com/HDFGroup/hdf5_plugins>).
#[derive(Debug, Clone, PartialEq, Eq)]
enum FilterKind {
    Deflate,
    Shuffle,
    Fletcher32,
    Lzf,
    Blosc,
    Lz4,
    Zstd,
    Bzip2,
    /// Filter that is not supported, by its name.
    Other(String),
}

impl FilterKind {
    fn from_number(number: u64, name: &str) -> Self {
        let known = match number {
            1 => return Self::Deflate,
            2 => return Self::Shuffle,
            3 => return Self::Fletcher32,
            307 => return Self::Bzip2,
            32000 => return Self::Lzf,
            32001 => return Self::Blosc,
            32004 => return Self::Lz4,
            32015 => return Self::Zstd,
            4 => "szip",
            5 => "n-bit",
            6 => "scale-offset",
            32008 => "bitshuffle",
            32013 => "ZFP",
            32026 => "Blosc2",
            _ => return Self::Other(format!("{number} {}", sanitised(name, 40)).trim_end().to_owned()),
        };
        Self::Other(known.to_owned())
    }
}

/// Filter with its parameters.
#[derive(Debug, Clone, PartialEq, Eq)]
struct ChunkFilter {
    kind: FilterKind,
    parameters: Vec<u32>,
}

/// Filters of an array, in the order in which chunks pass them when they are written.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct FilterPipeline {
    filters: Vec<ChunkFilter>,
}

impl FilterPipeline {
    /// Parses the message of an array.
    pub(crate) fn parse(cursor: &mut FieldCursor<'_>) -> ParseResult<Self> {
        let (version, count) = (cursor.byte()?, cursor.byte()?);
        if !(1..=2).contains(&version) || count > MAX_FILTERS {
            return Err(format!("version {version} of {count} filters is not supported").into());
        }
        let is_old = version == 1;
        cursor.take(if is_old { 6 } else { 0 })?;
        let mut filters = Vec::new();
        for _ in 0..count {
            let number = cursor.number(2)?;
            let name = if is_old || number >= 256 { cursor.number(2)? as usize } else { 0 };
            cursor.take(2)?;
            let parameters = cursor.number(2)? as usize;
            let name = cursor.take(if is_old { name.next_multiple_of(8) } else { name })?;
            let kind = FilterKind::from_number(number, &text_before_zero(name));
            let values =
                (0..parameters).map(|_| Ok(cursor.number(4)? as u32)).collect::<ParseResult<Vec<u32>>>()?;
            cursor.take(if is_old && parameters % 2 == 1 { 4 } else { 0 })?;
            filters.push(ChunkFilter { kind, parameters: values });
        }
        Ok(Self { filters })
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.filters.is_empty()
    }

    /// Reason why chunks cannot be read, with what helps.
    pub(crate) fn refusal(&self) -> Option<(String, String)> {
        self.filters.iter().find_map(|filter| match &filter.kind {
            FilterKind::Other(name) => Some((
                format!("it is compressed by the filter {name}, which is not supported"),
                "write it without filters: h5repack -f NONE IN OUT".to_owned(),
            )),
            _ => None,
        })
    }

    /// Reverses the filters of a chunk that has `expected` bytes without them; the bits of `skipped` are filters that
    /// it did not pass.
    pub(crate) fn decode(
        &self,
        mut bytes: Vec<u8>,
        expected: usize,
        skipped: u32,
        control: &LoadControl,
    ) -> Result<Vec<u8>, FilterFault> {
        let limit = expected.saturating_add(ADDED_BYTES);
        for (at, filter) in self.filters.iter().enumerate().rev() {
            if skipped >> at & 1 != 0 {
                continue;
            }
            control.check().map_err(FilterFault::Stopped)?;
            bytes = match &filter.kind {
                FilterKind::Deflate => decode_zlib(&bytes, limit)?,
                FilterKind::Shuffle => {
                    unshuffle(&bytes, filter.parameters.first().map_or(1, |&size| size as usize))
                }
                FilterKind::Fletcher32 => fletcher32::verified(bytes)?,
                FilterKind::Lzf => lzf::decode(&bytes, limit)?,
                FilterKind::Blosc => decode_blosc(&bytes, limit)?,
                FilterKind::Lz4 => lz4_blocks::decode(&bytes, limit)?,
                FilterKind::Zstd => decode_zstd(&bytes, limit)?,
                FilterKind::Bzip2 => decode_bzip2(&bytes, limit)?,
                FilterKind::Other(name) => return Err(format!("the filter {name} is not supported").into()),
            };
        }
        if bytes.len() < expected {
            return Err(format!("{expected} bytes were expected, {} found", bytes.len()).into());
        }
        Ok(bytes)
    }
}
