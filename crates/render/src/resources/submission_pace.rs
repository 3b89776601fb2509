//! Pace of submissions: the number of steps that the adapter takes at a time, learned from how long earlier ones took.
//!
//! Each submission, and each wait for it, costs the host as much as a quick adapter needs for several steps; on a slow
//! one, a step is long enough for the window to wait for.

use std::cell::Cell;

/// Duration of a submission in milliseconds: a frame of most displays, after which a picture may be abandoned for a
/// newer one.
const SUBMISSION_MS: f64 = 16.0;

/// Maximum number of steps in a submission. Adapters that have been quick may meet steps a hundred times as long, and
/// drivers end programs that occupy the adapter for two seconds.
const MAX_STEPS: u32 = 64;

/// Maximum factor by which the number of steps grows at a time: steps differ.
const MAX_GROWTH: u32 = 4;

/// Kind of steps that last about as long as each other, and are submitted together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum StepKind {
    /// Steps that upload the volume, and fill what is derived from it.
    Volume,
    /// Steps that fill light volumes.
    Light,
    /// Steps that compute sky visibility and scattered light.
    Ambient,
    /// Steps that draw the linear picture, the floor and the display.
    Picture,
}

/// Number of kinds of steps.
const KINDS: usize = 4;

/// Number of steps per submission, for each kind.
#[derive(Debug, Default)]
pub(crate) struct SubmissionPace([Cell<StepCount>; KINDS]);

/// Number of steps to submit together.
#[derive(Debug, Clone, Copy)]
struct StepCount {
    steps: u32,
    /// True until more steps would take too long.
    grows: bool,
}

impl Default for StepCount {
    fn default() -> Self {
        Self { steps: 1, grows: true }
    }
}

impl SubmissionPace {
    /// Returns the number of steps of a kind to submit together.
    pub(crate) fn steps(&self, kind: StepKind) -> u32 {
        self.0[kind as usize].get().steps
    }

    /// Returns true if more steps of a kind may fit, which the next submission's time tells.
    pub(crate) fn grows(&self, kind: StepKind) -> bool {
        self.0[kind as usize].get().grows
    }

    /// Updates the number of steps of a kind, of which `steps` took this long.
    pub(crate) fn learn(&self, kind: StepKind, steps: u32, took_ms: f64) {
        if steps == 0 {
            return;
        }
        let known = &self.0[kind as usize];
        let before = known.get().steps;
        // The cast saturates.
        let fitting = (SUBMISSION_MS * f64::from(steps) / took_ms.max(1e-6)) as u32;
        let steps = fitting.clamp(1, (before * MAX_GROWTH).min(MAX_STEPS));
        known.set(StepCount { steps, grows: steps > before });
    }

    /// Returns to single steps if submissions that nothing waited for took much longer than they should: other work
    /// than before.
    pub(crate) fn slow_down(&self, submissions: u32, took_ms: f64) {
        if took_ms > f64::from(submissions) * f64::from(MAX_GROWTH) * SUBMISSION_MS {
            self.0.iter().for_each(|known| known.set(StepCount::default()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quick_steps_are_submitted_together_and_slow_ones_alone() {
        let pace = SubmissionPace::default();
        assert_eq!(pace.steps(StepKind::Light), 1);
        // Steps of 0.1 ms: more at each time, up to a limit.
        let counts: Vec<u32> = (0..5)
            .map(|_| {
                let steps = pace.steps(StepKind::Light);
                pace.learn(StepKind::Light, steps, 0.1 * f64::from(steps));
                pace.steps(StepKind::Light)
            })
            .collect();
        assert_eq!(counts, [4, 16, 64, 64, 64]);
        assert_eq!(pace.steps(StepKind::Picture), 1, "other kinds have their own pace");
        // Steps that become slow are alone at once.
        pace.learn(StepKind::Light, 64, 6400.0);
        assert_eq!(pace.steps(StepKind::Light), 1);
        // Three steps of 5 ms fit.
        pace.learn(StepKind::Light, 1, 5.0);
        assert_eq!(pace.steps(StepKind::Light), 3);
        pace.learn(StepKind::Light, 0, 0.0);
        assert_eq!(pace.steps(StepKind::Light), 3, "nothing is learned of nothing");
    }

    #[test]
    fn nothing_waits_once_the_number_is_known() {
        let pace = SubmissionPace::default();
        assert!(pace.grows(StepKind::Picture));
        pace.learn(StepKind::Picture, 1, 100.0);
        assert!(!pace.grows(StepKind::Picture) && pace.grows(StepKind::Light));
        pace.learn(StepKind::Light, 1, 0.1);
        assert!(pace.grows(StepKind::Light), "four steps may fit, and more");
        pace.learn(StepKind::Light, 4, 16.0);
        assert!(!pace.grows(StepKind::Light));
        pace.slow_down(3, 3.0 * SUBMISSION_MS);
        assert_eq!(pace.steps(StepKind::Light), 4);
        pace.slow_down(3, 13.0 * SUBMISSION_MS);
        assert_eq!(pace.steps(StepKind::Light), 1);
        assert!(pace.grows(StepKind::Picture), "it is measured again");
    }
}
