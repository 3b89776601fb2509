//! Metadata of version 2: <https://zarr-specs.readthedocs.io/en/latest/v2/v2.0.html>.

use serde_json::Value;

use super::super::store::join;
use super::codec_pipeline::{ByteCodec, CodecPipeline, SUPPORTED_CODECS};
use super::data_type::{ElementType, SUPPORTED_TYPES};
use super::fields::MetadataDocument;
use super::{ChunkKeys, Endian, LoadError, ZarrArray};
use chiaroscuro_volume::LoadContext;

/// Parses the metadata of an array.
pub(super) fn parse_array(
    context: LoadContext<'_>,
    path: &str,
    metadata: &Value,
    attributes: Value,
) -> Result<ZarrArray, LoadError> {
    let key = join(path, ".zarray");
    let document = MetadataDocument { context, key: &key, value: metadata };
    let shape = document.lengths("shape", &metadata["shape"], None, 0)?;
    let chunk_shape = document.lengths("chunks", &metadata["chunks"], Some(shape.len()), 1)?;
    let code = &metadata["dtype"];
    let element = code.as_str().and_then(ElementType::parse_numpy).ok_or_else(|| {
        let what = format!("the type {}", MetadataDocument::text(code));
        document.unsupported("dtype", &what, SUPPORTED_TYPES)
    })?;
    let endian = element.endian.unwrap_or(Endian::Little);
    let axis_order = match metadata["order"].as_str() {
        Some("F") => (0..shape.len()).rev().collect(),
        _ => Vec::new(),
    };
    let filters = metadata["filters"].as_array().into_iter().flatten();
    let compressor = Some(&metadata["compressor"]).filter(|compressor| !compressor.is_null());
    let mut byte_codecs = Vec::new();
    for codec in filters.chain(compressor) {
        let size = codec["elementsize"].as_u64().and_then(|size| usize::try_from(size).ok());
        let size = size.unwrap_or_else(|| element.number.bytes()).clamp(1, 1 << 10);
        let parsed = codec["id"].as_str().and_then(|id| ByteCodec::parse(id, size));
        byte_codecs.push(parsed.ok_or_else(|| {
            let what = format!("the codec {}", MetadataDocument::text(&codec["id"]));
            document.unsupported("compressor", &what, SUPPORTED_CODECS)
        })?);
    }
    let fill = document.fill_value(element.number, endian)?;
    let separator = metadata["dimension_separator"].as_str().and_then(|text| text.chars().next());
    let names = attributes["_ARRAY_DIMENSIONS"].as_array().cloned().unwrap_or_default();
    Ok(ZarrArray {
        path: path.to_owned(),
        shape,
        chunk_shape,
        number: element.number,
        fill,
        pipeline: CodecPipeline { axis_order, endian, byte_codecs },
        sharding: None,
        keys: ChunkKeys { has_prefix: false, separator: separator.unwrap_or('.') },
        axis_names: names.iter().map(|name| name.as_str().map(str::to_owned)).collect(),
        attributes,
    })
}
