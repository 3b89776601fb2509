//! Density field on a grid, as the renderer stores it, and trilinear interpolation in any grid.

pub(crate) mod classified;
pub(crate) mod integrated_table;
pub(crate) mod layers;
mod material_regions;
pub(crate) mod pyramid;

use glam::DVec3;

use chiaroscuro_volume::{Observer, Volume};

/// Rounding of a number when it is stored; for the GPU's half floats, f32 → f16 → f32.
pub type Rounding = fn(f32) -> f32;

/// Densities of a volume, or other numbers on its grid.
#[derive(Debug, Clone, PartialEq)]
pub struct DensityField {
    /// Number of voxels along x, y, z.
    pub dims: [usize; 3],
    /// One density per voxel, x fastest.
    pub densities: Vec<f64>,
    /// Values outside the grid.
    pub border: BorderMode,
}

/// Extension of a field outside its grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BorderMode {
    /// Values at the border are repeated (clamp to edge).
    Clamp,
    /// Values outside the grid are 0.
    Zero,
}

impl DensityField {
    /// Creates the densities of a volume, each rounded as it will be stored.
    pub fn with_rounding(volume: &Volume, round: impl Fn(f32) -> f32) -> Self {
        let dims = volume.dims();
        let densities = (0..dims[2])
            .flat_map(|z| volume.slice_densities(z))
            .map(|density| f64::from(round(density)))
            .collect();
        Self { dims, densities, border: BorderMode::Clamp }
    }

    /// Creates the presence of voxels for an observer, 1 for present and 0 for missing or hidden ones; missing voxels
    /// count as present unless `counts_missing`. `None` if all are present to eye and light.
    pub(crate) fn from_presence(volume: &Volume, observer: Observer, counts_missing: bool) -> Option<Self> {
        let missing = volume.missing().filter(|_| counts_missing);
        let hidden = volume.mask().map(|mask| mask.hidden_from(observer));
        let share = |voxel: usize| match hidden {
            _ if missing.is_some_and(|missing| missing.contains(voxel)) => 0.0,
            Some(hidden) => 1.0 - f64::from(hidden[voxel]) / 255.0,
            None => 1.0,
        };
        let densities = (0..volume.voxel_count()).map(share).collect();
        (missing.is_some() || hidden.is_some()).then_some(Self {
            dims: volume.dims(),
            densities,
            border: BorderMode::Zero,
        })
    }

    /// Returns the density of one voxel, inside the grid or outside.
    pub fn at(&self, x: i64, y: i64, z: i64) -> f64 {
        if self.border == BorderMode::Zero && !self.contains(x, y, z) {
            return 0.0;
        }
        let nearest = |c: i64, n: usize| c.clamp(0, n as i64 - 1) as usize;
        let [nx, ny, nz] = self.dims;
        self.densities[nearest(x, nx) + nx * (nearest(y, ny) + ny * nearest(z, nz))]
    }

    /// Returns true if a voxel is in the grid.
    pub(crate) fn contains(&self, x: i64, y: i64, z: i64) -> bool {
        [x, y, z].iter().zip(self.dims).all(|(c, n)| (0..n as i64).contains(c))
    }
}

/// Interpolates trilinearly between the eight values around `at`; values lie at integers, and are clamped to the edge
/// outside.
pub(crate) fn trilinear(dims: [usize; 3], values: &[f64], at: DVec3) -> f64 {
    let cell = |axis: usize| {
        let last = (dims[axis] - 1) as f64;
        let low = at[axis].floor();
        let clamped = [low, low + 1.0].map(|c| c.clamp(0.0, last) as usize);
        (clamped, at[axis] - low)
    };
    let ([x0, x1], tx) = cell(0);
    let ([y0, y1], ty) = cell(1);
    let ([z0, z1], tz) = cell(2);
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let row = |y: usize, z: usize| {
        let start = dims[0] * (y + dims[1] * z);
        mix(values[start + x0], values[start + x1], tx)
    };
    mix(mix(row(y0, z0), row(y1, z0), ty), mix(row(y0, z1), row(y1, z1), ty), tz)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fetch_is_linear_inside_and_constant_outside() {
        let values: Vec<f64> = (0..24)
            .map(|v| f64::from(v % 4) + 10.0 * f64::from(v / 4 % 3) + 100.0 * f64::from(v / 12))
            .collect();
        let fetch = |x, y, z| trilinear([4, 3, 2], &values, DVec3::new(x, y, z));
        assert!((fetch(1.25, 0.5, 0.75) - 81.25).abs() < 1e-12);
        assert!((fetch(-3.0, 7.0, -0.5) - 20.0).abs() < 1e-12);
    }
}
