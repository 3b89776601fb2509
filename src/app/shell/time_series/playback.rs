//! Playback of a series: which step is shown when, and which are read ahead. Times are in seconds of any monotonic clock.

/// Slowest and fastest playback, in steps per second.
pub(super) const RATES: std::ops::RangeInclusive<f64> = 0.1..=60.0;

/// Share of the interval between two steps that drawing one may take, so that there is time to prepare the next.
const DRAWING_SHARE: f64 = 0.6;

/// Share of the time that a step takes in fact that drawing it may take, where the series is slower than its rate.
const SLOW_DRAWING_SHARE: f64 = 0.3;

/// Longest time for drawing a step, in seconds: that of a picture of full quality on most adapters.
const LONGEST_DRAWING_S: f64 = 0.5;

/// State of the playback.
#[derive(Debug, Clone)]
pub(super) struct Playback {
    /// Time at which the next step is due; `None` while the series rests.
    due_s: Option<f64>,
    /// Time at which the last step was shown.
    shown_s: Option<f64>,
    /// Time from the step before to the last one, in seconds.
    taken_s: f64,
    /// Steps per second.
    pub rate: f64,
    /// True if the first step follows the last.
    pub is_loop: bool,
}

impl Default for Playback {
    fn default() -> Self {
        // Ten pictures a second are the least that seems to move; most series are made for that.
        Self { due_s: None, shown_s: None, taken_s: 0.0, rate: 10.0, is_loop: true }
    }
}

impl Playback {
    /// Returns true while the series plays.
    pub(super) fn is_playing(&self) -> bool {
        self.due_s.is_some()
    }

    /// Starts to play: the next step is due one interval after now.
    pub(super) fn start(&mut self, now_s: f64) {
        (self.due_s, self.shown_s, self.taken_s) = (Some(now_s + self.interval_s()), None, 0.0);
    }

    /// Stops at the step that is shown.
    pub(super) fn stop(&mut self) {
        self.due_s = None;
    }

    /// Returns the playback of another series at rest, with the same speed.
    pub(super) fn at_rest(&self) -> Self {
        Self { due_s: None, shown_s: None, ..self.clone() }
    }

    /// Time between two steps, in seconds.
    pub(super) fn interval_s(&self) -> f64 {
        1.0 / self.rate.clamp(*RATES.start(), *RATES.end())
    }

    /// Returns the step after another one of `count`; `None` at the end of a series that is not a loop.
    pub(super) fn next(&self, index: usize, count: usize) -> Option<usize> {
        match index + 1 {
            next if next < count => Some(next),
            _ => self.is_loop.then_some(0),
        }
    }

    /// Returns the time until the next step is due, in seconds, while the series plays.
    pub(super) fn wait_s(&self, now_s: f64) -> Option<f64> {
        self.due_s.map(|due_s| (due_s - now_s).max(0.0))
    }

    /// Records that the step that was due is shown. A series that is slower than its rate does not catch up.
    pub(super) fn advance(&mut self, now_s: f64) {
        let interval_s = self.interval_s();
        self.taken_s = self.shown_s.map_or(0.0, |shown_s| now_s - shown_s);
        self.shown_s = Some(now_s);
        self.due_s = self.due_s.map(|due_s| (due_s + interval_s).max(now_s));
    }

    /// Returns the time that drawing a step may take, in seconds. Where reading and uploading steps take longer than the
    /// interval between them, a finer picture hardly delays them.
    pub(super) fn drawing_s(&self) -> f64 {
        (DRAWING_SHARE * self.interval_s()).max(SLOW_DRAWING_SHARE * self.taken_s).min(LONGEST_DRAWING_S)
    }

    /// Returns the steps that are read, in order: the one that is wanted, then those that may be wanted next, `most` at
    /// most.
    pub(super) fn reading_order(&self, wanted: usize, count: usize, most: usize) -> Vec<usize> {
        let mut order = vec![wanted];
        let mut add = |index: usize| {
            if order.len() < most && !order.contains(&index) {
                order.push(index);
            }
        };
        if self.is_playing() {
            let mut at = wanted;
            for _ in 0..most {
                let Some(next) = self.next(at, count) else { break };
                add(next);
                at = next;
            }
        } else {
            for distance in 1..=most {
                if wanted + distance < count {
                    add(wanted + distance);
                }
                if let Some(before) = wanted.checked_sub(distance) {
                    add(before);
                }
            }
        }
        order
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_due_one_interval_apart() {
        let mut playback = Playback { rate: 4.0, ..Playback::default() };
        assert_eq!(playback.wait_s(0.0), None);
        playback.start(10.0);
        assert_eq!(playback.wait_s(10.0), Some(0.25));
        playback.advance(10.26);
        assert_eq!(playback.wait_s(10.26), Some(10.5 - 10.26), "a frame that is late delays no other");
        playback.advance(11.26);
        assert_eq!(playback.wait_s(11.26), Some(0.0), "a slow step delays the others");
        assert_eq!(playback.drawing_s(), 0.3 * (11.26 - 10.26));
        playback.advance(15.0);
        assert_eq!(playback.drawing_s(), 0.5, "the picture does not get finer then");
        playback.start(20.0);
        assert_eq!(playback.drawing_s(), 0.6 * 0.25);
        playback.stop();
        assert!(!playback.is_playing());
    }

    #[test]
    fn a_series_ends_or_begins_again() {
        let mut playback = Playback::default();
        assert_eq!((playback.next(0, 3), playback.next(2, 3)), (Some(1), Some(0)));
        playback.is_loop = false;
        assert_eq!(playback.next(2, 3), None);
    }

    #[test]
    fn steps_are_read_in_the_order_in_which_they_may_be_wanted() {
        let mut playback = Playback::default();
        assert_eq!(playback.reading_order(5, 9, 4), [5, 6, 4, 7]);
        assert_eq!(playback.reading_order(0, 9, 3), [0, 1, 2]);
        assert_eq!(playback.reading_order(8, 9, 3), [8, 7, 6]);
        playback.start(0.0);
        assert_eq!(playback.reading_order(7, 9, 4), [7, 8, 0, 1]);
        assert_eq!(playback.reading_order(1, 2, 9), [1, 0]);
        playback.is_loop = false;
        assert_eq!(playback.reading_order(7, 9, 4), [7, 8]);
    }
}
