//! Automatic exposure balance (*Keep balanced*): when to measure it again, and easing to the new value.
//!
//! It acts only on an idle picture, and writes its result into the settings: a picture depends on these alone,
//! whenever and wherever it is made. The picture may be a preview: until the balance is known, none is drawn at full
//! quality, so that a change is refined once. Times are in seconds of any monotonic clock.

use super::Document;
use super::easing::{eased_progress, interpolate_factor};
use chiaroscuro_scene::{RenderEngine, SamplingSettings, Settings, ShadowSettings};

/// Debounce time without changes, in seconds: longer than the pauses within one movement of a hand.
const DEBOUNCE_S: f64 = 0.25;

/// Relative difference up to which the balance is left alone: the eye does not notice it, and the measurement itself,
/// in a small picture, is hardly more exact.
const TOLERANCE: f64 = 0.02;

/// State of the window in one frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BalanceFrame<'a> {
    /// Time of the frame, in seconds.
    pub now_s: f64,
    /// Settings of the look in this frame.
    pub settings: &'a Settings,
    /// True if a picture of the look is on screen, preview or not.
    pub is_shown: bool,
    /// True while the user holds a pointer button or a key, or edits text.
    pub user_active: bool,
    /// True while an earlier measurement runs.
    pub busy: bool,
}

/// Action that the window has to take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum BalanceAction {
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
enum BalancePhase {
    Rest,
    Measuring,
    Easing { from: f64, to: f64, since_s: f64 },
}

/// State machine that decides when to measure and which balance to set.
#[derive(Debug)]
pub(crate) struct AutoBalance {
    /// Settings of the look in the previous frame.
    previous: Settings,
    /// Settings for which the balance was found last, as [`brightness_key`] reduces them.
    balanced: Option<Settings>,
    /// Time of the last change or held input, in seconds.
    last_change_s: f64,
    phase: BalancePhase,
}

impl AutoBalance {
    /// Starts with a look; `is_balanced`: its balance was measured.
    pub(crate) fn new(settings: &Settings, is_balanced: bool) -> Self {
        let balanced = is_balanced.then(|| brightness_key(settings));
        Self { previous: settings.clone(), balanced, last_change_s: 0.0, phase: BalancePhase::Rest }
    }

    /// Accepts the balance of a look as part of it, as after an undo or from a session.
    pub(crate) fn accept(&mut self, settings: &Settings) {
        *self = Self { last_change_s: self.last_change_s, ..Self::new(settings, true) };
    }

    /// Returns true if the balance of the settings is going to change automatically.
    pub(crate) fn is_due(&self, settings: &Settings) -> bool {
        let ShadowSettings { keep_balanced, algorithm, .. } = settings.shadows;
        // Without shadows a balance has no effect.
        keep_balanced && algorithm.is_on() && self.balanced.as_ref() != Some(&brightness_key(settings))
    }

    /// Decides on the action for this frame.
    pub(crate) fn next_action(&mut self, moment: BalanceFrame<'_>) -> BalanceAction {
        let BalanceFrame { now_s, settings, is_shown, user_active: held, busy } = moment;
        let is_changed = *settings != self.previous;
        if is_changed {
            if settings.shadows.balance.to_bits() != self.previous.shadows.balance.to_bits() {
                // A balance that was set explicitly is kept.
                self.balanced = Some(brightness_key(settings));
            }
            self.previous.clone_from(settings);
        }
        if is_changed || held {
            self.last_change_s = now_s;
            self.phase = BalancePhase::Rest;
        }
        if !settings.shadows.keep_balanced {
            // Forgotten while switched off, so that it is measured when switched on again.
            self.balanced = None;
        }
        if !self.is_due(settings) {
            self.phase = BalancePhase::Rest;
            return BalanceAction::Nothing;
        }
        match self.phase {
            BalancePhase::Easing { from, to, since_s } => self.ease(from, to, eased_progress(since_s, now_s)),
            BalancePhase::Measuring => BalanceAction::Nothing,
            // The window draws a frame when any of these ends.
            BalancePhase::Rest if held || busy || !is_shown => BalanceAction::Nothing,
            BalancePhase::Rest => {
                let wait_s = self.last_change_s + DEBOUNCE_S - now_s;
                if wait_s > 0.0 {
                    return BalanceAction::Wait(wait_s);
                }
                self.phase = BalancePhase::Measuring;
                BalanceAction::Measure
            }
        }
    }

    fn ease(&mut self, from: f64, to: f64, share: f64) -> BalanceAction {
        let balance = interpolate_factor(from, to, share);
        self.set(balance);
        if share >= 1.0 {
            self.finish();
        }
        BalanceAction::Set(balance)
    }

    /// Sets the balance without counting it as a change.
    fn set(&mut self, balance: f64) {
        self.previous.shadows.balance = balance;
    }

    /// Marks the current balance as final.
    fn finish(&mut self) {
        self.balanced = Some(brightness_key(&self.previous));
        self.phase = BalancePhase::Rest;
    }

    /// Takes the result of a measurement. `None` is a failure, which is not retried until something changes. A result
    /// from before the last change is dropped.
    pub(crate) fn set_result(&mut self, now_s: f64, balance: Option<f64>) {
        if self.phase != BalancePhase::Measuring {
            return;
        }
        let from = self.previous.shadows.balance;
        match balance {
            Some(to) if (to / from - 1.0).abs() > TOLERANCE => {
                self.phase = BalancePhase::Easing { from, to, since_s: now_s };
            }
            _ => self.finish(),
        }
    }
}

impl Document {
    /// Sets a balance that was found automatically, as part of the change that it follows.
    pub(crate) fn apply_balance(&mut self, balance: f64, now_s: f64) {
        let before = self.history_step();
        self.settings.shadows.balance = balance;
        let after = self.history_step();
        self.history.merge_into_last(now_s, &before, &after);
        self.first_lights.accept_change(&before.settings, &self.settings);
    }
}

/// Reduces a look to the settings that influence how much shadows darken it, and the balance; without the balance,
/// a value eased half-way could pass for the final one. The small influence of the view is ignored:
/// turning a volume must not change its light.
fn brightness_key(settings: &Settings) -> Settings {
    let Settings {
        schema,
        camera: _,
        lights,
        layers,
        mode: _,
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
    let mut layers = layers.clone();
    let layer = layers.first_mut();
    // Names of labels have no influence.
    layer.labels = layer.labels.without_names();
    Settings {
        schema: *schema,
        lights,
        layers,
        mode: settings.as_lit().mode.clone(),
        shading: shading.clone(),
        shadows: ShadowSettings { keep_balanced: true, ..shadows.clone() },
        sky: sky.clone(),
        scattering: scattering.clone(),
        cuts: cuts.clone(),
        // Both engines make the same picture.
        sampling: SamplingSettings { engine: RenderEngine::Gather, ..sampling.clone() },
        volume: *volume,
        ..Settings::default()
    }
}

#[cfg(test)]
mod tests;
