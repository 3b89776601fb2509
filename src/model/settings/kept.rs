//! Views and looks that somebody keeps beside the picture: they are no part of it.

use std::sync::Arc;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::data::{Corrections, single_line};
use crate::model::{Camera, MAX_NAME, Settings};

/// How many views and looks can be kept: as many as a strip of small pictures shows at a glance, with some scrolling.
pub const MAX_KEPT: usize = 32;

/// Bytes that all of them may have in a session: a fifth of what a session may have. A look of a few materials takes
/// four thousand; one of a thousand labels would take all of it.
pub const MAX_KEPT_BYTES: usize = 1 << 18;

/// The digits that can go to a kept view or look.
pub const DIGITS: std::ops::RangeInclusive<u8> = 1..=9;

/// A view or a look that is kept, under a name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Kept {
    /// What the user calls it.
    pub name: String,
    /// The digit that goes to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub digit: Option<u8>,
    /// What is kept.
    pub what: KeptThing,
}

/// What can be kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum KeptThing {
    /// Where the eye is.
    View(Camera),
    /// What things look like, and from where that was seen.
    Look(KeptLook),
}

/// Settings that are kept beside others: without anything kept in them, in range, and without what belongs to a file.
/// Copies share one value, so that steps of a history cost nothing.
#[derive(Debug, Clone)]
pub struct KeptLook(Arc<Settings>);

impl KeptLook {
    /// A look as it is.
    pub fn new(look: &Settings) -> Self {
        let mut look = Settings { kept: Vec::new(), volume: Corrections::default(), ..look.clone() };
        look.sanitise();
        Self(Arc::new(look))
    }

    /// The settings.
    pub fn settings(&self) -> &Settings {
        &self.0
    }
}

impl PartialEq for KeptLook {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

impl Serialize for KeptLook {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for KeptLook {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Settings::deserialize(deserializer).map(|look| Self::new(&look))
    }
}

impl Kept {
    /// A view, without a digit.
    pub fn view(name: impl Into<String>, camera: &Camera) -> Self {
        Self { name: name.into(), digit: None, what: KeptThing::View(camera.clone()) }
    }

    /// A look, without a digit.
    pub fn look(name: impl Into<String>, look: &Settings) -> Self {
        Self { name: name.into(), digit: None, what: KeptThing::Look(KeptLook::new(look)) }
    }

    /// From where it was seen.
    pub fn camera(&self) -> &Camera {
        match &self.what {
            KeptThing::View(camera) => camera,
            KeptThing::Look(look) => &look.settings().camera,
        }
    }

    /// The look, if it is one.
    pub fn as_look(&self) -> Option<&Settings> {
        match &self.what {
            KeptThing::View(_) => None,
            KeptThing::Look(look) => Some(look.settings()),
        }
    }

    /// From where it was seen, if it is no look.
    pub(super) fn as_view_mut(&mut self) -> Option<&mut Camera> {
        match &mut self.what {
            KeptThing::View(camera) => Some(camera),
            KeptThing::Look(_) => None,
        }
    }

    /// Bytes that it takes in a session.
    fn bytes(&self) -> usize {
        serde_json::to_string_pretty(self).map_or(usize::MAX, |text| text.len())
    }
}

impl Settings {
    /// Keeps something beside the picture; whether there was room for it.
    pub fn keep(&mut self, kept: Kept) -> bool {
        let bytes: usize = self.kept.iter().map(Kept::bytes).sum();
        let has_room = self.kept.len() < MAX_KEPT && bytes.saturating_add(kept.bytes()) <= MAX_KEPT_BYTES;
        if has_room {
            self.kept.push(kept);
        }
        has_room
    }

    /// Keeps something in the place of something else; whether there was room for it.
    pub fn keep_instead(&mut self, at: usize, what: KeptThing) -> bool {
        let Some(kept) = self.kept.get(at) else { return false };
        let instead = Kept { what, ..kept.clone() };
        let others: usize = self
            .kept
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != at)
            .map(|(_, kept)| kept.bytes())
            .sum();
        let has_room = others.saturating_add(instead.bytes()) <= MAX_KEPT_BYTES;
        if has_room {
            self.kept[at] = instead;
        }
        has_room
    }

    /// Leaves out what is kept beyond the bytes that there may be; how many that were.
    pub(in crate::model) fn bound_kept(&mut self) -> usize {
        let (before, mut bytes) = (self.kept.len(), 0_usize);
        self.kept.retain(|kept| {
            let with = bytes.saturating_add(kept.bytes());
            let fits = with <= MAX_KEPT_BYTES;
            bytes = if fits { with } else { bytes };
            fits
        });
        before - self.kept.len()
    }

    /// What a digit goes to.
    pub fn kept_under(&self, digit: u8) -> Option<&Kept> {
        self.kept.iter().find(|kept| kept.digit == Some(digit))
    }

    /// Keeps a view under a digit, in the place of the view that this went to; whether there was room for it.
    pub fn keep_view_under(&mut self, digit: u8, name: impl Into<String>) -> bool {
        let camera = self.camera.clone();
        if let Some(kept) = self.kept.iter_mut().find(|kept| kept.digit == Some(digit)) {
            if let KeptThing::View(view) = &mut kept.what {
                *view = camera;
                return true;
            }
            // A look goes on being kept, without the digit.
            kept.digit = None;
        }
        self.keep(Kept { digit: Some(digit), ..Kept::view(name, &camera) })
    }

    /// Brings what is kept within bounds.
    pub(super) fn sanitise_kept(&mut self) {
        self.kept.truncate(MAX_KEPT);
        let mut taken = Vec::new();
        for kept in &mut self.kept {
            kept.name = single_line(&kept.name, MAX_NAME);
            let is_free = |digit: &u8| DIGITS.contains(digit) && !taken.contains(digit);
            kept.digit = kept.digit.filter(is_free);
            taken.extend(kept.digit);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::ControlPoint;

    #[test]
    fn digits_go_to_one_thing_each() {
        let mut settings = Settings::default();
        assert!(settings.keep_view_under(3, "front"));
        settings.camera.azimuth_deg = 77.0;
        assert!(settings.keep_view_under(3, "other"));
        assert_eq!(settings.kept.len(), 1, "in its place");
        let kept = settings.kept_under(3).unwrap();
        assert_eq!((kept.name.as_str(), kept.camera().azimuth_deg), ("front", 77.0));
        // A look is not lost for a view.
        let look = Kept { digit: Some(4), ..Kept::look("bone", &settings) };
        assert!(settings.keep(look) && settings.keep_view_under(4, "side"));
        assert_eq!(settings.kept.iter().map(|kept| kept.digit).collect::<Vec<_>>(), [Some(3), None, Some(4)]);
        settings.kept[1].digit = Some(3);
        settings.kept[2].digit = Some(12);
        settings.sanitise();
        assert_eq!(settings.kept.iter().map(|kept| kept.digit).collect::<Vec<_>>(), [Some(3), None, None]);
    }

    #[test]
    fn looks_hold_nothing_kept_and_nothing_of_the_file() {
        let mut settings = Settings::default();
        assert!(settings.keep_view_under(1, "a"));
        settings.volume.spacing = Some([1.0, 2.0, 3.0]);
        let kept = Kept::look("b", &settings);
        assert!(settings.keep(kept));
        let look = settings.kept[1].as_look().unwrap();
        assert!(look.kept.is_empty() && look.volume.is_none());
        let mut other = settings.clone();
        other.shadows.gain = 3.0;
        other.camera.azimuth_deg = 12.0;
        let back = other.with_look(look);
        assert_eq!(back.shadows.gain, settings.shadows.gain);
        assert_eq!((&back.camera, &back.kept, &back.volume), (&other.camera, &other.kept, &other.volume));
        // Also where a file says otherwise, one in the other without end.
        let mut tree = serde_json::to_value(&settings).unwrap();
        tree["kept"][1]["what"]["look"]["kept"] = tree["kept"].clone();
        let read: Settings = serde_json::from_value(tree).unwrap();
        assert_eq!(read, settings);
    }

    #[test]
    fn what_is_kept_fits_into_a_session() {
        let mut settings = Settings::default();
        let mut many = 0;
        while settings.keep(Kept::look("x", &settings.clone())) {
            many += 1;
        }
        assert_eq!(many, MAX_KEPT);
        let mut wide = Settings::default();
        let point = ControlPoint::new(1.0, [0.5; 3], 0.5);
        wide.transfer.points = vec![point; crate::model::MAX_POINTS];
        let kept = Kept::look("x", &wide);
        assert!(!wide.keep(kept.clone()), "too much for a session");
        let (mut replaced, small) = (settings.clone(), settings.clone());
        assert!(!replaced.keep_instead(1, kept.what.clone()) && replaced == small);
        assert!(replaced.keep_instead(1, KeptThing::View(small.camera.clone())) && replaced != small);
        // From a file of somebody else.
        wide.kept = vec![small.kept[0].clone(), kept, small.kept[1].clone()];
        assert_eq!((wide.bound_kept(), wide.kept.len()), (1, 2));
        assert!(crate::model::to_json(&settings).len() < crate::model::MAX_LOOK_BYTES);
    }
}
