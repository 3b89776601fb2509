//! The end of a first look: the light that makes the most of shadows is sought when the first picture is on screen, on a
//! thread of its own, and taken over in one short movement. What the user has touched by then is left alone. Times are
//! in seconds, of any clock that does not go back.

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

/// Between two places that are tried: long enough for another thread to take the device.
const BREATH: Duration = Duration::from_millis(1);

/// The window in one of its frames.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moment<'a> {
    /// When it is.
    pub now_s: f64,
    /// The look.
    pub settings: &'a Settings,
    /// The full-quality picture of the look is on screen.
    pub complete: bool,
    /// Somebody holds a button of the pointer or a key, or writes.
    pub held: bool,
}

/// What the window has to do.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Act {
    /// Nothing, until something else happens.
    Nothing,
    /// Seek the lights of the settings.
    Search,
    /// Take these settings, and ask again in the next frame.
    Set(Box<Settings>),
}

/// How far the first look is.
#[derive(Debug, Clone, Default)]
enum Phase {
    /// It is finished, or no first look.
    #[default]
    Done,
    /// Nothing is sought yet.
    Due,
    Searching,
    /// Found, while somebody holds something.
    Waiting(Box<Found>),
    Easing {
        from: Box<Settings>,
        to: Box<Settings>,
        since_s: f64,
    },
}

/// Decides when to search and what to set.
#[derive(Debug, Default)]
pub(crate) struct FirstLights {
    phase: Phase,
    /// The look that was opened, with what has been set since.
    known: Settings,
}

impl FirstLights {
    /// For a first look that nobody has touched.
    pub(crate) fn of(settings: &Settings) -> Self {
        Self { phase: Phase::Due, known: settings.clone() }
    }

    /// Whether the look will change without anybody's doing.
    pub(crate) fn is_due(&self) -> bool {
        !matches!(self.phase, Phase::Done)
    }

    /// Nothing more is to come: the user has decided.
    pub(crate) fn stop(&mut self) {
        self.phase = Phase::Done;
    }

    /// The window has changed the look by itself, which nobody has touched for that.
    pub(crate) fn follow(&mut self, before: &Settings, after: &Settings) {
        if self.is_due() && is_alike(before, &self.known) {
            self.known.clone_from(after);
        }
    }

    /// As it goes on in another window, where nothing is sought yet and time has another beginning.
    #[must_use]
    pub(crate) fn again(self) -> Self {
        let phase = match self.phase {
            Phase::Searching | Phase::Easing { .. } => Phase::Due,
            other => other,
        };
        Self { phase, ..self }
    }

    /// A search has ended; without a finding what is there stays.
    pub(crate) fn found(&mut self, found: Result<Option<Found>, GpuError>) {
        if !matches!(self.phase, Phase::Searching) {
            return;
        }
        self.phase = match found {
            Ok(Some(found)) => Phase::Waiting(Box::new(found)),
            Ok(None) => Phase::Done,
            Err(err) => {
                // It is an offer; why there is none matters to nobody but developers.
                log::warn!("no light was found: {err}");
                // Another window takes the place of this one, and seeks again.
                if matches!(err, GpuError::Lost(_)) { Phase::Searching } else { Phase::Done }
            }
        };
    }

    /// What is to be done in this frame.
    pub(crate) fn act(&mut self, moment: Moment<'_>) -> Act {
        let Moment { now_s, settings, complete, held } = moment;
        if !self.is_due() {
            return Act::Nothing;
        }
        if !is_alike(settings, &self.known) {
            // What is sought would no longer be of what is shown, or would take away what somebody has chosen.
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

    /// The settings on their way to what was found.
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

/// Lights on their way from some places to others, each on a circle around the middle.
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

/// A search that runs. Dropping this ends it at its next step, and forgets what it has found.
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
    /// Finishes the first look of the volume, if nobody has touched it.
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
            // A balance that is about to change belongs to the picture for which lights are sought.
            complete: self.is_complete() && !self.keep_balanced.is_due(&self.settings),
            held: is_held(ctx),
        };
        match self.first_lights.act(moment) {
            Act::Nothing => {}
            Act::Search => self.seek_lights(ctx),
            Act::Set(next) => {
                let before = self.step();
                self.settings = *next;
                // It belongs to the first look: there is nothing to undo, whatever has been done to the view since, and
                // resetting leads here.
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

    /// Seeks the lights of the settings on a thread of its own, on the device of the pictures, whose pipelines are there.
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
                // Pictures that are asked for meanwhile come between.
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

/// A step of the history with the lights to which the window has brought a look: where it shows that look, from
/// wherever.
fn finished(step: &Step, before: &Step, after: &Settings) -> Step {
    if step.treated_as != before.treated_as || !is_alike(&step.settings, &before.settings) {
        return step.clone();
    }
    let Settings { camera, kept, .. } = step.settings.clone();
    Step { settings: Settings { camera, kept, ..after.clone() }, ..*step }
}

/// Whether two looks are the same but for the view.
fn is_alike(a: &Settings, b: &Settings) -> bool {
    let mut seen = a.clone();
    seen.camera.clone_from(&b.camera);
    seen.kept.clone_from(&b.kept);
    seen == *b
}

#[cfg(test)]
mod tests;
