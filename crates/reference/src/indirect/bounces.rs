//! Bounced light (multiple scattering) between blocks of voxels.
//!
//! For each block, ϖ is its scattering coefficient for each colour, and φ the mean of the light there over all
//! directions. φ₀ is that of lights and sky; bounced light is ψ = ⟨L⟩, the mean over directions of the light along
//! rays through blocks that emit S = ϖ (φ₀ + ψ). Each sweep's change of ψ diffuses, which gives what later bounces bring
//! of it.

use glam::DVec3;
use rayon::prelude::*;

use super::diffusion::DiffusionGrid;
use super::series::{SeriesStep, without_spread};
use super::sky::interpolate_with_zero_border;
use crate::field::classified::TransferSide;
use crate::field::trilinear;
use crate::{Reference, linear_from_srgb};
use chiaroscuro_render::plan::{SlicePosition, SweepFrame, sweep_directions};
use chiaroscuro_scene::{LightGeometry, SKY_LOOKUP_DISTANCE, ScatteringSettings, SceneLight};

/// Maximum number of points for an area light: bounced light shows no edges of shadows.
const MAX_LIGHT_POINTS: u32 = 8;

/// Number of last bounces before the visible one whose changes diffuse.
const DIFFUSED_BOUNCES: u32 = 4;

/// Volume of bounced light.
#[derive(Debug, Clone, PartialEq)]
pub struct BouncedLight {
    /// Number of blocks along x, y and z.
    pub dims: [usize; 3],
    /// Edge of a block, in voxels.
    pub divisor: usize,
    /// Linear RGB of each block, x fastest, channel by channel.
    pub light: [Vec<f64>; 3],
}

/// Participating medium in blocks of voxels: coefficients per scene unit.
#[derive(Debug, Clone)]
pub struct ScatteringMedium {
    /// Number of blocks along x, y and z.
    pub dims: [usize; 3],
    /// Edge of a block, in voxels.
    pub divisor: usize,
    /// Scattering coefficient for each colour: extinction times albedo.
    pub scattering: [Vec<f64>; 3],
    /// Extinction coefficient of each block.
    pub extinction: Vec<f64>,
}

/// Light that is on, sampled at points.
pub(super) struct PointSampledLight {
    points: Vec<SceneLight>,
    rgb: [f64; 3],
    /// Factor of the extinction; 0 if nothing attenuates the light.
    scale: f64,
}

impl BouncedLight {
    /// Interpolates between blocks at an index-space point.
    fn at(&self, point: DVec3) -> [f64; 3] {
        let place = (point + 0.5) / self.divisor as f64 - 0.5;
        self.light.each_ref().map(|light| trilinear(self.dims, light, place))
    }
}

impl ScatteringMedium {
    /// Returns the position of a block in the grid of blocks.
    pub fn block(&self, at: usize) -> DVec3 {
        let [nx, ny, _] = self.dims;
        DVec3::new((at % nx) as f64, (at / nx % ny) as f64, (at / (nx * ny)) as f64)
    }

    /// Interpolates scattering and extinction at a position in blocks.
    pub fn at(&self, block: DVec3) -> ([f64; 3], f64) {
        let of = |values: &[f64]| interpolate_with_zero_border(self.dims, values, block);
        (self.scattering.each_ref().map(|values| of(values)), of(&self.extinction))
    }

    /// Returns the optical depth along a ray, whose direction `along` is the displacement per scene unit, from one
    /// distance to another in steps of length `step`.
    pub(super) fn optical_depth(&self, block: DVec3, along: DVec3, (from, to): (f64, f64), step: f64) -> f64 {
        let (mut transmittance_along, mut depth) = (from, 0.0);
        while transmittance_along < to {
            let length = step.min(to - transmittance_along);
            let middle = block + along * (transmittance_along + 0.5 * length);
            if !self.contains(middle) {
                break;
            }
            depth += interpolate_with_zero_border(self.dims, &self.extinction, middle) * length;
            transmittance_along += length;
        }
        depth
    }

    /// Returns true if a position is in the grid or up to a block outside.
    pub fn contains(&self, block: DVec3) -> bool {
        block.min_element() >= -1.0 && (block - DVec3::from(self.dims.map(|n| n as f64))).max_element() <= 0.0
    }
}

impl Reference<'_> {
    /// Computes bounced light, with the number of bounces and directions and the resolution in the settings.
    pub fn bounced_light(&self) -> BouncedLight {
        let scattering = &self.settings.scattering;
        let medium = self.medium();
        let frames_of_a_bounce =
            self.frames(&medium, ScatteringSettings::inner_bounce_directions(scattering.directions));
        let frames = self.frames(&medium, scattering.directions);
        let count = medium.extinction.len();
        let own = self.settings.shading.emission / scattering.albedo;
        let sky = self.sky_in_blocks(&medium, &frames_of_a_bounce);
        let mut first = self.with_lights(&medium, sky);
        first.iter_mut().flatten().for_each(|light| *light += own);
        let emitted_by = |light: &[Vec<f64>; 3]| -> [Vec<f64>; 3] {
            std::array::from_fn(|c| {
                let of = |at: usize| medium.scattering[c][at] * (first[c][at] + light[c][at]);
                (0..count).map(of).collect()
            })
        };
        let mut light = [(); 3].map(|()| vec![0.0; count]);
        if scattering.bounces > 1 {
            let grids = self.diffusion_grids(&medium);
            // Before the first sweep all that blocks scatter or emit diffuses.
            let given = emitted_by(&light);
            for c in 0..3 {
                light[c] = self.diffuse(&grids[c], &given[c]).iter().map(|light| light.max(0.0)).collect();
            }
            let mut before: Option<[SeriesStep; 3]> = None;
            for bounce in 1..scattering.bounces {
                let mut next = mean_light(&medium, &frames_of_a_bounce, &emitted_by(&light), |_| [0.0; 3]);
                if !self.settings.sky.is_on() {
                    next = next.map(|light| without_spread(medium.dims, &medium.extinction, &light));
                }
                if scattering.bounces - bounce > DIFFUSED_BOUNCES {
                    light = next;
                    continue;
                }
                let steps = std::array::from_fn(|c| {
                    let change: Vec<f64> =
                        next[c].iter().zip(&light[c]).map(|(next, last)| next - last).collect();
                    let both = change.iter().zip(&medium.scattering[c]);
                    let scattered: Vec<f64> = both.map(|(change, share)| change * share).collect();
                    let later = self.diffuse(&grids[c], &scattered);
                    SeriesStep::new(&light[c], &change, &later)
                });
                for c in 0..3 {
                    let before = before.as_ref().map(|before| &before[c]);
                    light[c] = steps[c].mixed_with(before, &medium.extinction);
                }
                before = Some(steps);
            }
        }
        if scattering.bounces > 0 {
            // The last bounce is the visible one, and has more directions.
            light = mean_light(&medium, &frames, &emitted_by(&light), |_| [0.0; 3]);
        }
        BouncedLight { dims: medium.dims, divisor: medium.divisor, light }
    }

    /// Returns the mean light over all directions, linear RGB, that reaches each block from lights and sky before it
    /// bounces; that of the sky from the given number of directions.
    pub fn unscattered_light(&self, medium: &ScatteringMedium, directions: u32) -> [Vec<f64>; 3] {
        self.with_lights(medium, self.sky_in_blocks(medium, &self.frames(medium, directions)))
    }

    /// Creates the diffusion equation of each colour.
    fn diffusion_grids(&self, medium: &ScatteringMedium) -> [DiffusionGrid; 3] {
        let shortest = self.scene.smallest_edge();
        let edges = self.scene.voxel_edges / shortest * medium.divisor as f64;
        let depths = |of: &[f64]| of.iter().map(|per_unit| per_unit * shortest).collect::<Vec<f64>>();
        let extinction = depths(&medium.extinction);
        medium
            .scattering
            .each_ref()
            .map(|of| DiffusionGrid::new(medium.dims, edges, &extinction, &depths(of)))
    }

    /// Returns the light that all later bounces bring, from the light that blocks scatter per scene unit.
    fn diffuse(&self, grid: &DiffusionGrid, scattered: &[f64]) -> Vec<f64> {
        let per_edge: Vec<f64> = scattered.iter().map(|light| light * self.scene.smallest_edge()).collect();
        grid.solve(&per_edge)
    }

    /// Returns the mean light of the sky in each block.
    fn sky_in_blocks(&self, medium: &ScatteringMedium, frames: &[SweepFrame]) -> [Vec<f64>; 3] {
        let nothing = [(); 3].map(|()| vec![0.0; medium.extinction.len()]);
        match self.settings.sky.radiance(self.settings.camera.up) {
            Some(sky) => mean_light(medium, frames, &nothing, |towards| {
                std::array::from_fn(|c| (sky.mean[c] + sky.slope[c].dot(towards)).max(0.0))
            }),
            None => nothing,
        }
    }

    /// Adds the light of lamps to that of the sky in each block.
    fn with_lights(&self, medium: &ScatteringMedium, mut light: [Vec<f64>; 3]) -> [Vec<f64>; 3] {
        let sampled_lights = self.active_lights();
        let lit: Vec<_> = (0..light[0].len())
            .into_par_iter()
            .map(|at| self.light_in_block(medium, &sampled_lights, at))
            .collect();
        for (c, light) in light.iter_mut().enumerate() {
            light.iter_mut().zip(&lit).for_each(|(sum, light)| *sum += light[c]);
        }
        light
    }

    /// Creates sweep frames in the given number of directions.
    fn frames(&self, medium: &ScatteringMedium, directions: u32) -> Vec<SweepFrame> {
        let all = sweep_directions(directions).into_iter();
        all.map(|towards| SweepFrame::new(&self.scene, medium.divisor, towards)).collect()
    }

    /// Computes the medium that scatters light.
    pub fn medium(&self) -> ScatteringMedium {
        let scattering = &self.settings.scattering;
        let divisor = self.settings.shadows.soft_resolution(scattering.resolution, self.scene.dims).divisor();
        let dims = self.scene.dims.map(|n| n.div_ceil(divisor));
        let table = self.gathered_table(TransferSide::Eye);
        let level = (divisor as f64 / 2.0).max(1.0).log2();
        let color = |place: DVec3| {
            let point = place + self.kernel_shift();
            if let Some(classified) = self.classified(TransferSide::Eye) {
                let share = classified.shares.fetch(point, level).max(1e-20);
                return classified
                    .colors
                    .each_ref()
                    .map(|color| (color.fetch(point, level) / share).clamp(0.0, 1.0));
            }
            let [r, g, b, _] = table.sample(self.gathered_pyramid(TransferSide::Eye).fetch(point, level));
            self.tinted([r, g, b], place, level)
        };
        let blocks = self.blocks(dims, divisor, !self.settings.sky.is_on(), |point, extinction| {
            let [r, g, b] = color(point).map(|color| color * scattering.albedo * extinction);
            [r, g, b, extinction]
        });
        let of = |channel: usize| {
            blocks.iter().map(|block| block[channel] * scattering.density_scale).collect::<Vec<f64>>()
        };
        ScatteringMedium { dims, divisor, scattering: [of(0), of(1), of(2)], extinction: of(3) }
    }

    /// Returns the lights that are on.
    pub(super) fn active_lights(&self) -> Vec<PointSampledLight> {
        let settings = self.settings;
        let on = settings.lights.iter().enumerate().filter(|(_, light)| light.on);
        on.map(|(index, light)| {
            let whole = self.light(index);
            let samples = settings.shadows.area.samples.min(MAX_LIGHT_POINTS);
            PointSampledLight {
                points: if whole.area.is_some() && light.needs_volume() {
                    whole.sample_lights(samples)
                } else {
                    vec![whole]
                },
                rgb: light.color.map(|c| linear_from_srgb(c) * light.intensity * settings.shadows.balance),
                scale: if light.needs_volume() { light.density_scale } else { 0.0 },
            }
        })
        .collect()
    }

    /// Returns the mean light over all directions that reaches a block from the lights unscattered. A light whose
    /// brightness is that of a white surface facing it, E/π, contributes a quarter of it: E / 4π.
    fn light_in_block(
        &self,
        medium: &ScatteringMedium,
        sampled_lights: &[PointSampledLight],
        at: usize,
    ) -> [f64; 3] {
        if medium.extinction[at] <= 0.0 {
            return [0.0; 3];
        }
        let block = medium.block(at);
        self.light_at(medium, sampled_lights, block, |along, distance| {
            let step = 1.0 / along.abs().max_element();
            let own = medium.extinction[at] * step.min(distance);
            let mean = move |scale: f64| {
                if own * scale < 1e-9 { 1.0 } else { -(-own * scale).exp_m1() / (own * scale) }
            };
            (mean, medium.optical_depth(block, along, (0.5 * step, distance), step))
        })
    }

    /// Returns the mean light over all directions at a position, from lights unscattered. For a ray whose direction
    /// is the displacement in blocks per scene unit, up to a distance, `way` returns the transmittance of its first
    /// part as a function of the extinction's factor, and the optical depth of the rest.
    pub(super) fn light_at<F: Fn(f64) -> f64>(
        &self,
        medium: &ScatteringMedium,
        sampled_lights: &[PointSampledLight],
        block: DVec3,
        way: impl Fn(DVec3, f64) -> (F, f64),
    ) -> [f64; 3] {
        let divisor = medium.divisor as f64;
        let place = self.scene.scene_from_index.transform_point3((block + 0.5) * divisor - 0.5);
        let mut light = [0.0; 3];
        for sampled_light in sampled_lights {
            let left = |one: &SceneLight| {
                let (towards, distance) = match one.kind {
                    LightGeometry::Parallel => (one.direction(), f64::INFINITY),
                    LightGeometry::Perspective => {
                        let away = DVec3::from(one.position) - place;
                        (away.normalize_or(DVec3::Z), away.length())
                    }
                };
                let along = self.scene.index_from_scene.transform_vector3(towards) / divisor;
                let (first, depth) = way(along, distance);
                let cone = one.cone();
                first(sampled_light.scale)
                    * (-depth * sampled_light.scale).exp()
                    * cone.attenuation(-cone.axis.dot(towards))
            };
            let mean = sampled_light.points.iter().map(left).sum::<f64>() / sampled_light.points.len() as f64;
            light.iter_mut().zip(sampled_light.rgb).for_each(|(sum, rgb)| *sum += 0.25 * rgb * mean);
        }
        light
    }

    /// Returns bounced light that arrives at a surface; `weight` (0 … 1) is the degree to which the
    /// sample is a surface, and `side` the side that it faces, 1 along the normal and −1 against it.
    pub(crate) fn lit_by_bounces(
        &self,
        bounced: Option<&BouncedLight>,
        point: DVec3,
        normal: DVec3,
        weight: f64,
        side: Option<f64>,
    ) -> [f64; 3] {
        let Some(bounced) = bounced else { return [0.0; 3] };
        let scattering = &self.settings.scattering;
        let turned = if side.is_some_and(|side| side < 0.0) { -1.0 } else { 1.0 };
        let ahead = SKY_LOOKUP_DISTANCE * bounced.divisor as f64 * self.scene.smallest_edge();
        let ahead = self.scene.index_from_scene.transform_vector3(normal * (turned * weight * ahead));
        bounced.at(point + ahead).map(|light| light * scattering.strength)
    }
}

/// Returns the mean light over directions at every block, from the emission of blocks per scene unit and from light
/// that arrives from outside.
fn mean_light(
    medium: &ScatteringMedium,
    frames: &[SweepFrame],
    given: &[Vec<f64>; 3],
    arriving: impl Fn(DVec3) -> [f64; 3],
) -> [Vec<f64>; 3] {
    let count = medium.extinction.len();
    let mut sums = [(); 3].map(|()| vec![0.0; count]);
    for frame in frames {
        let deposits = march_emission(medium, frame, given, arriving(frame.towards));
        for (c, sums) in sums.iter_mut().enumerate() {
            sums.par_iter_mut().enumerate().for_each(|(at, sum)| {
                *sum += received_light(frame, &deposits, medium.block(at), c) / frames.len() as f64;
            });
        }
    }
    sums
}

/// Returns the mean light of each ray over each slice.
fn march_emission(
    medium: &ScatteringMedium,
    frame: &SweepFrame,
    given: &[Vec<f64>; 3],
    arriving: [f64; 3],
) -> Vec<[f64; 3]> {
    let [width, height] = frame.size;
    let of_ray = |ray: usize| {
        let ray = [ray as u32 % width, ray as u32 / width];
        let mut light = arriving;
        let mut deposits = Vec::with_capacity(frame.slices());
        for slice in 0..frame.slices() {
            let block = frame.block_position(slice as f64, frame.crossing(ray, slice));
            let depth = interpolate_with_zero_border(medium.dims, &medium.extinction, block) * frame.step;
            let given = given
                .each_ref()
                .map(|given| interpolate_with_zero_border(medium.dims, given, block) * frame.step);
            // (1 − e^−τ)/τ, and the mean over the slice of its own emission.
            let mean = if depth < 1e-12 { 1.0 } else { -(-depth).exp_m1() / depth };
            let share = if depth < 1e-5 { 0.5 } else { (1.0 - mean) / depth };
            deposits.push(std::array::from_fn(|c| light[c] * mean + given[c] * share));
            light = std::array::from_fn(|c| light[c] * (-depth).exp() + given[c] * mean);
        }
        deposits
    };
    (0..(width * height) as usize).into_par_iter().flat_map_iter(of_ray).collect()
}

/// Returns the light that a block receives, interpolated between the four rays around it.
fn received_light(frame: &SweepFrame, deposits: &[[f64; 3]], block: DVec3, channel: usize) -> f64 {
    let SlicePosition { slice, across: ray } = frame.ray_position(block);
    let low = ray.floor();
    let share = ray - low;
    let at = |i: usize, j: usize| {
        let ray = low.x as usize + i + (low.y as usize + j) * frame.size[0] as usize;
        deposits[ray * frame.slices() + slice.round() as usize][channel]
    };
    let row = |j: usize| at(0, j) * (1.0 - share.x) + at(1, j) * share.x;
    row(0) * (1.0 - share.y) + row(1) * share.y
}
