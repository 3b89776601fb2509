//! Response times: from the window's frame that read an input to the frame that shows its effect.

use std::collections::VecDeque;
use std::time::Instant;

/// Maximum number of unanswered requests that are remembered: 64 frames are more than a second.
const MOST_OPEN: usize = 64;

/// Statistics of response times.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(in crate::app) struct Response {
    /// Number of answered requests.
    pub count: u32,
    /// Mean response time, in milliseconds.
    pub mean_ms: f64,
    /// Longest response time, in milliseconds.
    pub worst_ms: f64,
}

/// Requests whose effect is not yet on screen, the oldest first.
#[derive(Debug)]
pub(crate) struct Waiting<T> {
    open: VecDeque<(T, Instant)>,
    answers: Response,
}

impl<T> Default for Waiting<T> {
    fn default() -> Self {
        Self { open: VecDeque::new(), answers: Response::default() }
    }
}

impl<T: PartialEq> Waiting<T> {
    /// Records a new request.
    pub(crate) fn ask(&mut self, request: T, now: Instant) {
        self.open.truncate(MOST_OPEN - 1);
        self.open.push_back((request, now));
    }

    /// Records that the picture of a request is on screen, which answers the earlier requests as well.
    pub(crate) fn answer(&mut self, shown: &T, now: Instant) {
        let Some(at) = self.open.iter().position(|(request, _)| request == shown) else { return };
        for (_, asked) in self.open.drain(..=at) {
            let took_ms = now.saturating_duration_since(asked).as_secs_f64() * 1000.0;
            let Response { count, mean_ms, worst_ms } = &mut self.answers;
            *count += 1;
            *mean_ms += (took_ms - *mean_ms) / f64::from(*count);
            *worst_ms = worst_ms.max(took_ms);
        }
    }

    /// Returns the statistics of all answers so far.
    pub(crate) fn answers(&self) -> Response {
        self.answers
    }

    /// Discards all records, after a change of volume.
    pub(crate) fn clear(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn the_oldest_input_that_a_picture_shows_waited_longest() {
        let start = Instant::now();
        let at = |ms: u64| start + Duration::from_millis(ms);
        let mut waiting = Waiting::default();
        for (request, ms) in [(1, 0), (2, 10), (3, 30)] {
            waiting.ask(request, at(ms));
        }
        waiting.answer(&2, at(100));
        assert_eq!(waiting.answers(), Response { count: 2, mean_ms: 95.0, worst_ms: 100.0 });
        waiting.answer(&2, at(150));
        waiting.answer(&9, at(160));
        assert_eq!(waiting.answers().count, 2, "seen before, or never asked for");
        waiting.answer(&3, at(180));
        assert_eq!(waiting.answers(), Response { count: 3, mean_ms: 340.0 / 3.0, worst_ms: 150.0 });
        for request in 0..200 {
            waiting.ask(request, at(200));
        }
        assert!(waiting.open.len() <= MOST_OPEN);
    }
}
