//! Time that a light volume took to fill.

use std::time::Instant;

/// Stopwatch from the first step of filling a volume to the last.
#[derive(Debug, Default)]
pub(crate) struct FillStopwatch {
    started: Option<Instant>,
    took_ms: Option<f64>,
}

impl FillStopwatch {
    /// Starts the stopwatch at the first step; later calls have no effect.
    pub(crate) fn begin(&mut self) {
        self.started.get_or_insert_with(Instant::now);
    }

    /// Stops the stopwatch after the last step.
    pub(crate) fn finish(&mut self) {
        self.took_ms = self.started.map(|started| started.elapsed().as_secs_f64() * 1000.0);
    }

    /// Returns the duration in milliseconds, once the volume is filled.
    pub(crate) fn elapsed_ms(&self) -> Option<f64> {
        self.took_ms
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_has_begun_and_ended_took_time() {
        let mut fill = FillStopwatch::default();
        fill.finish();
        assert_eq!(fill.elapsed_ms(), None);
        fill.begin();
        assert_eq!(fill.elapsed_ms(), None);
        fill.finish();
        assert!(fill.elapsed_ms().is_some_and(|ms| ms >= 0.0));
    }
}
