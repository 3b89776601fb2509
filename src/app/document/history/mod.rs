//! Undo and redo of settings.

mod steps;

use eframe::egui;
use eframe::egui::util::undoer::{self, Undoer};

pub(crate) use self::steps::HistorySteps;
use super::Document;
use crate::app::text;
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::{Corrections, FieldOrigin, KindName, Volume};

/// Time without a change after which a step can be undone, in seconds.
const SETTLE_S: f32 = 0.4;

/// State to which an undo or redo leads.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct HistoryStep {
    /// Settings of the look at this step.
    pub settings: Settings,
    /// Kind of data for which the first look was made, if not the volume's own.
    pub treated_as: Option<KindName>,
    /// Volumes that the further layers show.
    pub further_volumes: Vec<FieldOrigin>,
}

/// Undo history of the look.
#[derive(Debug)]
pub(crate) struct History {
    undoer: Undoer<HistoryStep>,
    /// Description of the last undo or redo, with the settings to which it has led.
    last_step: Option<(String, Settings)>,
}

impl Default for History {
    fn default() -> Self {
        let settings = undoer::Settings { stable_time: SETTLE_S, ..undoer::Settings::default() };
        Self { undoer: Undoer::with_settings(settings), last_step: None }
    }
}

impl History {
    /// Creates a history with one step before the look that is shown.
    pub(crate) fn with_previous(before: &HistoryStep) -> Self {
        let mut history = Self::default();
        history.undoer.add_undo(before);
        history
    }

    /// Describes the next undo or redo; `None` where there is none.
    pub(crate) fn describe_next(&self, now: &HistoryStep, is_back: bool) -> Option<String> {
        if !(if is_back { self.can_undo(now) } else { self.can_redo(now) }) {
            return None;
        }
        // A step is known only by taking it, here on a copy.
        let mut history = Self { undoer: self.undoer.clone(), last_step: None };
        let mut other = now.clone();
        let changed = if is_back {
            history.undo(&mut other);
            text::change_descriptions::describe_change(&other.settings, &now.settings)
        } else {
            history.redo(&mut other);
            text::change_descriptions::describe_change(&now.settings, &other.settings)
        };
        Some(changed.unwrap_or_else(|| text::change_descriptions::KIND_OF_DATA.to_owned()))
    }

    /// Returns the description of the undo or redo that has led to these settings, until they change.
    pub(crate) fn last_step(&self, settings: &Settings) -> Option<&str> {
        self.last_step.as_ref().filter(|(_, led_to)| led_to == settings).map(|(words, _)| words.as_str())
    }

    /// Records the description of an undo or redo, and the settings to which it has led.
    pub(crate) fn set_last_step(&mut self, words: String, settings: &Settings) {
        self.last_step = Some((words, settings.clone()));
    }

    /// Records the look, except during a drag: a drag is one step.
    pub(crate) fn observe(&mut self, ctx: &egui::Context, step: &HistoryStep) {
        if ctx.dragged_id().is_none() {
            self.undoer.feed_state(ctx.input(|input| input.time), step);
        }
        if self.undoer.is_in_flux() {
            ctx.request_repaint_after(std::time::Duration::from_secs_f32(SETTLE_S));
        }
    }

    /// Merges an automatic change into the step of the change that it follows.
    pub(crate) fn merge_into_last(&mut self, now_s: f64, before: &HistoryStep, after: &HistoryStep) {
        // The change is complete, though it may not have rested long enough to be a step.
        self.undoer.add_undo(before);
        if self.undoer.has_undo(before) {
            // Removes its step, and the redo that leads to it.
            self.undoer.undo(before);
            self.undoer.feed_state(now_s, after);
        } else {
            *self = Self::default();
        }
        self.undoer.add_undo(after);
    }

    /// Merges an automatic change of a look into all steps of that look, as if it had been made before them; adds no
    /// step. `shown` is the step shown until now, and `finished` maps a step to its changed version.
    pub(crate) fn merge_into_all(
        &mut self,
        now_s: f64,
        shown: &HistoryStep,
        finished: impl Fn(&HistoryStep) -> HistoryStep,
    ) {
        self.undoer.feed_state(now_s, shown);
        let mut at = shown.clone();
        let mut forward = 0;
        while let Some(next) = self.undoer.redo(&at).cloned() {
            (at, forward) = (next, forward + 1);
        }
        let mut steps = Vec::new();
        // A change that is still in flux is no step.
        if !self.undoer.is_in_flux() {
            steps.push(at.clone());
        }
        while let Some(before) = self.undoer.undo(&at).cloned() {
            steps.push(before.clone());
            at = before;
        }
        *self = Self::default();
        for step in steps.iter().rev() {
            self.undoer.add_undo(&finished(step));
        }
        at = steps.first().map(&finished).unwrap_or_default();
        for _ in 0..forward {
            self.undo(&mut at);
        }
        self.undoer.feed_state(now_s, &finished(shown));
    }

    /// Returns true if a step can be undone.
    pub(crate) fn can_undo(&self, step: &HistoryStep) -> bool {
        self.undoer.has_undo(step)
    }

    /// Returns true if a step can be redone.
    pub(crate) fn can_redo(&self, step: &HistoryStep) -> bool {
        self.undoer.has_redo(step)
    }

    /// Replaces `step` by the one before it, if there is one.
    pub(crate) fn undo(&mut self, step: &mut HistoryStep) {
        if let Some(before) = self.undoer.undo(step) {
            step.clone_from(before);
        }
    }

    /// Replaces `step` by the one undone last, if there is one.
    pub(crate) fn redo(&mut self, step: &mut HistoryStep) {
        if let Some(after) = self.undoer.redo(step) {
            step.clone_from(after);
        }
    }
}

impl Document {
    /// Returns the look as the history keeps it.
    pub(crate) fn history_step(&self) -> HistoryStep {
        HistoryStep {
            settings: self.settings.clone(),
            treated_as: self.kind_override.kind(),
            further_volumes: self.further_volumes.clone(),
        }
    }

    /// Takes one step back or forward; the values of the reset buttons follow, and [`Self::update_fields`] shows the
    /// volumes of the step. Returns true if the step has turned the object.
    pub(crate) fn take_step(&mut self, is_back: bool) -> bool {
        let mut step = self.history_step();
        if is_back {
            self.history.undo(&mut step);
        } else {
            self.history.redo(&mut step);
        }
        let up = self.settings.camera.up;
        (self.settings, self.further_volumes) = (step.settings, step.further_volumes);
        self.kind_override.change(step.treated_as, &mut self.defaults);
        // The balance of the step is part of it.
        self.keep_balanced.accept(&self.settings);
        self.settings.camera.up != up
    }

    /// Starts the history of a volume that was just opened: remembered corrections can be undone.
    pub(crate) fn start_history(&mut self, volume: &Volume) {
        let by = self.settings.volume;
        self.history = if by.is_none() || by != *volume.corrections() {
            History::default()
        } else {
            let mut settings = self.settings.clone();
            settings.apply_corrections(Corrections::default(), volume);
            History::with_previous(&HistoryStep { settings, ..self.history_step() })
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_scene::SavedEntry;

    /// Sequence of reproducible pseudo-random numbers (linear congruential generator).
    fn numbers(seed: u64) -> impl Iterator<Item = u64> {
        std::iter::successors(Some(seed), |x| {
            Some(x.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407))
        })
        .skip(1)
        .map(|x| x >> 33)
    }

    /// Applies one of eleven kinds of edits.
    fn edit(settings: &mut Settings, choice: u64, amount: u64) {
        let share = (amount % 1000) as f64 / 1000.0;
        match choice % 11 {
            0 => settings.camera.azimuth_deg = 360.0 * share,
            1 => settings.lights[0].position[0] = 4.0 * share + 1.0,
            2 => settings.shadows.strength = share,
            3 => settings.shading.ambient = share,
            4 => settings.lights[0].on ^= true,
            5 => settings.layer_mut().transfer.points.push(chiaroscuro_scene::ControlPoint::new(
                amount as f64,
                [share as f32; 3],
                share,
            )),
            6 => _ = settings.save_view_for_digit((amount % 9) as u8 + 1, "view"),
            7 => _ = settings.save_entry(SavedEntry::look("look", &settings.clone())),
            8 if !settings.kept.is_empty() => {
                let at = amount as usize % settings.kept.len();
                settings.kept.rotate_left(at);
            }
            9 => drop(settings.kept.pop()),
            _ => settings.layer_mut().lighting.scale = share + 0.5,
        }
    }

    fn step(settings: &Settings) -> HistoryStep {
        HistoryStep { settings: settings.clone(), ..HistoryStep::default() }
    }

    /// Undoes or redoes a step of the settings.
    fn undo_or_redo(history: &mut History, settings: &mut Settings, is_back: bool) {
        let mut at = step(settings);
        if is_back {
            history.undo(&mut at);
        } else {
            history.redo(&mut at);
        }
        *settings = at.settings;
    }

    #[test]
    fn what_finishes_a_look_is_no_step_and_in_all_steps_of_it() {
        let finish = |history: &mut History, now_s: f64, shown: &Settings| {
            let finished = |step: &HistoryStep| {
                let mut step = step.clone();
                if step.settings.shading == Settings::default().shading {
                    step.settings.lights[0].intensity = 3.0;
                }
                step
            };
            history.merge_into_all(now_s, &step(shown), finished);
            finished(&step(shown)).settings
        };
        let start = Settings::default();
        // Without any edit by the user.
        let mut history = History::default();
        history.undoer.feed_state(0.0, &step(&start));
        let settings = finish(&mut history, 1.0, &start);
        assert!(!history.can_undo(&step(&settings)) && !history.can_redo(&step(&settings)));
        // Turned a moment ago or long ago, after another look; and with one undo.
        for (rest_s, back) in [(0.1, 0), (3.0, 0), (3.0, 1)] {
            let mut history = History::default();
            let mut other = start.clone();
            other.shading.ambient = 0.9;
            let mut turned = start.clone();
            turned.camera.azimuth_deg = 77.0;
            for (at_s, look) in [(0.0, &other), (1.0, &start), (2.0, &start), (4.0, &turned)] {
                history.undoer.feed_state(at_s, &step(look));
            }
            history.undoer.feed_state(4.0 + rest_s, &step(&turned));
            let mut settings = turned.clone();
            for _ in 0..back {
                undo_or_redo(&mut history, &mut settings, true);
            }
            for frame in 0..3 {
                settings = finish(&mut history, 8.0 + 0.01 * f64::from(frame), &settings);
            }
            assert_eq!(history.can_redo(&step(&settings)), back > 0);
            for _ in 0..back {
                undo_or_redo(&mut history, &mut settings, false);
            }
            assert_eq!((settings.lights[0].intensity, settings.camera.azimuth_deg), (3.0, 77.0));
            undo_or_redo(&mut history, &mut settings, true);
            assert_eq!(settings.camera, start.camera, "the view goes back, after {rest_s} s");
            assert_eq!(settings.lights[0].intensity, 3.0, "and the light stays");
            undo_or_redo(&mut history, &mut settings, true);
            assert_eq!(settings, other, "what was before is not touched");
            assert!(!history.can_undo(&step(&settings)));
        }
    }

    #[test]
    fn what_follows_a_change_is_undone_with_it() {
        let (mut history, start) = (History::default(), Settings::default());
        let mut settings = start.clone();
        history.undoer.feed_state(0.0, &step(&settings));
        // Without a change there is nothing to undo.
        settings.shadows.balance = 1.1;
        history.merge_into_last(0.5, &step(&start), &step(&settings));
        assert!(!history.can_undo(&step(&settings)));
        let start = settings.clone();
        // At once, and after the change has become a step.
        for rest_s in [0.1, 3.0] {
            settings.lights[0].intensity = 2.0;
            history.undoer.feed_state(1.0, &step(&settings));
            history.undoer.feed_state(1.0 + rest_s, &step(&settings));
            for balance in [1.2, 1.3, 1.4] {
                let before = settings.clone();
                settings.shadows.balance = balance;
                history.merge_into_last(5.0, &step(&before), &step(&settings));
                history.undoer.feed_state(5.0, &step(&settings));
            }
            let end = settings.clone();
            undo_or_redo(&mut history, &mut settings, true);
            assert_eq!(settings, start);
            assert!(!history.can_undo(&step(&settings)));
            undo_or_redo(&mut history, &mut settings, false);
            assert_eq!(settings, end);
            undo_or_redo(&mut history, &mut settings, true);
            assert_eq!(settings, start);
        }
    }

    #[test]
    fn steps_are_listed_with_what_they_changed() {
        let (mut history, mut settings) = (History::default(), Settings::default());
        let mut time = 0.0;
        let mut rest = |history: &mut History, settings: &Settings| {
            for _ in 0..3 {
                history.undoer.feed_state(time, &step(settings));
                time += 1.0;
            }
        };
        rest(&mut history, &settings);
        settings.floor.on = true;
        rest(&mut history, &settings);
        settings.camera.azimuth_deg = 77.0;
        rest(&mut history, &settings);
        let all = history.list_steps(&step(&settings));
        assert_eq!(
            (all.names.as_slice(), all.current),
            (["switch on floor".to_owned(), "turn camera".to_owned()].as_slice(), 2)
        );
        undo_or_redo(&mut history, &mut settings, true);
        let before = history.list_steps(&step(&settings));
        assert_eq!((before.names, before.current), (all.names, 1));
    }

    #[test]
    fn undoing_all_is_the_start_and_redoing_all_is_the_end() {
        for seed in 0..20 {
            let (mut history, mut settings) = (History::default(), Settings::default());
            let start = settings.clone();
            let mut numbers = numbers(seed);
            let mut time = 0.0;
            let mut steps = vec![start.clone()];
            history.undoer.feed_state(time, &step(&settings));
            for _ in 0..25 {
                let (choice, amount) = (numbers.next().unwrap(), numbers.next().unwrap());
                edit(&mut settings, choice, amount);
                // Changed, and then left alone for long enough.
                for pause in [0.0, 1.0, 1.0] {
                    time += pause;
                    history.undoer.feed_state(time, &step(&settings));
                }
                if steps.last() != Some(&settings) {
                    steps.push(settings.clone());
                }
            }
            let end = settings.clone();
            let mut back = vec![settings.clone()];
            while history.can_undo(&step(&settings)) {
                undo_or_redo(&mut history, &mut settings, true);
                back.push(settings.clone());
            }
            assert_eq!(settings, start, "seed {seed}");
            back.reverse();
            assert_eq!(back, steps, "every step, in order; seed {seed}");
            while history.can_redo(&step(&settings)) {
                undo_or_redo(&mut history, &mut settings, false);
            }
            assert_eq!(settings, end, "seed {seed}");
        }
    }
}
