//! Tests of files of several volumes: the one shown first, choosing another, and reopening the same one.

use std::path::{Path, PathBuf};

use chiaroscuro::app::{App, WindowOptions};
use chiaroscuro_scene::{LayerBlend, LookRecord};
use eframe::egui::{Key, Modifiers, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{DroppedFile, click, sharp_window_with, wait_until, wait_until_idle};

/// Writes a NumPy array of bytes; `value` maps positions in the file to values.
pub(crate) fn write_npy(path: &Path, shape: &str, count: usize, value: impl Fn(usize) -> u8) {
    let header = format!("{{'descr': '|u1', 'fortran_order': False, 'shape': ({shape}), }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(header.len()).expect("a short header").to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend((0..count).map(value));
    std::fs::write(path, bytes).expect("a file");
}

/// Writes three time steps of a growing block.
fn write_time_steps(folder: &Path) -> PathBuf {
    let path = folder.join("steps.npy");
    write_npy(&path, "3, 8, 8, 8", 3 * 512, |at| {
        let (step, inside) = (at / 512, [at % 8, at / 8 % 8, at / 64 % 8]);
        if inside.iter().all(|&n| n >= 2 && n < 4 + step) { 200 } else { (at % 7) as u8 }
    });
    path
}

fn window_of(source: &Path, session: Option<&Path>) -> Harness<'static, App> {
    let session = session.map(Path::to_owned);
    let options = WindowOptions { source: Some(source.to_owned()), session, ..WindowOptions::default() };
    let mut harness = sharp_window_with(options, Vec2::new(760.0, 1500.0));
    click(&mut harness, "Data");
    harness.run_steps(8);
    harness
}

fn wait_for(harness: &mut Harness<'_, App>, label: &str) {
    let start = std::time::Instant::now();
    while harness.query_by_label(label).is_none() {
        harness.step();
        assert!(start.elapsed() < crate::harness::WAIT_TIMEOUT, "no {label}: {:?}", harness.state().errors());
    }
    wait_until_idle(harness);
}

#[test]
fn another_time_step_is_chosen_by_the_mouse_and_by_keys() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window_of(&write_time_steps(folder.path()), None);
    // A change that no first look makes.
    harness.key_press(Key::CloseBracket);
    harness.run_steps(3);
    let before = harness.state().settings().clone();
    click(&mut harness, "1 of 3 · Time step 1");
    harness.run_steps(3);
    assert!(harness.query_by_label("Choose a time step").is_some());
    assert!(harness.unnamed_widgets().is_empty(), "{:?}", harness.unnamed_widgets());
    click(&mut harness, "Time step 2");
    wait_for(&mut harness, "2 of 3 · Time step 2");
    assert_eq!(harness.state().settings(), &before, "the look stays");
    for key in [Key::ArrowDown, Key::ArrowDown, Key::ArrowDown, Key::Enter] {
        harness.key_press(key);
        harness.run_steps(2);
    }
    wait_for(&mut harness, "3 of 3 · Time step 3");
    assert_eq!(harness.state().settings(), &before, "and the arrow keys turn no light");
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert!(harness.query_by_label("Choose a time step").is_none());
    click(&mut harness, "Previous time step");
    wait_for(&mut harness, "2 of 3 · Time step 2");
    assert!(harness.state().errors().is_empty());
}

#[test]
fn a_look_of_its_own_is_made_where_that_is_wanted() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window_of(&write_time_steps(folder.path()), None);
    harness.key_press(Key::CloseBracket);
    harness.run_steps(3);
    let before = harness.state().settings().lights.clone();
    click(&mut harness, "1 of 3 · Time step 1");
    harness.run_steps(3);
    click(&mut harness, "Keep the look");
    click(&mut harness, "Time step 3");
    wait_for(&mut harness, "3 of 3 · Time step 3");
    assert_ne!(harness.state().settings().lights, before);
}

#[test]
fn a_session_and_the_list_of_files_open_the_same_one_again() {
    let folder = tempfile::tempdir().unwrap();
    let (source, session) = (write_time_steps(folder.path()), folder.path().join("s.json"));
    let mut harness = window_of(&source, Some(&session));
    click(&mut harness, "Next time step");
    wait_for(&mut harness, "2 of 3 · Time step 2");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    harness.run_steps(3);
    let record = LookRecord::parse(&std::fs::read_to_string(&session).unwrap()).unwrap();
    assert_eq!(record.volume.unwrap().choice.frame, Some(1));
    drop(harness);
    let harness = window_of(&session, None);
    assert!(harness.query_by_label("2 of 3 · Time step 2").is_some());
    drop(harness);
    // The file has fewer time steps now.
    write_npy(&source, "2, 8, 8, 8", 1024, |at| (at % 5) as u8);
    let text = std::fs::read_to_string(&session).unwrap().replace("\"frame\": 1", "\"frame\": 2");
    std::fs::write(&session, text).unwrap();
    let harness = window_of(&session, None);
    assert!(harness.query_by_label("1 of 2 · Time step 1").is_some());
}

#[test]
fn colours_open_as_their_luminance_and_are_shown_on_request() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("colors.npy");
    write_npy(&path, "6, 6, 6, 3", 648, |at| (at * 37 % 251) as u8);
    let mut harness = window_of(&path, None);
    assert!(harness.query_by_label("Luminance").is_some(), "beside the name of the file");
    click(&mut harness, "Show colours");
    wait_until(&mut harness, "the colors are shown", |app| app.settings().layers.count() == 4);
    let blends: Vec<_> = harness.state().settings().layers.iter().skip(1).map(|layer| layer.blend).collect();
    assert_eq!(blends, LayerBlend::CHANNELS);
    wait_until_idle(&mut harness);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    wait_until(&mut harness, "the luminance is back", |app| app.settings().layers.count() == 1);
    wait_until_idle(&mut harness);
    click(&mut harness, "1 of 4 · Luminance");
    harness.run_steps(3);
    click(&mut harness, "Green");
    wait_for(&mut harness, "3 of 4 · Green");
    let ctx = harness.ctx.clone();
    harness.state_mut().open("builtin:sphere:16", &ctx);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("sphere"));
    harness.run_steps(3);
    assert!(harness.query_by_label("Choose a component").is_none(), "there is nothing to choose from");
}

#[test]
fn the_page_keys_go_through_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for (name, shift) in [("a2.npy", 0), ("a10.npy", 3)] {
        write_npy(&path(name), "8, 8, 8", 512, |at| ((at * 7 + shift) % 200) as u8);
    }
    std::fs::write(path("a3.txt"), "no volume").unwrap();
    let mut harness = window_of(&path("a2.npy"), None);
    harness.key_press(Key::CloseBracket);
    harness.run_steps(3);
    let before = harness.state().settings().clone();
    harness.key_press(Key::PageDown);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("a10"));
    wait_until_idle(&mut harness);
    assert_eq!(harness.state().settings(), &before, "the same kind of data in the same grid");
    harness.key_press(Key::PageDown);
    let start = std::time::Instant::now();
    while harness.query_by_label_contains("the last volume of its folder").is_none() {
        harness.step();
        assert!(start.elapsed() < crate::harness::WAIT_TIMEOUT);
    }
    harness.key_press(Key::PageUp);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("a2"));
    assert!(harness.state().errors().is_empty());
}

#[test]
fn dropped_files_open_by_content() {
    let folder = tempfile::tempdir().unwrap();
    let picture = |name: &str, grey: u8| {
        let path = folder.path().join(name);
        let row: Vec<u8> = (0..64).map(|at| grey.wrapping_add(at * 3)).collect();
        image::save_buffer(&path, &row, 8, 8, image::ExtendedColorType::L8).expect("a picture");
        path
    };
    let slices: Vec<_> = (0..4).map(|at| picture(&format!("s{at}.png"), at * 20)).collect();
    let mut harness = crate::harness::window();
    // A picture without a look is a volume of one slice.
    harness.input_mut().dropped_files.push(std::sync::Arc::new(DroppedFile(slices[1].clone())));
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("s1"));
    wait_until_idle(&mut harness);
    for slice in &slices[..2] {
        harness.input_mut().dropped_files.push(std::sync::Arc::new(DroppedFile(slice.clone())));
    }
    harness.run_steps(4);
    assert!(harness.query_by_label_contains("Only the 2 dropped slices of the folder ").is_some());
    let name = folder.path().file_name().unwrap().to_string_lossy().into_owned();
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some(name.as_str()));
    assert!(harness.state().errors().is_empty(), "{:?}", harness.state().errors());
}
