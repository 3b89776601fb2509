//! Tests of looks from outside, and of the volumes that they name.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use chiaroscuro::app::{App, WindowOptions};
use chiaroscuro_media::export_png;
use chiaroscuro_scene::{LookRecord, Settings, VolumeRecord};
use chiaroscuro_volume::VolumeChoice;
use eframe::egui::Vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{DroppedFile, SCENE, adjusted_window, click, wait_until, wait_until_idle, window};

const QUESTION: &str = "Open the volume of this look?";

/// Writes a picture whose look has twice the usual gain, of a volume at some path.
fn write_picture_of(source: &str, path: &Path) {
    let mut settings = Settings::default();
    settings.shadows.gain = 2.0;
    settings.shadows.keep_balanced = false;
    let volume = VolumeRecord {
        source: source.to_owned(),
        source_bytes: None,
        content_id: String::new(),
        choice: VolumeChoice::default(),
        layers: Vec::new(),
    };
    let record = LookRecord::to_json(&settings, Some(&volume), None);
    export_png([1, 1], &[0; 4], false, Some(&record), path).expect("written");
}

fn write_voxels(path: &Path) {
    std::fs::write(path, (0..720).map(|i| (i / 3) as u8).collect::<Vec<_>>()).expect("written");
}

fn drop_on(harness: &mut Harness<'_, App>, path: &Path) {
    harness.input_mut().dropped_files.push(Arc::new(DroppedFile(path.to_owned())));
    harness.run_steps(2);
    wait_until(harness, "never read", |app| app.file_being_read().is_none());
    harness.run_steps(4);
}

#[test]
fn a_volume_elsewhere_is_asked_about_once() {
    let folder = tempfile::tempdir().unwrap();
    let storage = tempfile::tempdir().unwrap();
    let volume = folder.path().join("ramp_8x9x10_uint8.raw");
    write_voxels(&volume);
    std::fs::create_dir(folder.path().join("looks")).unwrap();
    let picture = folder.path().join("looks/picture.png");
    write_picture_of("../ramp_8x9x10_uint8.raw", &picture);
    let start = || {
        let (source, storage) = (Some(SCENE.into()), Some(storage.path().to_owned()));
        adjusted_window(
            WindowOptions { source, storage, ..WindowOptions::default() },
            Vec2::new(760.0, 1100.0),
        )
    };
    let mut harness = start();
    let gain = harness.state().settings().shadows.gain;
    drop_on(&mut harness, &picture);
    assert!(harness.query_by_label(QUESTION).is_some());
    assert!(harness.query_by_label_contains("ramp_8x9x10_uint8.raw").is_some(), "all of the path is shown");
    assert!(harness.unnamed_widgets().is_empty(), "{:?}", harness.unnamed_widgets());
    harness.run_steps(20);
    assert_eq!(harness.state().volume_name(), Some("chair"), "nothing is opened without an answer");
    assert_eq!(harness.state().settings().shadows.gain, gain);

    click(&mut harness, "Only the look");
    wait_until_idle(&mut harness);
    assert_eq!(
        (harness.state().volume_name(), harness.state().settings().shadows.gain),
        (Some("chair"), 2.0)
    );
    assert!(harness.query_by_label(QUESTION).is_none());

    drop_on(&mut harness, &picture);
    click(&mut harness, "Open it");
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("ramp") && app.is_idle());
    assert_eq!(harness.state().settings().shadows.gain, 2.0);
    // The user has opened the volume now, so it is not asked about again.
    let ctx = harness.ctx.clone();
    harness.state_mut().open(SCENE, &ctx);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("chair") && app.is_idle());
    drop_on(&mut harness, &picture);
    assert!(harness.query_by_label(QUESTION).is_none(), "asked twice");
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("ramp") && app.is_idle());
}

#[test]
fn a_volume_beside_its_look_is_opened_at_once() {
    let folder = tempfile::tempdir().unwrap();
    write_voxels(&folder.path().join("ramp_8x9x10_uint8.raw"));
    write_picture_of("ramp_8x9x10_uint8.raw", &folder.path().join("picture.png"));
    let mut harness = window();
    drop_on(&mut harness, &folder.path().join("picture.png"));
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("ramp") && app.is_idle());
}

#[test]
fn servers_and_devices_cannot_be_opened_for_a_look() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window();
    for source in ["\\\\host\\share\\x.nrrd", "/dev/zero", "http://host/x.nrrd"] {
        let picture = folder.path().join("picture.png");
        write_picture_of(source, &picture);
        drop_on(&mut harness, &picture);
        assert!(harness.query_by_label(QUESTION).is_some() && harness.query_by_label("Open it").is_none());
        click(&mut harness, "Only the look");
    }
    wait_until_idle(&mut harness);
    assert_eq!(
        (harness.state().volume_name(), harness.state().settings().shadows.gain),
        (Some("chair"), 2.0)
    );
}

#[test]
fn trusted_paths_and_named_volumes_open_without_asking() {
    let folder = tempfile::tempdir().unwrap();
    let volume = folder.path().join("ramp_8x9x10_uint8.raw");
    write_voxels(&volume);
    std::fs::create_dir(folder.path().join("looks")).unwrap();
    let picture = folder.path().join("looks/picture.png");
    write_picture_of("../ramp_8x9x10_uint8.raw", &picture);
    let options = |trust_paths: bool, volume: Option<&Path>, session: bool| WindowOptions {
        source: (!session).then(|| picture.clone()),
        session: session.then(|| picture.clone()),
        volume: volume.map(Path::to_owned),
        trust_paths,
        ..WindowOptions::default()
    };
    for (case, name) in [
        (options(true, None, false), Some("ramp")),
        (options(false, Some(&volume), false), Some("ramp")),
        (options(true, None, true), Some("ramp")),
        (options(false, Some(&volume), true), Some("ramp")),
        // The question is asked over the start screen.
        (options(false, None, false), None),
        (options(false, None, true), None),
    ] {
        let words = format!("{case:?} {name:?}");
        let mut harness = adjusted_window(case, Vec2::new(760.0, 900.0));
        assert_eq!(harness.state().volume_name(), name, "{words}");
        harness.run_steps(2);
        assert_eq!(harness.query_by_label(QUESTION).is_some(), name.is_none(), "{words}");
    }
}

#[cfg(unix)]
#[test]
fn non_utf8_names_open() {
    use std::os::unix::ffi::OsStrExt as _;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(std::ffi::OsStr::from_bytes(b"a\xff_8x9x10_uint8.raw"));
    write_voxels(&path);
    let mut harness = window();
    drop_on(&mut harness, &path);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("a·") && app.is_idle());
    assert!(harness.state().errors().is_empty(), "{:?}", harness.state().errors());
}

#[test]
fn long_names_and_curves_do_not_hold_up_the_window() {
    let folder = tempfile::tempdir().unwrap();
    let point = "{\"value\":0,\"opacity\":0},";
    let looks = [
        format!("{{\"lights\": [{{\"name\": \"{}\"}}]}}", "n".repeat(1_000_000)),
        format!("{{\"transfer\": {{\"points\": [{}]}}}}", point.repeat(43_000).trim_end_matches(',')),
        format!("{{\"{}\": 0}}", "k".repeat(1_000_000)),
    ];
    let mut harness = window();
    for (at, look) in looks.iter().enumerate() {
        let path = folder.path().join(format!("{at}.json"));
        std::fs::write(&path, look).unwrap();
        let start = Instant::now();
        drop_on(&mut harness, &path);
        // Before names were limited, one frame with 4 MB of them took 13.6 s.
        assert!(start.elapsed() < Duration::from_secs(5), "{at}: {:?}", start.elapsed());
    }
    assert_eq!(harness.state().settings().lights[0].name, "n".repeat(200));
    assert_eq!(harness.state().settings().layer().transfer.points.len(), 4096);
    wait_until_idle(&mut harness);
    assert!(harness.state().errors().is_empty(), "{:?}", harness.state().errors());
}
