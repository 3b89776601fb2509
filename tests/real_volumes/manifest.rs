//! Parser of `MANIFEST.tsv`, which describes the test data.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

/// Facts about a file in the manifest; `None` where it states nothing.
#[derive(Debug, Default)]
pub(crate) struct ManifestEntry {
    pub(crate) dims: Option<[usize; 3]>,
    pub(crate) voxel_type: Option<String>,
    pub(crate) spacing_mm: Option<[f64; 3]>,
}

/// Facts of all files, by path.
pub(crate) fn read_manifest(folder: &Path) -> HashMap<String, ManifestEntry> {
    let text = fs::read_to_string(folder.join("MANIFEST.tsv")).expect("the manifest is text");
    text.lines()
        .skip(1)
        .map(|line| {
            let columns: Vec<_> = line.split('\t').collect();
            let column = |index: usize| columns.get(index).copied().unwrap_or_default();
            let facts = ManifestEntry {
                dims: parse_dims(column(1)),
                voxel_type: parse_voxel_type(column(2)),
                spacing_mm: parse_spacing(column(3)),
            };
            (column(0).to_owned(), facts)
        })
        .collect()
}

/// Parses dimensions such as `256x256x108`; a picture has one slice.
fn parse_dims(text: &str) -> Option<[usize; 3]> {
    let numbers: Option<Vec<usize>> = text.split('x').map(|number| number.parse().ok()).collect();
    match numbers?[..] {
        [x, y] => Some([x, y, 1]),
        [x, y, z] => Some([x, y, z]),
        _ => None,
    }
}

/// Parses a voxel type such as `int16` or `16-bit signed integer`.
fn parse_voxel_type(text: &str) -> Option<String> {
    let bits = || text.split('-').next().unwrap_or_default();
    if text.ends_with("unsigned integer") {
        Some(format!("uint{}", bits()))
    } else if text.ends_with("signed integer") {
        Some(format!("int{}", bits()))
    } else {
        (!text.is_empty()).then(|| text.to_owned())
    }
}

/// Parses a spacing such as `0.957x0.957x1.5`, `(1.0, 1.0, 1.4) …` or `0.0156 iso …`.
fn parse_spacing(text: &str) -> Option<[f64; 3]> {
    if let Some((edge, _)) = text.split_once(" iso") {
        return edge.parse().ok().map(|edge| [edge; 3]);
    }
    let list = text.strip_prefix('(').map_or(text, |rest| rest.split(')').next().unwrap_or_default());
    let numbers: Option<Vec<f64>> = list.split(['x', ',']).map(|number| number.trim().parse().ok()).collect();
    numbers?.try_into().ok()
}

pub(crate) fn the_manifest_is_understood() {
    assert_eq!(parse_dims("256x256x108"), Some([256, 256, 108]));
    assert_eq!(parse_dims("3x9"), Some([3, 9, 1]));
    assert_eq!(parse_dims(""), None);
    assert_eq!(parse_voxel_type("16-bit unsigned integer").as_deref(), Some("uint16"));
    assert_eq!(parse_voxel_type("8-bit signed integer").as_deref(), Some("int8"));
    assert_eq!(parse_voxel_type("int16").as_deref(), Some("int16"));
    assert_eq!(parse_voxel_type(""), None);
    assert_eq!(parse_spacing("0.957x0.957x1.5"), Some([0.957, 0.957, 1.5]));
    assert_eq!(parse_spacing("(1.0, 1.0, 1.4) dirdev=0.000"), Some([1.0, 1.0, 1.4]));
    assert_eq!(parse_spacing("0.0156 iso (1x1x1 ratio)"), Some([0.0156; 3]));
    assert_eq!(parse_spacing(""), None);
}
