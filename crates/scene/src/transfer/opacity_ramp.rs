//! Opacities in place of extinctions, for voxels that are composed of layers before they are spread.
//!
//! Between an opaque voxel and an empty one, half of a large extinction is opaque, too, and a fiftieth is a haze around
//! the surface; half of the opacity is half.

use super::{BakedTransfer, LUT_SIZE};

impl BakedTransfer {
    /// Creates the table whose extinctions are replaced by the opacities of material of a length in scene units.
    #[must_use]
    pub fn with_opacities(&self, length: f64) -> Self {
        let opacity = |extinction: f32| -(-f64::from(extinction) * length).exp_m1() as f32;
        Self::new(self.entries.iter().map(|&[r, g, b, extinction]| [r, g, b, opacity(extinction)]).collect())
    }

    /// Creates a white table over relative opacity, of material of a length in scene units, whose extinction rises from
    /// 0 to `largest`: the inverse of [`Self::with_opacities`], for volumes that store shares of the largest opacity.
    pub fn opacity_ramp(largest: f32, length: f64) -> Self {
        let largest = f64::from(largest);
        let most = -(-largest * length).exp_m1();
        let extinction = |entry: usize| {
            let share = entry as f64 / (LUT_SIZE - 1) as f64;
            (-(-share * most).ln_1p() / length).min(largest) as f32
        };
        Self::new((0..LUT_SIZE).map(|entry| [1.0, 1.0, 1.0, extinction(entry)]).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extinctions_come_back_from_opacities() {
        for (largest, length) in [(0.01, 0.1), (3.0, 0.5), (200.0, 0.02)] {
            let ramp = BakedTransfer::linear_ramp(largest);
            let (opacities, back) =
                (ramp.with_opacities(length), BakedTransfer::opacity_ramp(largest, length));
            let most = f64::from(opacities.max_extinction());
            for density in [0.0, 0.1, 0.5, 0.9, 1.0] {
                let share = opacities.sample(density)[3] / most;
                let found = back.sample(share)[3];
                let expected = ramp.sample(density)[3];
                assert!(
                    (found - expected).abs() <= 2e-3 * f64::from(largest),
                    "{largest}: {found}, {expected}"
                );
            }
        }
        assert_eq!(BakedTransfer::opacity_ramp(0.0, 1.0).max_extinction(), 0.0);
    }
}
