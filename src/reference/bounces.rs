//! Light that bounces: what material scatters lights what is around it.
//!
//! Of a block, ϖ is what it scatters of the light that it meets, for each colour, and φ the mean light there over all
//! directions. φ₀ is that of lights and sky; what has bounced is ψ = ⟨L⟩, the mean over directions of the light along rays
//! through blocks that give off S = ϖ (φ₀ + ψ).

use glam::DVec3;
use rayon::prelude::*;

use super::Reference;
use super::field::classified::Side;
use super::field::trilinear;
use super::shade::linear_from_srgb;
use super::sky::bordered;
use crate::model::{LightKind, SKY_AHEAD, SceneLight};
use crate::plan::{SweepFrame, sweep_directions};

/// Most points that stand for a light: what has bounced shows no edge of a shadow.
const MOST_POINTS: u32 = 8;

/// The largest ratio of two bounces that is believed.
const MOST_RATIO: f64 = 0.98;

/// Light that has bounced.
#[derive(Debug, Clone, PartialEq)]
pub struct Bounced {
    /// Blocks along x, y and z.
    pub dims: [usize; 3],
    /// Voxels along the edge of a block.
    pub divisor: usize,
    /// Linear RGB of each block, x fastest, channel by channel.
    pub light: [Vec<f64>; 3],
}

/// What light meets: blocks of voxels, per scene unit.
#[derive(Debug, Clone)]
pub struct Medium {
    /// Blocks along x, y and z.
    pub dims: [usize; 3],
    /// Voxels along the edge of a block.
    pub divisor: usize,
    /// Extinction times what of it scatters, for each colour.
    pub scattering: [Vec<f64>; 3],
    /// Extinction.
    pub extinction: Vec<f64>,
}

/// A light that is on.
struct Lamp {
    points: Vec<SceneLight>,
    rgb: [f64; 3],
    /// Multiplies what it meets: 0 where nothing attenuates it.
    scale: f64,
}

impl Bounced {
    /// Between blocks.
    fn at(&self, point: DVec3) -> [f64; 3] {
        let place = (point + 0.5) / self.divisor as f64 - 0.5;
        self.light.each_ref().map(|light| trilinear(self.dims, light, place))
    }
}

impl Medium {
    /// A block's place in the grid.
    pub fn block(&self, at: usize) -> DVec3 {
        let [nx, ny, _] = self.dims;
        DVec3::new((at % nx) as f64, (at / nx % ny) as f64, (at / (nx * ny)) as f64)
    }

    /// Scattering and extinction between blocks.
    pub fn at(&self, block: DVec3) -> ([f64; 3], f64) {
        let of = |values: &[f64]| bordered(self.dims, values, block);
        (self.scattering.each_ref().map(|values| of(values)), of(&self.extinction))
    }

    /// The optical depth along a vector that is a scene unit long, over a part of the way and in steps of that length.
    fn depth(&self, block: DVec3, along: DVec3, (from, to): (f64, f64), step: f64) -> f64 {
        let (mut way, mut depth) = (from, 0.0);
        while way < to {
            let length = step.min(to - way);
            let middle = block + along * (way + 0.5 * length);
            if !self.holds(middle) {
                break;
            }
            depth += bordered(self.dims, &self.extinction, middle) * length;
            way += length;
        }
        depth
    }

    /// Whether a place is near the grid.
    pub fn holds(&self, block: DVec3) -> bool {
        block.min_element() >= -1.0 && (block - DVec3::from(self.dims.map(|n| n as f64))).max_element() <= 0.0
    }
}

impl Reference<'_> {
    /// The light that has bounced, from as many bounces and directions and as finely as the settings say.
    pub fn bounced(&self) -> Bounced {
        let scattering = &self.settings.scattering;
        let medium = self.medium();
        let frames: Vec<_> = sweep_directions(scattering.directions)
            .into_iter()
            .map(|towards| SweepFrame::new(&self.scene, medium.divisor, towards))
            .collect();
        let count = medium.extinction.len();
        let nothing = || [(); 3].map(|()| vec![0.0; count]);
        let sky = self.settings.sky.radiance(self.settings.camera.up);
        let mut first = nothing();
        if let Some(sky) = sky {
            let arriving =
                |towards: DVec3| std::array::from_fn(|c| (sky.mean[c] + sky.slope[c].dot(towards)).max(0.0));
            first = mean_light(&medium, &frames, &nothing(), arriving);
        }
        let lamps = self.lamps();
        let own = self.settings.shading.emission / scattering.albedo;
        let lit: Vec<_> =
            (0..count).into_par_iter().map(|at| self.unscattered(&medium, &lamps, at)).collect();
        for (c, first) in first.iter_mut().enumerate() {
            first.iter_mut().zip(&lit).for_each(|(sum, light)| *sum += light[c] + own);
        }
        // What bounces have brought in all, and how much more that was than before the last.
        let (mut light, mut change) = (nothing(), nothing());
        for bounce in 1..=scattering.bounces {
            let given: [Vec<f64>; 3] = std::array::from_fn(|c| {
                (0..count).map(|at| medium.scattering[c][at] * (first[c][at] + light[c][at])).collect()
            });
            let next = mean_light(&medium, &frames, &given, |_| [0.0; 3]);
            let more: [Vec<f64>; 3] = std::array::from_fn(|c| {
                next[c].iter().zip(&light[c]).map(|(next, last)| next - last).collect()
            });
            // The last leaps to the end of the series, and every other before it.
            let leaps = bounce > 1 && (scattering.bounces - bounce).is_multiple_of(2);
            for c in 0..3 {
                let ratio = if leaps { ratio(&medium, &more[c], &change[c]) } else { 0.0 };
                let leap =
                    |(light, more): (&mut f64, &f64)| *light = (*light + more / (1.0 - ratio)).max(0.0);
                light[c].iter_mut().zip(&more[c]).for_each(leap);
            }
            change = more;
        }
        Bounced { dims: medium.dims, divisor: medium.divisor, light }
    }

    /// What light meets that is scattered.
    pub fn medium(&self) -> Medium {
        let scattering = &self.settings.scattering;
        let divisor = scattering.resolution.divisor();
        let dims = self.scene.dims.map(|n| n.div_ceil(divisor));
        let table = self.gathered_table(Side::Eye);
        let level = (divisor as f64 / 2.0).max(1.0).log2();
        let color = |point: DVec3| {
            let point = point + self.kernel_shift();
            if let Some(classified) = self.classified(Side::Eye) {
                let share = classified.shares.fetch(point, level).max(1e-20);
                return classified
                    .colors
                    .each_ref()
                    .map(|color| (color.fetch(point, level) / share).clamp(0.0, 1.0));
            }
            let [r, g, b, _] = table.sample(self.gathered_pyramid(Side::Eye).fetch(point, level));
            [r, g, b]
        };
        let blocks = self.blocks(dims, divisor, |point, extinction| {
            let [r, g, b] = color(point).map(|color| color * scattering.albedo * extinction);
            [r, g, b, extinction]
        });
        let of = |channel: usize| {
            blocks.iter().map(|block| block[channel] * scattering.density_scale).collect::<Vec<f64>>()
        };
        Medium { dims, divisor, scattering: [of(0), of(1), of(2)], extinction: of(3) }
    }

    /// The lights that are on.
    fn lamps(&self) -> Vec<Lamp> {
        let settings = self.settings;
        let on = settings.lights.iter().enumerate().filter(|(_, light)| light.on);
        on.map(|(index, light)| {
            let whole = self.light(index);
            let samples = settings.shadows.area.samples.min(MOST_POINTS);
            Lamp {
                points: if whole.area.is_some() { whole.points(samples) } else { vec![whole] },
                rgb: light.color.map(|c| linear_from_srgb(c) * light.intensity * settings.shadows.balance),
                scale: if light.needs_volume() { light.density_scale } else { 0.0 },
            }
        })
        .collect()
    }

    /// The mean light over all directions that reaches a block from the lights without being scattered. Of a light whose
    /// brightness is that of a white surface which faces it, E/π, that is a quarter: E / 4π.
    fn unscattered(&self, medium: &Medium, lamps: &[Lamp], at: usize) -> [f64; 3] {
        if medium.extinction[at] <= 0.0 {
            return [0.0; 3];
        }
        let block = medium.block(at);
        self.light_of(medium, lamps, block, |along, distance| {
            let step = 1.0 / along.abs().max_element();
            let own = medium.extinction[at] * step.min(distance);
            let mean = move |scale: f64| {
                if own * scale < 1e-9 { 1.0 } else { -(-own * scale).exp_m1() / (own * scale) }
            };
            (mean, medium.depth(block, along, (0.5 * step, distance), step))
        })
    }

    /// The same at any place, by what `way` says of a ray through blocks along a vector that is a scene unit long, up to a
    /// distance: of an extinction's scale, what is left by its first part, and the optical depth of the rest.
    fn light_of<F: Fn(f64) -> f64>(
        &self,
        medium: &Medium,
        lamps: &[Lamp],
        block: DVec3,
        way: impl Fn(DVec3, f64) -> (F, f64),
    ) -> [f64; 3] {
        let divisor = medium.divisor as f64;
        let place = self.scene.scene_from_index.transform_point3((block + 0.5) * divisor - 0.5);
        let mut light = [0.0; 3];
        for lamp in lamps {
            let left = |one: &SceneLight| {
                let (towards, distance) = match one.kind {
                    LightKind::Parallel => (one.direction(), f64::INFINITY),
                    LightKind::Perspective => {
                        let away = DVec3::from(one.position) - place;
                        (away.normalize_or(DVec3::Z), away.length())
                    }
                };
                let along = self.scene.index_from_scene.transform_vector3(towards) / divisor;
                let (first, depth) = way(along, distance);
                let cone = one.cone();
                first(lamp.scale) * (-depth * lamp.scale).exp() * cone.share(-cone.axis.dot(towards))
            };
            let mean = lamp.points.iter().map(left).sum::<f64>() / lamp.points.len() as f64;
            light.iter_mut().zip(lamp.rgb).for_each(|(sum, rgb)| *sum += 0.25 * rgb * mean);
        }
        light
    }

    /// Light that has bounced before it reaches a block, by as many random walks of light against its way from there: free ways from
    /// the extinction between blocks by delta tracking (Woodcock, Murphy, Hemmings and Longworth 1965), directions evenly
    /// over all. The mean converges to the truth as the walks become more, whatever blocks, rays and bounces others count.
    pub fn bounced_by_walks(&self, medium: &Medium, at: usize, walks: u32, seed: u64) -> [f64; 3] {
        let lamps = self.lamps();
        let sky = self.settings.sky.radiance(self.settings.camera.up);
        let own = self.settings.shading.emission / self.settings.scattering.albedo;
        let most = medium.extinction.iter().copied().fold(0.0, f64::max);
        let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ at as u64);
        let mut sum = [0.0; 3];
        for walk in 0..walks {
            let within = DVec3::new(random.next(), random.next(), random.next()) - 0.5;
            let mut block = medium.block(at) + within;
            let mut weight = [1.0; 3];
            let mut has_bounced = false;
            // The first ways are spread evenly, which says more with fewer.
            let mut towards = on_a_sphere(
                1.0 - f64::from(2 * walk + 1) / f64::from(walks),
                f64::from(walk) * std::f64::consts::PI * (3.0 - 5f64.sqrt()),
            );
            while weight.iter().any(|&weight| weight > 1e-4) {
                let along = self.scene.index_from_scene.transform_vector3(towards) / medium.divisor as f64;
                block += along * (-random.next().ln() / most);
                if !medium.holds(block) {
                    if let (Some(sky), true) = (&sky, has_bounced) {
                        for c in 0..3 {
                            sum[c] += weight[c] * (sky.mean[c] + sky.slope[c].dot(towards)).max(0.0);
                        }
                    }
                    break;
                }
                let (scattering, extinction) = medium.at(block);
                if random.next() * most >= extinction {
                    continue;
                }
                has_bounced = true;
                let light = self.light_of(medium, &lamps, block, |along, distance| {
                    let step = 0.5 / along.abs().max_element();
                    (|_| 1.0, medium.depth(block, along, (0.0, distance), step))
                });
                for c in 0..3 {
                    weight[c] *= scattering[c] / extinction;
                    sum[c] += weight[c] * (light[c] + own);
                }
                towards = random.direction();
            }
        }
        sum.map(|sum| sum / f64::from(walks))
    }

    /// Bounced light on a surface, as a share of its colour; `weight` says how much of one it is, and `side` to which side it
    /// looks, 1 along the normal and −1 against it.
    pub(super) fn lit_by_bounces(
        &self,
        bounced: Option<&Bounced>,
        point: DVec3,
        normal: DVec3,
        weight: f64,
        side: Option<f64>,
    ) -> [f64; 3] {
        let Some(bounced) = bounced else { return [0.0; 3] };
        let scattering = &self.settings.scattering;
        let turned = if side.is_some_and(|side| side < 0.0) { -1.0 } else { 1.0 };
        let ahead = SKY_AHEAD * bounced.divisor as f64 * self.scene.smallest_edge();
        let ahead = self.scene.index_from_scene.transform_vector3(normal * (turned * weight * ahead));
        bounced.at(point + ahead).map(|light| light * scattering.albedo * scattering.strength)
    }
}

/// What a bounce brings of what the one before did, over all blocks that scatter light: all further ones bring
/// ρ / (1 − ρ) of it.
fn ratio(medium: &Medium, more: &[f64], before: &[f64]) -> f64 {
    let over = |a: &[f64], b: &[f64]| -> f64 {
        let products = medium.extinction.iter().zip(a.iter().zip(b));
        products.filter(|(extinction, _)| **extinction > 0.0).map(|(_, (a, b))| a * b).sum()
    };
    (over(more, before) / over(before, before).max(1e-20)).clamp(0.0, MOST_RATIO)
}

/// The mean light over directions at every block, of what blocks give off per scene unit and of what arrives from outside.
fn mean_light(
    medium: &Medium,
    frames: &[SweepFrame],
    given: &[Vec<f64>; 3],
    arriving: impl Fn(DVec3) -> [f64; 3],
) -> [Vec<f64>; 3] {
    let count = medium.extinction.len();
    let mut sums = [(); 3].map(|()| vec![0.0; count]);
    for frame in frames {
        let deposits = march(medium, frame, given, arriving(frame.towards));
        for (c, sums) in sums.iter_mut().enumerate() {
            sums.par_iter_mut().enumerate().for_each(|(at, sum)| {
                *sum += received(frame, &deposits, medium.block(at), c) / frames.len() as f64;
            });
        }
    }
    sums
}

/// The mean light of each ray over each slice.
fn march(medium: &Medium, frame: &SweepFrame, given: &[Vec<f64>; 3], arriving: [f64; 3]) -> Vec<[f64; 3]> {
    let [width, height] = frame.size;
    let of_ray = |ray: usize| {
        let ray = [ray as u32 % width, ray as u32 / width];
        let mut light = arriving;
        let mut deposits = Vec::with_capacity(frame.slices());
        for slice in 0..frame.slices() {
            let block = frame.block(slice as f64, frame.crossing(ray, slice));
            let depth = bordered(medium.dims, &medium.extinction, block) * frame.step;
            let given = given.each_ref().map(|given| bordered(medium.dims, given, block) * frame.step);
            // (1 − e^−τ)/τ, and what is left of the light that is given off itself.
            let mean = if depth < 1e-12 { 1.0 } else { -(-depth).exp_m1() / depth };
            let share = if depth < 1e-5 { 0.5 } else { (1.0 - mean) / depth };
            deposits.push(std::array::from_fn(|c| light[c] * mean + given[c] * share));
            light = std::array::from_fn(|c| light[c] * (-depth).exp() + given[c] * mean);
        }
        deposits
    };
    (0..(width * height) as usize).into_par_iter().flat_map_iter(of_ray).collect()
}

/// What of it a block receives: between the four rays around it.
fn received(frame: &SweepFrame, deposits: &[[f64; 3]], block: DVec3, channel: usize) -> f64 {
    let (slice, ray) = frame.place(block);
    let low = ray.floor();
    let share = ray - low;
    let at = |i: usize, j: usize| {
        let ray = low.x as usize + i + (low.y as usize + j) * frame.size[0] as usize;
        deposits[ray * frame.slices() + slice.round() as usize][channel]
    };
    let row = |j: usize| at(0, j) * (1.0 - share.x) + at(1, j) * share.x;
    row(0) * (1.0 - share.y) + row(1) * share.y
}

/// Numbers that look random and are the same every time: splitmix64 (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    /// Above 0, at most 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1u64 << 53) as f64 + f64::EPSILON / 2.0
    }

    /// A unit vector, evenly over the sphere.
    fn direction(&mut self) -> DVec3 {
        on_a_sphere(2.0 * self.next() - 1.0, std::f64::consts::TAU * self.next())
    }
}

/// The unit vector at a height and an angle about the axis.
fn on_a_sphere(z: f64, angle: f64) -> DVec3 {
    let across = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(across * angle.cos(), across * angle.sin(), z)
}
