//! Automatic light placement at the end of a first look.
//!
//! A background search for the light whose shadows show most starts when the first picture is on screen, and its
//! result is eased in. A look that the user has edited by then is left alone. Times are in seconds of any monotonic
//! clock.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use eframe::egui;
use glam::DVec3;

use super::easing::{is_held, share, towards};
use crate::app::App;
use crate::app::shell::history::Step;
use crate::app::worker::task::Work;
use crate::gpu::{Found, GpuError, LightSearch, Sought};
use crate::model::{Light, Settings};

/// Pause between two candidate positions: long enough for another thread to take the device.
const BREATH: Duration = Duration::from_millis(1);

/// State of the window in one frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moment<'a> {
    /// Time of the frame, in seconds.
    pub now_s: f64,
    /// Settings of the look in this frame.
    pub settings: &'a Settings,
    /// True if the full-quality picture of the look is on screen.
    pub complete: bool,
    /// True while the user holds a pointer button or a key, or edits text.
    pub held: bool,
}

/// Action that the window has to take.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Act {
    /// Do nothing until something else happens.
    Nothing,
    /// Search for the lights of the settings.
    Search,
    /// Apply these settings, and ask again in the next frame.
    Set(Box<Settings>),
}

/// Progress of the light placement.
#[derive(Debug, Clone, Default)]
enum Phase {
    /// Finished, or not a first look.
    #[default]
    Done,
    /// Search is due and not yet started.
    Due,
    Searching,
    /// Search has found lights, and the user holds a button or a key.
    Waiting(Box<Found>),
    Easing {
        from: Box<Settings>,
        to: Box<Settings>,
        since_s: f64,
    },
}

/// State machine that decides when to search and which settings to apply.
#[derive(Debug, Default)]
pub(crate) struct FirstLights {
    phase: Phase,
    /// Settings of the opened look, with the changes made automatically since.
    known: Settings,
}

impl FirstLights {
    /// Starts with a first look that the user has not edited.
    pub(crate) fn of(settings: &Settings) -> Self {
        Self { phase: Phase::Due, known: settings.clone() }
    }

    /// Returns true if the look is going to change automatically.
    pub(crate) fn is_due(&self) -> bool {
        !matches!(self.phase, Phase::Done)
    }

    /// Stops the placement, since the user has edited the look.
    pub(crate) fn stop(&mut self) {
        self.phase = Phase::Done;
    }

    /// Takes note of another automatic change of the look, which does not count as an edit by the user.
    pub(crate) fn follow(&mut self, before: &Settings, after: &Settings) {
        if self.is_due() && is_alike(before, &self.known) {
            self.known.clone_from(after);
        }
    }

    /// Returns the state for a successor window: with an unfinished search or easing due again, since its clock has
    /// another origin.
    #[must_use]
    pub(crate) fn again(self) -> Self {
        let phase = match self.phase {
            Phase::Searching | Phase::Easing { .. } => Phase::Due,
            other => other,
        };
        Self { phase, ..self }
    }

    /// Takes the result of a search; without one, the lights stay.
    pub(crate) fn found(&mut self, found: Result<Option<Found>, GpuError>) {
        if !matches!(self.phase, Phase::Searching) {
            return;
        }
        self.phase = match found {
            Ok(Some(found)) => Phase::Waiting(Box::new(found)),
            Ok(None) => Phase::Done,
            Err(err) => {
                // The search is optional: the reason of its failure matters only to developers.
                log::warn!("no light was found: {err}");
                // After the loss of the device, a successor window searches again.
                if matches!(err, GpuError::Lost(_)) { Phase::Searching } else { Phase::Done }
            }
        };
    }

    /// Decides on the action for this frame.
    pub(crate) fn act(&mut self, moment: Moment<'_>) -> Act {
        let Moment { now_s, settings, complete, held } = moment;
        if !self.is_due() {
            return Act::Nothing;
        }
        if !is_alike(settings, &self.known) {
            // The result would no longer fit the picture, or would override a choice of the user.
            self.stop();
            return Act::Nothing;
        }
        match std::mem::take(&mut self.phase) {
            Phase::Due if complete && !held => {
                self.phase = Phase::Searching;
                Act::Search
            }
            Phase::Waiting(found) if !held => {
                let (from, to) = (Box::new(settings.clone()), Box::new(found.apply(settings)));
                if from == to {
                    return Act::Nothing;
                }
                self.phase = Phase::Easing { from, to, since_s: now_s };
                self.ease(settings, now_s)
            }
            easing @ Phase::Easing { .. } => {
                self.phase = easing;
                self.ease(settings, now_s)
            }
            other => {
                self.phase = other;
                Act::Nothing
            }
        }
    }

    /// Interpolates the settings towards the search result.
    fn ease(&mut self, settings: &Settings, now_s: f64) -> Act {
        let Phase::Easing { from, to, since_s } = &self.phase else { return Act::Nothing };
        let share = share(*since_s, now_s);
        let mut next = settings.clone();
        let is_last = share >= 1.0;
        if is_last {
            next.lights.clone_from(&to.lights);
            next.floor.clone_from(&to.floor);
            next.shadows.balance = to.shadows.balance;
            next.output.exposure = to.output.exposure;
        } else {
            next.lights = between(&from.lights, &to.lights, share);
            next.shadows.balance = towards(from.shadows.balance, to.shadows.balance, share);
            next.output.exposure = towards(from.output.exposure, to.output.exposure, share);
        }
        self.known.clone_from(&next);
        if is_last {
            self.phase = Phase::Done;
        }
        Act::Set(Box::new(next))
    }
}

/// Interpolates between two sets of lights, each light along a circle around the centre.
fn between(from: &[Light], to: &[Light], share: f64) -> Vec<Light> {
    let pairs = to.iter().enumerate();
    pairs
        .map(|(at, target)| {
            let before = from.get(at).map_or(target.position, |light| light.position);
            let place = DVec3::from(before).slerp(DVec3::from(target.position), share);
            Light { position: place.into(), ..target.clone() }
        })
        .collect()
}

/// Running light search. Dropping this value cancels the search at its next step and discards the result.
pub(crate) struct Seeking {
    work: Work<Result<Option<Found>, GpuError>>,
    is_unwanted: Arc<AtomicBool>,
}

impl Drop for Seeking {
    fn drop(&mut self) {
        self.is_unwanted.store(true, Ordering::Relaxed);
    }
}

impl App {
    /// Finishes the first look of the volume with the lights found, unless the user has edited it.
    pub(crate) fn finish_first_look(&mut self, ctx: &egui::Context) {
        if let Some(result) = self.light_search.as_ref().and_then(|seeking| seeking.work.take()) {
            self.light_search = None;
            self.first_lights.found(result.unwrap_or_else(|panic| {
                log::error!("no light was found: {panic}");
                Ok(None)
            }));
        }
        if !self.first_lights.is_due() {
            self.light_search = None;
        }
        let now_s = ctx.input(|input| input.time);
        let moment = Moment {
            now_s,
            settings: &self.settings,
            // The search refers to the picture with the final balance, so a pending change comes first.
            complete: self.is_complete() && !self.keep_balanced.is_due(&self.settings),
            held: is_held(ctx),
        };
        match self.first_lights.act(moment) {
            Act::Nothing => {}
            Act::Search => self.seek_lights(ctx),
            Act::Set(next) => {
                let before = self.step();
                self.settings = *next;
                // Part of the first look: there is nothing to undo, even if the view has changed since, and resets
                // lead here.
                self.history.finish(now_s, &before, |step| finished(step, &before, &self.settings));
                let Settings { lights, floor, shadows, output, .. } = &self.settings;
                self.defaults.lights.clone_from(lights);
                self.defaults.floor.clone_from(floor);
                self.defaults.shadows.balance = shadows.balance;
                self.defaults.output.exposure = output.exposure;
                self.keep_balanced.accept(&self.settings);
                ctx.request_repaint();
            }
        }
    }

    /// Starts a light search on a thread, on the render device, whose pipelines are compiled already.
    fn seek_lights(&mut self, ctx: &egui::Context) {
        let Some(dataset) = self.viewport.dataset() else { return self.first_lights.stop() };
        let (shaders, settings) = (self.loader.shaders().clone(), self.settings.clone());
        let is_unwanted = Arc::new(AtomicBool::new(false));
        let asked = Arc::clone(&is_unwanted);
        let task = move || -> Result<Option<Found>, GpuError> {
            let mut search = LightSearch::new(shaders, &dataset, &settings, Sought::KeyAndFill)?;
            while search.step()? {
                if asked.load(Ordering::Relaxed) {
                    return Ok(None);
                }
                // Lets pictures that were requested meanwhile go first.
                std::thread::sleep(BREATH);
            }
            Ok(search.finish())
        };
        match Work::start("light-search", ctx, task) {
            Ok(work) => self.light_search = Some(Seeking { work, is_unwanted }),
            Err(err) => {
                log::warn!("no light was sought: {err}");
                self.first_lights.stop();
            }
        }
    }
}

/// Applies the automatic lights to a step of the history, if the step shows that look from any view.
fn finished(step: &Step, before: &Step, after: &Settings) -> Step {
    if step.treated_as != before.treated_as || !is_alike(&step.settings, &before.settings) {
        return step.clone();
    }
    let Settings { camera, kept, .. } = step.settings.clone();
    Step { settings: Settings { camera, kept, ..after.clone() }, ..*step }
}

/// Returns true if two looks differ in the view and the saved views at most.
fn is_alike(a: &Settings, b: &Settings) -> bool {
    let mut seen = a.clone();
    seen.camera.clone_from(&b.camera);
    seen.kept.clone_from(&b.kept);
    seen == *b
}

#[cfg(test)]
mod tests;
