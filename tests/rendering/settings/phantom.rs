//! Phantom of a head with an L on its left, written by other programs in every format, with other axis orders and
//! directions (`tests/oracle/phantom/`): the picture is the same.

use std::path::{Path, PathBuf};

use chiaroscuro_render::Renderer;
use chiaroscuro_scene::{Camera, ControlPoint, OpacityInterpolation, Settings, TransferFunction};
use chiaroscuro_volume::{LoadControl, Volume};
use chiaroscuro_volume_io::{LoadOptions, load};
use glam::{DAffine3, DVec3};

use crate::common::{Dataset, full_precision_renderer, render};
use crate::compare::{channels_f32, compare};
use crate::scenes;
use crate::thresholds::PHANTOM;

/// Orientations of the head: along the axes of the body, or oblique with voxels of three lengths.
const ORIENTATIONS: [&str; 2] = ["straight", "aslant"];

/// Files of a head in one orientation; the first is the one that others are compared with.
fn phantom_files(orientation: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/oracle/phantom");
    let mut found: Vec<PathBuf> = std::fs::read_dir(folder)
        .expect("the folder is there")
        .map(|entry| entry.expect("it can be listed").path())
        // Raw data are opened through their description.
        .filter(|path| path.extension().is_some_and(|ending| ending != "bin"))
        .filter(|path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(orientation)))
        .collect();
    found.sort_by_key(|path| (!path.ends_with(format!("{orientation}_ras_r.nrrd")), path.clone()));
    found
}

fn open(path: &Path) -> Volume {
    load(path, &LoadOptions::default(), &LoadControl::new()).unwrap_or_else(|error| panic!("{error}"))
}

/// View from the left, front and above, with a light from the side.
fn look() -> Settings {
    let point = |value, color, opacity| ControlPoint::new(value, color, opacity);
    let transfer = TransferFunction {
        points: vec![
            point(15.0, [0.8, 0.6, 0.5], 0.0),
            point(45.0, [0.8, 0.6, 0.5], 0.4),
            point(80.0, [0.9, 0.3, 0.2], 0.7),
            point(120.0, [0.2, 0.5, 1.0], 0.9),
        ],
        interpolation: OpacityInterpolation::Opacity,
        ..TransferFunction::default()
    };
    let camera = Camera { azimuth_deg: 150.0, elevation_deg: 20.0, ..Camera::default() };
    Settings { camera, ..scenes::look() }.with_transfer(transfer)
}

fn picture(renderer: &mut Renderer, volume: Volume) -> Vec<f64> {
    channels_f32(&render(renderer, &Dataset::new(volume), &look(), [64, 64]).linear)
}

#[test]
fn a_head_looks_the_same_in_every_format_and_order_of_axes() {
    let mut renderer = full_precision_renderer();
    let mut wrong = Vec::new();
    let mut count = 0;
    for lie in ORIENTATIONS {
        let files = phantom_files(lie);
        let first = open(&files[0]);
        let expected = picture(&mut renderer, first.clone());
        for path in &files[1..] {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            wrong.extend(compare(&name, &picture(&mut renderer, open(path)), &expected, PHANTOM).err());
            count += 1;
        }
        // Guards the comparison: a mirrored or reversed head differs.
        for turn in [DVec3::new(-1.0, 1.0, 1.0), DVec3::new(1.0, -1.0, 1.0), DVec3::new(1.0, 1.0, -1.0)] {
            let place = DAffine3::from_scale(turn) * first.world_from_index();
            let turned =
                Volume::new("turned", first.dims(), place, first.samples().clone()).expect("a volume");
            let found = compare("turned", &picture(&mut renderer, turned), &expected, PHANTOM);
            assert!(found.is_err(), "{lie} turned by {turn}");
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    assert!(count > 70, "{count} files");
}
