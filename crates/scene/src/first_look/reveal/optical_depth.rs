//! Optical depth of a veil along parallel rays: of those through a body, and of those beside it. Rays are in index
//! space, lengths in opacity units.

use glam::DVec3;
use rayon::prelude::*;

use crate::{Camera, OpacityLength};
use chiaroscuro_volume::Volume;

/// Number of rays along each edge of the picture: 256 in all, of which a body takes about half. The median of so many
/// is far steadier than an opacity has to be, and twice as many take a second of a large scan's first look.
const RAYS_PER_EDGE: usize = 16;

/// Distance between the samples of a ray, in edges of a voxel: four in the width of a boundary between two voxels.
const STEP_VOXELS: f64 = 0.5;

/// Optical depths per unit of a veil's extinction.
#[derive(Debug, Clone, Copy)]
pub(super) struct VeilDepths {
    /// Median of the rays through the body.
    pub through_body: f64,
    /// Median of the rays that cross the volume beside the body, so that rays along its surface hardly matter; 0
    /// without such rays.
    pub beside_body: f64,
}

impl VeilDepths {
    /// Measures a veil, whose relative extinction `veil` returns for a value, from a distant camera. Rays go through
    /// the body if they have a value for which `is_body` is true; without any, there is nothing to measure.
    pub(super) fn measure(
        volume: &Volume,
        camera: &Camera,
        opacity_unit: OpacityLength,
        veil: impl Fn(f64) -> f64 + Sync,
        is_body: impl Fn(f64) -> bool + Sync,
    ) -> Option<Self> {
        let scene = volume.scene();
        let scene_from_view = camera.scene_from_view();
        let view_from_index = glam::DAffine3::from_mat3(scene_from_view.transpose()) * scene.scene_from_index;
        let index_from_view = view_from_index.inverse();
        let last = DVec3::from(volume.dims().map(|n| n as f64 - 1.0));
        let corners = (0..8).map(|corner| {
            let is_last =
                DVec3::new(f64::from(corner & 1), f64::from(corner >> 1 & 1), f64::from(corner >> 2));
            view_from_index.transform_point3(last * is_last)
        });
        let (low, high) = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), corner| {
            (low.min(corner), high.max(corner))
        });
        let step = STEP_VOXELS * scene.smallest_edge();
        let units_per_step = step / opacity_unit.scene_units(&scene).max(1e-9);
        let count = ((high.z - low.z) / step).ceil() as usize;
        let forward = index_from_view.transform_vector3(DVec3::Z * step);
        let rays: Vec<RaySum> = (0..RAYS_PER_EDGE * RAYS_PER_EDGE)
            .into_par_iter()
            .map(|ray| {
                let share = |at: usize| (at as f64 + 0.5) / RAYS_PER_EDGE as f64;
                let across = DVec3::new(share(ray % RAYS_PER_EDGE), share(ray / RAYS_PER_EDGE), 0.0);
                let start = index_from_view.transform_point3(low + (high - low) * across);
                let mut sum = RaySum::default();
                for at in 0..=count {
                    let place = start + forward * at as f64;
                    if place.cmplt(DVec3::ZERO).any() || place.cmpgt(last).any() {
                        continue;
                    }
                    sum.is_inside = true;
                    if let Some(value) = smoothed_value(volume, place) {
                        sum.depth += veil(value) * units_per_step;
                        sum.has_body |= is_body(value);
                    }
                }
                sum
            })
            .collect();
        let median = |has_body: bool| {
            let of_kind = rays.iter().filter(|ray| ray.is_inside && ray.has_body == has_body);
            let mut depths: Vec<f64> = of_kind.map(|ray| ray.depth).collect();
            let middle = depths.len() / 2;
            (!depths.is_empty()).then(|| *depths.select_nth_unstable_by(middle, f64::total_cmp).1)
        };
        Some(Self { through_body: median(true)?, beside_body: median(false).unwrap_or(0.0) })
    }
}

/// Sums along a ray.
#[derive(Debug, Clone, Copy, Default)]
struct RaySum {
    depth: f64,
    is_inside: bool,
    has_body: bool,
}

/// Returns the value that the cubic B-spline, with which pictures are drawn, has at a place in index space; `None`
/// beside missing voxels.
fn smoothed_value(volume: &Volume, place: DVec3) -> Option<f64> {
    let dims = volume.dims();
    let base = place.floor();
    let weights = (place - base).to_array().map(|t| {
        // The four pieces of the cubic B-spline.
        let (s, t2, t3) = (1.0 - t, t * t, t * t * t);
        [s * s * s, 3.0 * t3 - 6.0 * t2 + 4.0, -3.0 * t3 + 3.0 * t2 + 3.0 * t + 1.0, t3].map(|w| w / 6.0)
    });
    // Beyond the grid its border counts.
    let index = |axis: usize, tap: usize| (base[axis] as usize + tap).saturating_sub(1).min(dims[axis] - 1);
    let mut density = 0.0;
    for z in 0..4 {
        for y in 0..4 {
            for x in 0..4 {
                let weight = weights[0][x] * weights[1][y] * weights[2][z];
                density += weight * volume.density_at([index(0, x), index(1, y), index(2, z)])?;
            }
        }
    }
    Some(volume.value_of(density))
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_volume::Samples;

    const N: usize = 24;

    fn volume(value: impl Fn(DVec3) -> f64) -> Volume {
        let place = |at: usize| DVec3::from([at % N, at / N % N, at / N / N].map(|c| c as f64 - 11.5));
        let samples = Samples::F32((0..N * N * N).map(|at| value(place(at)) as f32).collect());
        Volume::with_spacing("t", [N; 3], DVec3::ONE, samples).unwrap()
    }

    fn depths(volume: &Volume, unit: f64) -> VeilDepths {
        // Along y.
        let camera = Camera { azimuth_deg: 90.0, elevation_deg: 0.0, ..Camera::default() };
        let is_veil = |value: f64| f64::from(u8::from((0.25..0.75).contains(&value)));
        let unit = OpacityLength::Voxels(unit);
        VeilDepths::measure(volume, &camera, unit, is_veil, |value| value > 0.9).expect("a body")
    }

    #[test]
    fn depths_are_lengths_in_the_veil() {
        // A block of half the width, whose front and back lie in a veil of three voxels each.
        let wall = |p: DVec3| match (p.x.abs() < 6.0, p.y.abs()) {
            (true, y) if y < 5.0 => 1.0,
            (true, y) if y < 8.0 => 0.5,
            _ => 0.0,
        };
        let found = depths(&volume(wall), 1.0);
        // Smoothing ends the veil half a voxel before either side of it, and rounds its edges.
        assert!((found.through_body - 6.0).abs() < 1.0, "{found:?}");
        assert!(found.beside_body < 1.0, "{found:?}");
        let half = depths(&volume(wall), 2.0);
        assert!((half.through_body - found.through_body / 2.0).abs() < 1e-9);
        // A haze all around is beside the body as well.
        let haze = depths(&volume(|p| wall(p).max(0.5)), 1.0);
        assert!(haze.beside_body > 20.0, "{haze:?}");
    }

    #[test]
    fn without_a_body_there_is_nothing_to_measure() {
        let camera = Camera::default();
        let haze = volume(|_| 0.5);
        let unit = OpacityLength::Voxels(1.0);
        assert!(VeilDepths::measure(&haze, &camera, unit, |_| 1.0, |value| value > 0.9).is_none());
    }

    #[test]
    fn smoothed_values_are_those_of_the_kernel() {
        let ramp = volume(|p| p.x + 11.5);
        assert!((smoothed_value(&ramp, DVec3::new(7.3, 9.0, 4.5)).unwrap() - 7.3).abs() < 1e-3);
        let spot = volume(|p| f64::from(u8::from(p.length() < 1.0)));
        // Eight voxels around the centre, each with a weight of (23/48)³.
        let peak = smoothed_value(&spot, DVec3::splat(11.5)).unwrap();
        assert!((peak - 8.0 * (23.0f64 / 48.0).powi(3)).abs() < 1e-3, "{peak}");
    }
}
