//! Built-in presets: transfer functions and materials by domain.
//!
//! Values are data values if a domain has units (Hounsfield units for CT), else shares of the look's range
//! (`"_values": "relative"`). Light presets fit any data: they set a sky and multiple scattering. The paper's also
//! set shadows and sheets as in the paper, and the benchmark's sets everything. Scenes belong to one built-in volume
//! each, with camera and lights. All others leave camera, lights, shadows and sampling unchanged.

use serde_json::Value;

use super::layer_fields::{first_layer, move_into_layer};
use crate::{AppliedSettings, PresetError, Settings, apply_json};
use chiaroscuro_volume::{DataKind, ValueRanges};

/// Preset of the built-in library.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Preset {
    /// Name on the command line, `domain/name`, as `--preset` takes it.
    pub name: &'static str,
    /// Title in menus, unique among the presets.
    pub title: &'static str,
    text: &'static str,
}

macro_rules! presets {
    ($($name:literal: $title:literal),+ $(,)?) => {
        [$(Preset {
            name: $name,
            title: $title,
            text: include_str!(concat!("../../../../presets/", $name, ".json")),
        }),+]
    };
}

/// All built-in presets, grouped by domain.
pub const PRESETS: [Preset; 27] = presets![
    "ct/bone": "Bone",
    "ct/muscle_and_skin": "Muscle and skin",
    "ct/angiography": "CT angiography",
    "ct/lung": "Lung",
    "mr/head": "Head",
    "mr/angiography": "MR angiography",
    "microscopy/fluorescence": "Fluorescence",
    "microscopy/stained_tissue": "Stained tissue",
    "simulation/fuel": "Spray",
    "simulation/cloud": "Vapour",
    "simulation/signed": "Plus and minus",
    "light/studio": "Studio",
    "light/overcast": "Overcast",
    "light/window": "Window light",
    "light/hollows": "Hollows",
    "light/wax": "Wax",
    "light/cloud": "Sunlit cloud",
    "light/ink_drawing": "Ink drawing",
    "paper/lobster": "Lobster",
    "paper/fuel": "Fuel injection",
    "paper/chair": "Chair",
    "bench/creature": "Creature",
    "scene/bone": "Carved bone",
    "scene/cloud": "Evening cloud",
    "scene/wax": "Wax rabbit",
    "scene/stained_glass": "Rose window",
    "scene/cells": "Cell cluster",
];

impl Preset {
    /// Returns the preset with the given name.
    pub fn find(name: &str) -> Option<Self> {
        PRESETS.into_iter().find(|preset| preset.name == name)
    }

    /// Returns the JSON text of the preset.
    pub fn json(&self) -> &'static str {
        self.text
    }

    /// Returns the domain, the first part of the name.
    pub fn domain(&self) -> &'static str {
        self.name.split_once('/').map_or("", |(domain, _)| domain)
    }

    /// Returns the domain's title above a list.
    pub fn domain_title(&self) -> &'static str {
        match self.domain() {
            "ct" => "CT (Hounsfield units)",
            "mr" => "Magnetic resonance",
            "microscopy" => "Microscopy",
            "simulation" => "Simulation",
            "light" => "Light, for any data",
            "paper" => "Splatting with shadows",
            "scene" => "Built-in scenes",
            other => other,
        }
    }

    /// Returns the name of the built-in volume whose scene this is; `None` for presets that fit other volumes.
    pub fn scene_volume(&self) -> Option<&'static str> {
        self.name.strip_prefix("scene/")
    }

    /// Returns true if menus offer the preset for any volume: the benchmark's is for the command line, and scenes are
    /// opened with their volume.
    pub fn is_offered(&self) -> bool {
        self.domain() != "bench" && self.scene_volume().is_none()
    }

    /// Returns true if the preset suits the kind of data: CT presets refer to Hounsfield units, and show nothing, or
    /// a solid block, in other data, including scans whose values are offset by 1024.
    pub fn suits_data(&self, kind: &DataKind) -> bool {
        self.domain() != "ct" || matches!(kind, DataKind::HounsfieldCt { water } if *water == 0.0)
    }

    /// Returns the description of the preset.
    pub fn description(&self) -> String {
        let value: Value = serde_json::from_str(self.text).unwrap_or_default();
        value.get("_about").and_then(Value::as_str).unwrap_or_default().to_owned()
    }

    /// Applies the preset to settings, for a volume with the given value ranges.
    ///
    /// # Errors
    /// As [`apply_json`]; a test proves that it does not happen.
    pub fn apply(&self, settings: &Settings, ranges: &ValueRanges) -> Result<Settings, PresetError> {
        let overlay: Value = serde_json::from_str(self.text).map_err(PresetError::Syntax)?;
        apply_relative(settings, &overlay, ranges).map(|applied| applied.settings)
    }

    /// Returns true if applying the preset to the settings would change nothing.
    pub fn is_in_use(&self, settings: &Settings, ranges: &ValueRanges) -> bool {
        self.apply(settings, ranges).is_ok_and(|applied| applied == *settings)
    }
}

/// Applies a preset as [`apply_json`] does, with support for relative values, which are shares of the look's range
/// for a volume with the given value ranges. The volume's corrections are not changed.
///
/// # Errors
/// As [`apply_json`].
pub fn apply_relative(
    settings: &Settings,
    overlay: &Value,
    ranges: &ValueRanges,
) -> Result<AppliedSettings, PresetError> {
    let AppliedSettings { settings: mut applied, mut warnings } = apply_json(settings, overlay)?;
    // A look applies to any volume; corrections apply only to their file.
    let applied_corrections = std::mem::replace(&mut applied.volume, settings.volume);
    if applied_corrections != settings.volume
        && !applied_corrections.is_none()
        && overlay.get("_volume").is_none()
    {
        warnings.push(
            "corrections of a volume (`volume`) were ignored: a preset applies to any volume".to_owned(),
        );
    }
    let layer = applied.layer_mut();
    let range = layer.range.resolve(ranges);
    if overlay.get("_values").and_then(Value::as_str) == Some("relative") {
        let mut given = overlay.clone();
        move_into_layer(&mut given);
        let has = |path: &str| first_layer(&given).is_some_and(|layer| layer.pointer(path).is_some());
        let curves = [
            (has("/transfer/points"), &mut layer.transfer),
            (has("/lighting/curve/points"), &mut layer.lighting.curve),
        ];
        for (_, function) in curves.into_iter().filter(|(given, _)| *given) {
            for point in &mut function.points {
                point.value = range.value_at(point.value);
            }
        }
        for material in layer.materials.iter_mut().filter(|_| has("/materials")) {
            material.values = material.values.map(|value| range.value_at(value));
            material.changes = material.changes.map(|change| range.span() * change);
        }
    }
    Ok(AppliedSettings { settings: applied, warnings })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DensityRange;
    use chiaroscuro_volume::{ValueRange, synthetic::builtin};

    #[test]
    fn presets_of_ct_suit_hounsfield_units_alone() {
        let bone = Preset::find("ct/bone").unwrap();
        assert!(bone.suits_data(&DataKind::HounsfieldCt { water: 0.0 }));
        assert!(
            !bone.suits_data(&DataKind::HounsfieldCt { water: 1024.0 })
                && !bone.suits_data(&DataKind::Scalar)
        );
        assert!(Preset::find("mr/head").unwrap().suits_data(&DataKind::Scalar));
    }

    #[test]
    fn presets_are_valid_understood_and_show_something() {
        for preset in PRESETS {
            let overlay: Value = serde_json::from_str(preset.text).unwrap();
            let ranges = ValueRanges::without_outliers(ValueRange::new(-1000.0, 3000.0));
            let AppliedSettings { settings, warnings } =
                apply_relative(&Settings::default(), &overlay, &ranges).unwrap();
            assert!(warnings.is_empty(), "{}: {warnings:?}", preset.name);
            assert_eq!(preset.apply(&Settings::default(), &ranges).unwrap(), settings);
            let points = &settings.layer().transfer.points;
            assert!(points.windows(2).all(|pair| pair[0].value <= pair[1].value), "{}", preset.name);
            // Light presets work with any curve, and labels have no curve.
            let is_seen =
                points.iter().any(|point| point.opacity > 0.05) || !settings.layer().labels.is_empty();
            assert!(is_seen || preset.domain() == "light" && settings.sky.is_on(), "{}", preset.name);
            assert!(
                !preset.description().is_empty() && !preset.title.is_empty() && !preset.domain().is_empty()
            );
        }
    }

    #[test]
    fn scenes_belong_to_built_in_volumes_and_light_them() {
        let scenes = PRESETS.into_iter().filter_map(|preset| Some((preset, preset.scene_volume()?)));
        let mut count = 0;
        for (preset, name) in scenes {
            let volume = builtin(name, Some(32)).unwrap();
            let scene = preset.apply(&Settings::default(), &volume.ranges()).unwrap();
            assert!(!preset.is_offered() && !scene.shadows.keep_balanced, "{name}");
            assert!(scene.lights.iter().any(|light| light.on && light.casts_shadows), "{name}");
            // A look-up by label is for label maps alone, and shows all labels that there are.
            assert_eq!(scene.layer().labels.is_empty(), !volume.is_label_map(), "{name}");
            let labels = volume.labels().filter(|_| volume.is_label_map());
            for label in labels.iter().flat_map(|set| set.labels()).filter(|label| label.number > 0) {
                assert!(scene.layer().labels.get(label.number).is_some(), "{name} lacks {}", label.number);
            }
            let points = &scene.layer().transfer.points;
            let range = volume.value_range();
            assert!(points.iter().all(|point| range.low <= point.value), "{name}");
            count += 1;
        }
        assert_eq!(count, 5);
    }

    #[test]
    fn no_two_presets_have_the_same_title() {
        for (at, preset) in PRESETS.iter().enumerate() {
            let others = &PRESETS[..at];
            let is_other = |other: &Preset| !other.title.eq_ignore_ascii_case(preset.title);
            assert!(others.iter().all(is_other), "{}: {}", preset.name, preset.title);
        }
    }

    #[test]
    fn names_of_the_command_line_stay() {
        for name in ["simulation/cloud", "light/cloud", "simulation/fuel", "paper/fuel", "ct/angiography"] {
            assert_eq!(Preset::find(name).map(|preset| preset.name), Some(name));
        }
    }

    #[test]
    fn presets_are_in_use_until_something_of_them_changes() {
        let ranges =
            ValueRanges { all: ValueRange::new(-1024.0, 3000.0), robust: ValueRange::new(-1000.0, 1200.0) };
        for preset in PRESETS {
            let first = Settings::default();
            assert!(!preset.is_in_use(&first, &ranges), "{}", preset.name);
            let mut used = preset.apply(&first, &ranges).unwrap();
            used.sanitise();
            assert!(preset.is_in_use(&used, &ranges), "{}", preset.name);
            // A preset without a camera allows it to turn.
            used.camera.azimuth_deg += 20.0;
            let has_camera = preset.domain() == "bench" || preset.scene_volume().is_some();
            assert_eq!(preset.is_in_use(&used, &ranges), !has_camera, "{}", preset.name);
            for point in &mut used.layer_mut().transfer.points {
                point.opacity *= 0.5;
            }
            used.sky.intensity += 0.1;
            used.scattering.bounces += 1;
            assert!(!preset.is_in_use(&used, &ranges), "{}", preset.name);
        }
    }

    #[test]
    fn every_preset_of_the_folder_is_in_the_library() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets");
        let mut found = 0;
        for domain in std::fs::read_dir(folder).unwrap() {
            let domain = domain.unwrap();
            for file in std::fs::read_dir(domain.path()).unwrap() {
                let file = file.unwrap().path();
                let title = file.file_stem().unwrap().to_str().unwrap();
                let name = format!("{}/{title}", domain.file_name().to_str().unwrap());
                assert!(Preset::find(&name).is_some(), "{name}");
                found += 1;
            }
        }
        assert_eq!(found, PRESETS.len());
    }

    #[test]
    fn what_is_known_of_a_file_is_neither_in_a_preset_nor_changed_by_one() {
        let ranges = ValueRanges::without_outliers(ValueRange::new(-1000.0, 3000.0));
        let mut over = Settings::default();
        over.volume.spacing = Some([0.5, 0.5, 2.0]);
        for preset in PRESETS {
            let own: Value = serde_json::from_str(preset.text).unwrap();
            assert_eq!(own.get("volume"), None, "{}", preset.name);
            assert_eq!(preset.apply(&over, &ranges).unwrap().volume, over.volume);
        }
        let own = serde_json::json!({"shadows": {"gain": 2.0}, "volume": {"flip": {"x": true}}});
        let AppliedSettings { settings: applied, warnings } = apply_relative(&over, &own, &ranges).unwrap();
        assert_eq!((applied.volume, applied.shadows.gain), (over.volume, 2.0));
        assert!(warnings.len() == 1 && warnings[0].contains("`volume`"), "{warnings:?}");
        // A complete look without corrections does not affect them.
        let whole = serde_json::to_value(Settings::default()).unwrap();
        let AppliedSettings { settings: applied, warnings } = apply_relative(&over, &whole, &ranges).unwrap();
        assert_eq!((applied.volume, warnings), (over.volume, Vec::<String>::new()));
    }

    #[test]
    fn relative_values_follow_the_range_and_others_do_not() {
        let ranges = ValueRanges { all: ValueRange::new(0.0, 1000.0), robust: ValueRange::new(100.0, 300.0) };
        let over = Settings::default();
        let head = Preset::find("mr/head").unwrap().apply(&over, &ranges).unwrap();
        assert!((head.layer().transfer.points[0].value - 112.0).abs() < 1e-9);
        let all = over.clone().with_range(DensityRange::Full);
        let head = Preset::find("mr/head").unwrap().apply(&all, &ranges).unwrap();
        assert!((head.layer().transfer.points[0].value - 60.0).abs() < 1e-9);
        let bone = Preset::find("ct/bone").unwrap().apply(&over, &ranges).unwrap();
        assert_eq!(bone.layer().transfer.points[0].value, 150.0);
        assert_eq!((&bone.lights, &bone.camera, &bone.shadows), (&over.lights, &over.camera, &over.shadows));
    }
}
