//! Label table: name, colour, opacity and visibility by label number, in place of a transfer function over values.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::{
    ColorMixing, ControlPoint, Easing, MAX_NAME_CHARS, MAX_POINTS, OpacityInterpolation, Settings,
    TransferFunction, label_color,
};
use chiaroscuro_files::sanitised_line;
use chiaroscuro_volume::{DensityMapping, LabelSet, ValueRanges, Volume};

/// Default opacity of a label: it hides the material behind it within a voxel or two.
const DEFAULT_OPACITY: f64 = 0.9;

/// Half the width of a class around its number.
const HALF_CLASS: f64 = 0.5;

/// Appearance of a label.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LabelLook {
    /// Display name; may be empty.
    pub name: String,
    /// Colour as sRGB, 0 … 1.
    pub color: [f32; 3],
    /// Opacity per opacity unit, 0 … 1.
    pub opacity: f64,
    /// Shows the label; hidden ones have no material.
    pub visible: bool,
}

impl LabelLook {
    /// Returns the default look of a label: the colour of its number. Numbers of 0 and below are background and
    /// hidden.
    pub fn default_for(number: i64) -> Self {
        Self {
            name: String::new(),
            color: label_color(number),
            opacity: DEFAULT_OPACITY,
            visible: number > 0,
        }
    }

    /// Returns the opacity used for rendering: 0 if hidden.
    pub fn effective_opacity(&self) -> f64 {
        if self.visible { self.opacity } else { 0.0 }
    }
}

/// Partial look as a file gives it; missing parts keep their defaults.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct PartialLabelLook {
    name: Option<String>,
    color: Option<[f32; 3]>,
    opacity: Option<f64>,
    visible: Option<bool>,
}

/// Looks by label number, at most [`MAX_POINTS`]; labels without an entry have the look of [`LabelLook::default_for`].
///
/// In JSON an object with the numbers as keys; an entry may omit parts of a look. Copies share the entries.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(from = "Option<BTreeMap<i64, PartialLabelLook>>", into = "BTreeMap<i64, LabelLook>")]
pub struct LabelTable(Arc<BTreeMap<i64, LabelLook>>);

impl PartialEq for LabelTable {
    fn eq(&self, other: &Self) -> bool {
        // Settings are compared in every frame.
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

impl From<Option<BTreeMap<i64, PartialLabelLook>>> for LabelTable {
    fn from(named: Option<BTreeMap<i64, PartialLabelLook>>) -> Self {
        let look = |(number, named): (i64, PartialLabelLook)| {
            let LabelLook { name, color, opacity, visible } = LabelLook::default_for(number);
            let look = LabelLook {
                name: named.name.unwrap_or(name),
                color: named.color.unwrap_or(color),
                opacity: named.opacity.unwrap_or(opacity),
                visible: named.visible.unwrap_or(visible),
            };
            (number, look)
        };
        named.into_iter().flatten().map(look).collect()
    }
}

impl From<LabelTable> for BTreeMap<i64, LabelLook> {
    fn from(table: LabelTable) -> Self {
        Arc::unwrap_or_clone(table.0)
    }
}

impl FromIterator<(i64, LabelLook)> for LabelTable {
    fn from_iter<I: IntoIterator<Item = (i64, LabelLook)>>(looks: I) -> Self {
        Self(Arc::new(looks.into_iter().collect()))
    }
}

impl LabelTable {
    /// Returns true if the table has no entries: volumes are then shown by their values.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the number of entries.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Returns the entry of a label number.
    pub fn get(&self, number: i64) -> Option<&LabelLook> {
        self.0.get(&number)
    }

    /// Iterates over all entries by number.
    pub fn iter(&self) -> impl Iterator<Item = (i64, &LabelLook)> {
        self.0.iter().map(|(&number, look)| (number, look))
    }

    /// Returns the look of a label: its entry or the default.
    pub fn look_or_default(&self, number: i64) -> Cow<'_, LabelLook> {
        self.get(number).map_or_else(|| Cow::Owned(LabelLook::default_for(number)), Cow::Borrowed)
    }

    /// Returns the entry of a label number for changes; creates it if missing.
    pub fn entry_mut(&mut self, number: i64) -> &mut LabelLook {
        Arc::make_mut(&mut self.0).entry(number).or_insert_with(|| LabelLook::default_for(number))
    }

    /// Applies a change to every entry.
    pub fn modify_all(&mut self, change: impl Fn(i64, &mut LabelLook)) {
        for (&number, look) in Arc::make_mut(&mut self.0).iter_mut() {
            change(number, look);
        }
    }

    /// Returns the table with all names empty.
    #[must_use]
    pub fn without_names(&self) -> Self {
        if self.0.values().all(|look| look.name.is_empty()) {
            return self.clone();
        }
        self.iter()
            .map(|(number, look)| (number, LabelLook { name: String::new(), ..look.clone() }))
            .collect()
    }

    /// Returns number, colour and opacity of each entry, without names: the part that affects the image.
    pub fn materials(&self) -> Vec<LabelMaterial> {
        let material = |(number, look): (i64, &LabelLook)| LabelMaterial {
            number,
            color: look.color,
            opacity: look.effective_opacity(),
        };
        self.iter().map(material).collect()
    }

    /// Returns a step function over the classes of labels: between half a class below and half a class above, it has
    /// the look of the label that represents the class.
    pub fn step_function(&self, labels: &LabelSet) -> TransferFunction {
        let step = |class: usize| {
            let look = self.look_or_default(labels.representative_of_class(class).number);
            let point = ControlPoint::new(class as f64 - HALF_CLASS, look.color, look.effective_opacity());
            ControlPoint { easing: Easing::Step, ..point }
        };
        let points = (0..labels.class_count()).map(step).collect();
        TransferFunction { points, interpolation: OpacityInterpolation::Opacity, mixing: ColorMixing::Light }
    }

    /// Truncates names and the table to their largest lengths, and clamps numbers to their ranges.
    pub(crate) fn sanitise(&mut self) {
        let is_sane = |look: &LabelLook| {
            (0.0..=1.0).contains(&look.opacity)
                && look.color.iter().all(|c| (0.0..=1.0).contains(c))
                && sanitised_line(&look.name, MAX_NAME_CHARS) == look.name
        };
        if self.len() <= MAX_POINTS && self.0.values().all(is_sane) {
            return;
        }
        let table = Arc::make_mut(&mut self.0);
        while table.len() > MAX_POINTS {
            table.pop_last();
        }
        for LabelLook { name, color, opacity, visible: _ } in table.values_mut() {
            *name = sanitised_line(name, MAX_NAME_CHARS);
            *color = color.map(|c| if c.is_finite() { c.clamp(0.0, 1.0) } else { 1.0 });
            *opacity = if opacity.is_finite() { opacity.clamp(0.0, 1.0) } else { 0.0 };
        }
    }
}

/// Rendered colour and opacity of a label.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LabelMaterial {
    /// Label number stored in the voxels.
    pub number: i64,
    /// Colour as sRGB, 0 … 1.
    pub color: [f32; 3],
    /// Opacity per opacity unit; 0 if hidden.
    pub opacity: f64,
}

impl Settings {
    /// Returns the meaning of densities in images of a volume with these value ranges: values or label classes.
    pub fn shown_content(&self, ranges: &ValueRanges) -> DensityMapping {
        if self.layer().labels.is_empty() {
            DensityMapping::Range(self.shown_range(ranges))
        } else {
            DensityMapping::Labels
        }
    }

    /// Returns the settings as used for rendering a volume: those of its [mode](Self::resolved_mode), and if it is
    /// shown by labels, the transfer function is made of their looks over their classes, light uses the same, and
    /// voxels are classified before they are spread. Keys do not change.
    pub fn resolved_for(&self, volume: &Volume) -> Cow<'_, Self> {
        if self.layer().labels.is_empty() {
            return self.resolved_mode_and_materials(volume);
        }
        let Some(labels) = volume.labels() else { return Cow::Borrowed(self) };
        let mut drawn = self.clone();
        drawn.layer_mut().transfer = self.layer().labels.step_function(labels);
        drawn.layer_mut().lighting.linked = true;
        drawn.sampling.classification = self.classification();
        Cow::Owned(drawn)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use half::f16;

    use super::*;
    use crate::{
        AppliedSettings, BakedTransfer, ClassificationOrder, OpacityLength, apply_path, load_json,
        settings_to_json,
    };
    use chiaroscuro_volume::{MAX_CLASSES, Samples};

    /// Creates a volume with the given labels in a row.
    fn volume(numbers: Vec<i32>) -> Volume {
        let dims = [numbers.len(), 1, 1];
        Volume::with_spacing("t", dims, DVec3::ONE, Samples::I32(numbers))
            .unwrap()
            .with_density_mapping(DensityMapping::Labels)
    }

    fn baked(settings: &Settings, volume: &Volume) -> BakedTransfer {
        settings.resolved_for(volume).bake_eye(volume.table_range(), &volume.scene())
    }

    fn with(labels: LabelTable) -> Settings {
        Settings::default().with_labels(labels).with_opacity_unit(OpacityLength::Mm(1.0))
    }

    /// Returns a look that is unique to a number.
    fn unmistakable(number: i64) -> LabelLook {
        let share = |by: i64| ((number * by).rem_euclid(251) as f32 + 1.0) / 256.0;
        let opacity = f64::from(share(101));
        LabelLook { color: [share(1), share(7), share(31)], opacity, ..LabelLook::default_for(number) }
    }

    #[test]
    fn every_label_has_its_look_and_nothing_of_another() {
        for count in 2..=MAX_CLASSES {
            let numbers: Vec<i32> = (0..count).map(|rank| 3 * rank as i32 + 1).collect();
            let volume = volume(numbers.clone());
            let looks = numbers.iter().map(|&number| (i64::from(number), unmistakable(number.into())));
            let settings = with(looks.collect());
            let table = baked(&settings, &volume);
            let wanted = settings.resolved_for(&volume).into_owned().layer().transfer.clone();
            for (rank, density) in volume.slice_densities(0).into_iter().enumerate() {
                let look = settings.layer().labels.look_or_default(numbers[rank].into());
                assert_eq!(wanted.opacity_at(rank as f64) as f32, look.opacity as f32);
                let own = table.entries[(rank as f64 * 1023.0 / (count - 1) as f64).round() as usize];
                let unorm = (density * 65535.0).round() / 65535.0;
                for stored in [f16::from_f32(density).to_f32(), unorm] {
                    let at = f64::from(stored) * 1023.0;
                    let low = (at as usize).min(1022);
                    for entry in low..=low + usize::from(at > low as f64) {
                        assert_eq!(table.entries[entry], own, "{count} labels, {rank}");
                    }
                }
            }
        }
    }

    #[test]
    fn numbers_do_not_matter_and_their_order_decides_densities_alone() {
        let before = [0, 3, 9, 3, 200];
        let looks = [(0, 0), (3, 1), (9, 2), (200, 3)];
        let look = |at: i64| LabelLook { visible: true, ..unmistakable(10 + at) };
        let material = |volume: &Volume, settings: &Settings| -> Vec<[f64; 4]> {
            let table = baked(settings, volume);
            volume.slice_densities(0).into_iter().map(|density| table.sample(f64::from(density))).collect()
        };
        let table = |renumbered: &dyn Fn(i32) -> i32| {
            let entries = looks.map(|(number, at)| (i64::from(renumbered(number)), look(at)));
            let settings = with(entries.into_iter().collect());
            (volume(before.map(renumbered).to_vec()), settings)
        };
        let (plain, settings) = table(&|number| number);
        let (kept, kept_settings) = table(&|number| 2 * number + 1000);
        assert_eq!(kept.slice_densities(0), plain.slice_densities(0));
        assert_eq!(baked(&kept_settings, &kept), baked(&settings, &plain));
        let (turned, turned_settings) = table(&|number| 500 - number);
        assert_ne!(turned.slice_densities(0), plain.slice_densities(0));
        assert_eq!(material(&turned, &turned_settings), material(&plain, &settings));
    }

    #[test]
    fn what_is_hidden_has_no_material_for_eye_and_light() {
        let volume = volume(vec![0, 1, 2]);
        let mut settings =
            with([(2, LabelLook { visible: false, ..LabelLook::default_for(2) })].into_iter().collect());
        // A lighting curve makes no sense over labels.
        settings.layer_mut().lighting.linked = false;
        settings.layer_mut().lighting.scale = 0.5;
        let drawn = settings.resolved_for(&volume);
        let (range, scene) = (volume.table_range(), volume.scene());
        let (eye, light) = (drawn.bake_eye(range, &scene), drawn.bake_lighting(range, &scene));
        assert_eq!([0.0, 1.0].map(|density| eye.sample(density)[3]), [0.0; 2]);
        assert!(eye.sample(0.5)[3] > 0.0);
        for (eye, light) in eye.entries.iter().zip(&light.entries) {
            assert_eq!(0.5 * eye[3], light[3]);
        }
        assert_eq!(settings.classification(), ClassificationOrder::Pre);
        assert_eq!(drawn.sampling.classification, ClassificationOrder::Pre);
        assert_eq!(
            settings.with_density_range(chiaroscuro_volume::ValueRange::new(-5.0, 5.0), &volume.ranges()),
            settings
        );
        // Applying it twice changes nothing.
        assert_eq!(drawn.resolved_for(&volume), drawn);
    }

    #[test]
    fn without_a_table_nothing_changes() {
        let volume = volume(vec![0, 1, 2]);
        let settings = Settings::default();
        assert!(matches!(settings.resolved_for(&volume), Cow::Borrowed(same) if *same == settings));
        assert_eq!(settings.shown_content(&volume.ranges()), DensityMapping::Range(volume.ranges().robust));
        // Nor for a volume without labels.
        let fields = Volume::with_spacing("t", [2, 1, 1], DVec3::ONE, Samples::F32(vec![0.0, 0.5])).unwrap();
        let settings = with([(1, LabelLook::default_for(1))].into_iter().collect());
        assert!(matches!(settings.resolved_for(&fields), Cow::Borrowed(_)));
    }

    #[test]
    fn tables_are_written_by_number_and_read_in_part() {
        let look = LabelLook { name: "Left lung".to_owned(), visible: false, ..LabelLook::default_for(17) };
        let settings = with([(17, look), (-3, LabelLook::default_for(-3))].into_iter().collect());
        let text = settings_to_json(&settings);
        assert!(text.contains(r#""17": {"#) && text.contains(r#""-3": {"#), "{text}");
        let AppliedSettings { settings: back, warnings } = load_json(&Settings::default(), &text).unwrap();
        assert_eq!((&back.layer().labels, warnings.len()), (&settings.layer().labels, 0));
        let part = r#"{"labels": {"17": {"opacity": 0.2}, "4": {"visible": false}}}"#;
        let AppliedSettings { settings: laid_over, warnings } = load_json(&settings, part).unwrap();
        let labels = &laid_over.layer().labels;
        assert!(warnings.is_empty() && labels.len() == 3, "{warnings:?}");
        let changed = labels.get(17).unwrap();
        assert_eq!((changed.opacity, changed.name.as_str(), changed.visible), (0.2, "Left lung", false));
        assert_eq!(labels.get(4), Some(&LabelLook { visible: false, ..LabelLook::default_for(4) }));
        let set = |path: &str, to: &str| apply_path(&settings, path, to).unwrap().layer().labels.clone();
        assert!(set("labels.17.visible", "true").get(17).unwrap().visible);
        assert_eq!(set("labels.5.opacity", "0.25").get(5).unwrap().opacity, 0.25, "made where there is none");
        assert!(set("labels", "{}").is_empty());
        assert!(apply_path(&settings, "labels.lung.visible", "true").is_err());
        assert!(apply_path(&settings, "labels.17.colour", "true").is_err());
    }

    #[test]
    fn tables_are_bounded_and_sane() {
        let wild = LabelLook {
            name: format!("a\u{1b}{}", "n".repeat(1000)),
            color: [f32::NAN, 2.0, -1.0],
            opacity: f64::INFINITY,
            visible: true,
        };
        let mut settings = with((0..MAX_POINTS as i64 + 9).map(|number| (number, wild.clone())).collect());
        settings.sanitise();
        assert_eq!(settings.layer().labels.len(), MAX_POINTS);
        let look = settings.layer().labels.get(3).unwrap();
        assert_eq!((look.color, look.opacity), ([1.0, 1.0, 0.0], 0.0));
        assert!(look.name.chars().count() == MAX_NAME_CHARS && !look.name.contains('\u{1b}'));
        let sane = settings.clone();
        settings.sanitise();
        assert_eq!(settings, sane);
    }
}
