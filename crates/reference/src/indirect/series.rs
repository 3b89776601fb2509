//! Steps towards the limit of the series of bounces.

/// Largest magnitude of the share of a step that is taken out of the next.
const MAX_MIXED_SHARE: f64 = 1.0;

/// Step towards the limit of the series of bounces in one colour: what a sweep changed, and what diffuses of it.
pub(super) struct SeriesStep {
    step: Vec<f64>,
    reached: Vec<f64>,
}

impl SeriesStep {
    /// Creates the step from the light before a sweep, by the sweep's change and what diffuses of it.
    pub(super) fn new(from: &[f64], change: &[f64], later: &[f64]) -> Self {
        let step: Vec<f64> = change.iter().zip(later).map(|(change, later)| change + later).collect();
        let reached = from.iter().zip(&step).map(|(from, step)| from + step).collect();
        Self { step, reached }
    }

    /// Returns the light that is reached, less γ times how much more that is than the step before reached (Anderson
    /// 1965): γ makes the difference of the steps, taken γ times out of the last, as small as it can be.
    pub(super) fn mixed_with(&self, before: Option<&Self>, extinction: &[f64]) -> Vec<f64> {
        let Some(before) = before else { return self.reached.iter().map(|light| light.max(0.0)).collect() };
        let (mut product, mut square) = (0.0, 0.0);
        for (at, _) in extinction.iter().enumerate().filter(|(_, extinction)| **extinction > 0.0) {
            let change = self.step[at] - before.step[at];
            product += change * self.step[at];
            square += change * change;
        }
        let share = (product / square.max(1e-20)).clamp(-MAX_MIXED_SHARE, MAX_MIXED_SHARE);
        let both = self.reached.iter().zip(&before.reached);
        both.map(|(reached, before)| (reached - share * (reached - before)).max(0.0)).collect()
    }
}
