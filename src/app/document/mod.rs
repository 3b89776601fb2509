//! Document of the window: the look that is edited, facts about the volume that it shows, and what belongs to both
//! while the volume is open (undo history, corrections, session, saved views, automatic changes).
//!
//! It knows no panels: the dataset, which the viewport holds, is an argument of its methods, and errors that the user
//! should see are returned for the window to report; optional work logs its own. Lengths and angles are those of
//! [`Settings`].

pub(super) mod auto_balance;
pub(super) mod corrections;
pub(super) mod data_kind;
pub(super) mod easing;
mod edits;
pub(super) mod history;
mod layers;
pub(super) mod light_placement;
pub(super) mod looks;
mod orientation;
mod outline;
mod saved_views;
pub(super) mod session;

use std::borrow::Cow;

use self::auto_balance::AutoBalance;
use self::corrections::CorrectionState;
use self::data_kind::KindOverride;
use self::history::History;
use self::layers::SpareField;
use self::light_placement::LightPlacement;
use self::orientation::OrientationTasks;
use self::outline::OutlineCache;
use self::session::SessionFile;
use crate::app::common::volume_facts::VolumeFacts;
use chiaroscuro_scene::{Settings, VolumeLayer};
use chiaroscuro_volume::{Dataset, FieldOrigin, ValueRanges};

/// Look that is edited, the volume that it shows, and what is kept about both.
#[derive(Debug)]
pub(crate) struct Document {
    /// Settings of the current look, with the saved views and looks.
    pub settings: Settings,
    /// First look at the open volume, which the reset buttons restore.
    pub defaults: Settings,
    /// Facts about the open volume; `None` before the first one is open.
    pub volume: Option<VolumeFacts>,
    /// Index of the light that is selected.
    pub selected_light: usize,
    /// Index of the layer whose curve and range are edited; the first one is if there is no such layer.
    pub selected_layer: usize,
    /// Layer and index of the material that is bright in the picture, while the pointer is over its box.
    pub highlighted_material: Option<(usize, usize)>,
    /// Further volumes that the layers of the look show, in their order; those that could not be opened are the last
    /// ones, and stay in what is saved.
    pub further_volumes: Vec<FieldOrigin>,
    /// Fields of layers that were removed or undone.
    spare_fields: Vec<SpareField>,
    /// Undo history of the look.
    pub history: History,
    /// Session file of Ctrl+S, if there is one.
    pub session: Option<SessionFile>,
    /// Corrections of the file's metadata.
    pub corrections: CorrectionState,
    /// Kind of data as which the volume is treated.
    pub kind_override: KindOverride,
    /// Placement of the lights at the end of the first look.
    pub first_lights: LightPlacement,
    /// Balance that is kept automatically.
    pub keep_balanced: AutoBalance,
    /// Turns of the object in progress.
    orientation: OrientationTasks,
    outline_cache: OutlineCache,
}

impl Default for Document {
    fn default() -> Self {
        Self {
            settings: Settings::default(),
            defaults: Settings::default(),
            volume: None,
            selected_light: 0,
            selected_layer: 0,
            highlighted_material: None,
            further_volumes: Vec::new(),
            spare_fields: Vec::new(),
            history: History::default(),
            session: None,
            corrections: CorrectionState::default(),
            kind_override: KindOverride::default(),
            first_lights: LightPlacement::default(),
            keep_balanced: AutoBalance::new(&Settings::default(), true),
            orientation: OrientationTasks::default(),
            outline_cache: OutlineCache::default(),
        }
    }
}

impl Document {
    /// Returns the document for a successor window, whose clock has another origin: automatic changes begin again,
    /// and turns in progress end.
    #[must_use]
    pub(crate) fn restarted(self) -> Self {
        Self {
            first_lights: self.first_lights.restarted(),
            keep_balanced: AutoBalance::new(&self.settings, true),
            orientation: OrientationTasks::default(),
            outline_cache: OutlineCache::default(),
            ..self
        }
    }

    /// Returns the settings that the picture shows: those of the look, with a highlighted material.
    pub(crate) fn shown_settings(&self) -> Cow<'_, Settings> {
        match self.highlighted_material {
            None => Cow::Borrowed(&self.settings),
            Some((layer, material)) => Cow::Owned(self.settings.with_material_highlighted(layer, material)),
        }
    }

    /// Returns true while a requested look is computed on another thread: for another kind of data, or for the object
    /// turned to stand another way up.
    pub(crate) fn is_making_look(&self) -> bool {
        self.kind_override.is_busy() || self.orientation.is_busy()
    }

    /// Drops turns of the object in progress.
    pub(crate) fn drop_turns(&mut self) {
        self.orientation = OrientationTasks::default();
    }

    /// Selects a layer that there is, after layers were removed or undone.
    pub(crate) fn clamp_selected_layer(&mut self) {
        self.selected_layer = self.selected_layer.min(self.settings.layers.count() - 1);
    }

    /// Returns facts about the volume of the selected layer.
    pub(crate) fn selected_volume(&self) -> Option<&VolumeFacts> {
        self.volume.as_ref().map(|volume| volume.of_layer(self.selected_layer))
    }

    /// Returns the ranges of values of the open volume.
    pub(crate) fn value_ranges(&self) -> ValueRanges {
        self.volume.as_ref().map_or(ValueRanges::UNIT, |volume| volume.ranges)
    }

    /// Returns the ranges of values of the selected layer's volume.
    pub(crate) fn selected_ranges(&self) -> ValueRanges {
        self.selected_volume().map_or(ValueRanges::UNIT, |volume| volume.ranges)
    }

    /// Returns the settings with the selected layer in the place of the first one.
    pub(crate) fn with_selected_first(&self) -> Settings {
        self.settings.clone().with_first_exchanged(self.selected_layer)
    }

    /// Returns the selected layer, to be changed.
    pub(crate) fn selected_layer_mut(&mut self) -> &mut VolumeLayer {
        self.settings.layer_at_mut(self.selected_layer)
    }

    /// Returns the name of the open volume, or an empty one if there is none.
    pub(crate) fn volume_name(&self) -> &str {
        self.volume.as_ref().map_or("", |volume| volume.name.as_str())
    }

    /// Returns true if +x, +y and +z are a body's right, front and head.
    pub(crate) fn is_anatomical(&self) -> bool {
        self.volume.as_ref().is_some_and(|volume| volume.is_anatomical)
    }

    /// Updates the facts for editor and panels to the range of values that the picture shows.
    pub(crate) fn update_shown_range(&mut self, dataset: Option<&Dataset>) {
        if let (Some(dataset), Some(facts)) = (dataset, &mut self.volume)
            && !facts.shows_ranges_of(dataset)
        {
            facts.update(dataset);
        }
    }
}
