//! Saved views and looks of a session; they do not affect the image.

use std::sync::Arc;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::{Camera, MAX_NAME_CHARS, SCHEMA, Settings};
use chiaroscuro_files::sanitised_line;
use chiaroscuro_volume::Corrections;

/// Largest number of saved views and looks: as many as a strip of thumbnails shows at a glance, with some scrolling.
pub const MAX_SAVED_ENTRIES: usize = 32;

/// Largest total size of saved entries in a session, in bytes: a fifth of a session's limit. A look of a few
/// materials takes four thousand; one of a thousand labels would take all of it.
pub const MAX_SAVED_BYTES: usize = 1 << 18;

/// Largest size of all entries of a file that is read: entries that had room in a file before schema 3 have it now,
/// when four more characters stand before each line of a layer, whose lines had 19 or more.
const MAX_READ_BYTES: usize = MAX_SAVED_BYTES + MAX_SAVED_BYTES / 4;

/// Digit keys that can be assigned to saved views and looks.
pub const DIGIT_KEYS: std::ops::RangeInclusive<u8> = 1..=9;

/// Saved view or look with a name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedEntry {
    /// Name given by the user.
    pub name: String,
    /// Digit key that recalls the entry.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub digit: Option<u8>,
    /// Saved content: a view or a look.
    pub what: SavedContent,
}

/// Content of a saved entry.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SavedContent {
    /// View: the camera alone.
    View(Camera),
    /// Complete look, including its camera.
    Look(SavedLook),
}

/// Settings of a saved look: without saved entries of their own, within range, and without corrections, which belong
/// to a file.
///
/// Copies share one allocation, so that steps of the undo history cost nothing.
#[derive(Debug, Clone)]
pub struct SavedLook(Arc<Settings>);

impl SavedLook {
    /// Saves a copy of a look.
    pub fn new(look: &Settings) -> Self {
        let look = look.clone();
        let mut look = Settings { schema: SCHEMA, kept: Vec::new(), volume: Corrections::default(), ..look };
        look.sanitise();
        Self(Arc::new(look))
    }

    /// Returns the settings of the look.
    pub fn settings(&self) -> &Settings {
        &self.0
    }
}

impl PartialEq for SavedLook {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

impl Serialize for SavedLook {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for SavedLook {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Settings::deserialize(deserializer).map(|look| Self::new(&look))
    }
}

impl SavedEntry {
    /// Creates a saved view without a digit key.
    pub fn view(name: impl Into<String>, camera: &Camera) -> Self {
        Self { name: name.into(), digit: None, what: SavedContent::View(camera.clone()) }
    }

    /// Creates a saved look without a digit key.
    pub fn look(name: impl Into<String>, look: &Settings) -> Self {
        Self { name: name.into(), digit: None, what: SavedContent::Look(SavedLook::new(look)) }
    }

    /// Returns the camera of the view or look.
    pub fn camera(&self) -> &Camera {
        match &self.what {
            SavedContent::View(camera) => camera,
            SavedContent::Look(look) => &look.settings().camera,
        }
    }

    /// Returns the settings if the entry is a look.
    pub fn as_look(&self) -> Option<&Settings> {
        match &self.what {
            SavedContent::View(_) => None,
            SavedContent::Look(look) => Some(look.settings()),
        }
    }

    /// Removes a further layer of a look that has it.
    pub(super) fn remove_layer(&mut self, index: usize) {
        if let SavedContent::Look(SavedLook(look)) = &mut self.what
            && look.layers.get(index).is_some()
        {
            Arc::make_mut(look).layers.remove(index);
        }
    }

    /// Returns the camera if the entry is a view.
    pub(super) fn as_view_mut(&mut self) -> Option<&mut Camera> {
        match &mut self.what {
            SavedContent::View(camera) => Some(camera),
            SavedContent::Look(_) => None,
        }
    }

    /// Returns the size of the entry in a session, in bytes.
    fn json_bytes(&self) -> usize {
        serde_json::to_string_pretty(self).map_or(usize::MAX, |text| text.len())
    }
}

impl Settings {
    /// Saves an entry; returns false if it does not fit.
    pub fn save_entry(&mut self, kept: SavedEntry) -> bool {
        let bytes: usize = self.kept.iter().map(SavedEntry::json_bytes).sum();
        let has_room =
            self.kept.len() < MAX_SAVED_ENTRIES && bytes.saturating_add(kept.json_bytes()) <= MAX_SAVED_BYTES;
        if has_room {
            self.kept.push(kept);
        }
        has_room
    }

    /// Replaces the content of an entry; returns false if it does not fit.
    pub fn replace_saved(&mut self, at: usize, what: SavedContent) -> bool {
        let Some(kept) = self.kept.get(at) else { return false };
        let instead = SavedEntry { what, ..kept.clone() };
        let others: usize = self
            .kept
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != at)
            .map(|(_, kept)| kept.json_bytes())
            .sum();
        let has_room = others.saturating_add(instead.json_bytes()) <= MAX_SAVED_BYTES;
        if has_room {
            self.kept[at] = instead;
        }
        has_room
    }

    /// Removes entries of a file that do not fit into [`MAX_READ_BYTES`], and returns their number.
    pub(crate) fn drop_oversized_saved(&mut self) -> usize {
        let (before, mut bytes) = (self.kept.len(), 0_usize);
        self.kept.retain(|kept| {
            let with = bytes.saturating_add(kept.json_bytes());
            let fits = with <= MAX_READ_BYTES;
            bytes = if fits { with } else { bytes };
            fits
        });
        before - self.kept.len()
    }

    /// Returns the entry that a digit key recalls.
    pub fn saved_for_digit(&self, digit: u8) -> Option<&SavedEntry> {
        self.kept.iter().find(|kept| kept.digit == Some(digit))
    }

    /// Saves the current view under a digit key and replaces the view that had it; returns false if it does not fit.
    pub fn save_view_for_digit(&mut self, digit: u8, name: impl Into<String>) -> bool {
        let camera = self.camera.clone();
        if let Some(kept) = self.kept.iter_mut().find(|kept| kept.digit == Some(digit)) {
            if let SavedContent::View(view) = &mut kept.what {
                *view = camera;
                return true;
            }
            // A look stays saved, without the digit key.
            kept.digit = None;
        }
        self.save_entry(SavedEntry { digit: Some(digit), ..SavedEntry::view(name, &camera) })
    }

    /// Clamps names, digit keys and the number of entries to their limits.
    pub(super) fn sanitise_saved(&mut self) {
        self.kept.truncate(MAX_SAVED_ENTRIES);
        let mut taken = Vec::new();
        for kept in &mut self.kept {
            kept.name = sanitised_line(&kept.name, MAX_NAME_CHARS);
            let is_free = |digit: &u8| DIGIT_KEYS.contains(digit) && !taken.contains(digit);
            kept.digit = kept.digit.filter(is_free);
            taken.extend(kept.digit);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ControlPoint;

    #[test]
    fn digits_go_to_one_thing_each() {
        let mut settings = Settings::default();
        assert!(settings.save_view_for_digit(3, "front"));
        settings.camera.azimuth_deg = 77.0;
        assert!(settings.save_view_for_digit(3, "other"));
        assert_eq!(settings.kept.len(), 1, "in its place");
        let kept = settings.saved_for_digit(3).unwrap();
        assert_eq!((kept.name.as_str(), kept.camera().azimuth_deg), ("front", 77.0));
        // A look is not replaced by a view.
        let look = SavedEntry { digit: Some(4), ..SavedEntry::look("bone", &settings) };
        assert!(settings.save_entry(look) && settings.save_view_for_digit(4, "side"));
        assert_eq!(settings.kept.iter().map(|kept| kept.digit).collect::<Vec<_>>(), [Some(3), None, Some(4)]);
        settings.kept[1].digit = Some(3);
        settings.kept[2].digit = Some(12);
        settings.sanitise();
        assert_eq!(settings.kept.iter().map(|kept| kept.digit).collect::<Vec<_>>(), [Some(3), None, None]);
    }

    #[test]
    fn looks_hold_nothing_kept_and_nothing_of_the_file() {
        let mut settings = Settings::default();
        assert!(settings.save_view_for_digit(1, "a"));
        settings.volume.spacing = Some([1.0, 2.0, 3.0]);
        let kept = SavedEntry::look("b", &settings);
        assert!(settings.save_entry(kept));
        let look = settings.kept[1].as_look().unwrap();
        assert!(look.kept.is_empty() && look.volume.is_none());
        let mut other = settings.clone();
        other.shadows.gain = 3.0;
        other.camera.azimuth_deg = 12.0;
        let back = other.with_saved_look(look);
        assert_eq!(back.shadows.gain, settings.shadows.gain);
        assert_eq!((&back.camera, &back.kept, &back.volume), (&other.camera, &other.kept, &other.volume));
        // This also holds for a file that nests looks without end.
        let mut tree = serde_json::to_value(&settings).unwrap();
        tree["kept"][1]["what"]["look"]["kept"] = tree["kept"].clone();
        let read: Settings = serde_json::from_value(tree).unwrap();
        assert_eq!(read, settings);
    }

    #[test]
    fn what_is_kept_fits_into_a_session() {
        let mut settings = Settings::default();
        let mut many = 0;
        while settings.save_entry(SavedEntry::look("x", &settings.clone())) {
            many += 1;
        }
        assert_eq!(many, MAX_SAVED_ENTRIES);
        let mut wide = Settings::default();
        let point = ControlPoint::new(1.0, [0.5; 3], 0.5);
        wide.layer_mut().transfer.points = vec![point; crate::MAX_POINTS];
        let kept = SavedEntry::look("x", &wide);
        assert!(!wide.save_entry(kept.clone()), "too much for a session");
        let (mut replaced, small) = (settings.clone(), settings.clone());
        assert!(!replaced.replace_saved(1, kept.what.clone()) && replaced == small);
        assert!(replaced.replace_saved(1, SavedContent::View(small.camera.clone())) && replaced != small);
        // Entries from a file that another program wrote.
        wide.kept = vec![small.kept[0].clone(), kept, small.kept[1].clone()];
        assert_eq!((wide.drop_oversized_saved(), wide.kept.len()), (1, 2));
        assert!(crate::settings_to_json(&settings).len() < chiaroscuro_files::MAX_LOOK_BYTES);
    }
}
