//! Metadata of version 3: <https://zarr-specs.readthedocs.io/en/latest/v3/core/index.html>.

use serde_json::Value;

use super::super::store::join;
use super::codec_pipeline::{ByteCodec, CodecPipeline, SUPPORTED_CODECS};
use super::data_type::{ElementType, SUPPORTED_TYPES};
use super::fields::{HELP, MetadataDocument};
use super::sharding::{IndexPlace, Sharding};
use super::{ChunkKeys, Endian, FileNumberType, LoadError, ZarrArray, ZarrNode};
use chiaroscuro_volume::LoadContext;

/// Parses the metadata of a group or an array.
pub(super) fn parse_node(
    context: LoadContext<'_>,
    path: &str,
    metadata: &Value,
) -> Result<ZarrNode, LoadError> {
    let key = join(path, "zarr.json");
    let document = MetadataDocument { context, key: &key, value: metadata };
    if metadata["zarr_format"].as_u64() != Some(3) {
        let why = format!("3 was expected, {} was found", MetadataDocument::text(&metadata["zarr_format"]));
        return Err(document.error("zarr_format", why, HELP));
    }
    match metadata["node_type"].as_str() {
        Some("group") => Ok(ZarrNode::Group(metadata["attributes"].clone())),
        Some("array") => parse_array(document, path).map(|array| ZarrNode::Array(Box::new(array))),
        _ => {
            let found = MetadataDocument::text(&metadata["node_type"]);
            Err(document.error(
                "node_type",
                format!("\"group\" or \"array\" was expected, {found} was found"),
                HELP,
            ))
        }
    }
}

fn parse_array(document: MetadataDocument<'_>, path: &str) -> Result<ZarrArray, LoadError> {
    let metadata = document.value;
    let shape = document.lengths("shape", &metadata["shape"], None, 0)?;
    let grid = &metadata["chunk_grid"];
    if grid["name"].as_str() != Some("regular") {
        let what = format!("the chunk grid {}", MetadataDocument::text(&grid["name"]));
        return Err(document.unsupported("chunk_grid", &what, "regular ones"));
    }
    let field = "chunk_grid.configuration.chunk_shape";
    let outer_shape = document.lengths(field, &grid["configuration"]["chunk_shape"], Some(shape.len()), 1)?;
    let name = &metadata["data_type"];
    let element = name.as_str().and_then(ElementType::parse_name).ok_or_else(|| {
        let what = format!("the type {}", MetadataDocument::text(name));
        document.unsupported("data_type", &what, SUPPORTED_TYPES)
    })?;
    let codecs = CodecList { document, number: element.number, axes: shape.len() };
    let (pipeline, sharding) = codecs.parse("codecs", &metadata["codecs"], &outer_shape)?;
    let fill = document.fill_value(element.number, pipeline.endian)?;
    let encoding = &metadata["chunk_key_encoding"];
    let separator = encoding["configuration"]["separator"].as_str().and_then(|text| text.chars().next());
    let keys = match encoding["name"].as_str() {
        Some("v2") => ChunkKeys { has_prefix: false, separator: separator.unwrap_or('.') },
        _ => ChunkKeys { has_prefix: true, separator: separator.unwrap_or('/') },
    };
    let names = metadata["dimension_names"].as_array().into_iter().flatten();
    let chunk_shape = sharding.as_ref().map_or(outer_shape, |sharding| sharding.chunk_shape.clone());
    Ok(ZarrArray {
        path: path.to_owned(),
        shape,
        chunk_shape,
        number: element.number,
        fill,
        pipeline,
        sharding,
        keys,
        axis_names: names.map(|name| name.as_str().map(str::to_owned)).collect(),
        attributes: metadata["attributes"].clone(),
    })
}

/// Parser of a list of codecs.
struct CodecList<'a> {
    document: MetadataDocument<'a>,
    number: FileNumberType,
    /// Number of axes of the array.
    axes: usize,
}

impl CodecList<'_> {
    /// Parses the codecs of an array, which may be shards of chunks.
    fn parse(
        &self,
        field: &str,
        list: &Value,
        outer_shape: &[u64],
    ) -> Result<(CodecPipeline, Option<Sharding>), LoadError> {
        let codecs = list.as_array().map(Vec::as_slice).unwrap_or_default();
        let is_sharding = |codec: &Value| codec["name"].as_str() == Some("sharding_indexed");
        if !codecs.iter().any(is_sharding) {
            return Ok((self.pipeline(field, codecs)?, None));
        }
        let [only] = codecs else {
            return Err(self.document.unsupported(
                field,
                "another codec beside sharding_indexed",
                "shards alone",
            ));
        };
        let configuration = &only["configuration"];
        let at = |name: &str| format!("{field}.sharding_indexed.{name}");
        let chunk_shape =
            self.document.lengths(&at("chunk_shape"), &configuration["chunk_shape"], Some(self.axes), 1)?;
        if outer_shape.iter().zip(&chunk_shape).any(|(outer, inner)| !outer.is_multiple_of(*inner)) {
            let why = format!("chunks of {chunk_shape:?} do not divide shards of {outer_shape:?}");
            return Err(self.document.error(&at("chunk_shape"), why, HELP));
        }
        let inner = configuration["codecs"].as_array().map(Vec::as_slice).unwrap_or_default();
        if inner.iter().any(is_sharding) {
            return Err(self.document.unsupported(field, "a shard within a shard", "shards of chunks"));
        }
        let pipeline = self.pipeline(&at("codecs"), inner)?;
        let index = configuration["index_codecs"].as_array().map(Vec::as_slice).unwrap_or_default();
        let index = self.pipeline(&at("index_codecs"), index)?;
        if index.byte_codecs.iter().any(|codec| *codec != ByteCodec::Crc32c) || index.byte_codecs.len() > 1 {
            return Err(self.document.unsupported(
                &at("index_codecs"),
                "a compressed index",
                "bytes and crc32c",
            ));
        }
        let place = match configuration["index_location"].as_str() {
            Some("start") => IndexPlace::Start,
            _ => IndexPlace::End,
        };
        let shards = outer_shape.iter().zip(&chunk_shape).map(|(outer, inner)| outer / inner).collect();
        Ok((pipeline, Some(Sharding { chunk_shape, chunks_per_shard: shards, index, place })))
    }

    /// Parses codecs of a single chunk.
    fn pipeline(&self, field: &str, codecs: &[Value]) -> Result<CodecPipeline, LoadError> {
        let mut parsed =
            CodecPipeline { axis_order: Vec::new(), endian: Endian::Little, byte_codecs: Vec::new() };
        for codec in codecs {
            // A codec without a configuration may be its name alone.
            let name = codec["name"].as_str().or_else(|| codec.as_str()).unwrap_or_default();
            let configuration = &codec["configuration"];
            match name {
                "bytes" | "endian" => {
                    if configuration["endian"].as_str() == Some("big") {
                        parsed.endian = Endian::Big;
                    }
                }
                "transpose" => {
                    let order = self.axis_order(field, &configuration["order"])?;
                    parsed.axis_order = match parsed.axis_order.as_slice() {
                        [] => order,
                        before => order.iter().map(|&axis| before[axis]).collect(),
                    };
                }
                _ => {
                    let size =
                        configuration["elementsize"].as_u64().and_then(|size| usize::try_from(size).ok());
                    let size = size.unwrap_or_else(|| self.number.bytes()).clamp(1, 1 << 10);
                    let codec = ByteCodec::parse(name, size).ok_or_else(|| {
                        let what = format!("the codec {}", MetadataDocument::text(&codec["name"]));
                        self.document.unsupported(field, &what, SUPPORTED_CODECS)
                    })?;
                    parsed.byte_codecs.push(codec);
                }
            }
        }
        Ok(parsed)
    }

    /// Parses the order of a transposition: each axis once, or "C" and "F" of early versions.
    fn axis_order(&self, field: &str, order: &Value) -> Result<Vec<usize>, LoadError> {
        let listed = match order.as_str() {
            Some("C") => Some((0..self.axes).collect()),
            Some("F") => Some((0..self.axes).rev().collect()),
            _ => order.as_array().map(|list| {
                list.iter().filter_map(|axis| usize::try_from(axis.as_u64()?).ok()).collect::<Vec<usize>>()
            }),
        };
        let is_order =
            |list: &Vec<usize>| list.len() == self.axes && (0..self.axes).all(|axis| list.contains(&axis));
        listed.filter(is_order).ok_or_else(|| {
            let found = MetadataDocument::text(order);
            let why =
                format!("the axes 0 to {} were expected, {found} was found", self.axes.saturating_sub(1));
            self.document.error(&format!("{field}.transpose.order"), why, HELP)
        })
    }
}
