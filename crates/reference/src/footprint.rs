//! Footprints, the paper's weights: kernel slices integrated over a slab (h̄ of P eq. 9 and 10), one voxel at a time.
//!
//! Where the paper looks them up in tables, every value is integrated here along the pixel's ray, so that sheared and
//! perspective footprints need no approximation: h̄ = 1/Δs ∫ over the slab of K((p(z) − v)/s) / s³ dz, with s ≥ 1 the
//! perspective stretch and s⁻³ its amplitude (P §4, Fourier scaling). The kernel is isotropic in index space.

use std::ops::RangeInclusive;

use glam::{DMat3, DVec3};

use super::field::DensityField;
use super::kernel::{KernelProfile, quadrature_nodes};
use chiaroscuro_render::plan::SheetFrame;
use chiaroscuro_scene::{ReconstructionKernel, SlabQuadrature};

/// Projection of index-space points onto sheets: the inverse of [`SheetFrame::point`].
///
/// With w = 1 + z · spread, point(i, j, z) = origin + w·i · right + w·j · down + z · forward: linear in (w·i, w·j,
/// z).
#[derive(Debug, Clone, Copy)]
struct SheetProjector {
    sheets_from_index: DMat3,
    origin: DVec3,
}

impl SheetProjector {
    fn new(frame: &SheetFrame) -> Self {
        let index_from_sheets =
            DMat3::from_cols(frame.origin.per_i, frame.origin.per_j, frame.direction.base);
        Self { sheets_from_index: index_from_sheets.inverse(), origin: frame.origin.base }
    }

    /// Returns (w·i, w·j, z) of an index-space point.
    fn locate(&self, point: DVec3) -> DVec3 {
        self.sheets_from_index * (point - self.origin)
    }

    /// Returns half the extents, in (w·i, w·j, z), of a cube with half-edge `reach` in index space.
    fn half_extents(&self, reach: f64) -> DVec3 {
        let rows = self.sheets_from_index.transpose();
        DVec3::new(
            rows.x_axis.abs().element_sum(),
            rows.y_axis.abs().element_sum(),
            rows.z_axis.abs().element_sum(),
        ) * reach
    }
}

/// Slab of a stack, prepared for the footprints of voxels: covered pixels and weights.
pub(super) struct SlabSlice<'f> {
    frame: &'f SheetFrame,
    projector: SheetProjector,
    /// Width of the kernel here, relative to index space.
    stretch: f64,
    /// Half the extents of a kernel's box in (w·i, w·j, z).
    half: DVec3,
    middle: f64,
    averaging: SlabAveraging,
}

/// Method by which a kernel is averaged over the slab.
#[derive(Debug, Clone, Copy)]
enum SlabAveraging {
    /// Integral along the ray.
    Integral,
    /// Mean over one or two points.
    Points(SlabQuadrature),
    /// Integral of a round Gaussian with this standard deviation, cut at a cylinder along the ray, two voxels (times
    /// `width`) in radius and half length.
    Round { sigma: f64, width: f64 },
}

impl<'f> SlabSlice<'f> {
    /// Prepares slab `k`, for a kernel that is never narrower than `least_stretch` voxels: integrated over the slab,
    /// or evaluated at `points` as in the scattering engine.
    pub(super) fn new(
        frame: &'f SheetFrame,
        k: u32,
        profile: &KernelProfile,
        points: Option<SlabQuadrature>,
        least_stretch: f64,
    ) -> Self {
        let (averaging, reach) = match (points, profile.kernel) {
            (None, _) => (SlabAveraging::Integral, profile.reach()),
            (Some(_), ReconstructionKernel::Gaussian { sigma }) => {
                // Bounding ball of the cylinder.
                let round = SlabAveraging::Round { sigma, width: profile.width };
                (round, profile.reach() * std::f64::consts::SQRT_2)
            }
            (Some(quadrature), _) => (SlabAveraging::Points(quadrature), profile.reach()),
        };
        let projector = SheetProjector::new(frame);
        let middle = frame.depth_of(f64::from(k));
        let stretch = (frame.pitch_at(middle) / frame.voxel_edge).max(least_stretch);
        Self { frame, projector, stretch, half: projector.half_extents(reach * stretch), middle, averaging }
    }

    /// Returns the pixels (columns, rows) that the kernel's slice around `centre` can touch; `None` if the kernel
    /// does not overlap the slab.
    pub(super) fn covered_pixels(&self, centre: DVec3) -> Option<[RangeInclusive<u32>; 2]> {
        let at = self.projector.locate(centre);
        if (at.z - self.middle).abs() >= self.half.z + self.frame.slab / 2.0 {
            return None;
        }
        let widening = |depth: f64| (1.0 + depth * self.frame.inverse_distance).max(1e-6);
        let near = widening((at.z - self.half.z).max(self.middle - self.frame.slab / 2.0));
        let far = widening((at.z + self.half.z).min(self.middle + self.frame.slab / 2.0));
        let range = |axis: usize| {
            let (low, high) = (at[axis] - self.half[axis], at[axis] + self.half[axis]);
            let first = (low / near).min(low / far).ceil().max(0.0);
            let last = (high / near).max(high / far).floor().min(f64::from(self.frame.size[axis]) - 1.0);
            (first <= last).then_some(first as u32..=last as u32)
        };
        Some([range(0)?, range(1)?])
    }

    /// Returns true if the whole slab lies behind the kernel around `centre`.
    pub(super) fn is_beyond(&self, centre: DVec3) -> bool {
        self.middle - self.projector.locate(centre).z >= self.half.z + self.frame.slab / 2.0
    }

    /// Returns the volume in voxels that a pixel of this slab represents.
    pub(super) fn voxels_per_pixel(&self) -> f64 {
        let pitch = self.frame.pitch_at(self.middle) / self.frame.voxel_edge;
        pitch * pitch * self.frame.slab / self.frame.voxel_edge
    }

    /// Returns h̄: the mean over the slab, along pixel (i, j)'s ray, of the kernel around `centre`.
    pub(super) fn kernel_mean(&self, kernel: impl Fn(f64) -> f64, centre: DVec3, i: u32, j: u32) -> f64 {
        let (i, j) = (f64::from(i), f64::from(j));
        let start = (self.frame.point(i, j, self.middle) - centre) / self.stretch;
        let step = self.frame.direction.at(i, j) * self.frame.slab / self.stretch;
        let product = |offset: f64| {
            let r = start + step * offset;
            let x = kernel(r.x);
            // Shortcut: most points are already outside the kernel along x.
            if x == 0.0 { 0.0 } else { x * kernel(r.y) * kernel(r.z) }
        };
        let mean = match self.averaging {
            SlabAveraging::Integral => {
                quadrature_nodes().into_iter().map(|(offset, weight)| weight * product(offset)).sum::<f64>()
            }
            SlabAveraging::Points(quadrature) => {
                let offsets = quadrature.offsets();
                offsets.iter().map(|&offset| product(offset)).sum::<f64>() / offsets.len() as f64
            }
            SlabAveraging::Round { sigma, width } => round_mean(start, step, sigma, width),
        };
        mean / self.stretch.powi(3)
    }
}

/// Returns the mean of a Gaussian of area 1 around the origin over the segment `start` ± `step`/2: the product of a
/// function of the distance across the ray and the integral along the segment.
fn round_mean(start: DVec3, step: DVec3, sigma: f64, width: f64) -> f64 {
    let (sigma, radius) = (sigma * width, 2.0 * width);
    let length = step.length();
    let along = step / length;
    let middle = start.dot(along);
    let squared = (start - along * middle).length_squared();
    let (near, far) = ((middle - length / 2.0).max(-radius), (middle + length / 2.0).min(radius));
    if squared >= radius * radius || near >= far {
        return 0.0;
    }
    let variance = sigma * sigma;
    let amplitude = (std::f64::consts::TAU * variance).powf(-1.5);
    let at = |t: f64| (-t * t / (2.0 * variance)).exp();
    let part: f64 = quadrature_nodes()
        .into_iter()
        .map(|(offset, weight)| weight * at(f64::midpoint(near, far) + offset * (far - near)))
        .sum();
    amplitude * (-squared / (2.0 * variance)).exp() * part * (far - near) / length
}

/// Computes the sheet of slab `k`, row by row: Σ ρ(v) · h̄ over all voxels whose kernel overlaps it.
pub(super) fn splat(
    field: &DensityField,
    frame: &SheetFrame,
    profile: &KernelProfile,
    points: Option<SlabQuadrature>,
    shift: DVec3,
    k: u32,
) -> Vec<f64> {
    let slice = SlabSlice::new(frame, k, profile, points, 1.0);
    let [nx, ny, _] = field.dims;
    let width = frame.size[0] as usize;
    let mut sheet = vec![0.0; width * frame.size[1] as usize];
    for (voxel, &density) in field.densities.iter().enumerate().filter(|&(_, &density)| density != 0.0) {
        let [x, y, z] = [voxel % nx, voxel / nx % ny, voxel / (nx * ny)].map(|c| c as f64);
        // Sampling with a shift equals moving the voxel the opposite way.
        let centre = DVec3::new(x, y, z) - shift;
        let Some([columns, rows]) = slice.covered_pixels(centre) else {
            continue;
        };
        for j in rows {
            for i in columns.clone() {
                sheet[i as usize + width * j as usize] +=
                    density * slice.kernel_mean(|t| profile.density_weight(t), centre, i, j);
            }
        }
    }
    sheet
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;

    use super::*;
    use chiaroscuro_render::plan::{eye_frame, light_views};
    use chiaroscuro_scene::{Camera, Projection, ReconstructionKernel, SceneLight, ShadowSettings};
    use chiaroscuro_volume::math::SceneSpace;

    #[test]
    fn projecting_inverts_the_rays() {
        let scene = SceneSpace::new([20, 16, 12], DAffine3::from_scale(DVec3::new(1.0, 1.2, 2.0)));
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let camera = Camera { projection, ..Camera::default() };
            let frame = eye_frame(&camera, &scene, [32, 24], 1.0);
            let at = SheetProjector::new(&frame).locate(frame.point(5.0, 7.0, 0.3));
            let w = 1.0 + 0.3 * frame.inverse_distance;
            assert!((at - DVec3::new(5.0 * w, 7.0 * w, 0.3)).length() < 1e-12, "{at}");
        }
    }

    #[test]
    fn along_an_axis_the_slab_integral_has_a_closed_form() {
        let scene = SceneSpace::new([9; 3], DAffine3::IDENTITY);
        let light = SceneLight { position: [0.0, 0.0, 1.0], ..SceneLight::default() };
        let views = light_views(&light, &ShadowSettings::default(), &scene);
        let frame = &views[0].frame;
        let k = frame.slab_count / 2;
        let profile = KernelProfile { kernel: ReconstructionKernel::BSpline, width: 1.0 };
        let slice = SlabSlice::new(frame, k, &profile, None, 1.0);
        let centre = DVec3::splat(4.0);
        let [columns, rows] = slice.covered_pixels(centre).unwrap();
        let total: f64 = rows
            .flat_map(|j| columns.clone().map(move |i| (i, j)))
            .map(|(i, j)| slice.kernel_mean(|t| profile.density_weight(t), centre, i, j))
            .sum();
        // Σ over the sheet's pixels is 1 by partition of unity; what remains is ∫ b₃ over the slab.
        let z = frame.point(0.0, 0.0, frame.depth_of(f64::from(k))).z - 4.0;
        let exact: f64 = (0..1000)
            .map(|n| super::super::kernel::cubic_b_spline(z - 0.5 + (f64::from(n) + 0.5) / 1000.0))
            .sum::<f64>()
            / 1000.0;
        assert!((total - exact).abs() < 1e-4, "{total} {exact}");
    }
}
