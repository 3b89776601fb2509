//! Automatic light placement at the end of a first look.
//!
//! A background search for the light whose shadows show most starts when the first picture is on screen, preview or
//! not, and its result is eased in. A light that would move later than two seconds after that picture, or after the
//! user has touched anything, stays where it is. Times are in seconds of any monotonic clock.

use glam::DVec3;

use super::Document;
use super::easing::{eased_progress, interpolate_factor};
use super::history::HistoryStep;
use chiaroscuro_render::{GpuError, LightSearchResult};
use chiaroscuro_scene::{LightSettings, Settings};

/// State of the window in one frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LightPlacementFrame<'a> {
    /// Time of the frame, in seconds.
    pub now_s: f64,
    /// Settings of the look in this frame.
    pub settings: &'a Settings,
    /// True if a picture of the look is on screen, preview or not.
    pub is_shown: bool,
    /// True while the user holds a pointer button or a key, or edits text.
    pub user_active: bool,
    /// Longest time from the first picture to the movement of lights, in seconds.
    pub limit_s: f64,
}

/// Action that the window has to take.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum LightPlacementAction {
    /// Do nothing until something else happens.
    Nothing,
    /// Search for the lights of the settings.
    Search,
    /// Apply these settings, and ask again in the next frame.
    Set(Box<Settings>),
}

/// Usual longest time from the first picture to the movement of lights, in seconds: later, it looks like a mistake.
pub(crate) const SEARCH_LIMIT_S: f64 = 2.0;

/// Progress of the light placement.
#[derive(Debug, Clone, Default)]
enum LightPlacementPhase {
    /// Finished, or not a first look.
    #[default]
    Done,
    /// Search is due and not yet started.
    Due,
    Searching {
        since_s: f64,
    },
    /// Search has found lights.
    Complete(Box<LightSearchResult>),
    Easing {
        from: Box<Settings>,
        to: Box<Settings>,
        since_s: f64,
    },
}

/// State machine that decides when to search and which settings to apply.
#[derive(Debug, Default)]
pub(crate) struct LightPlacement {
    phase: LightPlacementPhase,
    /// Settings of the opened look, with the changes made automatically since.
    expected: Settings,
}

impl LightPlacement {
    /// Starts with a first look that the user has not edited.
    pub(crate) fn new(settings: &Settings) -> Self {
        Self { phase: LightPlacementPhase::Due, expected: settings.clone() }
    }

    /// Returns true if the look is going to change automatically.
    pub(crate) fn is_due(&self) -> bool {
        !matches!(self.phase, LightPlacementPhase::Done)
    }

    /// Returns true while lights are sought.
    pub(crate) fn is_searching(&self) -> bool {
        matches!(self.phase, LightPlacementPhase::Searching { .. } | LightPlacementPhase::Complete(_))
    }

    /// Stops the placement, since the user has edited the look.
    pub(crate) fn stop(&mut self) {
        self.phase = LightPlacementPhase::Done;
    }

    /// Takes note of another automatic change of the look, which does not count as an edit by the user.
    pub(crate) fn accept_change(&mut self, before: &Settings, after: &Settings) {
        if self.is_due() && differs_in_view_only(before, &self.expected) {
            self.expected.clone_from(after);
        }
    }

    /// Returns the state for a successor window: with an unfinished search or easing due again, since its clock has
    /// another origin.
    #[must_use]
    pub(crate) fn restarted(self) -> Self {
        let phase = match self.phase {
            LightPlacementPhase::Searching { .. } | LightPlacementPhase::Easing { .. } => {
                LightPlacementPhase::Due
            }
            other => other,
        };
        Self { phase, ..self }
    }

    /// Takes the result of a search; without one, the lights stay.
    pub(crate) fn set_result(&mut self, found: Result<Option<LightSearchResult>, GpuError>) {
        let LightPlacementPhase::Searching { since_s } = self.phase else { return };
        self.phase = match found {
            Ok(Some(found)) => LightPlacementPhase::Complete(Box::new(found)),
            Ok(None) => LightPlacementPhase::Done,
            Err(err) => {
                // The search is optional: the reason of its failure matters only to developers.
                log::warn!("the search for a light position failed: {err}");
                // After the loss of the device, a successor window searches again.
                if matches!(err, GpuError::DeviceLost(_)) {
                    LightPlacementPhase::Searching { since_s }
                } else {
                    LightPlacementPhase::Done
                }
            }
        };
    }

    /// Decides on the action for this frame.
    pub(crate) fn next_action(&mut self, moment: LightPlacementFrame<'_>) -> LightPlacementAction {
        let LightPlacementFrame { now_s, settings, is_shown, user_active: held, limit_s } = moment;
        if !self.is_due() {
            return LightPlacementAction::Nothing;
        }
        if !differs_in_view_only(settings, &self.expected) {
            // The result would no longer fit the picture, or would override a choice of the user.
            self.stop();
            return LightPlacementAction::Nothing;
        }
        if held && !matches!(self.phase, LightPlacementPhase::Easing { .. }) {
            self.stop();
            return LightPlacementAction::Nothing;
        }
        match std::mem::take(&mut self.phase) {
            LightPlacementPhase::Due if is_shown => {
                self.phase = LightPlacementPhase::Searching { since_s: now_s };
                LightPlacementAction::Search
            }
            LightPlacementPhase::Searching { since_s } if now_s - since_s >= limit_s => {
                LightPlacementAction::Nothing
            }
            LightPlacementPhase::Complete(found) => {
                let (from, to) = (Box::new(settings.clone()), Box::new(found.apply(settings)));
                if from == to {
                    return LightPlacementAction::Nothing;
                }
                self.phase = LightPlacementPhase::Easing { from, to, since_s: now_s };
                self.ease(settings, now_s)
            }
            easing @ LightPlacementPhase::Easing { .. } => {
                self.phase = easing;
                self.ease(settings, now_s)
            }
            other => {
                self.phase = other;
                LightPlacementAction::Nothing
            }
        }
    }

    /// Interpolates the settings towards the search result.
    fn ease(&mut self, settings: &Settings, now_s: f64) -> LightPlacementAction {
        let LightPlacementPhase::Easing { from, to, since_s } = &self.phase else {
            return LightPlacementAction::Nothing;
        };
        let share = eased_progress(*since_s, now_s);
        let mut next = settings.clone();
        let is_last = share >= 1.0;
        if is_last {
            next.lights.clone_from(&to.lights);
            next.floor.clone_from(&to.floor);
            next.shadows.balance = to.shadows.balance;
            next.output.exposure = to.output.exposure;
        } else {
            next.lights = interpolate_lights(&from.lights, &to.lights, share);
            next.shadows.balance = interpolate_factor(from.shadows.balance, to.shadows.balance, share);
            next.output.exposure = interpolate_factor(from.output.exposure, to.output.exposure, share);
        }
        self.expected.clone_from(&next);
        if is_last {
            self.phase = LightPlacementPhase::Done;
        }
        LightPlacementAction::Set(Box::new(next))
    }
}

/// Interpolates between two sets of lights, each light along a circle around the centre.
fn interpolate_lights(from: &[LightSettings], to: &[LightSettings], share: f64) -> Vec<LightSettings> {
    let pairs = to.iter().enumerate();
    pairs
        .map(|(at, target)| {
            let before = from.get(at).map_or(target.position, |light| light.position);
            let place = DVec3::from(before).slerp(DVec3::from(target.position), share);
            LightSettings { position: place.into(), ..target.clone() }
        })
        .collect()
}

impl Document {
    /// Applies a step of the light placement. It is part of the first look: there is nothing to undo, even if the view
    /// has changed since, and resets lead here.
    pub(crate) fn apply_placed_lights(&mut self, next: Settings, now_s: f64) {
        let before = self.history_step();
        self.settings = next;
        self.history
            .merge_into_all(now_s, &before, |step| with_automatic_lights(step, &before, &self.settings));
        let Settings { lights, floor, shadows, output, .. } = &self.settings;
        self.defaults.lights.clone_from(lights);
        self.defaults.floor.clone_from(floor);
        self.defaults.shadows.balance = shadows.balance;
        self.defaults.output.exposure = output.exposure;
        self.keep_balanced.accept(&self.settings);
    }
}

/// Applies the automatic lights to a step of the history, if the step shows that look from any view.
fn with_automatic_lights(step: &HistoryStep, before: &HistoryStep, after: &Settings) -> HistoryStep {
    if step.treated_as != before.treated_as || !differs_in_view_only(&step.settings, &before.settings) {
        return step.clone();
    }
    let Settings { camera, kept, .. } = step.settings.clone();
    HistoryStep { settings: Settings { camera, kept, ..after.clone() }, ..step.clone() }
}

/// Returns true if two looks differ in the view and the saved views at most.
fn differs_in_view_only(a: &Settings, b: &Settings) -> bool {
    let mut seen = a.clone();
    seen.camera.clone_from(&b.camera);
    seen.kept.clone_from(&b.kept);
    seen == *b
}

#[cfg(test)]
mod tests;
