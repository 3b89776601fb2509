//! Automatic exposure balance (*Keep balanced*): when to measure it again, and easing to the new value.
//!
//! It acts only on an idle picture, and writes its result into the settings: a picture depends on these alone,
//! whenever and wherever it is made. The picture may be a preview: until the balance is known, none is drawn at full
//! quality, so that a change is refined once. Times are in seconds of any monotonic clock.

use std::time::Duration;

use eframe::egui;

use super::easing::{is_held, share, towards};
use crate::app::worker::task::Work;
use crate::app::{App, text};
use crate::gpu::Renderer;
use crate::model::{Engine, Sampling, Settings, Shadows};

/// Debounce time without changes, in seconds: longer than the pauses within one movement of a hand.
const REST_S: f64 = 0.25;

/// Relative difference up to which the balance is left alone: the eye does not notice it, and the measurement itself,
/// in a small picture, is hardly more exact.
const TOLERANCE: f64 = 0.02;

/// State of the window in one frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moment<'a> {
    /// Time of the frame, in seconds.
    pub now_s: f64,
    /// Settings of the look in this frame.
    pub settings: &'a Settings,
    /// True if a picture of the look is on screen, preview or not.
    pub is_shown: bool,
    /// True while the user holds a pointer button or a key, or edits text.
    pub held: bool,
    /// True while an earlier measurement runs.
    pub busy: bool,
}

/// Action that the window has to take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Act {
    /// Do nothing until something else happens.
    Nothing,
    /// Ask again after this time, in seconds.
    Wait(f64),
    /// Measure the balance of the settings.
    Measure,
    /// Set the balance, and ask again in the next frame.
    Set(f64),
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Phase {
    Rest,
    Measuring,
    Easing { from: f64, to: f64, since_s: f64 },
}

/// State machine that decides when to measure and which balance to set.
#[derive(Debug)]
pub(crate) struct KeepBalanced {
    /// Settings of the look in the previous frame.
    seen: Settings,
    /// Settings for which the balance was found last, as [`brightness`] reduces them.
    balanced: Option<Settings>,
    /// Time of the last change or held input, in seconds.
    stirred_s: f64,
    phase: Phase,
}

impl KeepBalanced {
    /// Starts with a look; `is_balanced`: its balance was measured.
    pub(crate) fn new(settings: &Settings, is_balanced: bool) -> Self {
        let balanced = is_balanced.then(|| brightness(settings));
        Self { seen: settings.clone(), balanced, stirred_s: 0.0, phase: Phase::Rest }
    }

    /// Accepts the balance of a look as part of it, as after an undo or from a session.
    pub(crate) fn accept(&mut self, settings: &Settings) {
        *self = Self { stirred_s: self.stirred_s, ..Self::new(settings, true) };
    }

    /// Returns true if the balance of the settings is going to change automatically.
    pub(crate) fn is_due(&self, settings: &Settings) -> bool {
        let Shadows { keep_balanced, algorithm, .. } = settings.shadows;
        // Without shadows a balance has no effect.
        keep_balanced && algorithm.is_on() && self.balanced.as_ref() != Some(&brightness(settings))
    }

    /// Decides on the action for this frame.
    pub(crate) fn act(&mut self, moment: Moment<'_>) -> Act {
        let Moment { now_s, settings, is_shown, held, busy } = moment;
        let is_changed = *settings != self.seen;
        if is_changed {
            if settings.shadows.balance.to_bits() != self.seen.shadows.balance.to_bits() {
                // A balance that was set explicitly is kept.
                self.balanced = Some(brightness(settings));
            }
            self.seen.clone_from(settings);
        }
        if is_changed || held {
            self.stirred_s = now_s;
            self.phase = Phase::Rest;
        }
        if !settings.shadows.keep_balanced {
            // Forgotten while switched off, so that it is measured when switched on again.
            self.balanced = None;
        }
        if !self.is_due(settings) {
            self.phase = Phase::Rest;
            return Act::Nothing;
        }
        match self.phase {
            Phase::Easing { from, to, since_s } => self.ease(from, to, share(since_s, now_s)),
            Phase::Measuring => Act::Nothing,
            // The window draws a frame when any of these ends.
            Phase::Rest if held || busy || !is_shown => Act::Nothing,
            Phase::Rest => {
                let wait_s = self.stirred_s + REST_S - now_s;
                if wait_s > 0.0 {
                    return Act::Wait(wait_s);
                }
                self.phase = Phase::Measuring;
                Act::Measure
            }
        }
    }

    fn ease(&mut self, from: f64, to: f64, share: f64) -> Act {
        let balance = towards(from, to, share);
        self.set(balance);
        if share >= 1.0 {
            self.settle();
        }
        Act::Set(balance)
    }

    /// Sets the balance without counting it as a change.
    fn set(&mut self, balance: f64) {
        self.seen.shadows.balance = balance;
    }

    /// Marks the current balance as final.
    fn settle(&mut self) {
        self.balanced = Some(brightness(&self.seen));
        self.phase = Phase::Rest;
    }

    /// Takes the result of a measurement. `None` is a failure, which is not retried until something changes. A result
    /// from before the last change is dropped.
    pub(crate) fn found(&mut self, now_s: f64, balance: Option<f64>) {
        if self.phase != Phase::Measuring {
            return;
        }
        let from = self.seen.shadows.balance;
        match balance {
            Some(to) if (to / from - 1.0).abs() > TOLERANCE => {
                self.phase = Phase::Easing { from, to, since_s: now_s };
            }
            _ => self.settle(),
        }
    }
}

impl App {
    /// Starts measuring the balance of the current settings, on a device of its own; does nothing without a volume.
    pub(super) fn start_balance(&mut self, ctx: &egui::Context) {
        let Some(dataset) = self.viewport.dataset().filter(|_| self.balance.is_none()) else {
            return;
        };
        let (context, settings) = (self.viewport.context().clone(), self.settings.clone());
        let task = move || {
            let mut renderer = Renderer::new(&context.sibling()?)?;
            crate::gpu::balance(&mut renderer, &dataset, &settings)
        };
        match Work::start("balance", ctx, task) {
            Ok(work) => self.balance = Some(work),
            Err(err) => self.messages.error(text::messages::BALANCE_NOT_MEASURED, err.to_string()),
        }
    }

    /// Keeps the picture as bright as without shadows, if the setting is on.
    pub(crate) fn keep_balanced(&mut self, ctx: &egui::Context) {
        let now_s = ctx.input(|input| input.time);
        let (held, busy, has_its_volume) = (is_held(ctx), self.balance.is_some(), self.has_its_volume());
        let is_due = self.keep_balanced.is_due(&self.settings);
        self.viewport.hold_refinement(is_due && !held && !busy && has_its_volume);
        let act = self.keep_balanced.act(Moment {
            now_s,
            settings: &self.settings,
            is_shown: has_its_volume && self.viewport.shows(&self.compare.looks(&self.settings)),
            held,
            busy,
        });
        match act {
            Act::Nothing => {}
            Act::Wait(wait_s) => ctx.request_repaint_after(Duration::from_secs_f64(wait_s)),
            Act::Measure => self.viewport.measure_balance(&self.settings),
            Act::Set(balance) => {
                let before = self.step();
                self.settings.shadows.balance = balance;
                self.history.follow(now_s, &before, &self.step());
                self.first_lights.follow(&before.settings, &self.settings);
                ctx.request_repaint();
            }
        }
    }
}

/// Reduces a look to the settings that influence how much shadows darken it, and the balance; without the balance,
/// a value eased half-way could pass for the final one. The small influence of the view is ignored:
/// turning a volume must not change its light.
fn brightness(settings: &Settings) -> Settings {
    let Settings {
        schema,
        camera: _,
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
        floor: _,
        sampling,
        output: _,
        kept: _,
        volume,
    } = settings;
    let mut lights = lights.clone();
    for light in &mut lights {
        light.name.clear();
    }
    Settings {
        schema: *schema,
        lights,
        range: *range,
        // Names of labels have no influence.
        labels: labels.unnamed(),
        transfer: transfer.clone(),
        lighting: lighting.clone(),
        opacity_unit: *opacity_unit,
        shading: shading.clone(),
        shadows: Shadows { keep_balanced: true, ..shadows.clone() },
        sky: sky.clone(),
        scattering: scattering.clone(),
        cuts: cuts.clone(),
        // Both engines make the same picture.
        sampling: Sampling { engine: Engine::Gather, ..sampling.clone() },
        volume: *volume,
        ..Settings::default()
    }
}

#[cfg(test)]
mod tests;
