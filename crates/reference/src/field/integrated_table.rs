//! Transfer function with its integrals, for means between two densities.

use glam::DVec3;

use super::classified::associated;
use chiaroscuro_scene::{BakedTransfer, LUT_SIZE};

/// Distance of two densities, in entries, below which the mean over their entry stands for the mean between them.
const MIN_DISTANCE: f64 = 0.125;

/// Lookup table of a transfer function that is integrated between densities.
pub(crate) struct IntegratedTable {
    table: BakedTransfer,
    /// `true` if it is that of classified voxels, of which shares of the largest extinction are spread.
    is_of_shares: bool,
}

impl IntegratedTable {
    pub(crate) fn new(table: BakedTransfer, is_of_shares: bool) -> Self {
        Self { table, is_of_shares }
    }

    /// Returns the position of a density in the table, in entries.
    fn position(density: f64) -> f64 {
        density.clamp(0.0, 1.0) * (LUT_SIZE - 1) as f64
    }

    /// Returns the integral up to a position, of colour times extinction and of extinction.
    fn integral(&self, at: f64) -> [f64; 4] {
        let low = (at as usize).min(LUT_SIZE - 2);
        let [first, second] = [low, low + 1].map(|entry| self.table.integrals[entry].map(f64::from));
        std::array::from_fn(|i| first[i] + (second[i] - first[i]) * (at - low as f64))
    }

    /// Returns the means between two densities: of colour times extinction, and of extinction.
    pub(crate) fn mean_between(&self, from: f64, to: f64) -> [f64; 4] {
        let (mut a, mut b) = (Self::position(from), Self::position(to));
        if (b - a).abs() < MIN_DISTANCE {
            if self.is_of_shares {
                // The mean over the first entry would be that of faint material, which empty space is not.
                let [near, far] = [from, to].map(|share| associated(self.table.sample(share)));
                return std::array::from_fn(|i| 0.5 * (near[i] + far[i]));
            }
            let entry = (0.5 * (a + b)).min((LUT_SIZE - 2) as f64).floor();
            (a, b) = (entry, entry + 1.0);
        }
        let (first, last) = (self.integral(a), self.integral(b));
        std::array::from_fn(|i| (last[i] - first[i]) / (b - a))
    }

    /// Returns the linear colour at a density.
    pub(crate) fn color_at(&self, density: f64) -> DVec3 {
        let [r, g, b, _] = self.table.sample(density);
        DVec3::new(r, g, b)
    }

    /// Returns the largest extinction between two densities.
    pub(crate) fn max_between(&self, a: f64, b: f64) -> f64 {
        self.table.max_extinction_in(a.min(b), a.max(b))
    }
}
