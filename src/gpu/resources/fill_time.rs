//! How long a volume of light took to be filled.

use std::time::Instant;

/// From the first of its steps to the last.
#[derive(Debug, Default)]
pub(crate) struct FillTime {
    started: Option<Instant>,
    took_ms: Option<f64>,
}

impl FillTime {
    /// A step is recorded, perhaps the first.
    pub(crate) fn begin(&mut self) {
        self.started.get_or_insert_with(Instant::now);
    }

    /// The last of its steps was recorded.
    pub(crate) fn finish(&mut self) {
        self.took_ms = self.started.map(|started| started.elapsed().as_secs_f64() * 1000.0);
    }

    /// Milliseconds that it took, once it is filled.
    pub(crate) fn took_ms(&self) -> Option<f64> {
        self.took_ms
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_has_begun_and_ended_took_time() {
        let mut fill = FillTime::default();
        fill.finish();
        assert_eq!(fill.took_ms(), None);
        fill.begin();
        assert_eq!(fill.took_ms(), None);
        fill.finish();
        assert!(fill.took_ms().is_some_and(|ms| ms >= 0.0));
    }
}
