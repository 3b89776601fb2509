//! The GPU's weights: the density at a point, gathered from the voxels around it.
//!
//! The sum over voxels of density × kernel (P eq. 9) turned around: the same sum as that of the
//! footprints, with the slab's mean taken at one or two points and weights that sum to 1.

use glam::DVec3;

use super::Reference;
use super::kernel::{Profile, cubic_b_spline, cubic_b_spline_slope};
use super::pyramid::MAX_LEVEL;
use crate::model::{BakedTransfer, Kernel, Quadrature};
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
    weighed(reference, point, weights(profile, point))
}

/// ∇ Σ ρ(v) · w(v) with the cubic B-spline, in index space: along one axis the slope, along the others the weight.
pub(super) fn slope(reference: &Reference<'_>, point: DVec3) -> DVec3 {
    let distances = point.fract_gl().to_array().map(|f| [f + 1.0, f, f - 1.0, f - 2.0]);
    let [wx, wy, wz] = distances.map(|axis| axis.map(cubic_b_spline));
    let [sx, sy, sz] = distances.map(|axis| axis.map(cubic_b_spline_slope));
    let along = |of| weighed(reference, point, of);
    DVec3::new(along([sx, wy, wz]), along([wx, sy, wz]), along([wx, wy, sz]))
}

/// The weights along each axis of the voxels around a point.
fn weights(profile: &Profile, point: DVec3) -> [[f64; 4]; 3] {
    point.fract_gl().to_array().map(|fraction| profile.four_weights(fraction))
}

/// Σ ρ(v) · w(v) with these weights along each axis.
fn weighed(reference: &Reference<'_>, point: DVec3, weights: [[f64; 4]; 3]) -> f64 {
    neighbours(reference, point, weights).map(|tap| tap.weight * tap.density).sum()
}

/// A voxel near a point.
struct Tap {
    /// w(v).
    weight: f64,
    /// ρ(v).
    density: f64,
    /// Whether it is a voxel of the grid, and not its border's repetition.
    is_there: bool,
}

/// The 4³ voxels around a point.
fn neighbours(
    reference: &Reference<'_>,
    point: DVec3,
    [wx, wy, wz]: [[f64; 4]; 3],
) -> impl Iterator<Item = Tap> {
    let [x, y, z] = point.floor().to_array().map(|c| c as i64 - 1);
    (0..64).map(move |at| {
        let [dx, dy, dz] = [at % 4, at / 4 % 4, at / 16];
        let voxel = [x + dx as i64, y + dy as i64, z + dz as i64];
        let [x, y, z] = voxel;
        Tap {
            weight: wx[dx] * wy[dy] * wz[dz],
            density: reference.field.at(x, y, z),
            is_there: reference.field.has(x, y, z),
        }
    })
}

/// What stands at a point when voxels are classified before they are spread: colours times extinction,
/// and extinction. A stretched kernel finds the blurred volume classified instead.
pub(super) fn material(
    reference: &Reference<'_>,
    profile: &Profile,
    table: &BakedTransfer,
    point: DVec3,
    level: f64,
) -> [f64; 4] {
    let level = level.clamp(0.0, MAX_LEVEL as f64);
    let blurred = |level: f64| {
        let there = reference.presence(profile, point, level);
        associated(table.sample(reference.pyramid.fetch(point, level))).map(|channel| channel * there)
    };
    if level >= 1.0 {
        return blurred(level);
    }
    let mut narrow = [0.0; 4];
    let taps = neighbours(reference, point, weights(profile, point));
    // Where voxels are missing others stand in for them, and the sum fades with what is there.
    let has_missing = reference.presence.is_some();
    for tap in taps.filter(|tap| tap.is_there || has_missing) {
        let voxel = associated(table.sample(tap.density));
        for (sum, value) in narrow.iter_mut().zip(voxel) {
            *sum += tap.weight * value;
        }
    }
    if has_missing {
        narrow = narrow.map(|channel| channel * reference.presence(profile, point, 0.0));
    }
    if level == 0.0 {
        return narrow;
    }
    let wide = blurred(1.0);
    std::array::from_fn(|channel| narrow[channel] + (wide[channel] - narrow[channel]) * level)
}

/// A material with its colours weighted by its extinction.
pub(super) fn associated([r, g, b, extinction]: [f64; 4]) -> [f64; 4] {
    [r * extinction, g * extinction, b * extinction, extinction]
}

/// The reverse.
pub(super) fn straight([r, g, b, extinction]: [f64; 4]) -> [f64; 4] {
    if extinction <= 0.0 { [0.0; 4] } else { [r / extinction, g / extinction, b / extinction, extinction] }
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
