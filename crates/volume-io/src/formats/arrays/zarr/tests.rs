//! Tests on small stores, whose chunks are not compressed.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use tempfile::TempDir;

use super::*;
use crate::tests::helpers::{assert_refused, load_path};
use chiaroscuro_volume::{LoadErrorKind, Portion, Samples, VolumeChoice};

/// Folder with a hierarchy.
struct TestStore {
    _folder: TempDir,
    root: PathBuf,
}

impl TestStore {
    fn new() -> Self {
        let folder = TempDir::new().unwrap();
        let root = folder.path().join("scan.ome.zarr");
        fs::create_dir(&root).unwrap();
        Self { _folder: folder, root }
    }

    fn write(&self, key: &str, bytes: &[u8]) {
        let path = self.root.join(key);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }

    fn write_json(&self, key: &str, value: &Value) {
        self.write(key, value.to_string().as_bytes());
    }

    /// Writes an array of bytes of version 2, whose element is a hash of its place.
    fn array(&self, path: &str, shape: &[usize], chunks: &[usize]) {
        let metadata = json!({"zarr_format": 2, "shape": shape, "chunks": chunks, "dtype": "|u1", "order": "C",
            "compressor": null, "filters": null, "fill_value": 9, "dimension_separator": "/"});
        self.write_json(&join(path, ".zarray"), &metadata);
        let counts: Vec<usize> = shape.iter().zip(chunks).map(|(n, edge)| n.div_ceil(*edge)).collect();
        for chunk in places(&counts) {
            let element = |within: &Vec<usize>| {
                let place: Vec<usize> = chunk
                    .iter()
                    .zip(chunks)
                    .zip(within)
                    .map(|((chunk, edge), at)| chunk * edge + at)
                    .collect();
                value(&place)
            };
            let bytes: Vec<u8> = places(chunks).iter().map(element).collect();
            let name: Vec<String> = chunk.iter().map(usize::to_string).collect();
            self.write(&join(path, &name.join("/")), &bytes);
        }
    }

    fn load(&self, choice: VolumeChoice) -> Result<Volume, LoadError> {
        load_path(&self.root, choice)
    }
}

/// All places in a box, the last axis fastest.
fn places(lengths: &[usize]) -> Vec<Vec<usize>> {
    lengths.iter().fold(vec![Vec::new()], |all, &length| {
        all.iter().flat_map(|place| (0..length).map(|at| [&place[..], &[at]].concat())).collect()
    })
}

/// Element at a place of an array.
fn value(place: &[usize]) -> u8 {
    place.iter().fold(17usize, |sum, at| sum * 31 + at) as u8
}

/// Elements of a box of the last three axes, at fixed indices of those before.
fn expected(before: &[usize], z: Range, y: Range, x: Range) -> Samples {
    let mut all = Vec::new();
    for z in z {
        for y in y.clone() {
            all.extend(x.clone().map(|x| value(&[before, &[z, y, x]].concat())));
        }
    }
    Samples::U8(all)
}

type Range = std::ops::Range<usize>;

fn nothing() -> VolumeChoice {
    VolumeChoice::default()
}

/// Axes of an image in micrometres.
fn axes(names: &str) -> Value {
    let axis = |name: char| match name {
        't' => json!({"name": "t", "type": "time"}),
        'c' => json!({"name": "c", "type": "channel"}),
        _ => json!({"name": name.to_string(), "type": "space", "unit": "micrometer"}),
    };
    names.chars().map(axis).collect()
}

/// Image of two channels, two time steps and two levels.
fn image() -> TestStore {
    let store = TestStore::new();
    store.array("0", &[2, 2, 5, 6, 7], &[1, 1, 2, 4, 3]);
    store.array("1", &[2, 2, 3, 3, 4], &[1, 2, 3, 3, 4]);
    let scale = |factor: f64| {
        json!([{"type": "scale", "scale": [1.0, 1.0, 2.0 * factor, 0.5 * factor, 0.25 * factor]},
        {"type": "translation", "translation": [0.0, 0.0, factor, 0.0, 3.0]}])
    };
    store.write_json(".zattrs", &json!({"multiscales": [{"name": "cells", "axes": axes("tczyx"), "datasets": [
        {"path": "0", "coordinateTransformations": scale(1.0)}, {"path": "1", "coordinateTransformations": scale(2.0)}]}],
        "omero": {"channels": [{"label": "DAPI", "color": "0000FF"}, {"label": "GFP", "color": "00FF00",
            "window": {"start": 3, "end": 40}}]}}));
    store
}

#[test]
fn channels_times_and_levels_are_chosen() {
    let store = image();
    assert_refused(store.load(nothing()), LoadErrorKind::BadInput, &["2 time steps", "--frame"]);
    let choice = VolumeChoice { frame: Some(1), channel: Some(1), ..nothing() };
    let volume = store.load(choice.clone()).unwrap();
    assert_eq!(volume.dims(), [7, 6, 5]);
    assert_eq!(*volume.samples(), expected(&[1, 1], 0..5, 0..6, 0..7));
    let affine = volume.world_from_index();
    let axes = affine.matrix3;
    assert_eq!([axes.x_axis.x, axes.y_axis.y, axes.z_axis.z], [0.25e-3, 0.5e-3, 2e-3]);
    assert_eq!(affine.translation, DVec3::new(3e-3, 0.0, 1e-3));
    assert_eq!((volume.name(), volume.metadata().window), ("scan", Some([3.0, 40.0])));
    let channels = volume.contents().alternatives_in(FileDimension::Channel).unwrap();
    assert_eq!((channels.offers[1].name.as_str(), channels.offers[1].color), ("GFP", Some([0, 255, 0])));
    let levels = volume.contents().alternatives_in(FileDimension::Level).unwrap();
    assert_eq!((levels.selected, levels.offers[1].dims), (0, Some([4, 3, 3])));
    let coarse = store.load(VolumeChoice { level: Some("1".to_owned()), ..choice }).unwrap();
    assert_eq!(*coarse.samples(), expected(&[1, 1], 0..3, 0..3, 0..4));
    assert_eq!(coarse.world_from_index().matrix3.z_axis.z, 4e-3);
}

#[test]
fn a_coarser_level_is_opened_where_the_finest_does_not_fit_and_that_is_said() {
    let store = TestStore::new();
    store.array("0", &[16, 16, 16], &[16, 16, 16]);
    store.array("1", &[8, 8, 8], &[8, 8, 8]);
    store.write_json(
        ".zattrs",
        &json!({"multiscales": [{"axes": axes("zyx"), "datasets": [{"path": "0"}, {"path": "1"}]}]}),
    );
    // The finest has 4096 bytes of voxels.
    let options = LoadOptions { memory_budget_bytes: 4000, ..LoadOptions::default() };
    let volume = crate::load(&store.root, &options, &LoadControl::new()).unwrap();
    assert_eq!((volume.dims(), volume.contents().choice().level.as_deref()), ([8; 3], Some("1")));
    let remarks = volume.remarks().join("; ");
    assert!(remarks.contains("finest level, of 16 x 16 x 16 voxels"), "{remarks}");
    assert!(store.load(nothing()).unwrap().remarks().iter().all(|remark| !remark.contains("coarsely")));
}

#[test]
fn only_chunks_of_the_region_are_read() {
    let store = image();
    // Broken chunks of other levels, channels and places are not noticed.
    for key in ["1/0/0/0/0/0", "0/0/0/0/0/0", "0/1/1/2/0/0", "0/1/1/0/1/0", "0/1/1/0/0/2"] {
        assert!(store.root.join(key).exists());
        store.write(key, b"broken");
    }
    let region = Portion { region: "0:6,0:4,1:4".parse().ok(), ..Portion::default() };
    let choice = VolumeChoice { frame: Some(1), channel: Some(1), portion: Some(region), ..nothing() };
    let volume = store.load(choice.clone()).unwrap();
    assert_eq!(*volume.samples(), expected(&[1, 1], 1..4, 0..4, 0..6));
    let whole = store.load(VolumeChoice { portion: None, ..choice });
    assert_refused(
        whole,
        LoadErrorKind::BadInput,
        &["0/1/1/", "chunk is broken", "6 bytes", "24 were expected"],
    );
}

#[test]
fn every_second_voxel_and_blocks_are_read() {
    let store = TestStore::new();
    store.array("", &[40, 9, 11], &[1, 4, 11]);
    let half = |portion| store.load(VolumeChoice { portion: Some(portion), ..nothing() }).unwrap();
    let Samples::U8(all) = expected(&[], 0..40, 0..9, 0..11) else { panic!("bytes") };
    let every = half(Portion::with_stride(2));
    let picked =
        all.iter().enumerate().filter(|(at, _)| at % 11 % 2 == 0 && at / 11 % 9 % 2 == 0 && at / 99 % 2 == 0);
    assert_eq!(*every.samples(), Samples::U8(picked.map(|(_, value)| *value).collect()));
    assert_eq!(half(Portion::with_block_average(2)).dims(), [6, 5, 20]);
}

#[test]
fn missing_chunks_have_the_fill_value() {
    let store = TestStore::new();
    store.array("", &[4, 4, 4], &[2, 4, 4]);
    fs::remove_file(store.root.join("1/0/0")).unwrap();
    let Samples::U8(found) = store.load(nothing()).unwrap().samples().clone() else { panic!("bytes") };
    assert_eq!(found[32..], [9; 32]);
    assert_eq!(Samples::U8(found[..32].to_vec()), expected(&[], 0..2, 0..4, 0..4));
    fs::remove_dir_all(store.root.join("0")).unwrap();
    let remarks = store.load(nothing()).unwrap().remarks().join("; ");
    assert!(remarks.contains("no chunk"), "{remarks}");
}

#[test]
fn labels_are_offered_beside_their_image() {
    let store = TestStore::new();
    store.array("0", &[3, 4, 5], &[3, 4, 5]);
    store.array("labels/cells/s0", &[3, 4, 5], &[3, 4, 5]);
    let image = |path: &str| json!({"multiscales": [{"axes": axes("zyx"), "datasets": [{"path": path}]}]});
    store.write_json(".zattrs", &image("0"));
    store.write_json("labels/.zattrs", &json!({"labels": ["cells"]}));
    let mut cells = image("s0");
    cells["image-label"] = json!({"colors": [{"label-value": 7, "rgba": [255, 0, 0, 255]}]});
    store.write_json("labels/cells/.zattrs", &cells);
    let volume = store.load(nothing()).unwrap();
    let offers = &volume.contents().alternatives_in(FileDimension::Array).unwrap().offers;
    assert_eq!(offers.iter().map(|offer| offer.key.as_str()).collect::<Vec<_>>(), ["image", "labels/cells"]);
    let labels = store.load(nothing().with_selected(FileDimension::Array, "labels/cells")).unwrap();
    assert_eq!(labels.metadata().labels.get(7).and_then(|label| label.color), Some([1.0, 0.0, 0.0]));
    assert_eq!((labels.metadata().meaning, labels.name()), (ValueMeaning::Labels, "scan labels/cells"));
    assert!(volume.has_unknown_scale(), "no level states its scale");
}

#[test]
fn plates_series_and_groups_offer_their_images() {
    let plain = json!({"multiscales": [{"axes": axes("zyx"), "datasets": [{"path": "0"}]}]});
    let keys = |store: &TestStore| {
        let Err(LoadError::Several { offers, .. }) = store.load(nothing()) else {
            panic!("several are there")
        };
        offers.into_iter().map(|offer| offer.key).collect::<Vec<_>>()
    };
    let store = TestStore::new();
    for path in ["A/1/0", "A/1/1", "B/2/0"] {
        store.array(&join(path, "0"), &[2, 2, 2], &[2, 2, 2]);
        store.write_json(&join(path, ".zattrs"), &plain);
    }
    store.write_json("A/1/.zattrs", &json!({"well": {"images": [{"path": "0"}, {"path": "1"}]}}));
    store.write_json("B/2/.zattrs", &json!({"well": {"images": [{"path": "0"}]}}));
    store.write_json(".zattrs", &json!({"plate": {"wells": [{"path": "A/1"}, {"path": "B/2"}]}}));
    assert_eq!(keys(&store), ["A/1/0", "A/1/1", "B/2/0"]);
    let chosen = nothing().with_selected(FileDimension::Array, "B/2/0");
    assert_eq!(store.load(chosen).unwrap().dims(), [2, 2, 2]);

    store.write_json(".zattrs", &json!({"bioformats2raw.layout": 3}));
    store.write_json("OME/.zattrs", &json!({"series": ["A/1/1", "B/2/0"]}));
    assert_eq!(keys(&store), ["A/1/1", "B/2/0"]);

    let store = TestStore::new();
    store.write_json(".zgroup", &json!({"zarr_format": 2}));
    store.array("ct", &[2, 3, 4], &[2, 3, 4]);
    store.write_json("more/.zgroup", &json!({"zarr_format": 2}));
    store.array("more/pet", &[2, 3, 4], &[2, 3, 4]);
    store.array("names", &[8], &[8]);
    assert_eq!(keys(&store), ["ct", "more/pet"]);
}

#[test]
fn hostile_stores_are_refused() {
    let store = TestStore::new();
    store.array("0", &[2, 2, 2], &[2, 2, 2]);
    let with_path =
        |path: &str| json!({"multiscales": [{"axes": axes("zyx"), "datasets": [{"path": path}]}]});
    for path in ["../0", "/etc", "0/../../x", "a\\b", ""] {
        store.write_json(".zattrs", &with_path(path));
        assert_refused(
            store.load(nothing()),
            LoadErrorKind::BadInput,
            &["leads out of the folder", "multiscales"],
        );
    }
    store.write_json(".zattrs", &with_path("0"));
    let array = |field: &str, value: Value| {
        let mut metadata: Value =
            serde_json::from_slice(&fs::read(store.root.join("0/.zarray")).unwrap()).unwrap();
        metadata[field] = value;
        metadata
    };
    let valid = array("zarr_format", json!(2));
    for (field, value, words) in [
        ("chunks", json!([1u64 << 40, 1, 1]), "chunks of 1099511627776"),
        ("shape", json!([1u64 << 40, 1u64 << 40, 1u64 << 40]), "0/shape"),
        ("shape", json!([0, 2, 2]), "is empty"),
        ("shape", json!([2, 2]), "2 whole numbers from 1 were expected"),
        ("chunks", json!([0, 1, 1]), "whole numbers from 1"),
        ("dtype", json!("<U4"), "the type \"<U4\" is not supported"),
        ("compressor", json!({"id": "lzma"}), "the codec \"lzma\" is not supported"),
        ("fill_value", json!("abc"), "no number of the array's type"),
    ] {
        store.write_json("0/.zarray", &array(field, value));
        let error = store.load(nothing()).unwrap_err().to_string();
        assert!(error.contains(words), "{words:?} is not in: {error}");
        store.write_json("0/.zarray", &valid);
    }
    store.write("0/.zarray", b"[[[[");
    assert_refused(store.load(nothing()), LoadErrorKind::BadInput, &["0/.zarray", "no valid JSON"]);
}

#[cfg(unix)]
#[test]
fn links_are_refused_and_pipes_are_no_chunks() {
    let store = TestStore::new();
    store.array("", &[2, 2, 2], &[2, 2, 2]);
    let other = store.root.parent().unwrap().join("other");
    fs::rename(store.root.join("0"), &other).unwrap();
    std::os::unix::fs::symlink(&other, store.root.join("0")).unwrap();
    assert_refused(store.load(nothing()), LoadErrorKind::BadInput, &["it is a link", "(", ", 0/0/0"]);
}

#[test]
fn a_document_opens_its_folder() {
    let store = image();
    let choice = VolumeChoice { frame: Some(0), channel: Some(0), ..nothing() };
    let volume = load_path(&store.root.join(".zattrs"), choice).unwrap();
    assert_eq!((volume.dims(), volume.name()), ([7, 6, 5], "scan"));
    assert!(is_zarr_folder(&store.root) && !is_zarr_folder(Path::new("/")));
}
