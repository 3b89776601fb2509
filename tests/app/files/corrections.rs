//! Tests of corrections of a file's metadata: edited, undone, stored with the session, and remembered for the file.

use std::path::{Path, PathBuf};

use chiaroscuro::app::{App, WindowOptions};
use chiaroscuro_scene::{LookRecord, OpacityLength, Settings};
use chiaroscuro_volume::{Corrections, SpacingUnit};
use eframe::egui::{Key, Modifiers, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{
    adjusted_window, click, drag, key_events, key_stroke, picture, send_in_one_frame, slow_window,
    wait_until, wait_until_idle,
};

fn settings(harness: &Harness<'_, App>) -> Settings {
    harness.state().settings().clone()
}

fn press(harness: &mut Harness<'_, App>, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    harness.run_steps(8);
    wait_until_idle(harness);
}

/// Writes a slab that is long in x, shorter in y and thin in z, surrounded by zeros.
fn write_slab(path: &Path) {
    let value = |at: usize| {
        let [x, y, z] = [at % 24, at / 24 % 24, at / 576];
        u8::from((2..18).contains(&x) && (6..18).contains(&y) && (10..14).contains(&z)) * 200
    };
    std::fs::write(path, (0..24 * 24 * 24).map(value).collect::<Vec<_>>()).expect("written");
}

fn window_of(source: &Path, storage: &Path, session: Option<PathBuf>) -> Harness<'static, App> {
    let (source, storage) = (Some(source.to_owned()), Some(storage.to_owned()));
    adjusted_window(
        WindowOptions { source, storage, session, ..WindowOptions::default() },
        Vec2::new(760.0, 1600.0),
    )
}

/// Expands the corrections in the section "Data".
fn expand_corrections(harness: &mut Harness<'_, App>) {
    for part in ["Data", "Corrections"] {
        harness.get_by_label(part).scroll_to_me();
        harness.run_steps(8);
        click(harness, part);
        harness.run_steps(8);
    }
    harness.get_by_label("All as in the file").scroll_to_me();
    harness.run_steps(8);
}

/// Numbers typed with Tab between them go into their own fields, and none is a command, however slow frames are.
#[test]
fn numbers_are_typed_with_tab_within_a_frame() {
    let mut harness = slow_window(Vec2::new(760.0, 1600.0));
    expand_corrections(&mut harness);
    let before = settings(&harness);
    click(&mut harness, "Spacing along x");
    let [tab, enter] = [Key::Tab, Key::Enter].map(|key| key_stroke(key, Modifiers::NONE).to_vec());
    let [first, last] = ["0.957", "1.5"].map(key_events);
    send_in_one_frame(&mut harness, [first.clone(), tab.clone(), first, tab, last, enter].concat());
    wait_until_idle(&mut harness);
    let after = settings(&harness);
    assert_eq!(after.volume.spacing, Some([0.957, 0.957, 1.5]));
    // No digit was taken as a command for a view.
    assert_eq!(after.camera.azimuth_deg, before.camera.azimuth_deg);
    assert_eq!(after.camera.elevation_deg, before.camera.elevation_deg);
    assert_eq!(after.camera.projection, before.camera.projection);
}

#[test]
fn corrections_are_shown_undone_and_remembered() {
    let (folder, storage) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let file = folder.path().join("slab_24x24x24_uint8.raw");
    write_slab(&file);
    // Not the first run, which shows hints over the picture.
    std::fs::create_dir(storage.path().join("runs")).expect("a folder");
    let mut harness = window_of(&file, storage.path(), None);
    let as_opened = settings(&harness);
    assert!(as_opened.volume.is_none());
    let (before, _) = picture(&mut harness);
    expand_corrections(&mut harness);
    let fills = harness.state().light_rebuilds();
    click(&mut harness, "Flip x");
    wait_until(&mut harness, "never corrected", |app| app.settings().volume.flip.x && app.is_idle());
    assert!(harness.state().light_rebuilds() > fills, "light falls on it from elsewhere");
    let (after, _) = picture(&mut harness);
    assert!(before != after, "it is another picture");
    let flipped = settings(&harness);
    assert_eq!(
        (&flipped.layer().transfer, &flipped.lights),
        (&as_opened.layer().transfer, &as_opened.lights)
    );

    // One undo step and one redo step.
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(settings(&harness), as_opened);
    let (undone, _) = picture(&mut harness);
    assert!(undone == before, "as it was, to the last pixel");
    press(&mut harness, Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
    assert_eq!(settings(&harness), flipped);

    // A drag is one undo step, whatever values it passes.
    let number = harness.get_by_label("Spacing along z").rect().center();
    drag(&mut harness, number, Vec2::new(120.0, 0.0));
    harness.run_steps(8);
    wait_until_idle(&mut harness);
    let spaced = settings(&harness);
    let spacing = spaced.volume.spacing.expect("it was dragged");
    assert!(spacing[0] == 1.0 && spacing[1] == 1.0 && spacing[2] > 1.2, "{spacing:?}");
    assert!(spaced.camera.distance > 0.0 && spaced.volume.flip.x);
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(settings(&harness).volume, flipped.volume);
    press(&mut harness, Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
    assert_eq!(settings(&harness), spaced);
    assert!(harness.state().errors().is_empty(), "{:?}", harness.state().errors());
    drop(harness);

    // The next run opens the file corrected, and says so; undo shows it as in the file, and forgets the correction.
    let mut harness = window_of(&file, storage.path(), None);
    assert_eq!(settings(&harness).volume, spaced.volume);
    let said = harness.state().latest_note().map(str::to_owned);
    assert!(
        said.as_ref().is_some_and(|said| said.starts_with("Corrected as last time: spacing 1 × 1 ×")),
        "{said:?}"
    );
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert!(settings(&harness).volume.is_none());
    drop(harness);
    let harness = window_of(&file, storage.path(), None);
    assert!(settings(&harness).volume.is_none());
    drop(harness);

    // Another file at the same path is not corrected.
    let mut harness = window_of(&file, storage.path(), None);
    expand_corrections(&mut harness);
    click(&mut harness, "Flip z");
    wait_until(&mut harness, "never corrected", |app| app.settings().volume.flip.z && app.is_idle());
    drop(harness);
    std::fs::write(&file, (0..24 * 24 * 24).map(|at| (at % 251) as u8).collect::<Vec<_>>()).expect("written");
    let harness = window_of(&file, storage.path(), None);
    assert!(settings(&harness).volume.is_none());
}

#[test]
fn a_session_corrects_its_volume_and_no_other() {
    let (folder, storage) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let [file, other] = ["a", "b"].map(|name| folder.path().join(format!("{name}_24x24x24_uint8.raw")));
    write_slab(&file);
    std::fs::write(&other, (0..24 * 24 * 24).map(|at| (at % 240) as u8).collect::<Vec<_>>())
        .expect("written");
    let session = folder.path().join("session.json");
    let mut harness = window_of(&file, storage.path(), Some(session.clone()));
    let mut wanted = settings(&harness);
    expand_corrections(&mut harness);
    click(&mut harness, "Flip y");
    wait_until(&mut harness, "never corrected", |app| app.settings().volume.flip.y && app.is_idle());
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    harness.run_steps(8);
    drop(harness);
    let record = LookRecord::parse(&std::fs::read_to_string(&session).expect("saved")).expect("a record");
    wanted.volume.flip.y = true;
    let id =
        u64::from_str_radix(&record.volume.as_ref().expect("of a volume").content_id, 16).expect("a number");
    assert_eq!(record.corrections_for(id), Some(wanted.volume));
    // With a storage that remembers nothing of the file.
    let elsewhere = tempfile::tempdir().unwrap();
    let harness = window_of(&file, elsewhere.path(), Some(session.clone()));
    assert_eq!(settings(&harness).volume, wanted.volume);
    drop(harness);
    let harness = window_of(&other, elsewhere.path(), Some(session));
    assert!(settings(&harness).volume.is_none());
}

#[test]
fn a_look_that_is_kept_and_lengths_go_along() {
    let (folder, storage) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let [file, other] = ["a", "b"].map(|name| folder.path().join(format!("{name}_24x24x24_uint8.raw")));
    write_slab(&file);
    std::fs::write(&other, (0..24 * 24 * 24).map(|at| (at % 240) as u8).collect::<Vec<_>>())
        .expect("written");
    let options = WindowOptions {
        source: Some(file),
        storage: Some(storage.path().to_owned()),
        adjust: Some(Box::new(|mut settings| {
            settings.shadows.keep_balanced = false;
            settings.shading.ambient = 0.4;
            settings.layer_mut().opacity_unit = OpacityLength::Mm(2.0);
            settings.volume = Corrections { unit: Some(SpacingUnit::Um), ..Corrections::default() };
            settings
        })),
        ..WindowOptions::default()
    };
    let mut harness = adjusted_window(options, Vec2::new(760.0, 1600.0));
    assert_eq!(settings(&harness).volume.unit, Some(SpacingUnit::Um));
    expand_corrections(&mut harness);
    click(&mut harness, "All as in the file");
    wait_until(&mut harness, "never corrected", |app| app.settings().volume.is_none() && app.is_idle());
    assert_eq!(
        settings(&harness).layer().opacity_unit,
        OpacityLength::Mm(2000.0),
        "the same share of the object"
    );
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!((settings(&harness).layer().opacity_unit, settings(&harness).volume.unit), {
        (OpacityLength::Mm(2.0), Some(SpacingUnit::Um))
    });
    // The next volume keeps this look, but not its corrections.
    let ctx = harness.ctx.clone();
    harness.get_by_label("File").click();
    harness.run_steps(6);
    click(&mut harness, "Keep look for next file");
    harness.state_mut().open(&other, &ctx);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("b") && app.is_idle());
    let kept = settings(&harness);
    assert_eq!(kept.shading.ambient, 0.4);
    assert!(kept.volume.is_none());
}
