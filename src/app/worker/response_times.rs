//! Response times: from the window's frame that read an input to the frame that shows its effect.

use std::collections::VecDeque;
use std::time::Instant;

/// Maximum number of unanswered requests that are remembered: 64 frames are more than a second.
const MAX_PENDING: usize = 64;

/// Statistics of response times.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct ResponseTimes {
    /// Number of answered requests.
    pub count: u32,
    /// Mean response time, in milliseconds.
    pub mean_ms: f64,
    /// Longest response time, in milliseconds.
    pub max_ms: f64,
}

/// Requests whose effect is not yet on screen, the oldest first.
#[derive(Debug)]
pub(crate) struct PendingRequests<T> {
    pending: VecDeque<(T, Instant)>,
    answers: ResponseTimes,
}

impl<T> Default for PendingRequests<T> {
    fn default() -> Self {
        Self { pending: VecDeque::new(), answers: ResponseTimes::default() }
    }
}

impl<T: PartialEq> PendingRequests<T> {
    /// Records a new request.
    pub(crate) fn add(&mut self, request: T, now: Instant) {
        // The oldest requests are those that no picture will answer.
        self.pending.drain(..self.pending.len().saturating_sub(MAX_PENDING - 1));
        self.pending.push_back((request, now));
    }

    /// Records that the picture of a request is on screen, which answers the earlier requests as well.
    pub(crate) fn complete(&mut self, shown: &T, now: Instant) {
        let Some(at) = self.pending.iter().position(|(request, _)| request == shown) else { return };
        for (_, asked) in self.pending.drain(..=at) {
            let took_ms = now.saturating_duration_since(asked).as_secs_f64() * 1000.0;
            let ResponseTimes { count, mean_ms, max_ms: worst_ms } = &mut self.answers;
            *count += 1;
            *mean_ms += (took_ms - *mean_ms) / f64::from(*count);
            *worst_ms = worst_ms.max(took_ms);
        }
    }

    /// Returns the statistics of all answers so far.
    pub(crate) fn statistics(&self) -> ResponseTimes {
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
        let mut waiting = PendingRequests::default();
        for (request, ms) in [(1, 0), (2, 10), (3, 30)] {
            waiting.add(request, at(ms));
        }
        waiting.complete(&2, at(100));
        assert_eq!(waiting.statistics(), ResponseTimes { count: 2, mean_ms: 95.0, max_ms: 100.0 });
        waiting.complete(&2, at(150));
        waiting.complete(&9, at(160));
        assert_eq!(waiting.statistics().count, 2, "seen before, or never asked for");
        waiting.complete(&3, at(180));
        assert_eq!(waiting.statistics(), ResponseTimes { count: 3, mean_ms: 340.0 / 3.0, max_ms: 150.0 });
        for request in 0..200 {
            waiting.add(request, at(200));
        }
        let kept: Vec<_> = waiting.pending.iter().map(|(request, _)| *request).collect();
        assert_eq!(kept, (200 - MAX_PENDING as i32..200).collect::<Vec<_>>(), "the newest are kept");
    }
}
