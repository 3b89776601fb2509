//! Descriptions of undo steps, in a few words that follow "Undo" and "Undone:".

use std::cmp::Ordering;

use crate::app::text;
use chiaroscuro_scene::{
    Camera, Clipping, LightSettings, OutputSettings, QualityPreset, RenderModeSettings, SavedEntry, Settings,
    ShadowSettings, TransferFunction, VolumeLayer,
};
use chiaroscuro_volume::Corrections;

/// Description of a step that only changes the kind of data for which the look was made.
pub(crate) const KIND_OF_DATA: &str = "change kind of data";

/// Describes the difference between two looks; `None` where they are equal.
pub(crate) fn describe_change(before: &Settings, after: &Settings) -> Option<String> {
    let Settings {
        schema: _,
        camera,
        lights,
        layers,
        mode,
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
    let VolumeLayer {
        range,
        labels,
        transfer,
        lighting,
        opacity_unit,
        visibility,
        blend,
        edges,
        materials,
        ignores_cuts,
    } = layers.first();
    let layer_after = after.layer();
    let with = |differs: bool, words: &str| differs.then(|| words.to_owned());
    let parts = [
        (*lights != after.lights).then(|| describe_lights(lights, &after.lights)),
        with(*camera != after.camera, describe_camera(camera, &after.camera)),
        with(*transfer != layer_after.transfer, describe_transfer(transfer, &layer_after.transfer)),
        with(*lighting != layer_after.lighting, "change opacity for light"),
        with(*labels != layer_after.labels, "change labels"),
        with(*range != layer_after.range, "change range of values"),
        with(*opacity_unit != layer_after.opacity_unit, "change opacity unit"),
        with(*edges != layer_after.edges, "change edges"),
        with(*materials != layer_after.materials, "change materials"),
        with(
            (visibility, blend, ignores_cuts)
                != (&layer_after.visibility, &layer_after.blend, &layer_after.ignores_cuts),
            "change layer",
        ),
        with(!layers.iter().skip(1).eq(after.layers.iter().skip(1)), describe_layers(before, after)),
        with(*mode != after.mode, describe_mode(mode, &after.mode)),
        with(*shading != after.shading, "change shading"),
        with(with_balance(&after.shadows, shadows.balance) != *shadows, "change shadows"),
        with(*sky != after.sky, "change sky"),
        with(*scattering != after.scattering, "change scattering"),
        with(*cuts != after.cuts, describe_cuts(cuts, &after.cuts)),
        (*floor != after.floor).then(|| describe_switch("floor", [floor.on, after.floor.on], "change floor")),
        with(*sampling != after.sampling, "change sampling"),
        with(*output != after.output, describe_output(output, &after.output)),
        with(*kept != after.kept, describe_saved_views(kept, &after.kept)),
        with(*volume != after.volume, describe_corrections(volume, &after.volume)),
    ];
    let changed: Vec<String> = parts.into_iter().flatten().collect();
    match &changed[..] {
        // A new balance follows from other changes and is named only where it is the only change.
        [] => (shadows.balance.to_bits() != after.shadows.balance.to_bits())
            .then(|| "balance lights".to_owned()),
        _ if is_quality(before, after) => Some("change quality".to_owned()),
        [one] => Some(one.clone()),
        [one, other] => Some(join_changes(one, other)),
        _ => Some("change look".to_owned()),
    }
}

/// Joins two changes into one phrase, with a common verb said once.
fn join_changes(one: &str, other: &str) -> String {
    let verb = "change ";
    let other = if one.starts_with(verb) { other.strip_prefix(verb).unwrap_or(other) } else { other };
    format!("{one} and {other}")
}

/// Returns true if the only change is another level of quality.
fn is_quality(before: &Settings, after: &Settings) -> bool {
    QualityPreset::from_settings(after).is_some_and(|level| {
        let mut chosen = before.clone();
        level.apply(&mut chosen);
        chosen.shadows.balance = after.shadows.balance;
        QualityPreset::from_settings(before) != Some(level) && chosen == *after
    })
}

/// Copies shadow settings with another balance.
fn with_balance(shadows: &ShadowSettings, balance: f64) -> ShadowSettings {
    ShadowSettings { balance, ..shadows.clone() }
}

/// Describes a switch that was turned on or off, or falls back to `other`.
fn describe_switch(name: &str, was_and_is_on: [bool; 2], other: &str) -> String {
    match was_and_is_on {
        [false, true] => format!("switch on {name}"),
        [true, false] => format!("switch off {name}"),
        _ => other.to_owned(),
    }
}

fn describe_camera(before: &Camera, after: &Camera) -> &'static str {
    let angles =
        |camera: &Camera| [camera.azimuth_deg, camera.elevation_deg, camera.roll_deg].map(f64::to_bits);
    if before.up != after.up {
        "turn object"
    } else if before.projection != after.projection {
        "change projection"
    } else if angles(before) != angles(after) {
        // Distance and target may have changed as well, to keep the object in frame.
        "turn camera"
    } else if before.target != after.target {
        "move camera"
    } else if before.distance.to_bits() != after.distance.to_bits() {
        "zoom"
    } else {
        "change field of view"
    }
}

fn describe_layers(before: &Settings, after: &Settings) -> &'static str {
    match before.layers.count().cmp(&after.layers.count()) {
        Ordering::Less => "add layer",
        Ordering::Greater => "remove layer",
        Ordering::Equal => "change layer",
    }
}

fn describe_lights(before: &[LightSettings], after: &[LightSettings]) -> String {
    if after.len() > before.len() {
        return "add light".to_owned();
    }
    if after.len() < before.len() {
        return "remove light".to_owned();
    }
    let changed: Vec<(&LightSettings, &LightSettings)> =
        before.iter().zip(after).filter(|(a, b)| a != b).collect();
    match changed[..] {
        [(a, b)] => describe_light(a, b),
        _ => "change lights".to_owned(),
    }
}

/// Describes the change of one light.
fn describe_light(a: &LightSettings, b: &LightSettings) -> String {
    let name = if b.name.is_empty() { text::lights::UNNAMED } else { &b.name };
    // True if `b` results from this change alone.
    let alone = |done: LightSettings| done == *b;
    if alone(LightSettings { name: b.name.clone(), ..a.clone() }) {
        "rename light".to_owned()
    } else if alone(LightSettings { position: b.position, ..a.clone() }) {
        format!("move {name}")
    } else if alone(LightSettings { on: b.on, ..a.clone() }) {
        describe_switch(name, [a.on, b.on], "")
    } else if alone(LightSettings { intensity: b.intensity, ..a.clone() }) {
        format!("change intensity of {name}")
    } else if alone(LightSettings { color: b.color, ..a.clone() }) {
        format!("change colour of {name}")
    } else {
        format!("change {name}")
    }
}

fn describe_transfer(before: &TransferFunction, after: &TransferFunction) -> &'static str {
    let has_all = |of: &TransferFunction, other: &TransferFunction| {
        other.points.iter().all(|point| of.points.contains(point))
    };
    // Adding a point beyond the ends of the curve adds a second one with it.
    let most_added = before.points.len() + 2;
    if (before.points.len() + 1..=most_added).contains(&after.points.len()) && has_all(after, before) {
        "add point of transfer function"
    } else if after.points.len() + 1 == before.points.len() && has_all(before, after) {
        "remove point of transfer function"
    } else {
        "change transfer function"
    }
}

fn describe_corrections(before: &Corrections, after: &Corrections) -> &'static str {
    let is_table_alone = Corrections { hidden_table: after.hidden_table, ..*before } == *after;
    match (is_table_alone, after.hidden_table) {
        (true, Some(_)) => "hide table",
        (true, None) => "show table",
        (false, _) => "correct file metadata",
    }
}

fn describe_mode(before: &RenderModeSettings, after: &RenderModeSettings) -> &'static str {
    if before.kind != after.kind {
        "change render mode"
    } else if before.isovalue != after.isovalue {
        "change isovalue"
    } else {
        "change light of the maximum"
    }
}

fn describe_cuts(before: &Clipping, after: &Clipping) -> &'static str {
    if before.shapes != after.shapes {
        return match before.shapes.len().cmp(&after.shapes.len()) {
            Ordering::Less => "cut by shape",
            Ordering::Greater => "remove cut",
            Ordering::Equal => "change cut",
        };
    }
    match (before.plane.on, after.plane.on, before.crop.on, after.crop.on) {
        (false, true, ..) => "switch on clip plane",
        (true, false, ..) => "switch off clip plane",
        (.., false, true) => "switch on crop box",
        (.., true, false) => "switch off crop box",
        _ if before.crop == after.crop => "move clip plane",
        _ if before.plane == after.plane => "change crop box",
        _ => "change clipping",
    }
}

fn describe_output(before: &OutputSettings, after: &OutputSettings) -> &'static str {
    if (OutputSettings { exposure: after.exposure, ..before.clone() }) == *after {
        "change exposure"
    } else if (OutputSettings { antialiasing: after.antialiasing, ..before.clone() }) == *after {
        "change antialiasing"
    } else {
        "change background"
    }
}

fn describe_saved_views(before: &[SavedEntry], after: &[SavedEntry]) -> &'static str {
    match after.len().cmp(&before.len()) {
        std::cmp::Ordering::Greater => "save view",
        std::cmp::Ordering::Less => "remove saved view",
        std::cmp::Ordering::Equal => "change saved views",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_scene::ControlPoint;

    fn change(of_settings: impl FnOnce(&mut Settings)) -> String {
        let before = Settings::default();
        let mut after = before.clone();
        of_settings(&mut after);
        describe_change(&before, &after).unwrap_or_default()
    }

    #[test]
    fn steps_say_what_was_done() {
        assert_eq!(describe_change(&Settings::default(), &Settings::default()), None);
        let named = |done: fn(&mut LightSettings)| {
            let mut before = Settings::default();
            before.lights[0].name = "Key".to_owned();
            let mut after = before.clone();
            done(&mut after.lights[0]);
            describe_change(&before, &after).unwrap_or_default()
        };
        assert_eq!(named(|light| light.position = [1.0; 3]), "move Key");
        assert_eq!(named(|light| light.name = "Lamp".to_owned()), "rename light");
        assert_eq!(named(|light| light.on = false), "switch off Key");
        assert_eq!(named(|light| light.intensity = 3.0), "change intensity of Key");
        assert_eq!(named(|light| light.color = [0.1; 3]), "change colour of Key");
        assert_eq!(named(|light| light.size = 0.7), "change Key");
        assert_eq!(change(|settings| settings.lights.push(LightSettings::default())), "add light");
        assert_eq!(change(|settings| settings.lights.clear()), "remove light");
        assert_eq!(change(|settings| settings.camera.azimuth_deg += 7.0), "turn camera");
        assert_eq!(change(|settings| settings.camera.distance *= 2.0), "zoom");
        assert_eq!(change(|settings| settings.camera.target[0] += 1.0), "move camera");
        assert_eq!(change(|settings| settings.floor.on = true), "switch on floor");
        assert_eq!(change(|settings| settings.floor.opacity = 0.123), "change floor");
        assert_eq!(change(|settings| settings.cuts.plane.on = true), "switch on clip plane");
        assert_eq!(change(|settings| settings.output.exposure = 2.0), "change exposure");
        assert_eq!(change(|settings| settings.shadows.balance = 2.0), "balance lights");
        let point = ControlPoint::new(1.0, [1.0; 3], 0.5);
        assert_eq!(
            change(|look| look.layer_mut().transfer.points.push(point)),
            "add point of transfer function"
        );
    }

    #[test]
    fn what_follows_a_change_is_not_named_beside_it() {
        let balanced = change(|settings| {
            settings.lights[0].intensity = 3.0;
            settings.shadows.balance = 2.0;
        });
        assert_eq!(balanced, format!("change intensity of {}", Settings::default().lights[0].name));
    }

    #[test]
    fn several_changes_have_a_name_too() {
        let two = change(|settings| {
            settings.floor.on = true;
            settings.camera.azimuth_deg = 3.0;
        });
        assert_eq!(two, "turn camera and switch on floor");
        let alike = change(|settings| {
            settings.shading.ambient = 0.9;
            settings.shadows.gain = 2.0;
        });
        assert_eq!(alike, "change shading and shadows");
        let all = change(|settings| {
            settings.floor.on = true;
            settings.camera.azimuth_deg = 3.0;
            settings.shadows.gain = 2.0;
        });
        assert_eq!(all, "change look");
        assert_eq!(change(|settings| QualityPreset::Exact.apply(settings)), "change quality");
    }
}
