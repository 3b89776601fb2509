//! Path tracing by Woodcock (delta) tracking: free paths through material without steps, slabs or sheet kernels.

use chiaroscuro_reference::cubic_b_spline;
use chiaroscuro_scene::{BakedTransfer, Settings};
use glam::DVec3;

use crate::common::Dataset;

/// Material that paths run through.
pub(crate) struct TracedMaterial {
    /// Number of voxels along each axis, including the empty border around the grid.
    dims: [usize; 3],
    densities: Vec<f64>,
    table: BakedTransfer,
    /// Largest extinction anywhere, per scene unit (the majorant).
    majorant: f64,
    /// True for a cell if any of the 4³ voxels around it may attenuate; cells lie between neighbouring voxels along
    /// each axis.
    is_occupied: Vec<bool>,
}

/// Width of the empty border around the grid, in voxels: the radius of a kernel, and one for points on its rim.
const BORDER_VOXELS: usize = 3;

impl TracedMaterial {
    /// Builds the material of a volume under the eye's transfer function.
    pub(crate) fn new(loaded: &Dataset, settings: &Settings) -> Self {
        let range = settings.shown_range(&loaded.volume().ranges());
        let volume = &loaded.volume().with_density_mapping(range);
        let table = settings.bake_eye(range, &volume.scene());
        let dims = volume.dims().map(|length| length + 2 * BORDER_VOXELS);
        let mut densities = vec![0.0; dims.iter().product()];
        for z in 0..volume.dims()[2] {
            for (at, density) in volume.slice_densities(z).into_iter().enumerate() {
                let [x, y] = [at % volume.dims()[0], at / volume.dims()[0]];
                densities
                    [((z + BORDER_VOXELS) * dims[1] + y + BORDER_VOXELS) * dims[0] + x + BORDER_VOXELS] =
                    f64::from(density);
            }
        }
        let reached = 3 * (dims[0] * dims[1] + dims[0] + 1);
        let is_occupied = (0..densities.len().saturating_sub(reached))
            .map(|first| {
                let densest = row_starts(dims, first)
                    .flat_map(|row| &densities[row..row + 4])
                    .fold(0.0, |a, &b| b.max(a));
                table.max_extinction_in(0.0, densest) > 0.0
            })
            .collect();
        Self { dims, densities, majorant: table.max_extinction_in(0.0, 1.0), is_occupied, table }
    }

    /// Extinction at an index-space point, per scene unit.
    fn extinction(&self, point: DVec3) -> f64 {
        self.density(point).map_or(0.0, |density| self.table.sample(density)[3])
    }

    /// Colour at an index-space point, linear RGB.
    pub(crate) fn color(&self, point: DVec3) -> [f64; 3] {
        let [r, g, b, _] = self.table.sample(self.density(point).unwrap_or(0.0));
        [r, g, b]
    }

    /// Density at an index-space point; `None` if nothing around it attenuates.
    fn density(&self, point: DVec3) -> Option<f64> {
        let below = point.floor();
        // The first of the four voxels along each axis whose kernels reach the point.
        let first = below + (BORDER_VOXELS as f64 - 1.0);
        let is_near = (0..3).all(|axis| first[axis] >= 0.0 && first[axis] + 3.0 < self.dims[axis] as f64);
        if !is_near {
            return None;
        }
        let [x, y, z] = first.to_array().map(|c| c as usize);
        let first = (z * self.dims[1] + y) * self.dims[0] + x;
        if !self.is_occupied[first] {
            return None;
        }
        let [wx, wy, wz] =
            (point - below).to_array().map(|f| [1.0 + f, f, 1.0 - f, 2.0 - f].map(cubic_b_spline));
        let density: f64 = row_starts(self.dims, first)
            .enumerate()
            .map(|(at, row)| {
                let along: f64 = self.densities[row..row + 4].iter().zip(wx).map(|(d, w)| d * w).sum();
                wz[at / 4] * wy[at % 4] * along
            })
            .sum();
        Some(density)
    }

    /// First interaction of a ray with material, by Woodcock tracking; `step` is one scene unit along the ray.
    pub(crate) fn first_interaction(
        &self,
        random: &mut RandomNumbers,
        mut point: DVec3,
        step: DVec3,
        length: f64,
    ) -> Option<DVec3> {
        let mut left = length;
        loop {
            let way = -(1.0 - random.next_uniform()).ln() / self.majorant;
            left -= way;
            if left < 0.0 {
                return None;
            }
            point += step * way;
            if random.next_uniform() * self.majorant < self.extinction(point) {
                return Some(point);
            }
        }
    }

    /// Unbiased estimate of the transmittance along a ray (ratio tracking).
    pub(crate) fn transmittance(
        &self,
        lots: &mut RandomNumbers,
        mut point: DVec3,
        step: DVec3,
        length: f64,
    ) -> f64 {
        let mut left = length;
        let mut transmittance = 1.0;
        loop {
            let way = -(1.0 - lots.next_uniform()).ln() / self.majorant;
            left -= way;
            if left < 0.0 || transmittance < 1e-6 {
                return transmittance;
            }
            point += step * way;
            transmittance *= 1.0 - self.extinction(point) / self.majorant;
        }
    }
}

/// Indices of the first voxels of the 4² rows of four voxels that start at a voxel.
fn row_starts(dims: [usize; 3], first: usize) -> impl Iterator<Item = usize> {
    (0..16).map(move |row| first + (row / 4 * dims[1] + row % 4) * dims[0])
}

/// Pseudo-random numbers in [0, 1) (`SplitMix64`).
pub(crate) struct RandomNumbers(pub(crate) u64);

impl RandomNumbers {
    pub(crate) fn next_uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Random unit vector, uniform over the sphere.
    pub(crate) fn next_direction(&mut self) -> DVec3 {
        let (z, angle) = (2.0 * self.next_uniform() - 1.0, std::f64::consts::TAU * self.next_uniform());
        let across = (1.0 - z * z).max(0.0).sqrt();
        DVec3::new(across * angle.cos(), across * angle.sin(), z)
    }
}
