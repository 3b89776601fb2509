//! A volume along single rays: where something is seen, what attenuates light, which way surfaces face.

use glam::DVec3;

use crate::data::{Missing, Volume};
use crate::math::{Bounds, Region, SceneSpace};
use crate::model::BakedTransfer;

/// Share of the light to the eye that must have been met for something to count as seen: half.
const SEEN: f64 = 0.5;

/// Less than this share of a ray's light met: nothing is seen.
const NOTHING: f64 = 0.03;

/// The optical depth of what hardly dims a light: a tenth.
const LITTLE: f64 = 0.1;

/// Share of a loss that lies before what is called its place, and behind it: the surface that is seen takes some, too.
const ENDS: f64 = 0.25;

/// Voxel edges (the smallest) per step of a ray.
const STEP: f64 = 0.5;

/// The way from a point towards a light.
#[derive(Debug, Clone, Copy)]
pub(super) struct Way {
    /// Where it begins, in scene space.
    pub(super) point: DVec3,
    /// Of length 1.
    pub(super) towards: DVec3,
    /// How far away the light is, in scene units; it may be infinitely far.
    pub(super) distance: f64,
}

/// A volume and what makes it visible, for single rays.
pub(super) struct Rays<'a> {
    pub(super) volume: &'a Volume,
    pub(super) scene: SceneSpace,
    /// Voxels are classified, and then what they are is mixed.
    pub(super) is_by_label: bool,
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
    pub(super) fn first_seen(
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

    /// Steps from one beyond a point towards a light, each as its distance and the optical depth of what it meets: what is
    /// seen does not shade itself.
    fn steps(&self, table: &BakedTransfer, remains: &Region, way: Way) -> impl Iterator<Item = (f64, f64)> {
        let Way { point, towards, distance } = way;
        let step = self.step();
        // Where there is nothing on the way there are no steps.
        let (enter, leave) = self.span(remains, point, towards).unwrap_or_default();
        let first = (enter / step).ceil().max(1.0) as usize;
        let last = (leave.min(distance) / step).floor().max(1.0) as usize;
        (first..last).map(move |k| {
            let at = (k as f64 + 0.5) * step;
            (at, self.extinction(table, point + towards * at) * step)
        })
    }

    /// ∫ extinction from a step beyond a point towards a light.
    pub(super) fn optical_depth(&self, table: &BakedTransfer, remains: &Region, way: Way) -> f64 {
        self.steps(table, remains, way).map(|(_, depth)| depth).sum()
    }

    /// Between which distances from a point towards a light all but a quarter of its loss at either end happens; none where
    /// hardly anything is lost.
    pub(super) fn blocked(&self, table: &BakedTransfer, remains: &Region, way: Way) -> Option<[f64; 2]> {
        let mut sum = 0.0;
        let met: Vec<(f64, f64)> = self
            .steps(table, remains, way)
            .map(|(at, depth)| {
                sum += depth;
                (at, sum)
            })
            .collect();
        let reaches = |share: f64| met.iter().find(|(_, met)| *met >= share * sum).map(|(at, _)| *at);
        (sum >= LITTLE).then(|| Some([reaches(ENDS)?, reaches(1.0 - ENDS)?])).flatten()
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
    pub(super) fn field(&self, index: DVec3, table: &BakedTransfer) -> (f64, f64) {
        self.between_voxels(index, |value| {
            if self.is_by_label {
                f64::from(u8::from(self.voxel_extinction(table, value) > 0.0))
            } else {
                self.volume.density_of(value)
            }
        })
    }

    /// The value between voxels, linearly; of labels the one of which most is seen, or is there at all.
    pub(super) fn value(&self, index: DVec3, table: &BakedTransfer) -> f64 {
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
    pub(super) fn gradient(&self, point: DVec3, seen: &Region, turned: f64, table: &BakedTransfer) -> DVec3 {
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
