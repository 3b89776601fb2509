//! Arrays of Zarr: their metadata in versions 2 and 3, codecs, shards, and reading of boxes.

mod chunk_reader;
mod codec_pipeline;
mod data_type;
mod fields;
mod sharding;
mod v2;
mod v3;

use serde_json::Value;

use super::number::{FileNumberType, VoxelEncoding};
use super::samples::ReadFault;
use super::store::{ByteRange, Store, StoreError, join};
use super::{Endian, LoadError};
use chiaroscuro_volume::LoadContext;
use codec_pipeline::CodecPipeline;
use sharding::Sharding;

pub(super) use chunk_reader::{ArrayBox, SlabReader};

/// Maximum length of a document of metadata, in bytes; consolidated ones of whole screens have a few MiB.
const MAX_DOCUMENT_BYTES: u64 = 16 << 20;

/// Maximum number of dimensions of an array.
const MAX_DIMENSIONS: usize = 32;

/// Group or array of a hierarchy.
#[derive(Debug)]
pub(super) enum ZarrNode {
    /// Group, with its attributes.
    Group(Value),
    /// Array with its metadata.
    Array(Box<ZarrArray>),
}

impl ZarrNode {
    /// Attributes of the user.
    pub(super) fn attributes(&self) -> &Value {
        match self {
            Self::Group(attributes) => attributes,
            Self::Array(array) => &array.attributes,
        }
    }

    /// Reads the node at a path of the hierarchy; `None` if there is none.
    ///
    /// # Errors
    /// `BadInput` for metadata that are broken, or of an array that is not supported.
    pub(super) fn read(
        context: LoadContext<'_>,
        store: &dyn Store,
        path: &str,
    ) -> Result<Option<Self>, LoadError> {
        let document = |name: &str| read_document(context, store, &join(path, name));
        if let Some(metadata) = document("zarr.json")? {
            return v3::parse_node(context, path, &metadata).map(Some);
        }
        let attributes = document(".zattrs")?;
        if let Some(metadata) = document(".zarray")? {
            let attributes = attributes.unwrap_or_default();
            let array = v2::parse_array(context, path, &metadata, attributes)?;
            return Ok(Some(Self::Array(Box::new(array))));
        }
        if attributes.is_some() || document(".zgroup")?.is_some() {
            return Ok(Some(Self::Group(attributes.unwrap_or_default())));
        }
        Ok(None)
    }
}

/// Reads a document of metadata; `None` if there is none.
fn read_document(context: LoadContext<'_>, store: &dyn Store, key: &str) -> Result<Option<Value>, LoadError> {
    let read = store.read(key, ByteRange::AtMost(MAX_DOCUMENT_BYTES));
    let Some(bytes) = read.map_err(|error| error.into_load_error(context, key))? else { return Ok(None) };
    serde_json::from_slice(&bytes).map(Some).map_err(|error| {
        context.bad_input_error(
            key,
            format!("it is no valid JSON: {error}"),
            "copy or write the folder again",
        )
    })
}

/// Names of chunks' values below their array.
#[derive(Debug, Clone, PartialEq, Eq)]
struct ChunkKeys {
    /// True for keys that begin with `c`, as in version 3.
    has_prefix: bool,
    /// Character between the indices of a chunk.
    separator: char,
}

impl ChunkKeys {
    fn key(&self, array: &str, chunk: &[u64]) -> String {
        let mut parts: Vec<String> = self.has_prefix.then(|| "c".to_owned()).into_iter().collect();
        parts.extend(chunk.iter().map(u64::to_string));
        if parts.is_empty() {
            parts.push("0".to_owned());
        }
        join(array, &parts.join(&self.separator.to_string()))
    }
}

/// Array of a hierarchy, by its metadata.
#[derive(Debug)]
pub(super) struct ZarrArray {
    path: String,
    /// Lengths of the axes, slowest first.
    pub(super) shape: Vec<u64>,
    /// Lengths of the chunks that are decoded one by one: within shards, where there are shards.
    chunk_shape: Vec<u64>,
    number: FileNumberType,
    /// One element of the fill value, in the byte order of the chunks.
    fill: Vec<u8>,
    pipeline: CodecPipeline,
    sharding: Option<Sharding>,
    keys: ChunkKeys,
    /// Names of the axes, where the array has any.
    pub(super) axis_names: Vec<Option<String>>,
    pub(super) attributes: Value,
}

impl ZarrArray {
    /// Storage of the elements of decoded chunks.
    pub(super) fn encoding(&self) -> VoxelEncoding {
        VoxelEncoding::scalar(self.number, self.pipeline.endian)
    }

    /// Bytes of a decoded chunk, saturated.
    fn chunk_bytes(&self) -> u64 {
        self.chunk_shape.iter().fold(self.number.bytes() as u64, |bytes, &n| bytes.saturating_mul(n))
    }
}
