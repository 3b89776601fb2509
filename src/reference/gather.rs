//! The GPU's weights: the density at a point, gathered from the voxels around it.
//!
//! The sum over voxels of density × kernel (P eq. 9) turned around: the same sum as that of the
//! footprints, with the slab's mean taken at one or two points and weights that sum to 1.

use glam::DVec3;

use super::Reference;
use super::kernel::Profile;
use super::pyramid::MAX_LEVEL;
use crate::model::{Kernel, Quadrature};
use crate::plan::SheetFrame;

/// The density at an index-space point, with the kernel stretched 2^`level` times.
pub(super) fn density(reference: &Reference<'_>, profile: &Profile, point: DVec3, level: f64) -> f64 {
    let pyramid = &reference.pyramid;
    let level = level.clamp(0.0, MAX_LEVEL as f64);
    if profile.kernel == Kernel::Prefiltered || level >= 1.0 {
        return pyramid.fetch(point, level);
    }
    let narrow = with_kernel(reference, profile, point);
    if level == 0.0 { narrow } else { narrow + (pyramid.fetch(point, 1.0) - narrow) * level }
}

/// Σ ρ(v) · w(v) over the 4³ voxels around a point.
fn with_kernel(reference: &Reference<'_>, profile: &Profile, point: DVec3) -> f64 {
    let cell = point.floor();
    let [wx, wy, wz] = (point - cell).to_array().map(|fraction| profile.four_weights(fraction));
    let [x, y, z] = cell.to_array().map(|c| c as i64 - 1);
    let mut sum = 0.0;
    for (dz, wz) in (0..).zip(wz) {
        for (dy, wy) in (0..).zip(wy) {
            for (dx, wx) in (0..).zip(wx) {
                sum += wx * wy * wz * reference.field.at(x + dx, y + dy, z + dz);
            }
        }
    }
    sum
}

/// The mean density over slab `k` along the ray of pixel (i, j): the mean over the quadrature's
/// points, each with the stretch of its own depth.
pub(super) fn slab_mean(
    reference: &Reference<'_>,
    frame: &SheetFrame,
    profile: &Profile,
    quadrature: Quadrature,
    [i, j, k]: [f64; 3],
) -> f64 {
    let offsets = quadrature.offsets();
    let sum: f64 = offsets
        .iter()
        .map(|offset| {
            let depth = frame.depth_of(k) + offset * frame.slab;
            let point = frame.point(i, j, depth) + reference.kernel_shift();
            density(reference, profile, point, frame.stretch_level(depth))
        })
        .sum();
    sum / offsets.len() as f64
}
