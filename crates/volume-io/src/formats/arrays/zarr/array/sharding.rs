//! Shards: several chunks in one value, with an index of their places.
//!
//! After <https://zarr-specs.readthedocs.io/en/latest/v3/codecs/sharding-indexed/index.html>.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::codec_pipeline::CodecPipeline;
use super::{ByteRange, Endian, Store, StoreError};

/// Place of a shard's index.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum IndexPlace {
    Start,
    End,
}

/// Layout of shards.
#[derive(Debug)]
pub(super) struct Sharding {
    /// Lengths of a chunk within a shard.
    pub(super) chunk_shape: Vec<u64>,
    /// Number of chunks of a shard along each axis.
    pub(super) chunks_per_shard: Vec<u64>,
    /// Codecs of the index.
    pub(super) index: CodecPipeline,
    pub(super) place: IndexPlace,
}

/// Mark of a chunk that a shard does not hold, in place of its offset and its length.
const ABSENT: u64 = u64::MAX;

/// Maximum length of an index, in bytes: four million chunks.
const MAX_INDEX_BYTES: u64 = 64 << 20;

/// Offset and length of each chunk of a shard.
type ShardIndex = Vec<[u64; 2]>;

/// Indices of the shards that were read until now; `None` for those that the store does not hold.
#[derive(Debug, Default)]
pub(super) struct ShardIndices(Mutex<HashMap<String, Option<Arc<ShardIndex>>>>);

impl Sharding {
    /// Indices of the shard of a chunk, and the chunk's number within it.
    pub(super) fn locate(&self, chunk: &[u64]) -> (Vec<u64>, u64) {
        let shard = chunk.iter().zip(&self.chunks_per_shard).map(|(index, count)| index / count).collect();
        let within = chunk.iter().zip(&self.chunks_per_shard);
        (shard, within.fold(0, |number, (index, count)| number.saturating_mul(*count) + index % count))
    }

    /// Returns the place of a chunk in a shard; `None` where the store does not hold it.
    pub(super) fn chunk_range(
        &self,
        store: &dyn Store,
        indices: &ShardIndices,
        key: &str,
        number: u64,
    ) -> Result<Option<ByteRange>, StoreError> {
        let known = indices.0.lock().unwrap_or_else(PoisonError::into_inner).get(key).cloned();
        let index = if let Some(index) = known {
            index
        } else {
            let index = self.read_index(store, key)?.map(Arc::new);
            indices.0.lock().unwrap_or_else(PoisonError::into_inner).insert(key.to_owned(), index.clone());
            index
        };
        let place = index.and_then(|index| index.get(usize::try_from(number).ok()?).copied());
        Ok(place.filter(|place| *place != [ABSENT; 2]).map(|[at, length]| ByteRange::From(at, length)))
    }

    fn read_index(&self, store: &dyn Store, key: &str) -> Result<Option<ShardIndex>, StoreError> {
        let chunks = self.chunks_per_shard.iter().fold(1u64, |all, &count| all.saturating_mul(count));
        let bytes = chunks.saturating_mul(16);
        let stored = bytes.saturating_add(4 * self.index.byte_codecs.len() as u64);
        if stored > MAX_INDEX_BYTES {
            let why = format!(
                "a shard of {chunks} chunks has an index of {stored} bytes, {MAX_INDEX_BYTES} are allowed"
            );
            return Err(StoreError::Unusable(why, "write the array with smaller shards"));
        }
        let range = match self.place {
            IndexPlace::Start => ByteRange::From(0, stored),
            IndexPlace::End => ByteRange::Last(stored),
        };
        let Some(index) = store.read(key, range)? else { return Ok(None) };
        let index = self.index.decode(index, bytes as usize).map_err(|why| {
            StoreError::Unusable(
                format!("the index of the shard is broken: {why}"),
                "copy or download the file again",
            )
        })?;
        let (numbers, _) = index.as_chunks::<8>();
        let number = |bytes: &[u8; 8]| match self.index.endian {
            Endian::Little => u64::from_le_bytes(*bytes),
            Endian::Big => u64::from_be_bytes(*bytes),
        };
        let (pairs, _) = numbers.as_chunks::<2>();
        Ok(Some(pairs.iter().map(|[at, length]| [number(at), number(length)]).collect()))
    }
}
