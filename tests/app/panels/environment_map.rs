//! Tests of lighting by an environment map, chosen in the section of the sky.

use chiaroscuro_scene::{ENVIRONMENT_LIGHT_NAME, SkyMode};
use eframe::egui;

use crate::harness::{wait_until, wait_until_idle, window};

#[test]
fn a_panorama_is_chosen_and_lights_the_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("yard.hdr");
    let panorama = image::Rgb32FImage::from_fn(64, 32, |x, y| {
        image::Rgb(if (x, y) == (10, 8) { [4000.0; 3] } else { [0.5, 0.6, 0.8] })
    });
    panorama.save(&path).expect("the folder can be written to");
    let mut harness = window();
    let before = harness.state().settings().clone();
    let ctx = harness.ctx.clone();
    harness.state_mut().read_environment_map(&path, &ctx);
    wait_until(&mut harness, "the panorama is read", |app| app.settings().sky.mode == SkyMode::Picture);
    let settings = harness.state().settings().clone();
    assert_eq!(settings.sky.picture.name, "yard.hdr");
    assert_eq!(settings.lights[0].name, ENVIRONMENT_LIGHT_NAME);
    wait_until_idle(&mut harness);
    // One undo step reverts all of it.
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(2);
    assert_eq!(harness.state().settings().lights, before.lights);
    assert_eq!(harness.state().settings().sky, before.sky);
    wait_until_idle(&mut harness);
}
