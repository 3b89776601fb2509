//! What a step of the history changes, in a few words.

use crate::app::text;
use crate::model::{Light, Settings, Shadows};

/// Where only the kind of data changes for which the look was made.
pub(crate) const KIND_OF_DATA: &str = "kind of data";

/// What differs between two looks; `None` where nothing does.
pub(crate) fn of(before: &Settings, after: &Settings) -> Option<String> {
    let Settings {
        schema: _,
        camera,
        lights,
        range,
        labels,
        transfer,
        lighting,
        opacity_unit,
        shading,
        shadows,
        sky,
        scattering,
        cuts,
        floor,
        sampling,
        output,
        kept,
        volume,
    } = before;
    let parts = [
        (*lights != after.lights, "lights"),
        (*camera != after.camera, "view"),
        (*transfer != after.transfer, "transfer function"),
        (*lighting != after.lighting, "light opacity"),
        (*labels != after.labels, "labels"),
        (*range != after.range, "range of values"),
        (*opacity_unit != after.opacity_unit, "opacity unit"),
        (*shading != after.shading, "shading"),
        (with_balance(&after.shadows, shadows.balance) != *shadows, "shadows"),
        (*sky != after.sky, "sky"),
        (*scattering != after.scattering, "scattering"),
        (*cuts != after.cuts, "cut"),
        (*floor != after.floor, "floor"),
        (*sampling != after.sampling, "sampling"),
        (*output != after.output, "exposure and background"),
        (*kept != after.kept, "kept views and looks"),
        (*volume != after.volume, "corrections of the file"),
    ];
    let changed: Vec<&str> =
        parts.into_iter().filter(|(differs, _)| *differs).map(|(_, name)| name).collect();
    match changed[..] {
        // It follows what else changes, and is nobody's doing then.
        [] if shadows.balance.to_bits() != after.shadows.balance.to_bits() => Some("balance".to_owned()),
        [] => None,
        ["lights"] => Some(of_lights(lights, &after.lights)),
        [one] => Some(one.to_owned()),
        [one, other] => Some(format!("{one} and {other}")),
        // More than that is another look.
        _ => Some("look".to_owned()),
    }
}

/// Shadows with another balance.
fn with_balance(shadows: &Shadows, balance: f64) -> Shadows {
    Shadows { balance, ..shadows.clone() }
}

fn of_lights(before: &[Light], after: &[Light]) -> String {
    if after.len() > before.len() {
        return "adding a light".to_owned();
    }
    if after.len() < before.len() {
        return "removing a light".to_owned();
    }
    let changed: Vec<(&Light, &Light)> = before.iter().zip(after).filter(|(a, b)| a != b).collect();
    let [(a, b)] = changed[..] else { return "lights".to_owned() };
    let name = if b.name.is_empty() { text::lights::UNNAMED } else { &b.name };
    let moved = Light { position: b.position, ..a.clone() };
    if moved == *b { format!("moving {name}") } else { name.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Settings;

    fn change(of_settings: impl FnOnce(&mut Settings)) -> Option<String> {
        let before = Settings::default();
        let mut after = before.clone();
        of_settings(&mut after);
        of(&before, &after)
    }

    #[test]
    fn steps_have_names() {
        let said = |found: Option<String>| found.unwrap_or_default();
        assert_eq!(change(|_| {}), None);
        assert_eq!(said(change(|settings| settings.lights[0].position = [1.0; 3])), "moving Light");
        assert_eq!(said(change(|settings| settings.lights[0].intensity = 3.0)), "Light");
        assert_eq!(said(change(|settings| settings.lights.push(Light::default()))), "adding a light");
        assert_eq!(said(change(|settings| settings.lights.clear())), "removing a light");
        assert_eq!(said(change(|settings| settings.floor.on = true)), "floor");
        assert_eq!(said(change(|settings| settings.shadows.balance = 2.0)), "balance");
        let balanced = said(change(|settings| {
            settings.lights[0].intensity = 3.0;
            settings.shadows.balance = 2.0;
        }));
        assert_eq!(balanced, "Light");
        let two = said(change(|settings| {
            settings.floor.on = true;
            settings.camera.azimuth_deg = 3.0;
        }));
        assert_eq!(two, "view and floor");
        let all = said(change(|settings| {
            settings.floor.on = true;
            settings.camera.azimuth_deg = 3.0;
            settings.shadows.gain = 2.0;
        }));
        assert_eq!(all, "look");
    }
}
