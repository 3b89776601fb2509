//! Checks of a real volume and of its first look.

use std::fs;
use std::path::{Path, PathBuf};

use chiaroscuro_scene::first_look;
use chiaroscuro_volume::{
    Histogram, LoadControl, LoadError, Samples, ValueRange, Volume, synthetic::builtin,
};
use chiaroscuro_volume_io::{LoadOptions, RawFormat, load};

use crate::manifest::{ManifestEntry, read_manifest};

/// Files of a folder with one of these extensions, sorted.
pub(crate) fn files_with_extension(folder: &Path, endings: &[&str]) -> Vec<PathBuf> {
    let mut found: Vec<_> = fs::read_dir(folder)
        .unwrap_or_else(|err| panic!("{}: {err}", folder.display()))
        .map(|entry| entry.expect("the folder can be listed").path())
        .filter(|path| path.extension().is_some_and(|found| endings.iter().any(|ending| found == *ending)))
        .collect();
    found.sort();
    assert!(!found.is_empty(), "{} has no {endings:?}", folder.display());
    found
}

pub(crate) fn open(path: &Path, raw: RawFormat) -> Result<Volume, LoadError> {
    load(path, &LoadOptions { raw, ..LoadOptions::default() }, &LoadControl::new())
}

/// All differences between a volume and the known facts about its file.
fn manifest_differences(volume: &Volume, facts: &ManifestEntry) -> Vec<String> {
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
    let ValueRange { low, high } = volume.value_range();
    if low >= high {
        found.push(format!("values from {low} to {high}"));
    }
    if volume.non_finite_voxels() > 0 {
        found.push(format!("{} voxels are not finite", volume.non_finite_voxels()));
    }
    found
}

/// All faults of the first look at a volume.
fn first_look_flaws(volume: &Volume) -> Vec<String> {
    let settings = first_look::first_settings(volume, &Histogram::from_volume(volume));
    let mut found = Vec::new();
    let values: Vec<f64> = settings.layer().transfer.points.iter().map(|point| point.value).collect();
    if !values.windows(2).all(|pair| pair[0] <= pair[1]) {
        found.push(format!("control points do not ascend: {values:?}"));
    }
    // As pictures show it: missing voxels are left out, and values beyond the range are clamped to it.
    let shown = volume.with_density_mapping(settings.shown_range(&volume.ranges()));
    let [nx, ny, nz] = shown.dims();
    let places = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
    let (mut present, mut visible) = (0usize, 0usize);
    for density in places.filter_map(|place| shown.density_at(place)) {
        present += 1;
        visible += usize::from(settings.layer().transfer.opacity_at(shown.value_of(density)) > 0.05);
    }
    let share = visible as f64 / present as f64;
    println!("{}: {:.1} % of the voxels are visible", volume.name(), share * 100.0);
    // A smaller share is an empty picture; more than two thirds is a shapeless block. (The Marschner–Lobb signal
    // fills more of its cube than any scan.)
    if !(0.005..=0.667).contains(&share) {
        found.push(format!("{:.2} % of the voxels are visible, 0.5 % to 67 % expected", share * 100.0));
    }
    if !settings.camera.distance.is_finite() || settings.camera.target.iter().any(|c| !c.is_finite()) {
        found.push(format!("the camera is nowhere: {:?}", settings.camera));
    }
    found
}

/// Loads files as the manifest describes them; returns the volumes, or fails with all differences.
pub(crate) fn load_all(folder: &Path, paths: &[PathBuf]) -> Vec<Volume> {
    let facts = read_manifest(folder);
    let (mut volumes, mut wrong) = (Vec::new(), Vec::new());
    for path in paths {
        let name = path.strip_prefix(folder).expect("it is below").to_string_lossy().replace('\\', "/");
        let Some(facts) = facts.get(&name) else {
            wrong.push(format!("{name} is not in the manifest"));
            continue;
        };
        // A RAW file cannot state its spacing.
        let is_raw = path.extension().is_some_and(|ending| ending == "raw");
        let spacing_mm = if is_raw { facts.spacing_mm } else { None };
        match open(path, RawFormat { spacing_mm, ..RawFormat::default() }) {
            Ok(volume) => {
                wrong.extend(
                    manifest_differences(&volume, facts).into_iter().map(|flaw| format!("{name}: {flaw}")),
                );
                volumes.push(volume);
            }
            Err(err) => wrong.push(format!("{name}: {err}")),
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    volumes
}

pub(crate) fn assert_good_first_looks(volumes: &[Volume]) {
    let wrong: Vec<_> = volumes
        .iter()
        .flat_map(|volume| {
            let flaws = first_look_flaws(volume);
            flaws.into_iter().map(|flaw| format!("{} {:?}: {flaw}", volume.name(), volume.dims()))
        })
        .collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

pub(crate) fn wrong_facts_and_looks_are_noticed() {
    let ball = builtin("sphere", Some(16)).expect("it can be made");
    let right = ManifestEntry {
        dims: Some([16; 3]),
        voxel_type: Some("uint8".to_owned()),
        spacing_mm: Some([8.0; 3]),
    };
    assert_eq!(manifest_differences(&ball, &right), Vec::<String>::new());
    let wrong = ManifestEntry {
        dims: Some([16, 16, 17]),
        voxel_type: Some("int8".to_owned()),
        spacing_mm: Some([8.0, 8.0, 8.1]),
    };
    assert_eq!(manifest_differences(&ball, &wrong).len(), 3);

    let empty = Volume::with_spacing("empty", [8; 3], glam::DVec3::ONE, Samples::U8(vec![0; 512]))
        .expect("a volume of one value");
    assert!(!first_look_flaws(&empty).is_empty(), "all of it looks the same");
    assert!(!manifest_differences(&empty, &ManifestEntry::default()).is_empty(), "only one value");
}
