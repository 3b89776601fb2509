//! Treatment of the volume as another kind of data than was detected, with the first look for that kind.
//!
//! A thread makes the look in a pass over all voxels.

use std::sync::Arc;

use eframe::egui;

use crate::app::shell::first_lights::FirstLights;
use crate::app::worker::task::Work;
use crate::app::{App, text};
use crate::data::KindName;
use crate::model::{LabelTable, Settings, TransferFunction, auto};

/// Result of a pass over all voxels.
#[derive(Debug)]
enum Made {
    /// First look for a kind of data.
    Look(Option<KindName>, Box<Settings>),
    /// Transfer function or table of labels.
    Transfer(TransferFunction, LabelTable),
}

/// Kind of data as which the volume is treated, and the first looks for the other kinds.
#[derive(Debug, Default)]
pub(in crate::app) struct Treated {
    kind: Option<KindName>,
    /// Values of the reset buttons for other kinds of data, one look for each.
    others: Vec<(Option<KindName>, Settings)>,
    making: Option<Work<Made>>,
}

impl Treated {
    /// Returns the kind chosen for the current look; `None` is the volume's own.
    pub(in crate::app) fn kind(&self) -> Option<KindName> {
        self.kind
    }

    /// Returns true while a look is being made.
    pub(in crate::app) fn is_busy(&self) -> bool {
        self.making.is_some()
    }

    /// Changes the kind, and with it the values of the reset buttons, if they have been made for it.
    pub(in crate::app) fn change(&mut self, kind: Option<KindName>, defaults: &mut Settings) {
        let before = std::mem::replace(&mut self.kind, kind);
        if before == kind {
            return;
        }
        let known = self.others.iter().position(|(other, _)| *other == kind);
        let known = known.map(|at| self.others.swap_remove(at).1);
        self.others.push((before, defaults.clone()));
        if let Some(look) = known {
            *defaults = look;
        }
    }
}

impl App {
    /// Makes a first look for a kind of data, or for the volume's own kind if `None`.
    pub(in crate::app::shell) fn treat_as(&mut self, kind: Option<KindName>, ctx: &egui::Context) {
        let (Some(dataset), Some(facts)) = (self.viewport.dataset(), &self.volume) else { return };
        let (histogram, up) = (Arc::clone(&facts.histogram), self.settings.camera.up);
        let task =
            move || Made::Look(kind, Box::new(auto::treated_as(dataset.volume(), &histogram, kind, up)));
        self.make(task, ctx);
    }

    /// Makes the automatic transfer function or table of labels for the current kind of data.
    pub(in crate::app::shell) fn use_automatic_transfer(&mut self, ctx: &egui::Context) {
        let (Some(dataset), Some(facts)) = (self.viewport.dataset(), &self.volume) else { return };
        let (histogram, kind) = (Arc::clone(&facts.histogram), self.treated.kind);
        let task = move || {
            let volume = dataset.volume();
            Made::Transfer(auto::transfer_as(volume, &histogram, kind), auto::labels_as(volume, kind))
        };
        self.make(task, ctx);
    }

    /// Starts a task; the result of one in progress is dropped.
    fn make(&mut self, task: impl FnOnce() -> Made + Send + 'static, ctx: &egui::Context) {
        match Work::start("first-look", ctx, task) {
            Ok(work) => self.treated.making = Some(work),
            Err(err) => self.messages.error(text::messages::LOOK_NOT_MADE, err.to_string()),
        }
    }

    /// Takes over the result of a task from its thread.
    pub(in crate::app::shell) fn take_treated(&mut self, ctx: &egui::Context) {
        let Some(made) = self.treated.making.as_ref().and_then(Work::take) else { return };
        self.treated.making = None;
        match made {
            Ok(Made::Look(kind, look)) => self.use_first_look(kind, *look, ctx),
            Ok(Made::Transfer(transfer, labels)) => {
                (self.settings.transfer, self.settings.labels) = (transfer, labels);
            }
            Err(panic) => self.messages.error(text::messages::LOOK_NOT_MADE, panic),
        }
    }

    /// Applies a first look for a kind of data.
    fn use_first_look(&mut self, kind: Option<KindName>, look: Settings, ctx: &egui::Context) {
        if look.camera.up != self.settings.camera.up {
            // The object was turned meanwhile.
            return self.treat_as(kind, ctx);
        }
        let look = auto::in_place_of(look, &self.settings);
        self.treated.change(kind, &mut self.defaults);
        self.selected_light = self.selected_light.min(look.lights.len().saturating_sub(1));
        // Starts a light search, as for any first look.
        self.first_lights = FirstLights::of(&look);
        self.light_search = None;
        self.defaults = look.clone();
        self.settings = look;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_has_one_first_look_to_which_steps_lead_back() {
        let look = |ambient: f64| {
            let mut settings = Settings::default();
            settings.shading.ambient = ambient;
            settings
        };
        let (mut treated, mut defaults) = (Treated::default(), look(0.1));
        for round in 0..50 {
            for (at, kind) in KindName::choices().enumerate() {
                treated.change(kind, &mut defaults);
                if round == 0 && kind.is_some() {
                    defaults = look(f64::from(at as u32 + 2) / 10.0);
                }
            }
        }
        assert!(treated.others.len() < KindName::choices().count());
        for (at, kind) in KindName::choices().enumerate() {
            treated.change(kind, &mut defaults);
            let ambient = if kind.is_some() { f64::from(at as u32 + 2) / 10.0 } else { 0.1 };
            assert_eq!((treated.kind(), &defaults), (kind, &look(ambient)));
            treated.change(kind, &mut defaults);
            assert_eq!(defaults, look(ambient));
        }
    }
}
