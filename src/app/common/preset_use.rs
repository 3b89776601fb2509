//! Presets that the settings are as if they had just been chosen, for lists that mark them.

use eframe::egui::Ui;

use crate::data::ValueRanges;
use crate::model::{PRESETS, Preset, Settings};

/// Cache of the presets in use: to find them, all are laid over the settings.
#[derive(Debug, Default)]
pub(crate) struct PresetUse {
    /// What they were found for.
    of: Option<(Settings, ValueRanges)>,
    found: Vec<Preset>,
}

impl PresetUse {
    /// Finds the presets that settings for a volume with these values are made by, unless that is known. While something
    /// is dragged, those stay that were found before.
    pub(crate) fn look_at(&mut self, ui: &Ui, settings: &Settings, ranges: &ValueRanges) {
        let is_known = self.of.as_ref().is_some_and(|(known, of)| known == settings && of == ranges);
        if is_known || self.of.is_some() && ui.input(|input| input.pointer.any_down()) {
            return;
        }
        self.found = PRESETS.into_iter().filter(|preset| preset.is_in_use(settings, ranges)).collect();
        self.of = Some((settings.clone(), *ranges));
    }

    /// Whether a preset is one of them.
    pub(crate) fn has(&self, preset: &Preset) -> bool {
        self.found.contains(preset)
    }
}
