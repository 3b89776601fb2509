//! Gathering with the GPU's weights: the density at a point from the voxels around it.
//!
//! Gathers the sum over voxels of density × kernel (P eq. 9) that footprints scatter, with the slab's mean taken at
//! one or two points and weights that sum to 1.

use glam::DVec3;

use super::Reference;
use super::field::classified::TransferSide;
use super::field::pyramid::MAX_LEVEL;
use super::kernel::{KernelProfile, cubic_b_spline, cubic_b_spline_slope};
use chiaroscuro_render::plan::SheetFrame;
use chiaroscuro_scene::{ReconstructionKernel, SlabQuadrature};

/// Returns the density at an index-space point, with the kernel stretched 2^`level` times.
pub(super) fn density(
    reference: &Reference<'_>,
    side: TransferSide,
    profile: &KernelProfile,
    point: DVec3,
    level: f64,
) -> f64 {
    let pyramid = reference.gathered_pyramid(side);
    let level = level.clamp(0.0, MAX_LEVEL as f64);
    if profile.kernel == ReconstructionKernel::Prefiltered || level >= 1.0 {
        return pyramid.fetch(point, level);
    }
    let narrow = kernel_sum(reference, profile, point);
    if level == 0.0 { narrow } else { narrow + (pyramid.fetch(point, 1.0) - narrow) * level }
}

/// Returns Σ ρ(v) · w(v) over the 4³ voxels around a point.
fn kernel_sum(reference: &Reference<'_>, profile: &KernelProfile, point: DVec3) -> f64 {
    weighted_sum(reference, point, weights(profile, point))
}

/// Returns ∇ Σ ρ(v) · w(v) with the cubic B-spline, in index space: the spline's slope along one axis, its weight
/// along the others.
pub(super) fn kernel_gradient(reference: &Reference<'_>, point: DVec3) -> DVec3 {
    let distances = point.fract_gl().to_array().map(|f| [f + 1.0, f, f - 1.0, f - 2.0]);
    let [wx, wy, wz] = distances.map(|axis| axis.map(cubic_b_spline));
    let [sx, sy, sz] = distances.map(|axis| axis.map(cubic_b_spline_slope));
    let along = |of| weighted_sum(reference, point, of);
    DVec3::new(along([sx, wy, wz]), along([wx, sy, wz]), along([wx, wy, sz]))
}

/// Returns the weights along each axis of the voxels around a point.
fn weights(profile: &KernelProfile, point: DVec3) -> [[f64; 4]; 3] {
    point.fract_gl().to_array().map(|fraction| profile.four_weights(fraction))
}

/// Returns Σ ρ(v) · w(v) for given weights along each axis.
fn weighted_sum(reference: &Reference<'_>, point: DVec3, weights: [[f64; 4]; 3]) -> f64 {
    let [wx, wy, wz] = weights;
    let [x, y, z] = point.floor().to_array().map(|c| c as i64 - 1);
    let term = |at: usize| {
        let [dx, dy, dz] = [at % 4, at / 4 % 4, at / 16];
        let density = reference.field.at(x + dx as i64, y + dy as i64, z + dz as i64);
        wx[dx] * wy[dy] * wz[dz] * density
    };
    (0..64).map(term).sum()
}

/// Returns the mean of `of(point, level)` over slab `k` along the ray of pixel (i, j): over the quadrature's points,
/// each with the stretch at its own depth.
pub(super) fn slab_mean(
    reference: &Reference<'_>,
    frame: &SheetFrame,
    quadrature: SlabQuadrature,
    [i, j, k]: [f64; 3],
    of: impl Fn(DVec3, f64) -> f64,
) -> f64 {
    let offsets = quadrature.offsets();
    let sum: f64 = offsets
        .iter()
        .map(|offset| {
            let depth = frame.depth_of(k) + offset * frame.slab;
            of(frame.point(i, j, depth) + reference.kernel_shift(), frame.stretch_level(depth))
        })
        .sum();
    sum / offsets.len() as f64
}
