//! Detection of the presets that match the current settings, for lists that mark them.

use eframe::egui::Ui;

use chiaroscuro_scene::{PRESETS, Preset, Settings};
use chiaroscuro_volume::ValueRanges;

/// Cache of the presets in use: finding them takes applying all presets to the settings.
#[derive(Debug, Default)]
pub(crate) struct PresetMatchCache {
    /// Settings and ranges of values for which the presets were found.
    found_for: Option<(Settings, ValueRanges)>,
    found: Vec<Preset>,
}

impl PresetMatchCache {
    /// Finds the presets that match settings for a volume with these ranges of values, unless they are cached. The
    /// result stays as it is during a drag.
    pub(crate) fn update(&mut self, ui: &Ui, settings: &Settings, ranges: &ValueRanges) {
        let is_known = self.found_for.as_ref().is_some_and(|(known, of)| known == settings && of == ranges);
        if is_known || self.found_for.is_some() && ui.input(|input| input.pointer.any_down()) {
            return;
        }
        self.found = PRESETS.into_iter().filter(|preset| preset.is_in_use(settings, ranges)).collect();
        self.found_for = Some((settings.clone(), *ranges));
    }

    /// Returns true if the preset is in use.
    pub(crate) fn is_in_use(&self, preset: &Preset) -> bool {
        self.found.contains(preset)
    }
}
