//! Sky visibility of each block of voxels, and sky light on surfaces.
//!
//! Stored are moments over directions ω of the transmittance T from the block out of the volume: V₀ = ⟨T⟩ and V₁ = ⟨T
//! ω⟩.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use crate::Reference;
use crate::field::classified::TransferSide;
use crate::field::trilinear;
use chiaroscuro_render::plan::{SlicePosition, SweepFrame, directions_above, sweep_directions};
use chiaroscuro_scene::{ReconstructionKernel, SKY_LOOKUP_DISTANCE};

/// Volume of sky visibility: two moments over directions.
#[derive(Debug, Clone, PartialEq)]
pub struct SkyVisibility {
    /// Number of blocks along x, y and z.
    pub dims: [usize; 3],
    /// Edge of a block, in voxels.
    pub divisor: usize,
    /// V₀ of each block, x fastest.
    pub mean_transmittance: Vec<f64>,
    /// V₁ along x, y and z of scene space.
    pub first_moment: [Vec<f64>; 3],
}

impl SkyVisibility {
    /// Interpolates V₀ and V₁ between blocks at an index-space point.
    pub(crate) fn at(&self, point: DVec3) -> (f64, DVec3) {
        let place = (point + 0.5) / self.divisor as f64 - 0.5;
        let of = |values: &[f64]| trilinear(self.dims, values, place);
        (of(&self.mean_transmittance), DVec3::from(self.first_moment.each_ref().map(|values| of(values))))
    }
}

impl Reference<'_> {
    /// Computes sky visibility, with the directions and the resolution in the settings.
    pub fn sky_visibility(&self) -> SkyVisibility {
        let sky = &self.settings.sky;
        self.sky_visibility_from(&sweep_directions(sky.directions), self.sky_divisor())
    }

    /// Computes sky visibility from the given directions, in blocks of `divisor` voxels along an edge.
    pub fn sky_visibility_from(&self, directions: &[DVec3], divisor: usize) -> SkyVisibility {
        let dims = self.scene.dims.map(|n| n.div_ceil(divisor));
        let extinction = self.sky_blocks(dims, divisor);
        let surfaces = self.surfaces_of_blocks(dims, divisor, &extinction, directions);
        let extinction = self.sharpened(dims, &extinction);
        let count: usize = dims.iter().product();
        let mut sums = vec![[0.0; 4]; count];
        for &towards in directions {
            let frame = SweepFrame::new(&self.scene, divisor, towards);
            let deposits = march(&frame, &extinction);
            sums.par_iter_mut().enumerate().for_each(|(at, sum)| {
                let block = [at % dims[0], at / dims[0] % dims[1], at / (dims[0] * dims[1])];
                let block = DVec3::from(block.map(|at| at as f64));
                let surface = surfaces[at].as_ref();
                let start = surface.map_or(block, |surface| surface.ray_start(block, &frame));
                let weights = surface.map_or(towards.extend(1.0), |surface| surface.moment_weights(towards));
                let moments = weights * light_at(&frame, &deposits, start);
                sum.iter_mut().zip(moments.to_array()).for_each(|(sum, moment)| *sum += moment);
            });
        }
        let mean_of =
            |moment: usize| sums.iter().map(|sum| sum[moment] / directions.len() as f64).collect::<Vec<_>>();
        SkyVisibility {
            dims,
            divisor,
            mean_transmittance: mean_of(3),
            first_moment: [mean_of(0), mean_of(1), mean_of(2)],
        }
    }

    /// Returns sweep frames in the number of directions and the resolution of the settings, from the hemisphere
    /// above, with the transmittance of each ray to the floor; empty if nothing attenuates a sky.
    pub(crate) fn sky_rays(&self) -> Vec<(SweepFrame, Vec<f64>)> {
        let sky = &self.settings.sky;
        if !self.settings.has_sky_volume() {
            return Vec::new();
        }
        let divisor = self.sky_divisor();
        let dims = self.scene.dims.map(|n| n.div_ceil(divisor));
        let extinction = self.sharpened(dims, &self.sky_blocks(dims, divisor));
        let up = self.settings.camera.up.direction();
        // Height of a position in blocks above the floor.
        let above = |block: DVec3| {
            let index = (block + 0.5) * divisor as f64 - 0.5;
            self.scene.scene_from_index.transform_point3(index).dot(up) - self.settings.floor.height
        };
        let of = |towards| {
            let frame = SweepFrame::new(&self.scene, divisor, towards);
            let left = transmittance_to_floor(&frame, &extinction, above);
            (frame, left)
        };
        directions_above(up, sky.directions).into_iter().map(of).collect()
    }

    /// Returns the light of the sky on a floor that faces up, at an index-space point, as a share of its colour: E/π
    /// = ⟨L(ω) T⟩ over directions of equal contribution, with the transmittance of each; and the exact value for an
    /// unshadowed floor: l₀ + ⅔ l₁ · up.
    pub(crate) fn sky_on_floor(&self, rays: &[(SweepFrame, Vec<f64>)], point: DVec3) -> [[f64; 3]; 2] {
        let up = self.settings.camera.up.direction();
        let Some(sky) = self.settings.sky.radiance(self.settings.camera.up) else { return [[0.0; 3]; 2] };
        let bare = [0, 1, 2].map(|c| sky.mean[c] + sky.slope[c].dot(up) * 2.0 / 3.0);
        let strength = self.settings.shadows.strength;
        if rays.is_empty() {
            return [bare; 2];
        }
        let place = (point + 0.5) / self.sky_divisor() as f64 - 0.5;
        let seen = [0, 1, 2].map(|c| {
            let from = |(frame, left): &(SweepFrame, Vec<f64>)| {
                let radiance = sky.mean[c] + sky.slope[c].dot(frame.towards);
                radiance * light_on_floor(frame, left, place)
            };
            rays.iter().map(from).sum::<f64>() / rays.len() as f64
        });
        [[0, 1, 2].map(|c| (bare[c] + strength * (seen[c] - bare[c])).max(0.0)), bare]
    }

    /// Returns the edge of a block, in voxels.
    fn sky_divisor(&self) -> usize {
        self.settings.shadows.soft_resolution(self.settings.sky.resolution, self.scene.dims).divisor()
    }

    /// Returns the extinction of sky light in each block.
    fn sky_blocks(&self, dims: [usize; 3], divisor: usize) -> Vec<f64> {
        let scale = self.settings.sky.density_scale;
        let most = self.largest_sky_extinction();
        let of_block = |_, extinction: f64| [(extinction * scale).min(most)];
        self.blocks(dims, divisor, false, of_block).into_iter().flatten().collect()
    }

    /// Averages a function of position and extinction over eight positions in each block, or evaluates it at the
    /// voxel if a block is a single one that is not smoothed.
    pub(crate) fn blocks<const N: usize>(
        &self,
        dims: [usize; 3],
        divisor: usize,
        is_smoothed: bool,
        of_place: impl Fn(DVec3, f64) -> [f64; N] + Sync,
    ) -> Vec<[f64; N]> {
        let table = self.gathered_table(TransferSide::Indirect);
        let pyramid = self.gathered_pyramid(TransferSide::Indirect);
        let profile = self.profile(ReconstructionKernel::Prefiltered);
        let remaining = self.attenuating_region();
        let level = (divisor as f64 / 2.0).max(1.0).log2();
        let offset = if divisor == 1 && !is_smoothed { 0.0 } else { divisor as f64 / 4.0 };
        let at = |point: DVec3| {
            let extinction = table.sample(pyramid.fetch(point + self.kernel_shift(), level))[3]
                * self.gathered_presence(&profile, point, level)
                * self.attenuating_share(&remaining, point);
            of_place(point, extinction)
        };
        let of_block = |block: usize| {
            let place = [block % dims[0], block / dims[0] % dims[1], block / (dims[0] * dims[1])];
            let middle = DVec3::from(place.map(|at| (at as f64 + 0.5) * divisor as f64 - 0.5));
            let corners = (0..8).map(|corner| {
                let side = |axis: usize| if corner >> axis & 1 == 0 { -offset } else { offset };
                at(middle + DVec3::new(side(0), side(1), side(2)))
            });
            corners.fold([0.0; N], |sum, found| std::array::from_fn(|c| sum[c] + found[c] / 8.0))
        };
        (0..dims.iter().product()).into_par_iter().map(of_block).collect()
    }

    /// Returns the light of a sky on a surface, as a share of its colour; `weight` (0 … 1) is the degree to which the
    /// sample is a surface, and `side` the side that it faces, 1 along the normal and −1 against it; `None` for a
    /// surface with two sides.
    ///
    /// For each colour, the mean of arriving light is A₀ = l₀ V₀ + l₁ · V₁, its first moment A₁ = l₀ V₁ + l₁ V₀ / 3,
    /// and the irradiance of a surface π (A₀ + 2 n · A₁): exact for an open hemisphere under a uniform sky.
    pub(crate) fn lit_by_sky(
        &self,
        openness: Option<&SkyVisibility>,
        point: DVec3,
        normal: DVec3,
        weight: f64,
        side: Option<f64>,
    ) -> [f64; 3] {
        let Some(radiance) = self.settings.sky.radiance(self.settings.camera.up) else { return [0.0; 3] };
        let strength = self.settings.shadows.strength;
        let (v0, v1) = openness.map_or((1.0, DVec3::ZERO), |openness| {
            let turned = if side.is_some_and(|side| side < 0.0) { -1.0 } else { 1.0 };
            let ahead = SKY_LOOKUP_DISTANCE * openness.divisor as f64 * self.scene.smallest_edge();
            let ahead = self.scene.index_from_scene.transform_vector3(normal * (turned * weight * ahead));
            let (v0, v1) = openness.at(point + ahead);
            (1.0 - strength * (1.0 - v0), v1 * strength)
        });
        std::array::from_fn(|c| {
            let (l0, l1) = (radiance.mean[c], radiance.slope[c]);
            let a0 = l0 * v0 + l1.dot(v1);
            let facing = 2.0 * normal.dot(l0 * v1 + l1 * (v0 / 3.0));
            let (along, against) = ((a0 + facing).max(0.0), (a0 - facing).max(0.0));
            let surface = side.map_or(along.max(against), |side| {
                let rising = 0.5 + 0.5 * side;
                rising * along + (1.0 - rising) * against
            });
            weight * surface + (1.0 - weight) * a0.max(0.0)
        })
    }
}

/// Iterates over the optical depths of a ray's slices.
fn depths<'a>(frame: &'a SweepFrame, extinction: &'a [f64], ray: usize) -> impl Iterator<Item = f64> + 'a {
    let ray = [ray as u32 % frame.size[0], ray as u32 / frame.size[0]];
    (0..frame.slices()).map(move |slice| {
        let block = frame.block_position(slice as f64, frame.crossing(ray, slice));
        interpolate_with_zero_border(frame.dims, extinction, block).max(0.0) * frame.step
    })
}

/// Returns the mean transmittance over a slice with an optical depth: (1 − e^−τ)/τ.
fn mean_transmittance(depth: f64) -> f64 {
    if depth < 1e-12 { 1.0 } else { -(-depth).exp_m1() / depth }
}

fn ray_count(frame: &SweepFrame) -> usize {
    frame.size.iter().map(|&n| n as usize).product()
}

/// Returns the deposit of each ray in each slice: the mean transmittance over it.
fn march(frame: &SweepFrame, extinction: &[f64]) -> Vec<f64> {
    let of_ray = |ray: usize| {
        let mut transmittance = 1.0;
        depths(frame, extinction, ray).map(move |depth| {
            let deposit = transmittance * mean_transmittance(depth);
            transmittance *= (-depth).exp();
            deposit
        })
    };
    (0..ray_count(frame)).into_par_iter().flat_map_iter(of_ray).collect()
}

/// Returns the transmittance of each ray where it meets the floor: the mean over the slice that contains the floor; 1
/// before the first slice, and that of the whole ray behind the last. `above` returns heights above the floor.
fn transmittance_to_floor(
    frame: &SweepFrame,
    extinction: &[f64],
    above: impl Fn(DVec3) -> f64 + Sync,
) -> Vec<f64> {
    let last = frame.slices() - 1;
    let of_ray = |ray: usize| {
        let at = [ray as u32 % frame.size[0], ray as u32 / frame.size[0]];
        let height = |slice: usize| above(frame.block_position(slice as f64, frame.crossing(at, slice)));
        // Heights are linear along a ray, so that two positions suffice; the second exists even for a grid of one
        // slice.
        let next = above(frame.block_position(1.0, frame.crossing(at, 1)));
        let in_slice = (height(0) / (height(0) - next) + 0.5).floor();
        if in_slice < 0.0 {
            return 1.0;
        }
        let whole: f64 = depths(frame, extinction, ray)
            .zip(0..=last)
            .take_while(|(_, at)| (*at as f64) < in_slice)
            .map(|(depth, _)| depth)
            .sum();
        let reached = depths(frame, extinction, ray).nth(in_slice as usize).map_or(1.0, mean_transmittance);
        (-whole).exp() * reached
    };
    (0..ray_count(frame)).into_par_iter().map(of_ray).collect()
}

/// Interpolates trilinearly between blocks, with 0 outside the grid.
pub(crate) fn interpolate_with_zero_border(dims: [usize; 3], values: &[f64], at: DVec3) -> f64 {
    let low = at.floor();
    let share = at - low;
    let corner = |corner: usize| {
        let mut weight = 1.0;
        let mut index = 0;
        let mut stride = 1;
        for axis in 0..3 {
            let is_far = corner >> axis & 1 == 1;
            weight *= if is_far { share[axis] } else { 1.0 - share[axis] };
            let place = low[axis] as i64 + i64::from(is_far);
            if place < 0 || place >= dims[axis] as i64 {
                return 0.0;
            }
            index += place as usize * stride;
            stride *= dims[axis];
        }
        weight * values[index]
    };
    (0..8).map(corner).sum()
}

/// Returns the share of light that reaches a position in blocks, interpolated between the rays and slices around it;
/// outside the grid light is unattenuated.
fn light_at(frame: &SweepFrame, deposits: &[f64], start: DVec3) -> f64 {
    let SlicePosition { slice, across } = frame.ray_position(start);
    let slice = slice.clamp(0.0, frame.slices() as f64 - 1.0);
    let share = slice.fract();
    let next = (slice.ceil() as usize).min(frame.slices() - 1);
    let in_slice =
        |n: usize| interpolate_rays(frame, across.max(DVec2::ZERO), |ray| deposits[ray * frame.slices() + n]);
    let passed = in_slice(slice as usize) * (1.0 - share) + in_slice(next) * share;
    let end = DVec3::from(frame.dims.map(|n| n as f64 - 0.5));
    let outside = (-0.5 - start).max(start - end).max_element();
    passed + (1.0 - passed) * (2.0 * outside).clamp(0.0, 1.0)
}

/// Returns the share of light that reaches a position of the floor in blocks, which may be outside the grid.
fn light_on_floor(frame: &SweepFrame, left: &[f64], place: DVec3) -> f64 {
    interpolate_rays(frame, frame.ray_position(place).across, |ray| left[ray])
}

/// Interpolates between the four rays around a position; outside all rays light is unattenuated.
fn interpolate_rays(frame: &SweepFrame, place: DVec2, of_ray: impl Fn(usize) -> f64) -> f64 {
    let low = place.floor();
    let share = place - low;
    let at = |i: f64, j: f64| {
        let (i, j) = (low.x + i, low.y + j);
        let is_ray = i >= 0.0 && j >= 0.0 && i < f64::from(frame.size[0]) && j < f64::from(frame.size[1]);
        if is_ray { of_ray(i as usize + j as usize * frame.size[0] as usize) } else { 1.0 }
    };
    let row = |j: f64| at(0.0, j) * (1.0 - share.x) + at(1.0, j) * share.x;
    row(0.0) * (1.0 - share.y) + row(1.0) * share.y
}
