//! Back-projection (reverse splat): sheets of light into the voxels of the light volume (P eq. 10, figure 3). The
//! attenuation Σ D·h / Σ h is stored, not the light.

use glam::DVec3;
use rayon::prelude::*;

use super::extent::point_weights::PointWeights;
use super::extent::surface_normals::SurfaceNormals;
use super::field::trilinear;
use super::footprint::SlabSlice;
use super::kernel::KernelProfile;
use super::light_march::ViewSheets;
use super::{Reference, ReferenceFault, ReferenceWeights};
use chiaroscuro_render::plan::SheetPosition;
use chiaroscuro_scene::{ReconstructionKernel, ReverseKernel, SceneLight, ShadowAlgorithm};

/// Attenuation volume of a light, as in the paper: the share that arrives in each voxel.
#[derive(Debug, Clone, PartialEq)]
pub struct AttenuationVolume {
    /// Number of light voxels along x, y, z.
    pub dims: [usize; 3],
    /// Voxels per light voxel along an axis.
    pub divisor: usize,
    /// One transmittance per light voxel, x fastest; 1 is unattenuated.
    pub values: Vec<f64>,
}

impl AttenuationVolume {
    /// Returns the trilinearly interpolated value at an index-space point.
    pub fn at(&self, point: DVec3) -> f64 {
        trilinear(self.dims, &self.values, (point + 0.5) / self.divisor as f64 - 0.5)
    }

    /// Creates a volume that is unattenuated everywhere.
    pub(super) fn unattenuated(grid: [usize; 3], divisor: usize) -> Self {
        let dims = grid.map(|n| n.div_ceil(divisor));
        Self { dims, divisor, values: vec![1.0; dims.iter().product()] }
    }

    /// Returns the index-space point in the middle of a light voxel.
    pub(super) fn voxel_centre(&self, voxel: usize) -> DVec3 {
        let [nx, ny, _] = self.dims;
        let texel = [voxel % nx, voxel / nx % ny, voxel / (nx * ny)];
        DVec3::from(texel.map(|t| (t as f64 + 0.5) * self.divisor as f64 - 0.5))
    }
}

impl Reference<'_> {
    /// Computes the attenuation volume of light `index`: the mean over its points, on surfaces weighted by their
    /// cosines.
    pub fn attenuation(&self, index: usize) -> AttenuationVolume {
        let resolution = self.light_resolution(index);
        let of_point = |point: &SceneLight| match self.settings.shadows.algorithm {
            ShadowAlgorithm::Raycast => self.raycast(point, resolution.divisor()),
            _ => self.back_project_to(&self.point_light_sheets(point, resolution), resolution.divisor()),
        };
        let points = self.points(index);
        let mut mean = AttenuationVolume::unattenuated(self.scene.dims, resolution.divisor());
        mean.values.fill(0.0);
        let light = self.light(index);
        let is_weighted = self.settings.shading.has_surfaces() && light.has_weighted_points();
        let divisor = (2 * resolution.divisor()).max(4);
        let normals =
            (is_weighted && points.len() > 1).then(|| self.surface_normals(divisor, light.density_scale));
        for point in &points {
            let values = of_point(point).values;
            let weight = |voxel: usize| {
                let place = mean.voxel_centre(voxel);
                let scene = self.scene.scene_from_index.transform_point3(place);
                let on_surface = |normals: &SurfaceNormals| {
                    PointWeights::new(&light, scene, normals.at(place)).by_offset(point)
                };
                normals.as_ref().map_or(1.0, on_surface)
            };
            let weights: Vec<f64> = (0..values.len()).map(weight).collect();
            for ((sum, value), weight) in mean.values.iter_mut().zip(values).zip(weights) {
                *sum += value * weight / points.len() as f64;
            }
        }
        mean
    }

    /// Computes the attenuation volumes of all lights that have one.
    pub fn attenuations(&self) -> Vec<Option<AttenuationVolume>> {
        let lights = &self.settings.lights;
        (0..lights.len())
            .map(|index| self.has_attenuation_volume(index).then(|| self.attenuation(index)))
            .collect()
    }

    /// Splats the sheets of a point light back into its attenuation volume. Voxels covered by several views get the
    /// value of the last; voxels covered by none are unattenuated.
    pub fn back_project(&self, sheets: &[ViewSheets]) -> AttenuationVolume {
        self.back_project_to(sheets, self.settings.shadows.resolution.divisor())
    }

    fn back_project_to(&self, sheets: &[ViewSheets], divisor: usize) -> AttenuationVolume {
        let mut volume = AttenuationVolume::unattenuated(self.scene.dims, divisor);
        for sheets in sheets.iter().filter(|sheets| !sheets.deposits.is_empty()) {
            let filled: Vec<_> = match self.weights() {
                ReferenceWeights::Footprint | ReferenceWeights::Scatter
                    if !self.settings.shadows.first_touch =>
                {
                    self.scatter(sheets, &volume)
                }
                _ => (0..volume.values.len())
                    .into_par_iter()
                    .map(|voxel| self.gather_voxel(sheets, volume.voxel_centre(voxel)))
                    .collect(),
            };
            for (value, filled) in volume.values.iter_mut().zip(filled) {
                *value = filled.unwrap_or(*value);
            }
        }
        volume
    }

    /// Returns the position of an index-space point on a view's sheets, if the view covers it.
    fn position(&self, sheets: &ViewSheets, point: DVec3) -> Option<SheetPosition> {
        sheets.view.project(self.scene.scene_from_index.transform_point3(point))
    }

    /// Gathers one voxel from all pixels around it, as the GPU does.
    fn gather_voxel(&self, sheets: &ViewSheets, point: DVec3) -> Option<f64> {
        let at = self.position(sheets, point)?;
        if self.settings.shadows.first_touch {
            return Some(first_touch(sheets, &at));
        }
        let kernel = match self.settings.shadows.reverse_kernel {
            ReverseKernel::Tent => ReconstructionKernel::Prefiltered,
            ReverseKernel::Forward => self.settings.shadows.kernel,
        };
        let profile = self.profile(kernel);
        let [columns, rows] = sheets.view.frame.size;
        let across = kernel_taps(&profile, at.pixel.x, at.kernel_pixels, columns as usize, &[0.0]);
        let down = kernel_taps(&profile, at.pixel.y, at.kernel_pixels, rows as usize, &[0.0]);
        // Across slabs, the kernel is averaged over each slab: the paper's h̄.
        let points = self.settings.shadows.quadrature.offsets();
        let deep = kernel_taps(&profile, at.slab, at.kernel_slabs, sheets.deposits.len(), points);
        let mut sums = WeightedSums::default();
        for &(k, wk) in &deep {
            for &(j, wj) in &down {
                for &(i, wi) in &across {
                    sums.add(sheets.deposit(i, j, k), wi * wj * wk);
                }
            }
        }
        Some(sums.normalised(self.options.fault))
    }

    /// Scatters sheet after sheet into the light volume, as the paper does, each pixel with the slice of the voxel's
    /// kernel that lies in the sheet's slab; a voxel is divided by its sum of weights as soon as the sheets have
    /// passed it (the rolling normalisation).
    fn scatter(&self, sheets: &ViewSheets, volume: &AttenuationVolume) -> Vec<Option<f64>> {
        let shadows = &self.settings.shadows;
        let profile = self.profile(shadows.kernel);
        let points = (self.weights() == ReferenceWeights::Scatter).then_some(shadows.quadrature);
        let mut light = vec![WeightedSums::default(); volume.values.len()];
        let mut done = vec![None; light.len()];
        for k in 0..sheets.view.frame.slab_count {
            // The kernel is as wide as a light voxel, or as a pixel where that is wider.
            let slice = SlabSlice::new(&sheets.view.frame, k, &profile, points, volume.divisor as f64);
            // Near a light, pixels are small and many: each is weighted by the part of the grid that it covers.
            let share = points.map_or(1.0, |_| slice.voxels_per_pixel());
            light.par_iter_mut().zip(&mut done).enumerate().for_each(|(voxel, (sums, done))| {
                let centre = volume.voxel_centre(voxel);
                if slice.is_beyond(centre) {
                    done.get_or_insert_with(|| sums.normalised(self.options.fault));
                    return;
                }
                let Some([columns, rows]) = slice.covered_pixels(centre) else {
                    return;
                };
                for j in rows {
                    for i in columns.clone() {
                        let weight = share * slice.kernel_mean(|t| profile.light_weight(t), centre, i, j);
                        sums.add(sheets.deposit(i as usize, j as usize, k as usize), weight);
                    }
                }
            });
        }
        let value = |(voxel, (sums, done)): (usize, (WeightedSums, Option<f64>))| {
            self.position(sheets, volume.voxel_centre(voxel))?;
            Some(done.unwrap_or_else(|| sums.normalised(self.options.fault)))
        };
        light.into_iter().zip(done).enumerate().map(value).collect()
    }
}

/// Sums of one voxel: Σ D·h (the light volume) and Σ h (the weight volume).
#[derive(Debug, Clone, Copy, Default)]
struct WeightedSums {
    light: f64,
    weight: f64,
}

impl WeightedSums {
    fn add(&mut self, deposit: f64, weight: f64) {
        self.light += deposit * weight;
        self.weight += weight;
    }

    fn normalised(self, fault: ReferenceFault) -> f64 {
        if self.weight <= 0.0 {
            1.0
        } else if fault == ReferenceFault::NoDivision {
            self.light
        } else {
            self.light / self.weight
        }
    }
}

/// Returns the integers 0 … count − 1 under a kernel of a given width around `centre`, with weights: the mean of the
/// kernel at `points` around each.
fn kernel_taps(
    profile: &KernelProfile,
    centre: f64,
    width: f64,
    count: usize,
    points: &[f64],
) -> Vec<(usize, f64)> {
    let reach = profile.reach() * width + points.iter().copied().fold(0.0, f64::max);
    let first = (centre - reach).ceil().max(0.0) as usize;
    let end = (centre + reach).floor().clamp(-1.0, count as f64 - 1.0) + 1.0;
    let weight = |tap: usize| {
        let at = |point: f64| profile.light_weight((tap as f64 + point - centre) / width);
        points.iter().map(|&point| at(point)).sum::<f64>() / points.len() as f64
    };
    (first..end as usize).map(|tap| (tap, weight(tap))).collect()
}

/// Returns the deposit of the first sheet that touches a voxel (P §4), l = ⌈z − 2·width⌉, which needs no weights.
/// Bilinear between the sheet's pixels.
fn first_touch(sheets: &ViewSheets, at: &SheetPosition) -> f64 {
    let last = (sheets.deposits.len() - 1) as f64;
    let k = (at.slab - 2.0 * at.kernel_slabs).ceil().clamp(0.0, last) as usize;
    let [columns, rows] = sheets.view.frame.size.map(|n| n as usize);
    trilinear([columns, rows, 1], &sheets.deposits[k], at.pixel.extend(0.0))
}
