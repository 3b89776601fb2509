//! Steps towards the limit of the series of bounces, and the light that each sweep brings.

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

/// Returns the light that a sweep brings to blocks without what the interpolation between its rays has spread: the
/// second difference times t(1 − t)/2, in the mean over t, for two axes of three. Along an axis it is unknown beside
/// blocks that do not attenuate light.
pub(super) fn without_spread(dims: [usize; 3], extinction: &[f64], light: &[f64]) -> Vec<f64> {
    let strides = [1, dims[0], dims[0] * dims[1]];
    let of_block = |at: usize| {
        let place = [at % dims[0], at / dims[0] % dims[1], at / strides[2]];
        let spread: f64 = (0..3)
            .filter(|&axis| place[axis] > 0 && place[axis] + 1 < dims[axis])
            .map(|axis| [at - strides[axis], at + strides[axis]])
            .filter(|both| both.iter().all(|&next| extinction[next] > 0.0))
            .map(|[before, after]| light[before] + light[after] - 2.0 * light[at])
            .sum();
        (light[at] - spread / 18.0).max(0.0)
    };
    (0..light.len()).map(of_block).collect()
}
