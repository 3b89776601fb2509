//! Keyboard control of lights: turning by the arrow keys, and the operations of the light commands.

use eframe::egui::{self, Key, Modifiers};
use glam::{DQuat, DVec3};

use super::shortcuts::is_typing;
use chiaroscuro_scene::{Camera, LightSettings, Settings};

/// Angle per press of an arrow key, in degrees.
const NUDGE_DEG: f64 = 1.0;
/// Angle per press of an arrow key with Shift, in degrees.
const BIG_NUDGE_DEG: f64 = 10.0;
/// Factor of the intensity per step.
const INTENSITY_STEP: f64 = 1.1;

/// Turns the selected light by the arrow keys, unless a widget has the keyboard focus.
pub(crate) fn nudge(ctx: &egui::Context, settings: &mut Settings, selected: usize) {
    if is_typing(ctx) || ctx.memory(egui::Memory::focused).is_some() {
        return;
    }
    let Settings { camera, lights, .. } = settings;
    let Some(light) = lights.get_mut(selected) else { return };
    for (key, right, up) in [
        (Key::ArrowLeft, -1.0, 0.0),
        (Key::ArrowRight, 1.0, 0.0),
        (Key::ArrowUp, 0.0, 1.0),
        (Key::ArrowDown, 0.0, -1.0),
    ] {
        let big = ctx.input_mut(|input| input.count_and_consume_key(Modifiers::SHIFT, key)) as f64;
        let small = ctx.input_mut(|input| input.count_and_consume_key(Modifiers::NONE, key)) as f64;
        let degrees = big * BIG_NUDGE_DEG + small * NUDGE_DEG;
        if degrees != 0.0 {
            turn(light, camera, right * degrees, up * degrees);
        }
    }
}

/// Turns a light about the centre of the volume, to the right and upwards in view space.
pub(crate) fn turn(light: &mut LightSettings, camera: &Camera, right_deg: f64, up_deg: f64) {
    let view = camera.scene_from_view();
    let turn = DQuat::from_axis_angle(view.y_axis, right_deg.to_radians())
        * DQuat::from_axis_angle(view.x_axis, -up_deg.to_radians());
    let world = DVec3::from(light.resolve(camera).position);
    light.set_scene_position(turn * world, camera);
}

/// Switches all lights off except one; if they are off already, switches all lights on.
pub(crate) fn solo(lights: &mut [LightSettings], selected: usize) {
    let alone = lights.iter().enumerate().all(|(at, light)| light.on == (at == selected));
    for (at, light) in lights.iter_mut().enumerate() {
        light.on = alone || at == selected;
    }
}

/// Multiplies the intensity by [`INTENSITY_STEP`] per step, up to 1000. Brightening a light of intensity 0 starts
/// from 0.05.
pub(crate) fn brighten(light: &mut LightSettings, steps: i32) {
    let from = if light.intensity > 0.0 || steps < 0 { light.intensity } else { 0.05 };
    light.intensity = (from * INTENSITY_STEP.powi(steps)).min(1e3);
}

/// Returns the index of the light `by` places further, wrapping around at both ends.
pub(crate) fn cycle(count: usize, selected: usize, by: isize) -> usize {
    if count == 0 { 0 } else { (selected as isize + by).rem_euclid(count as isize) as usize }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lights_turn_as_the_eye_sees_it() {
        let camera = Camera::default();
        let view = camera.scene_from_view();
        let mut light = LightSettings { position: (view.z_axis * 3.0).into(), ..LightSettings::default() };
        turn(&mut light, &camera, 10.0, 0.0);
        let seen = view.transpose() * DVec3::from(light.position);
        assert!((seen.x - 3.0 * 10f64.to_radians().sin()).abs() < 1e-9, "{seen}: to the right");
        turn(&mut light, &camera, -10.0, 0.0);
        turn(&mut light, &camera, 0.0, 10.0);
        let seen = view.transpose() * DVec3::from(light.position);
        assert!((seen.y - 3.0 * 10f64.to_radians().sin()).abs() < 1e-9, "{seen}: up");
    }

    #[test]
    fn solo_twice_is_as_before() {
        let mut lights = vec![LightSettings::default(); 3];
        let on = |lights: &[LightSettings]| lights.iter().map(|light| light.on).collect::<Vec<_>>();
        solo(&mut lights, 1);
        assert_eq!(on(&lights), [false, true, false]);
        solo(&mut lights, 2);
        assert_eq!(on(&lights), [false, false, true]);
        solo(&mut lights, 2);
        assert_eq!(on(&lights), [true; 3]);
    }

    #[test]
    fn selection_goes_around() {
        assert_eq!([cycle(3, 2, 1), cycle(3, 0, -1), cycle(0, 5, 1)], [0, 2, 0]);
    }

    #[test]
    fn brightness_goes_up_and_down_and_out_of_the_dark() {
        let mut light = LightSettings { intensity: 1.0, ..LightSettings::default() };
        brighten(&mut light, 1);
        brighten(&mut light, -1);
        assert!((light.intensity - 1.0).abs() < 1e-12);
        light.intensity = 0.0;
        brighten(&mut light, 1);
        assert!(light.intensity > 0.0);
    }
}
