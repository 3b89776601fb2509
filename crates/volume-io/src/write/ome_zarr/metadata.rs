//! Documents of metadata: of the group, which describes the image, and of its arrays.

use serde_json::{Value, json};

use super::PyramidSpec;
use super::level_writer::ShardGrid;
use super::pyramid_levels::LevelGrid;
use chiaroscuro_files::provenance_mark;
use chiaroscuro_volume::{FileLabelTable, SpacingUnit, VoxelType};

/// Version of OME-Zarr.
pub(super) const OME_VERSION: &str = "0.5";

/// Level of compression that is stated; decoders do not need it.
const ZSTANDARD_LEVEL: i32 = 1;

/// Returns numbers along z, y and x, the order of the array's axes.
fn slowest_first<T: Copy>([x, y, z]: [T; 3]) -> [T; 3] {
    [z, y, x]
}

/// Encodes the document of the group, with the attributes of the image and the program mark.
pub(super) fn group_document(spec: &PyramidSpec, levels: &[LevelGrid]) -> Vec<u8> {
    let axis = |name: &str| match spec.unit.map(unit_name) {
        Some(unit) => json!({"name": name, "type": "space", "unit": unit}),
        None => json!({"name": name, "type": "space"}),
    };
    let axes = ["z", "y", "x"].map(axis);
    let dataset = |(number, level): (usize, &LevelGrid)| {
        json!({"path": number.to_string(), "coordinateTransformations": [
            {"type": "scale", "scale": slowest_first(level.spacing)},
            {"type": "translation", "translation": slowest_first(level.translation)},
        ]})
    };
    let datasets: Vec<Value> = levels.iter().enumerate().map(dataset).collect();
    let mut ome = json!({"version": OME_VERSION, "multiscales": [{
        "name": spec.name,
        "axes": axes,
        "datasets": datasets,
        "type": if spec.has_label_numbers { "mode" } else { "mean" },
    }]});
    if let Some(labels) = &spec.labels {
        ome["image-label"] = image_label(labels);
    }
    let attributes = json!({"ome": ome, "chiaroscuro": provenance_mark()});
    encode(&json!({"zarr_format": 3, "node_type": "group", "attributes": attributes}))
}

/// Encodes the document of the array of a level.
pub(super) fn array_document(spec: &PyramidSpec, grid: &ShardGrid) -> Vec<u8> {
    let bytes_codec = match spec.voxel_type.bytes() {
        1 => json!({"name": "bytes"}),
        _ => json!({"name": "bytes", "configuration": {"endian": "little"}}),
    };
    let zstd = json!({"name": "zstd", "configuration": {"level": ZSTANDARD_LEVEL, "checksum": false}});
    let index = [json!({"name": "bytes", "configuration": {"endian": "little"}}), json!({"name": "crc32c"})];
    let sharding = json!({"name": "sharding_indexed", "configuration": {
        "chunk_shape": slowest_first(grid.chunk),
        "codecs": [bytes_codec, zstd],
        "index_codecs": index,
        "index_location": "end",
    }});
    encode(&json!({
        "zarr_format": 3,
        "node_type": "array",
        "shape": slowest_first(grid.dims),
        "data_type": spec.voxel_type.name(),
        "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": slowest_first(grid.shard())}},
        "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}},
        "fill_value": fill_value(spec),
        "codecs": [sharding],
        "dimension_names": ["z", "y", "x"],
        "attributes": {},
    }))
}

fn encode(document: &Value) -> Vec<u8> {
    // Numbers and texts always have a form in JSON.
    format!("{document:#}\n").into_bytes()
}

/// Name of a unit in the metadata.
fn unit_name(unit: SpacingUnit) -> &'static str {
    match unit {
        SpacingUnit::Nm => "nanometer",
        SpacingUnit::Um => "micrometer",
        SpacingUnit::Mm | SpacingUnit::Voxels => "millimeter",
        SpacingUnit::Cm => "centimeter",
        SpacingUnit::M => "meter",
    }
}

/// Number of voxels of which nothing is stored.
fn fill_value(spec: &PyramidSpec) -> Value {
    let value = spec.padding.unwrap_or(0.0);
    match spec.voxel_type {
        VoxelType::F32 | VoxelType::F64 if value.is_nan() => json!("NaN"),
        VoxelType::F32 | VoxelType::F64 if value.is_infinite() => {
            json!(if value > 0.0 { "Infinity" } else { "-Infinity" })
        }
        VoxelType::F32 => json!(f64::from(value as f32)),
        VoxelType::F64 => json!(value),
        _ => json!(value as i64),
    }
}

/// Returns the names and colours of labels.
fn image_label(labels: &FileLabelTable) -> Value {
    let color = |(number, label): (i64, &chiaroscuro_volume::FileLabel)| {
        let [red, green, blue] = label.color?.map(|part| (255.0 * part).round() as u8);
        Some(json!({"label-value": number, "rgba": [red, green, blue, 255]}))
    };
    let colors: Vec<Value> = labels.iter().filter_map(color).collect();
    let named = labels.iter().filter(|(_, label)| !label.name.is_empty() || label.color.is_none());
    let properties: Vec<Value> =
        named.map(|(number, label)| json!({"label-value": number, "name": label.name})).collect();
    let mut described = json!({});
    if !colors.is_empty() {
        described["colors"] = colors.into();
    }
    if !properties.is_empty() {
        described["properties"] = properties.into();
    }
    described
}
