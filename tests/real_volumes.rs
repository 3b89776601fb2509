//! Volumes as they come from scanners and other programs, where this machine has them: they load as
//! they should, and their first look shows something. The built-in volumes are checked everywhere.
//!
//! The files are in the folder that `CHIAROSCURO_TEST_DATA` names, else beside the project, with
//! `MANIFEST.tsv` saying what each of them is.

#![expect(clippy::print_stdout, reason = "tests say what they could not check, and what they measured")]

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use chiaroscuro::data::load::{LoadControl, LoadError, LoadErrorKind, LoadOptions, RawFormat, load};
use chiaroscuro::data::synthetic::{NAMES, builtin};
use chiaroscuro::data::{Histogram, Samples, Volume};
use chiaroscuro::model::auto;

/// Where the data are, if they are there.
fn test_data() -> Option<PathBuf> {
    let folder = std::env::var_os("CHIAROSCURO_TEST_DATA")
        .map_or_else(|| concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data").into(), PathBuf::from);
    if folder.join("MANIFEST.tsv").is_file() {
        Some(folder)
    } else {
        println!("test data not found at {}: real volumes are not checked", folder.display());
        None
    }
}

/// What the manifest says of a file; each part only where it is said.
#[derive(Debug, Default)]
struct Facts {
    dims: Option<[usize; 3]>,
    voxel_type: Option<String>,
    spacing_mm: Option<[f64; 3]>,
}

/// Facts by the path of the file.
fn manifest(folder: &Path) -> HashMap<String, Facts> {
    let text = fs::read_to_string(folder.join("MANIFEST.tsv")).expect("the manifest is text");
    text.lines()
        .skip(1)
        .map(|line| {
            let columns: Vec<_> = line.split('\t').collect();
            let column = |index: usize| columns.get(index).copied().unwrap_or_default();
            let facts = Facts {
                dims: dims(column(1)),
                voxel_type: voxel_type(column(2)),
                spacing_mm: spacing(column(3)),
            };
            (column(0).to_owned(), facts)
        })
        .collect()
}

/// `256x256x108`; a picture has one slice.
fn dims(text: &str) -> Option<[usize; 3]> {
    let numbers: Option<Vec<usize>> = text.split('x').map(|number| number.parse().ok()).collect();
    match numbers?[..] {
        [x, y] => Some([x, y, 1]),
        [x, y, z] => Some([x, y, z]),
        _ => None,
    }
}

/// `int16` or `16-bit signed integer`.
fn voxel_type(text: &str) -> Option<String> {
    let bits = || text.split('-').next().unwrap_or_default();
    if text.ends_with("unsigned integer") {
        Some(format!("uint{}", bits()))
    } else if text.ends_with("signed integer") {
        Some(format!("int{}", bits()))
    } else {
        (!text.is_empty()).then(|| text.to_owned())
    }
}

/// `0.957x0.957x1.5`, `(1.0, 1.0, 1.4) …` or `0.0156 iso …`.
fn spacing(text: &str) -> Option<[f64; 3]> {
    if let Some((edge, _)) = text.split_once(" iso") {
        return edge.parse().ok().map(|edge| [edge; 3]);
    }
    let list = text.strip_prefix('(').map_or(text, |rest| rest.split(')').next().unwrap_or_default());
    let numbers: Option<Vec<f64>> = list.split(['x', ',']).map(|number| number.trim().parse().ok()).collect();
    numbers?.try_into().ok()
}

/// Files of a folder with one of these endings, in order.
fn files(folder: &Path, endings: &[&str]) -> Vec<PathBuf> {
    let mut found: Vec<_> = fs::read_dir(folder)
        .unwrap_or_else(|err| panic!("{}: {err}", folder.display()))
        .map(|entry| entry.expect("the folder can be listed").path())
        .filter(|path| path.extension().is_some_and(|found| endings.iter().any(|ending| found == *ending)))
        .collect();
    found.sort();
    assert!(!found.is_empty(), "{} has no {endings:?}", folder.display());
    found
}

fn open(path: &Path, raw: RawFormat) -> Result<Volume, LoadError> {
    load(path, &LoadOptions { raw, ..LoadOptions::default() }, &LoadControl::new())
}

/// All that differs between a volume and what is known of its file.
fn differences(volume: &Volume, facts: &Facts) -> Vec<String> {
    let mut found = Vec::new();
    if facts.dims.is_some_and(|dims| dims != volume.dims()) {
        found.push(format!("{:?} voxels, {:?} expected", volume.dims(), facts.dims));
    }
    let voxel_type = volume.samples().voxel_type().name();
    if facts.voxel_type.as_deref().is_some_and(|expected| expected != voxel_type) {
        found.push(format!("voxels of {voxel_type}, {:?} expected", facts.voxel_type));
    }
    // The manifest gives four digits. A slice has no thickness of its own.
    let spacing_mm = volume.spacing_mm();
    let axes = if volume.dims()[2] == 1 { 2 } else { 3 };
    let differs = |expected: [f64; 3]| (0..axes).any(|i| (spacing_mm[i] / expected[i] - 1.0).abs() > 1e-3);
    if facts.spacing_mm.is_some_and(differs) {
        found.push(format!("spacing {spacing_mm:?}, {:?} expected", facts.spacing_mm));
    }
    let (low, high) = volume.value_range();
    if low >= high {
        found.push(format!("values from {low} to {high}"));
    }
    if volume.non_finite_voxels() > 0 {
        found.push(format!("{} voxels are not finite", volume.non_finite_voxels()));
    }
    found
}

/// All that is wrong with the first look at a volume.
fn first_look_flaws(volume: &Volume) -> Vec<String> {
    let settings = auto::first_settings(volume, &Histogram::of(volume, auto::BINS));
    let mut found = Vec::new();
    let values: Vec<f64> = settings.transfer.points.iter().map(|point| point.value).collect();
    if !values.windows(2).all(|pair| pair[0] < pair[1]) {
        found.push(format!("control points do not ascend: {values:?}"));
    }
    let visible: usize = (0..volume.dims()[2])
        .map(|z| {
            let slice = volume.slice_densities(z);
            let opacity = |density: f32| settings.transfer.opacity_at(volume.value_of(f64::from(density)));
            slice.into_iter().filter(|&density| opacity(density) > 0.05).count()
        })
        .sum();
    let share = visible as f64 / volume.voxel_count() as f64;
    println!("{}: {:.1} % of the voxels are visible", volume.name(), share * 100.0);
    // Less is a picture of nothing; more than two thirds is a block without a shape. (The
    // Marschner–Lobb signal fills more of its cube than any scan.)
    if !(0.005..=0.667).contains(&share) {
        found.push(format!("{:.2} % of the voxels are visible, 0.5 % to 67 % expected", share * 100.0));
    }
    if !settings.camera.distance.is_finite() || settings.camera.target.iter().any(|c| !c.is_finite()) {
        found.push(format!("the camera is nowhere: {:?}", settings.camera));
    }
    found
}

/// Loads files as the manifest describes them; the volumes, or all that is wrong.
fn load_all(folder: &Path, paths: &[PathBuf]) -> Vec<Volume> {
    let facts = manifest(folder);
    let (mut volumes, mut wrong) = (Vec::new(), Vec::new());
    for path in paths {
        let name = path.strip_prefix(folder).expect("it is below").to_string_lossy().replace('\\', "/");
        let Some(facts) = facts.get(&name) else {
            wrong.push(format!("{name} is not in the manifest"));
            continue;
        };
        // A RAW file cannot say its spacing.
        let is_raw = path.extension().is_some_and(|ending| ending == "raw");
        let spacing_mm = if is_raw { facts.spacing_mm } else { None };
        match open(path, RawFormat { spacing_mm, ..RawFormat::default() }) {
            Ok(volume) => {
                wrong.extend(differences(&volume, facts).into_iter().map(|flaw| format!("{name}: {flaw}")));
                volumes.push(volume);
            }
            Err(err) => wrong.push(format!("{name}: {err}")),
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    volumes
}

fn assert_good_first_looks(volumes: &[Volume]) {
    let wrong: Vec<_> = volumes
        .iter()
        .flat_map(|volume| {
            let flaws = first_look_flaws(volume);
            flaws.into_iter().map(|flaw| format!("{} {:?}: {flaw}", volume.name(), volume.dims()))
        })
        .collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn raw_volumes_load_as_their_names_and_the_manifest_say() {
    let Some(folder) = test_data() else { return };
    let volumes = load_all(&folder, &files(&folder.join("raw"), &["raw", "nhdr"]));
    assert_good_first_looks(&volumes);
}

#[test]
fn nrrd_volumes_load_as_the_manifest_says() {
    let Some(folder) = test_data() else { return };
    let mut paths = files(&folder.join("formats/nrrd"), &["nrrd", "nhdr"]);
    paths.extend(files(&folder.join("formats/nrrd/blaze"), &["nhdr"]));
    let volumes = load_all(&folder, &paths);
    assert_good_first_looks(&volumes);
}

#[test]
fn odd_nrrd_files_load_or_say_why_not() {
    let Some(folder) = test_data() else { return };
    let odd = folder.join("formats/nrrd/odd");
    let (refused, readable): (Vec<_>, Vec<_>) = files(&odd, &["nrrd", "nhdr"])
        .into_iter()
        .filter(|path| !path.ends_with("test_simple4d_raw.nrrd"))
        .partition(|path| path.ends_with("BallBinary30x30x30_bz2.nrrd"));
    let volumes = load_all(&folder, &readable);
    assert_eq!(volumes.len(), 4);

    for path in refused {
        let err = open(&path, RawFormat::default()).expect_err("bzip2 is not read");
        assert_eq!(err.kind(), LoadErrorKind::BadInput);
        assert!(err.to_string().contains("bzip2") && err.to_string().contains("encoding"), "{err}");
    }

    // Four axes, the last one not spatial, but all of one sample: one voxel.
    let single = open(&odd.join("test_simple4d_raw.nrrd"), RawFormat::default()).expect("one component");
    assert_eq!(single.dims(), [1; 3]);
    assert!((single.spacing_mm() - glam::DVec3::new(1.5, 1.5, 1.0)).length() < 1e-9);
}

#[test]
fn one_volume_is_the_same_in_every_form() {
    let Some(folder) = test_data() else { return };
    let read = |name: &str| open(&folder.join(name), RawFormat::default()).expect("it loads");
    for (a, b) in [
        ("raw/lobster_301x324x56_uint8.raw", "raw/lobster.nhdr"),
        ("raw/fuel_64x64x64_uint8.raw", "formats/nrrd/fuel.nhdr"),
        ("raw/neghip_64x64x64_uint8.raw", "formats/nrrd/neghip.nhdr"),
        ("raw/engine_149x208x110_uint8.raw", "formats/nrrd/blaze/engine.nhdr"),
        ("formats/nrrd/odd/BallBinary30x30x30.nhdr", "formats/nrrd/odd/BallBinary30x30x30_gz.nrrd"),
        (
            "formats/nrrd/odd/BallBinary30x30x30.nhdr",
            "formats/nrrd/odd/BallBinary30x30x30_byteskip_minus_one.nhdr",
        ),
    ] {
        let (first, second) = (read(a), read(b));
        assert_eq!(first.dims(), second.dims(), "{a} and {b}");
        assert!(same(first.samples(), second.samples()), "{a} and {b} have other voxels");
    }
}

fn same(a: &Samples, b: &Samples) -> bool {
    a.len() == b.len() && (0..a.len()).all(|voxel| a.value(voxel) == b.value(voxel))
}

#[test]
fn built_in_volumes_have_good_first_looks() {
    let volumes: Vec<_> = NAMES.iter().map(|name| builtin(name, Some(64)).expect("it can be made")).collect();
    assert_good_first_looks(&volumes);
}

#[test]
fn wrong_facts_and_looks_are_noticed() {
    let ball = builtin("sphere", Some(16)).expect("it can be made");
    let right =
        Facts { dims: Some([16; 3]), voxel_type: Some("uint8".to_owned()), spacing_mm: Some([8.0; 3]) };
    assert_eq!(differences(&ball, &right), Vec::<String>::new());
    let wrong = Facts {
        dims: Some([16, 16, 17]),
        voxel_type: Some("int8".to_owned()),
        spacing_mm: Some([8.0, 8.0, 8.1]),
    };
    assert_eq!(differences(&ball, &wrong).len(), 3);

    let empty = Volume::with_spacing("empty", [8; 3], glam::DVec3::ONE, Samples::U8(vec![0; 512]))
        .expect("a volume of one value");
    assert!(!first_look_flaws(&empty).is_empty(), "all of it looks the same");
    assert!(!differences(&empty, &Facts::default()).is_empty(), "only one value");
}

#[test]
fn the_manifest_is_understood() {
    assert_eq!(dims("256x256x108"), Some([256, 256, 108]));
    assert_eq!(dims("3x9"), Some([3, 9, 1]));
    assert_eq!(dims(""), None);
    assert_eq!(voxel_type("16-bit unsigned integer").as_deref(), Some("uint16"));
    assert_eq!(voxel_type("8-bit signed integer").as_deref(), Some("int8"));
    assert_eq!(voxel_type("int16").as_deref(), Some("int16"));
    assert_eq!(voxel_type(""), None);
    assert_eq!(spacing("0.957x0.957x1.5"), Some([0.957, 0.957, 1.5]));
    assert_eq!(spacing("(1.0, 1.0, 1.4) dirdev=0.000"), Some([1.0, 1.0, 1.4]));
    assert_eq!(spacing("0.0156 iso (1x1x1 ratio)"), Some([0.0156; 3]));
    assert_eq!(spacing(""), None);
}
