//! Tests of the dialog for a typed path: it opens if there is no file dialog, and takes letters while it is open.

use chiaroscuro::app::App;
use eframe::egui::{Event, Key, Modifiers, Pos2, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{
    flick, key_events, key_stroke, send_in_one_frame, slow_window, wait_until, wait_until_idle, window,
};

/// Events of a key stroke with Ctrl, as a keyboard sends it.
fn ctrl_stroke(key: Key) -> Vec<Event> {
    let modifiers = |modifiers| vec![Event::ModifiersChanged(modifiers)];
    [modifiers(Modifiers::COMMAND), key_stroke(key, Modifiers::COMMAND).to_vec(), modifiers(Modifiers::NONE)]
        .concat()
}

/// Keys typed immediately after the shortcut go into the dialog.
#[test]
fn a_path_that_is_typed_within_a_frame_is_opened() {
    let mut harness = slow_window(Vec2::new(760.0, 600.0));
    let enter = key_stroke(Key::Enter, Modifiers::NONE).to_vec();
    send_in_one_frame(&mut harness, [ctrl_stroke(Key::L), key_events("builtin:box:16"), enter].concat());
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("box"));
    wait_until_idle(&mut harness);
    assert!(harness.state().errors().is_empty());
}

/// After a click beside the field, letters are still no commands.
#[test]
fn letters_are_no_commands_while_a_path_can_be_typed() {
    let mut harness = window();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::L);
    harness.run_steps(4);
    let field = harness.get_by_label("Path").rect();
    let (before, picture) = (harness.state().settings().clone(), harness.state().viewport_rect());
    send_in_one_frame(&mut harness, flick(field.left_top() - Vec2::new(1.0, 3.0), Vec2::ZERO));
    assert!(!harness.ctx.text_edit_focused(), "the field has not the focus");
    send_in_one_frame(&mut harness, key_events("home/nmi2563/volume.nrrd"));
    assert_eq!(harness.state().settings(), &before);
    assert_eq!(harness.state().viewport_rect(), picture, "no panel has gone");
    harness.key_press(Key::Escape);
    harness.run_steps(4);
    assert!(harness.query_by_label("Path").is_none());
    send_in_one_frame(&mut harness, key_events("2"));
    assert_ne!(harness.state().settings().camera, before.camera, "and they are again");
    wait_until_idle(&mut harness);
}

/// Returns true if the dialog for a typed path is open, with this title.
fn is_path_dialog_open(harness: &Harness<'_, App>, title: &str) -> bool {
    harness.query_by_label("Path").is_some() && harness.query_all_by_label(title).count() > 0
}

/// Without a file dialog of the desktop, as here, each request opens the dialog, also one right after another.
#[test]
fn a_path_can_be_typed_where_there_is_no_dialog() {
    let mut harness = slow_window(Vec2::new(760.0, 600.0));
    for _ in 0..5 {
        for (key, title) in [(Key::S, "Save session"), (Key::O, "Open volume")] {
            send_in_one_frame(&mut harness, ctrl_stroke(key));
            let start = std::time::Instant::now();
            while !is_path_dialog_open(&harness, title) {
                assert!(start.elapsed().as_secs() < 20, "{title}");
                std::thread::sleep(std::time::Duration::from_millis(20));
                harness.step();
            }
            harness.key_press(Key::Escape);
            harness.run_steps(4);
            assert!(!is_path_dialog_open(&harness, title));
        }
    }
    send_in_one_frame(&mut harness, vec![Event::PointerMoved(Pos2::ZERO)]);
    wait_until_idle(&mut harness);
}
