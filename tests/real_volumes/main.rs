//! Tests of real volumes from scanners and other programs, if available: they load correctly, and their first look
//! shows something. The built-in volumes are checked everywhere.
//!
//! The files are in the folder that `CHIAROSCURO_TEST_DATA` names, else in `../shared/data`, described by
//! `MANIFEST.tsv`. Without them their tests are ignored and say why.

#![expect(clippy::print_stdout, reason = "tests say what they measured, and the harness how they went")]

mod checks;
mod harness;
mod manifest;
mod oracle;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use chiaroscuro_volume::{
    Histogram, KindName, Samples,
    synthetic::{BUILTIN_NAMES, builtin},
};
use chiaroscuro_volume_io::RawFormat;

use chiaroscuro_scene::first_look;

use checks::{assert_good_first_looks, files_with_extension, load_all, open};
use harness::NamedTest;

/// Environment variable that names the folder of the data.
const FOLDER: &str = "CHIAROSCURO_TEST_DATA";

/// Folder of the test data.
fn data() -> PathBuf {
    let beside = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data");
    std::env::var_os(FOLDER).map_or_else(|| beside.into(), PathBuf::from)
}

fn main() -> ExitCode {
    let folder = data();
    let missing = (!folder.join("MANIFEST.tsv").is_file()).then(|| format!("needs {FOLDER}"));
    let real = |name, check: fn(&Path)| {
        let folder = folder.clone();
        NamedTest::new(name, missing.clone(), move || check(&folder))
    };
    let always = |name, check: fn()| NamedTest::new(name, None, check);
    harness::run(&[
        real(
            "raw_volumes_load_as_their_names_and_the_manifest_say",
            raw_volumes_load_as_their_names_and_the_manifest_say,
        ),
        real("nrrd_volumes_load_as_the_manifest_says", nrrd_volumes_load_as_the_manifest_says),
        real("odd_nrrd_files_load_or_say_why_not", odd_nrrd_files_load_or_say_why_not),
        real("one_volume_is_the_same_in_every_form", one_volume_is_the_same_in_every_form),
        real("kinds_of_data_are_recognised", kinds_of_data_are_recognised),
        real(
            "test_data_are_read_as_other_libraries_read_them",
            oracle::test_data_are_read_as_other_libraries_read_them,
        ),
        always(
            "written_files_are_read_as_other_libraries_read_them",
            oracle::written_files_are_read_as_other_libraries_read_them,
        ),
        always("a_wrong_row_is_noticed", oracle::a_wrong_row_is_noticed),
        always("built_in_volumes_have_good_first_looks", built_in_volumes_have_good_first_looks),
        always("wrong_facts_and_looks_are_noticed", checks::wrong_facts_and_looks_are_noticed),
        always("the_manifest_is_understood", manifest::the_manifest_is_understood),
        always("tests_without_their_data_are_ignored", harness::tests_without_their_data_are_ignored),
    ])
}

fn raw_volumes_load_as_their_names_and_the_manifest_say(folder: &Path) {
    let volumes = load_all(folder, &files_with_extension(&folder.join("raw"), &["raw", "nhdr"]));
    assert_good_first_looks(&volumes);
}

fn nrrd_volumes_load_as_the_manifest_says(folder: &Path) {
    let mut paths = files_with_extension(&folder.join("formats/nrrd"), &["nrrd", "nhdr"]);
    paths.extend(files_with_extension(&folder.join("formats/nrrd/blaze"), &["nhdr"]));
    let volumes = load_all(folder, &paths);
    assert_good_first_looks(&volumes);
}

fn odd_nrrd_files_load_or_say_why_not(folder: &Path) {
    let odd = folder.join("formats/nrrd/odd");
    let readable: Vec<_> = files_with_extension(&odd, &["nrrd", "nhdr"])
        .into_iter()
        .filter(|path| !path.ends_with("test_simple4d_raw.nrrd"))
        .collect();
    let volumes = load_all(folder, &readable);
    assert_eq!(volumes.len(), 5);

    // Four axes, the last one not spatial, but all of one sample: one voxel.
    let single = open(&odd.join("test_simple4d_raw.nrrd"), RawFormat::default()).expect("one component");
    assert_eq!(single.dims(), [1; 3]);
    assert!((single.spacing_mm() - glam::DVec3::new(1.5, 1.5, 1.0)).length() < 1e-9);
}

fn one_volume_is_the_same_in_every_form(folder: &Path) {
    let read = |name: &str| open(&folder.join(name), RawFormat::default()).expect("it loads");
    for (a, b) in [
        ("raw/lobster_301x324x56_uint8.raw", "raw/lobster.nhdr"),
        ("raw/fuel_64x64x64_uint8.raw", "formats/nrrd/fuel.nhdr"),
        ("raw/neghip_64x64x64_uint8.raw", "formats/nrrd/neghip.nhdr"),
        ("raw/engine_149x208x110_uint8.raw", "formats/nrrd/blaze/engine.nhdr"),
        ("formats/nrrd/odd/BallBinary30x30x30.nhdr", "formats/nrrd/odd/BallBinary30x30x30_gz.nrrd"),
        ("formats/nrrd/odd/BallBinary30x30x30.nhdr", "formats/nrrd/odd/BallBinary30x30x30_bz2.nrrd"),
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

/// Files of each kind of data, by name; all others are scalar.
const KINDS: [(KindName, &[&str]); 4] = [
    (KindName::LabelMap, &["aal_labels", "ctchest_seg", "platynereis_labels", "torso_labels"]),
    (KindName::Signed, &["cn9_homo", "f_orbital", "narps_zmap", "seismic_ex2", "spmMotor", "spmMotor_nan"]),
    (KindName::HounsfieldCt, &["ctchest4", "cranium_256x256x108_int16"]),
    (KindName::DarkOnBright, &["x_vessel_inverted"]),
];

fn kinds_of_data_are_recognised(folder: &Path) {
    let mut paths = files_with_extension(&folder.join("first"), &["nrrd"]);
    paths.extend(files_with_extension(&folder.join("raw"), &["raw"]));
    let mut wrong = Vec::new();
    for path in paths {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let expected = KINDS
            .iter()
            .find(|(_, names)| names.contains(&name.as_str()))
            .map_or(KindName::Scalar, |(kind, _)| *kind);
        let volume = open(&path, RawFormat::default()).expect("it loads");
        let found = volume.kind();
        println!("{name}: {:?}, {}", found.kind, found.reason);
        if found.kind.name() != expected {
            wrong.push(format!("{name} is {expected:?}, {:?} was found: {}", found.kind, found.reason));
        }
        let settings = first_look::first_settings(&volume, &Histogram::from_volume(&volume));
        if expected == KindName::LabelMap && first_look::count_lost_labels(&settings, &volume) > 0 {
            wrong.push(format!("{name} has labels that are not shown"));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

fn same(a: &Samples, b: &Samples) -> bool {
    a.len() == b.len() && (0..a.len()).all(|voxel| a.value(voxel) == b.value(voxel))
}

fn built_in_volumes_have_good_first_looks() {
    let volumes: Vec<_> =
        BUILTIN_NAMES.iter().map(|name| builtin(name, Some(64)).expect("it can be made")).collect();
    assert_good_first_looks(&volumes);
}
