//! Single rays through a volume on the CPU: first visible position, attenuation of light, surface normals.

use glam::DVec3;

use chiaroscuro_scene::BakedTransfer;
use chiaroscuro_volume::{
    Observer, Volume,
    math::{Aabb, ClipRegion, RayInterval, SceneSpace},
};

/// Share of the ray's total opacity at which a position counts as visible: half.
const VISIBLE_SHARE: f64 = 0.5;

/// Opacity of a ray below which nothing is visible.
const MIN_OPACITY: f64 = 0.03;

/// Optical depth below which a light is hardly attenuated: a tenth.
const MIN_BLOCKING_DEPTH: f64 = 0.1;

/// Share of the loss that is excluded at either end of its range: the visible surface causes some, too.
const EXCLUDED_LOSS: f64 = 0.25;

/// Step of a ray, in edges of the smallest voxel.
const STEP_EDGES: f64 = 0.5;

/// Segment from a point towards a light.
#[derive(Debug, Clone, Copy)]
pub(super) struct LightSegment {
    /// Start of the segment, in scene space.
    pub(super) point: DVec3,
    /// Unit vector towards the light.
    pub(super) towards: DVec3,
    /// Distance to the light in scene units; may be infinite.
    pub(super) distance: f64,
}

/// Volume and scene for tracing single rays.
#[derive(Clone, Copy)]
pub(super) struct VolumeRays<'a> {
    pub(super) volume: &'a Volume,
    pub(super) scene: SceneSpace,
    /// True if voxels are classified before interpolation.
    pub(super) is_by_label: bool,
    /// Observer from whom voxels may be hidden.
    observer: Observer,
}

/// Step of a ray towards a light.
struct RayStep {
    /// Distance from the ray's origin to the middle of the step.
    distance: f64,
    /// Optical depth of the step.
    depth: f64,
}

/// Value at a point between voxels.
#[derive(Debug, Clone, Copy)]
pub(super) struct InterpolatedValue {
    /// Weighted mean of the present voxels nearby, or 0 if there are none.
    pub(super) value: f64,
    /// Sum of the weights of these voxels, from 0 to 1.
    pub(super) presence: f64,
}

impl<'a> VolumeRays<'a> {
    /// Creates the rays of the eye through a volume, in the scene that its grid has.
    pub(super) fn new(volume: &'a Volume) -> Self {
        let is_by_label = volume.shown_labels().is_some();
        Self { volume, scene: volume.scene(), is_by_label, observer: Observer::Eye }
    }

    /// Returns the rays of light through the same volume.
    pub(super) fn of_light(self) -> Self {
        Self { observer: Observer::Light, ..self }
    }

    /// Returns the presence of a voxel for the observer.
    fn presence(&self, [x, y, z]: [usize; 3]) -> f32 {
        let [nx, ny, _] = self.volume.dims();
        self.volume.presence_for(self.observer, x + nx * (y + ny * z))
    }

    /// Returns the box of voxel centres, in index space: there is nothing outside.
    fn grid(&self) -> Aabb {
        Aabb::of_grid(self.volume.dims(), 0.0)
    }

    fn step(&self) -> f64 {
        STEP_EDGES * self.scene.smallest_edge()
    }

    /// Returns the distances at which a ray enters and leaves the uncut part of the grid, not before its origin.
    fn span(&self, remains: &ClipRegion, origin: DVec3, direction: DVec3) -> Option<RayInterval> {
        let origin = self.scene.index_from_scene.transform_point3(origin);
        let direction = self.scene.index_from_scene.transform_vector3(direction);
        let RayInterval { enter, leave } = remains.intersection(&self.grid()).ray_interval(origin, direction);
        let enter = enter.max(0.0);
        (enter < leave).then_some(RayInterval { enter, leave })
    }

    /// Returns the position at which a ray has reached half of its total opacity.
    pub(super) fn first_visible(
        &self,
        table: &BakedTransfer,
        seen: &ClipRegion,
        origin: DVec3,
        direction: DVec3,
    ) -> Option<DVec3> {
        let RayInterval { enter, leave } = self.span(seen, origin, direction)?;
        let step = self.step();
        let mut accumulated = Vec::new();
        let mut transmittance = 1.0;
        let mut at = enter + 0.5 * step;
        while at < leave && transmittance > 0.01 {
            let tau = self.extinction(table, origin + direction * at) * step;
            transmittance *= (-tau).exp();
            accumulated.push((at, 1.0 - transmittance));
            at += step;
        }
        let all = 1.0 - transmittance;
        if all < MIN_OPACITY {
            return None;
        }
        let (at, _) = accumulated.into_iter().find(|&(_, opacity)| opacity >= VISIBLE_SHARE * all)?;
        Some(origin + direction * at)
    }

    /// Returns the position of the largest density along a ray, or of the smallest if `sign` is −1; `None` if the
    /// curve does not show it.
    pub(super) fn extreme(
        &self,
        sign: f64,
        table: &BakedTransfer,
        seen: &ClipRegion,
        origin: DVec3,
        direction: DVec3,
    ) -> Option<DVec3> {
        let RayInterval { enter, leave } = self.span(seen, origin, direction)?;
        let step = self.step();
        let count = ((leave - enter) / step).ceil() as usize;
        let points = (0..count).map(|at| origin + direction * (enter + (at as f64 + 0.5) * step).min(leave));
        let found = points.filter_map(|point| {
            let found = self.field(self.scene.index_from_scene.transform_point3(point), table);
            (found.presence >= VISIBLE_SHARE).then_some((point, sign * found.value))
        });
        let (point, value) = found.max_by(|(_, a), (_, b)| a.total_cmp(b))?;
        (table.sample(sign * value)[3] > 0.0).then_some(point)
    }

    /// Iterates over the steps of a ray towards a light, as distance and optical depth. It starts one step away from
    /// the point, so that a surface does not shade itself.
    fn steps(
        &self,
        table: &BakedTransfer,
        remains: &ClipRegion,
        way: LightSegment,
    ) -> impl Iterator<Item = RayStep> {
        let LightSegment { point, towards, distance } = way;
        let step = self.step();
        // A ray that misses the grid has no steps.
        let RayInterval { enter, leave } = self.span(remains, point, towards).unwrap_or_default();
        let first = (enter / step).ceil().max(1.0) as usize;
        let last = (leave.min(distance) / step).floor().max(1.0) as usize;
        (first..last).map(move |k| {
            let at = (k as f64 + 0.5) * step;
            RayStep { distance: at, depth: self.extinction(table, point + towards * at) * step }
        })
    }

    /// Returns ∫ extinction towards a light, from one step away from a point.
    pub(super) fn optical_depth(
        &self,
        table: &BakedTransfer,
        remains: &ClipRegion,
        way: LightSegment,
    ) -> f64 {
        self.steps(table, remains, way).map(|step| step.depth).sum()
    }

    /// Returns the range of distances from a point towards a light that contains all of the loss except a quarter at
    /// either end; `None` if hardly anything is lost.
    pub(super) fn blocked_range(
        &self,
        table: &BakedTransfer,
        remains: &ClipRegion,
        way: LightSegment,
    ) -> Option<[f64; 2]> {
        let mut sum = 0.0;
        let met: Vec<(f64, f64)> = self
            .steps(table, remains, way)
            .map(|RayStep { distance, depth }| {
                sum += depth;
                (distance, sum)
            })
            .collect();
        let reaches = |share: f64| met.iter().find(|(_, met)| *met >= share * sum).map(|(at, _)| *at);
        (sum >= MIN_BLOCKING_DEPTH)
            .then(|| Some([reaches(EXCLUDED_LOSS)?, reaches(1.0 - EXCLUDED_LOSS)?]))
            .flatten()
    }

    fn extinction(&self, table: &BakedTransfer, point: DVec3) -> f64 {
        let index = self.scene.index_from_scene.transform_point3(point);
        if self.is_by_label {
            let found = self.interpolate(index, |value| self.voxel_extinction(table, value));
            return found.value * found.presence;
        }
        let found = self.field(index, table);
        table.sample(found.value)[3] * found.presence
    }

    /// Returns the extinction of a voxel with the given value.
    fn voxel_extinction(&self, table: &BakedTransfer, value: f64) -> f64 {
        table.sample(self.volume.density_of(value))[3]
    }

    /// Returns the field in which surfaces are found, and the presence: the density, interpolated linearly, clamped
    /// at the border, and 0 where no voxel nearby is present. For labels, 1 in material and 0 outside is interpolated
    /// instead.
    pub(super) fn field(&self, index: DVec3, table: &BakedTransfer) -> InterpolatedValue {
        self.interpolate(index, |value| {
            if self.is_by_label {
                f64::from(u8::from(self.voxel_extinction(table, value) > 0.0))
            } else {
                self.volume.density_of(value)
            }
        })
    }

    /// Returns the value, interpolated linearly between voxels; for labels, the most visible one nearby, or any that
    /// is present.
    pub(super) fn value(&self, index: DVec3, table: &BakedTransfer) -> f64 {
        if !self.is_by_label {
            return self.interpolate(index, |value| value).value;
        }
        // An invisible voxel counts only if all around it are invisible, too.
        let seen = |value: f64| self.voxel_extinction(table, value).max(1e-12);
        let mut parts: Vec<(f64, f64)> = Vec::new();
        for (voxel, weight) in self.nearest_voxels(index) {
            let [x, y, z] = voxel;
            let value = self.volume.value(x, y, z);
            if self.presence(voxel) <= 0.0 {
                continue;
            }
            match parts.iter_mut().find(|(known, _)| *known == value) {
                Some((_, sum)) => *sum += weight * seen(value),
                None => parts.push((value, weight * seen(value))),
            }
        }
        parts.into_iter().max_by(|(_, a), (_, b)| a.total_cmp(b)).map_or(0.0, |(value, _)| value)
    }

    /// Iterates over the eight voxels around a point, with their linear weights.
    fn nearest_voxels(&self, index: DVec3) -> impl Iterator<Item = ([usize; 3], f64)> {
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

    /// Returns the weighted mean of `of` over the present voxels around a point, and the sum of their weights.
    fn interpolate(&self, index: DVec3, of: impl Fn(f64) -> f64) -> InterpolatedValue {
        let (mut sum, mut there) = (0.0, 0.0);
        for (voxel, weight) in self.nearest_voxels(index) {
            let [x, y, z] = voxel;
            let weight = weight * f64::from(self.presence(voxel));
            if weight > 0.0 {
                sum += weight * of(self.volume.value(x, y, z));
                there += weight;
            }
        }
        let value = if there > 0.0 { sum / there } else { 0.0 };
        InterpolatedValue { value, presence: there }
    }

    /// Returns ∇ of the field in scene space, by central differences over a voxel, plus `turned` times that of a
    /// solid of density 1 which ends at missing voxels, at the faces of the grid and at cuts.
    pub(super) fn gradient(
        &self,
        point: DVec3,
        seen: &ClipRegion,
        turned: f64,
        table: &BakedTransfer,
    ) -> DVec3 {
        let edge = self.scene.smallest_edge();
        let seen = seen.intersection(&self.grid());
        let index_of = |point| self.scene.index_from_scene.transform_point3(point);
        let here = self.field(index_of(point), table).value;
        let at = |offset: DVec3| {
            let index = index_of(point + offset * edge);
            let InterpolatedValue { value, presence } = self.field(index, table);
            if presence > 0.0 && seen.contains(index) { value + turned * presence } else { here }
        };
        DVec3::from(DVec3::AXES.map(|axis| at(axis) - at(-axis))) / (2.0 * edge)
    }
}
