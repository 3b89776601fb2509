//! Undo and redo of settings.

use eframe::egui;
use eframe::egui::util::undoer::{self, Undoer};

use crate::model::Settings;

/// Seconds without a change after which a step can be undone.
const STABLE_S: f32 = 0.4;

/// The settings as they were.
#[derive(Debug)]
pub(crate) struct History {
    undoer: Undoer<Settings>,
}

impl Default for History {
    fn default() -> Self {
        let settings = undoer::Settings { stable_time: STABLE_S, ..undoer::Settings::default() };
        Self { undoer: Undoer::with_settings(settings) }
    }
}

impl History {
    /// Takes note of the settings, except while something is dragged: a drag is one step.
    pub(crate) fn observe(&mut self, ctx: &egui::Context, settings: &Settings) {
        if ctx.dragged_id().is_none() {
            self.undoer.feed_state(ctx.input(|input| input.time), settings);
        }
        if self.undoer.is_in_flux() {
            ctx.request_repaint_after(std::time::Duration::from_secs_f32(STABLE_S));
        }
    }

    /// A change has been followed by another that the window makes by itself: both are one step.
    pub(crate) fn follow(&mut self, now_s: f64, before: &Settings, after: &Settings) {
        // The change is at rest, whether or not it has been for long enough to be a step.
        self.undoer.add_undo(before);
        if self.undoer.has_undo(before) {
            // Its step goes, and so does the way forward to it.
            self.undoer.undo(before);
            self.undoer.feed_state(now_s, after);
        } else {
            *self = Self::default();
        }
        self.undoer.add_undo(after);
    }

    /// Whether there is a step back.
    pub(crate) fn can_undo(&self, settings: &Settings) -> bool {
        self.undoer.has_undo(settings)
    }

    /// Whether there is a step forward.
    pub(crate) fn can_redo(&self, settings: &Settings) -> bool {
        self.undoer.has_redo(settings)
    }

    /// One step back.
    pub(crate) fn undo(&mut self, settings: &mut Settings) {
        if let Some(before) = self.undoer.undo(settings) {
            settings.clone_from(before);
        }
    }

    /// One step forward again.
    pub(crate) fn redo(&mut self, settings: &mut Settings) {
        if let Some(after) = self.undoer.redo(settings) {
            settings.clone_from(after);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A few numbers that look random and are always the same.
    fn numbers(seed: u64) -> impl Iterator<Item = u64> {
        std::iter::successors(Some(seed), |x| {
            Some(x.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407))
        })
        .skip(1)
        .map(|x| x >> 33)
    }

    /// Edits one thing or another.
    fn edit(settings: &mut Settings, choice: u64, amount: u64) {
        let share = (amount % 1000) as f64 / 1000.0;
        match choice % 8 {
            0 => settings.camera.azimuth_deg = 360.0 * share,
            1 => settings.lights[0].position[0] = 4.0 * share + 1.0,
            2 => settings.shadows.strength = share,
            3 => settings.shading.ambient = share,
            4 => settings.lights[0].on ^= true,
            5 => settings.transfer.points.push(crate::model::ControlPoint::new(
                amount as f64,
                [share as f32; 3],
                share,
            )),
            6 => drop(settings.views.insert((amount % 9) as u8 + 1, settings.camera.clone())),
            _ => settings.lighting.scale = share + 0.5,
        }
    }

    #[test]
    fn what_follows_a_change_is_undone_with_it() {
        let (mut history, start) = (History::default(), Settings::default());
        let mut settings = start.clone();
        history.undoer.feed_state(0.0, &settings);
        // Nothing was changed: there is nothing to undo.
        settings.shadows.balance = 1.1;
        history.follow(0.5, &start, &settings);
        assert!(!history.can_undo(&settings));
        let start = settings.clone();
        // At once, and after the change became a step.
        for rest_s in [0.1, 3.0] {
            settings.lights[0].intensity = 2.0;
            history.undoer.feed_state(1.0, &settings);
            history.undoer.feed_state(1.0 + rest_s, &settings);
            for balance in [1.2, 1.3, 1.4] {
                let before = settings.clone();
                settings.shadows.balance = balance;
                history.follow(5.0, &before, &settings);
                history.undoer.feed_state(5.0, &settings);
            }
            let end = settings.clone();
            history.undo(&mut settings);
            assert_eq!(settings, start);
            assert!(!history.can_undo(&settings));
            history.redo(&mut settings);
            assert_eq!(settings, end);
            history.undo(&mut settings);
            assert_eq!(settings, start);
        }
    }

    #[test]
    fn undoing_all_is_the_start_and_redoing_all_is_the_end() {
        for seed in 0..20 {
            let (mut history, mut settings) = (History::default(), Settings::default());
            let start = settings.clone();
            let mut numbers = numbers(seed);
            let mut time = 0.0;
            let mut steps = vec![start.clone()];
            history.undoer.feed_state(time, &settings);
            for _ in 0..25 {
                let (choice, amount) = (numbers.next().unwrap(), numbers.next().unwrap());
                edit(&mut settings, choice, amount);
                // Changed, and then left alone for long enough.
                for pause in [0.0, 1.0, 1.0] {
                    time += pause;
                    history.undoer.feed_state(time, &settings);
                }
                if steps.last() != Some(&settings) {
                    steps.push(settings.clone());
                }
            }
            let end = settings.clone();
            let mut back = vec![settings.clone()];
            while history.can_undo(&settings) {
                history.undo(&mut settings);
                back.push(settings.clone());
            }
            assert_eq!(settings, start, "seed {seed}");
            back.reverse();
            assert_eq!(back, steps, "every step, in order; seed {seed}");
            while history.can_redo(&settings) {
                history.redo(&mut settings);
            }
            assert_eq!(settings, end, "seed {seed}");
        }
    }
}
