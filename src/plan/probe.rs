//! What is at a point of the picture, and what light gets there: answers for a pointer, on the CPU, by
//! single rays.

use glam::DVec3;

use crate::data::{Missing, Volume};
use crate::math::{Bounds, Region, SceneSpace};
use crate::model::{BakedTransfer, LightKind, Settings, Sides};

/// Share of the light to the eye that must have been met for something to count as seen: half.
const SEEN: f64 = 0.5;

/// Less than this share of a ray's light met: nothing is seen.
const NOTHING: f64 = 0.03;

/// Voxel edges (the smallest) per step of a ray.
const STEP: f64 = 0.5;

/// What is seen somewhere in the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    /// In scene space.
    pub point: DVec3,
    /// In index space.
    pub index: DVec3,
    /// In millimetres, as the file places it.
    pub world_mm: DVec3,
    /// The value there, in data units.
    pub value: f64,
    /// Opacity there, per opacity unit of the eye's transfer function.
    pub opacity: f64,
    /// What gets there, for every light of the settings.
    pub lights: Vec<Arrival>,
}

/// What of a light arrives at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrival {
    /// Share that material lets through, 0 … 1; 1 for lights that cast no shadows.
    pub transmittance: f64,
    /// Share that the hood lets through.
    pub hood: f64,
    /// Cosine between the surface's normal and the direction to the light, never less than 0 where both sides are lit;
    /// `None` where nothing is a surface.
    pub facing: Option<f64>,
}

/// A volume and what makes it visible, for single rays.
struct Rays<'a> {
    volume: &'a Volume,
    scene: SceneSpace,
    /// Voxels are classified, and then what they are is mixed.
    is_by_label: bool,
}

/// Looks along a ray (in scene space) and says what is seen there; `None` if nothing is.
pub fn probe(volume: &Volume, settings: &Settings, origin: DVec3, direction: DVec3) -> Option<Probe> {
    let volume = &volume.showing(settings.shown(&volume.ranges()));
    let (settings, range) = (&*settings.as_drawn(volume), volume.table_range());
    let is_by_label = volume.shown_labels().is_some();
    let rays = Rays { volume, scene: volume.scene(), is_by_label };
    let scene = &rays.scene;
    let eye = settings.baked_eye(range, scene);
    let seen = settings.cuts.seen().region(scene);
    let point = rays.first_seen(&eye, &seen, origin, direction)?;
    let index = scene.index_from_scene.transform_point3(point);
    // As the file has it, beyond what is shown, too.
    let value = rays.value(index, &eye);
    let lighting = settings.baked_lighting(range, scene);
    let is_one_sided = settings.shading.sides == Sides::One;
    // Opacity falls towards high densities: into a solid, too, in which it rises.
    let falls = is_one_sided && !is_by_label && eye.side(rays.field(index, &eye).0) < 0.0;
    let turned = if falls { -1.0 } else { 1.0 };
    let normal = rays.gradient(point, &seen, turned, &eye).normalize_or_zero() * -turned;
    let shading_cut = settings.cuts.shading().region(scene);
    let lights = settings
        .lights
        .iter()
        .map(|light| {
            let light = light.in_scene(&settings.camera);
            let position = DVec3::from(light.position);
            let (towards, distance) = match light.kind {
                LightKind::Parallel => (light.direction(), f64::INFINITY),
                LightKind::Perspective => {
                    ((position - point).normalize_or(DVec3::Z), (position - point).length())
                }
            };
            let cone = light.cone();
            let depth = if light.needs_volume() && settings.shadows.algorithm.is_on() {
                rays.optical_depth(&lighting, &shading_cut, point, towards, distance) * light.density_scale
            } else {
                0.0
            };
            let facing = normal.dot(towards);
            let facing = if is_one_sided && light.casts_shadows { facing } else { facing.abs() };
            Arrival {
                transmittance: (-depth).exp(),
                hood: cone.share(cone.axis.dot(-towards)),
                facing: (normal != DVec3::ZERO).then_some(facing),
            }
        })
        .collect();
    Some(Probe {
        point,
        index,
        world_mm: volume.world_from_index().transform_point3(index),
        value,
        opacity: settings.transfer.opacity_at(range.at(volume.density_of(value))),
        lights,
    })
}

impl Rays<'_> {
    /// The box of the voxels, in index space: nothing lies outside.
    fn grid(&self) -> Bounds {
        Bounds::of_grid(self.volume.dims(), 0.0)
    }

    fn step(&self) -> f64 {
        STEP * self.scene.smallest_edge()
    }

    /// Where a ray enters what remains of the grid and where it leaves it, from its origin on.
    fn span(&self, remains: &Region, origin: DVec3, direction: DVec3) -> Option<(f64, f64)> {
        let origin = self.scene.index_from_scene.transform_point3(origin);
        let direction = self.scene.index_from_scene.transform_vector3(direction);
        let (enter, leave) = remains.within(&self.grid()).span(origin, direction);
        let enter = enter.max(0.0);
        (enter < leave).then_some((enter, leave))
    }

    /// Where half of what a ray meets has been met.
    fn first_seen(
        &self,
        table: &BakedTransfer,
        seen: &Region,
        origin: DVec3,
        direction: DVec3,
    ) -> Option<DVec3> {
        let (enter, leave) = self.span(seen, origin, direction)?;
        let step = self.step();
        let mut met = Vec::new();
        let mut transmittance = 1.0;
        let mut at = enter + 0.5 * step;
        while at < leave && transmittance > 0.01 {
            let tau = self.extinction(table, origin + direction * at) * step;
            transmittance *= (-tau).exp();
            met.push((at, 1.0 - transmittance));
            at += step;
        }
        let all = 1.0 - transmittance;
        if all < NOTHING {
            return None;
        }
        let (at, _) = met.into_iter().find(|&(_, opacity)| opacity >= SEEN * all)?;
        Some(origin + direction * at)
    }

    /// ∫ extinction from a step beyond a point towards a light: what is seen does not shade itself.
    fn optical_depth(
        &self,
        table: &BakedTransfer,
        remains: &Region,
        point: DVec3,
        towards: DVec3,
        distance: f64,
    ) -> f64 {
        let Some((enter, leave)) = self.span(remains, point, towards) else { return 0.0 };
        let step = self.step();
        let first = (enter / step).ceil().max(1.0) as usize;
        let last = (leave.min(distance) / step).floor().max(1.0) as usize;
        let sum: f64 =
            (first..last).map(|k| self.extinction(table, point + towards * ((k as f64 + 0.5) * step))).sum();
        sum * step
    }

    fn extinction(&self, table: &BakedTransfer, point: DVec3) -> f64 {
        let index = self.scene.index_from_scene.transform_point3(point);
        if self.is_by_label {
            let (extinction, there) = self.between_voxels(index, |value| self.voxel_extinction(table, value));
            return extinction * there;
        }
        let (density, there) = self.field(index, table);
        table.sample(density)[3] * there
    }

    /// The extinction of a voxel with that value.
    fn voxel_extinction(&self, table: &BakedTransfer, value: f64) -> f64 {
        table.sample(self.volume.density_of(value))[3]
    }

    /// What surfaces are found in, and the share of the voxels nearby that are there: the density between voxels, linearly;
    /// that of the border beyond it; 0 where no voxel nearby is there. Among labels whether there is material.
    fn field(&self, index: DVec3, table: &BakedTransfer) -> (f64, f64) {
        self.between_voxels(index, |value| {
            if self.is_by_label {
                f64::from(u8::from(self.voxel_extinction(table, value) > 0.0))
            } else {
                self.volume.density_of(value)
            }
        })
    }

    /// The value between voxels, linearly; of labels the one of which most is seen, or is there at all.
    fn value(&self, index: DVec3, table: &BakedTransfer) -> f64 {
        if !self.is_by_label {
            return self.between_voxels(index, |value| value).0;
        }
        let dims = self.volume.dims();
        // A voxel that is not seen counts where all around it are not seen either.
        let seen = |value: f64| self.voxel_extinction(table, value).max(1e-12);
        let mut parts: Vec<(f64, f64)> = Vec::new();
        for (voxel, weight) in self.around(index) {
            let [x, y, z] = voxel;
            let value = self.volume.value(x, y, z);
            if self.is_missing(x + dims[0] * (y + dims[1] * z)) {
                continue;
            }
            match parts.iter_mut().find(|(known, _)| *known == value) {
                Some((_, sum)) => *sum += weight * seen(value),
                None => parts.push((value, weight * seen(value))),
            }
        }
        parts.into_iter().max_by(|(_, a), (_, b)| a.total_cmp(b)).map_or(0.0, |(value, _)| value)
    }

    fn is_missing(&self, voxel: usize) -> bool {
        self.volume.missing().is_some_and(|missing: &Missing| missing.contains(voxel))
    }

    /// The voxels around a point, with their weights.
    fn around(&self, index: DVec3) -> impl Iterator<Item = ([usize; 3], f64)> {
        let dims = self.volume.dims();
        let last = DVec3::from(dims.map(|n| (n - 1) as f64));
        let at = index.clamp(DVec3::ZERO, last);
        let low = at.floor();
        let f = at - low;
        (0..8usize).map(move |side| {
            let is_high = |axis: usize| side >> axis & 1 == 1;
            let voxel =
                [0, 1, 2].map(|axis| (low[axis] as usize + usize::from(is_high(axis))).min(dims[axis] - 1));
            let weight = (0..3).map(|axis| if is_high(axis) { f[axis] } else { 1.0 - f[axis] }).product();
            (voxel, weight)
        })
    }

    /// The mean of what the voxels around a point that are there are, by their weights, and the sum of these.
    fn between_voxels(&self, index: DVec3, of: impl Fn(f64) -> f64) -> (f64, f64) {
        let dims = self.volume.dims();
        let (mut sum, mut there) = (0.0, 0.0);
        for ([x, y, z], weight) in self.around(index) {
            if self.is_missing(x + dims[0] * (y + dims[1] * z)) {
                continue;
            }
            sum += weight * of(self.volume.value(x, y, z));
            there += weight;
        }
        if there > 0.0 { (sum / there, there) } else { (0.0, 0.0) }
    }

    /// ∇ of the field in scene space, by central differences over a voxel, and `turned` times that of a solid of density 1
    /// which ends where voxels are missing, at the faces of the grid and where it is cut.
    fn gradient(&self, point: DVec3, seen: &Region, turned: f64, table: &BakedTransfer) -> DVec3 {
        let edge = self.scene.smallest_edge();
        let seen = seen.within(&self.grid());
        let index_of = |point| self.scene.index_from_scene.transform_point3(point);
        let here = self.field(index_of(point), table).0;
        let at = |offset: DVec3| {
            let index = index_of(point + offset * edge);
            let (density, there) = self.field(index, table);
            if there > 0.0 && seen.contains(index) { density + turned * there } else { here }
        };
        DVec3::from(DVec3::AXES.map(|axis| at(axis) - at(-axis))) / (2.0 * edge)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Samples;
    use crate::model::{ControlPoint, Length, Light, TransferFunction};

    /// A slab of stuff at z = 10 … 13 over a block at z = 0 … 5.
    fn slab_over_block() -> (Volume, Settings) {
        let n = 16;
        let values = (0..n * n * n)
            .map(|at| match at / (n * n) {
                0..=5 => 1.0,
                10..=13 => 0.5,
                _ => 0.0_f32,
            })
            .collect();
        let volume = Volume::with_spacing("layers", [n; 3], DVec3::ONE, Samples::F32(values)).unwrap();
        let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
        let transfer = TransferFunction {
            points: vec![point(0.4, 0.0), point(0.5, 0.3), point(1.0, 0.9)],
            ..TransferFunction::default()
        };
        let settings = Settings {
            transfer,
            opacity_unit: Length::Voxels(1.0),
            lights: vec![
                Light { position: [0.0, 0.0, 3.0], ..Light::default() },
                Light { position: [3.0, 0.0, 0.0], casts_shadows: false, ..Light::default() },
            ],
            ..Settings::default()
        };
        (volume, settings)
    }

    #[test]
    fn the_first_thing_met_is_what_is_seen() {
        let (volume, settings) = slab_over_block();
        let from_below = probe(&volume, &settings, DVec3::new(0.0, 0.0, -3.0), DVec3::Z).unwrap();
        assert!((from_below.index.z - 0.0).abs() < 1.0, "{from_below:?}");
        assert!((from_below.value - 1.0).abs() < 1e-6);
        let from_above = probe(&volume, &settings, DVec3::new(0.0, 0.0, 3.0), DVec3::NEG_Z).unwrap();
        assert!((9.0..14.5).contains(&from_above.index.z), "{from_above:?}");
        assert_eq!(probe(&volume, &settings, DVec3::new(0.0, 3.0, -3.0), DVec3::Z), None, "beside it");
        assert_eq!(
            probe(&volume, &settings, DVec3::new(-3.0, 0.0, 0.0), DVec3::X).map(|seen| seen.index.z > 5.0),
            None,
            "between the layers there is nothing"
        );
    }

    /// Voxels that a file declares as padding, with a value that the curve shows, are neither seen nor counted.
    #[test]
    fn what_is_missing_is_not_met() {
        let (volume, mut settings) = slab_over_block();
        // What is seen is a face, not the middle of what lies behind it.
        settings.transfer.points[1].opacity = 0.99;
        let look = |volume: &Volume| probe(volume, &settings, DVec3::new(0.0, 0.0, 3.0), DVec3::NEG_Z);
        let without_slab = volume.clone().with_padding(0.5).expect("the block");
        let [whole, block] = [&volume, &without_slab].map(|volume| look(volume).expect("something"));
        assert!(whole.index.z > 9.0 && block.index.z < 6.5, "{block:?}");
        // The block's side, below the slab.
        let [below, uncovered] = [&volume, &without_slab].map(|volume| {
            let seen = probe(volume, &settings, DVec3::new(-3.0, 0.0, -0.375), DVec3::X);
            seen.expect("the block's side").lights[0].transmittance
        });
        assert!(uncovered > 2.0 * below, "{uncovered} {below}");
        // Beside voxels that are missing, too, the value is that of voxels which are there; and the surface faces them.
        let layers = look(&volume.with_padding(0.0).expect("the layers")).expect("the slab");
        assert!((layers.value - 0.5).abs() < 1e-6, "{layers:?}");
        assert!(layers.lights[0].facing.is_some_and(|facing| facing > 0.9), "{layers:?}");
    }

    #[test]
    fn what_is_cut_away_is_not_met() {
        use crate::model::{ClipPlane, CutEffect};
        let (volume, mut settings) = slab_over_block();
        let look = |settings: &Settings| {
            probe(&volume, settings, DVec3::new(0.0, 0.0, 3.0), DVec3::NEG_Z).expect("something")
        };
        let whole = look(&settings);
        // Between the layers: the upper one is cut away.
        settings.cuts.plane =
            ClipPlane { on: true, normal: [0.0, 0.0, 1.0], offset: 0.1, ..ClipPlane::default() };
        let below = look(&settings);
        assert!(below.index.z < 7.0 && whole.index.z > 9.0, "{below:?}");
        settings.cuts.plane.effect = CutEffect::Hidden;
        let shaded = look(&settings);
        assert_eq!(shaded.index, below.index);
        assert!(shaded.lights[0].transmittance < 0.4 * below.lights[0].transmittance, "{shaded:?} {below:?}");
        settings.cuts.plane.effect = CutEffect::Shadowless;
        assert_eq!(look(&settings).index, whole.index);
        // Through the block: the face looks where the plane does.
        settings.cuts.plane =
            ClipPlane { on: true, normal: [0.0, 0.6, 0.8], offset: -0.5, ..ClipPlane::default() };
        let facing = look(&settings).lights[0].facing.expect("a face");
        assert!((facing - 0.8).abs() < 0.2, "{facing}");
    }

    /// The same layers with values turned around, under the curve turned around, face the same way.
    #[test]
    fn surfaces_face_where_opacity_falls() {
        let (volume, mut settings) = slab_over_block();
        // What is seen is the slab's face, not its middle.
        settings.transfer.points[1].opacity = 0.99;
        let from_above = |volume: &Volume, settings: &Settings| {
            let seen = probe(volume, settings, DVec3::new(0.0, 0.0, 3.0), DVec3::NEG_Z);
            seen.expect("the slab").lights[0].facing.expect("a surface")
        };
        let rising = from_above(&volume, &settings);
        assert!(rising > 0.9, "{rising}");
        let n = volume.dims()[0];
        let values = (0..n * n * n).map(|at| 1.0 - volume.value(at % n, at / n % n, at / (n * n)) as f32);
        let samples = Samples::F32(values.collect());
        let turned = Volume::with_spacing("turned", volume.dims(), DVec3::ONE, samples).unwrap();
        settings.transfer.points.reverse();
        for point in &mut settings.transfer.points {
            point.value = 1.0 - point.value;
        }
        assert!((from_above(&turned, &settings) - rising).abs() < 1e-6);
        // Lit from below it faces away, unless both sides are lit.
        settings.lights[0].position = [0.0, 0.0, -3.0];
        assert!(from_above(&turned, &settings) < -0.9);
        settings.shading.sides = Sides::Two;
        assert!(from_above(&turned, &settings) > 0.9);
    }

    #[test]
    fn light_is_attenuated_by_what_lies_between() {
        let (volume, settings) = slab_over_block();
        let seen = probe(&volume, &settings, DVec3::new(-3.0, 0.0, -0.375), DVec3::X);
        let seen = seen.expect("the block's side");
        // Four voxels of opacity 0.3 above: 0.7⁴, and the ramps of linear interpolation at both ends.
        let wanted = 0.7_f64.powi(4);
        let [above, beside] = seen.lights[..] else { panic!("two lights") };
        assert!(above.transmittance < wanted && above.transmittance > 0.0, "{above:?}, less than {wanted}");
        assert_eq!(beside.transmittance, 1.0, "it casts no shadows");
        assert_eq!(above.hood, 1.0);
    }
}
