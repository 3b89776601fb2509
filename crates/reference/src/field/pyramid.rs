//! Prefiltered volume and its pyramid, for kernels that perspective stretches (P §4: "the splatting kernels must be
//! progressively stretched") and for gradients.
//!
//! Level 0 is the volume blurred with [a, 1 − 2a, a]³, a = 1/12, on a lattice that begins four voxels before the
//! grid; a trilinear fetch of it has the variance of the cubic B-spline, ⅓. Each further level has half the
//! resolution, and a fetch of it four times the variance.

use glam::DVec3;
use rayon::prelude::*;

use super::{DensityField, Rounding, trilinear};

/// Coarsest level: kernels are stretched up to eight times.
pub(crate) const MAX_LEVEL: usize = 3;

/// Texels of padding before the grid on every axis.
const PAD: usize = 4;

/// Prefiltered volume at full, ½, ¼ and ⅛ resolution.
#[derive(Debug, Clone)]
pub struct Pyramid {
    levels: Vec<PyramidLevel>,
}

#[derive(Debug, Clone)]
struct PyramidLevel {
    dims: [usize; 3],
    values: Vec<f64>,
}

impl Pyramid {
    /// Blurs a field and halves the result three times. `width` is the kernel's width relative to the correct one;
    /// every level is rounded as it is stored.
    pub fn new(field: &DensityField, width: f64, rounding: Option<Rounding>) -> Self {
        Self::with_presence(field, width, rounding, None)
    }

    /// Creates a pyramid as [`Self::new`] does, whose blurred field is multiplied by presence.
    pub(crate) fn with_presence(
        field: &DensityField,
        width: f64,
        rounding: Option<Rounding>,
        presence: Option<&Self>,
    ) -> Self {
        Self::from_finest(blurred(field, prefilter_weights(width)), rounding, presence)
    }

    /// Creates the pyramids of fields as [`Self::with_presence`] does, but with a wider blur, [1, 2, 1]/4 along each
    /// axis, wherever that of the first field is larger.
    pub(crate) fn with_wide_outskirts<const N: usize>(
        fields: [&DensityField; N],
        width: f64,
        rounding: Option<Rounding>,
        presence: Option<&Self>,
    ) -> [Self; N] {
        let narrow = fields.map(|field| blurred(field, prefilter_weights(width)));
        let wide = fields.map(|field| blurred(field, [0.25, 0.5, 0.25]));
        let texels = narrow[0].values.iter().zip(&wide[0].values);
        let is_wide: Vec<bool> = texels.map(|(narrow, wide)| wide > narrow).collect();
        let mut finest = narrow;
        for (finest, wide) in finest.iter_mut().zip(&wide) {
            for ((value, wide), _) in
                finest.values.iter_mut().zip(&wide.values).zip(&is_wide).filter(|(_, is_wide)| **is_wide)
            {
                *value = *wide;
            }
        }
        finest.map(|finest| Self::from_finest(finest, rounding, presence))
    }

    fn from_finest(mut finest: PyramidLevel, rounding: Option<Rounding>, presence: Option<&Self>) -> Self {
        let round = |value: f64| rounding.map_or(value, |round| f64::from(round(value as f32)));
        if let Some(presence) = presence {
            finest
                .values
                .iter_mut()
                .zip(&presence.levels[0].values)
                .for_each(|(value, share)| *value *= share);
        }
        finest.values.iter_mut().for_each(|value| *value = round(*value));
        let mut levels = vec![finest];
        for finer in 0..MAX_LEVEL {
            levels.push(halved(&levels[finer], round));
        }
        Self { levels }
    }

    /// Quantises all values to `steps` steps from 0 to 1.
    pub(crate) fn quantised(mut self, steps: f64) -> Self {
        for value in self.levels.iter_mut().flat_map(|level| &mut level.values) {
            *value = (*value * steps).round() / steps;
        }
        self
    }

    /// Returns the differences between the next and the previous texel along an axis, level by level.
    pub(crate) fn central_differences(&self, axis: usize) -> Self {
        let change = |level: &PyramidLevel| {
            let PyramidLevel { dims, values } = level;
            let at = |texel: [usize; 3], along: usize| {
                let [x, y, z] = std::array::from_fn(|i| if i == axis { along } else { texel[i] });
                values[x + dims[0] * (y + dims[1] * z)]
            };
            let values = texels(*dims, |texel| {
                let behind = (texel[axis] + 1).min(dims[axis] - 1);
                at(texel, behind) - at(texel, texel[axis].saturating_sub(1))
            });
            PyramidLevel { dims: *dims, values }
        };
        Self { levels: self.levels.iter().map(change).collect() }
    }

    /// Returns the value at an index-space point: trilinear in the two levels around `level`, linear between them.
    pub fn fetch(&self, point: DVec3, level: f64) -> f64 {
        let level = level.clamp(0.0, MAX_LEVEL as f64);
        let finer = level as usize;
        let share = level - finer as f64;
        let low = self.fetch_level(point, finer);
        if share == 0.0 { low } else { low + (self.fetch_level(point, finer + 1) - low) * share }
    }

    /// Interpolates in one level. Texture coordinate u = (p + 4.5) / padded dims on every level, so in texels u ·
    /// dims − ½.
    fn fetch_level(&self, point: DVec3, level: usize) -> f64 {
        let PyramidLevel { dims, values } = &self.levels[level];
        let at = (point + PAD as f64 + 0.5) / (1 << level) as f64 - 0.5;
        trilinear(*dims, values, at)
    }
}

/// Returns the weights a, 1 − 2a, a of the blur along each axis; the variance 2a + 1/6 (the tent's) is ⅓ for width 1.
fn prefilter_weights(width: f64) -> [f64; 3] {
    let a = (width * width / 3.0 - 1.0 / 6.0) / 2.0;
    [a, 1.0 - 2.0 * a, a]
}

/// Blurs a field: the sum over the 27 neighbours, weighted along each axis.
fn blurred(field: &DensityField, weights: [f64; 3]) -> PyramidLevel {
    let dims = field.dims.map(|n| (n + 2 * PAD).next_multiple_of(1 << MAX_LEVEL));
    let values = texels(dims, |texel| {
        let [x, y, z] = texel.map(|t| t as i64 - PAD as i64);
        let mut sum = 0.0;
        for (dz, wz) in (-1..).zip(weights) {
            for (dy, wy) in (-1..).zip(weights) {
                for (dx, wx) in (-1..).zip(weights) {
                    sum += wx * wy * wz * field.at(x + dx, y + dy, z + dz);
                }
            }
        }
        sum
    });
    PyramidLevel { dims, values }
}

/// Halves the resolution. Eight trilinear fetches at ± 0.625 texel from the middle of a coarse texel weigh the finer
/// ones by 1/16, 7/16, 7/16, 1/16 per axis, which adds a variance of ½ texel².
fn halved(finer: &PyramidLevel, round: impl Fn(f64) -> f64 + Sync) -> PyramidLevel {
    const STEP: f64 = 0.625;
    let dims = finer.dims.map(|n| n / 2);
    let values = texels(dims, |texel| {
        let middle = DVec3::from(texel.map(|t| 2.0 * t as f64 + 0.5));
        let fetches = (0..8).map(|corner| {
            let side = |axis: usize| if corner >> axis & 1 == 0 { -STEP } else { STEP };
            trilinear(finer.dims, &finer.values, middle + DVec3::new(side(0), side(1), side(2)))
        });
        round(fetches.sum::<f64>() / 8.0)
    });
    PyramidLevel { dims, values }
}

/// Computes one value per texel, x fastest, slices in parallel.
fn texels(dims: [usize; 3], value: impl Fn([usize; 3]) -> f64 + Sync) -> Vec<f64> {
    let [nx, ny, nz] = dims;
    let row = |z: usize| (0..nx * ny).map(move |n| [n % nx, n / nx, z]);
    (0..nz).into_par_iter().flat_map_iter(|z| row(z).map(&value)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::BorderMode;

    #[test]
    fn every_level_keeps_the_sum_and_the_place_and_widens_the_kernel_as_it_should() {
        let densities = vec![0.0; 24 * 24 * 24];
        let mut field = DensityField { dims: [24; 3], densities, border: BorderMode::Clamp };
        field.densities[11 + 24 * (12 + 24 * 12)] = 1.0;
        let pyramid = Pyramid::new(&field, 1.0, None);
        // All phases: samples finely along x through the sums over y and z.
        for level in 0..=2usize {
            let step = 0.5;
            let (mut mass, mut mean, mut square) = (0.0, 0.0, 0.0);
            for n in 0..64usize.pow(3) {
                let [x, y, z] = [n % 64, n / 64 % 64, n / 4096].map(|c| -4.0 + c as f64 * step);
                let value = pyramid.fetch(DVec3::new(x, y, z), level as f64) * step.powi(3);
                mass += value;
                mean += value * x;
                square += value * x * x;
            }
            let variance = square / mass - (mean / mass).powi(2);
            assert!((mass - 1.0).abs() < 1e-9, "level {level}: {mass}");
            assert!((mean - 11.0).abs() < 0.5, "level {level}: {mean}");
            let right = 4f64.powi(level as i32) / 3.0;
            assert!((variance / right - 1.0).abs() < 0.25, "level {level}: {variance}, not {right}");
        }
    }
}
