//! How large a light is: the wider it looks from where its shadow falls, the softer the shadow's border.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use super::{LightKind, SceneLight};
use crate::model::{NearField, Resolution, Shadows};

/// The widest light, in scene units: as wide as most rooms around a volume.
pub const MAX_LIGHT_SIZE: f64 = 20.0;

/// The widest light that is infinitely far away, in degrees: half of the sky in each direction from its middle.
pub const MAX_LIGHT_ANGLE_DEG: f64 = 90.0;

/// The most oblong rectangle, width by height.
pub const MAX_LIGHT_ASPECT: f64 = 10.0;

/// How far the ways to points of a light come apart from that to its middle where a ray nearby stands for all of them, in
/// edges of the smallest voxel: half a disc is nearer than 0.7 of its radius.
const NEAR_SPREAD: f64 = 0.7;

/// The golden ratio less one: multiples of it, less their whole parts, fill 0 … 1 evenly however many they are.
const GOLDEN_SHARE: f64 = 0.618_033_988_749_894_9;

/// What shines of a light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LightShape {
    /// A point: shadows are as sharp as the volume.
    Point,
    /// A round plate that faces the middle of the volume.
    Disc,
    /// A rectangular one, as a window is.
    Rectangle,
    /// A ball, which looks the same from everywhere.
    Ball,
}

/// The extent of a light in the scene, around its place: in scene units, or for a parallel light in tangents of angles
/// from its direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightArea {
    /// Any but a point.
    pub shape: LightShape,
    /// From its middle to its right border, as seen from the middle of the volume.
    pub right: DVec3,
    /// From its middle to its upper border.
    pub up: DVec3,
    /// From its middle to its border towards the middle of the volume: zero for what is flat.
    pub near: DVec3,
}

impl LightShape {
    /// Point number `index` of `count` on the shape: across, up and towards the volume, each −1 … 1, so that as many
    /// lie in areas of the same size wherever that is looked at from.
    ///
    /// Of a disc rings as wide as each other; of a rectangle Fibonacci's lattice; of a ball the disc, each
    /// point moved along its chord by the arcsine law: density 1/√(1 − r²), whose shadow along every direction is an even
    /// disc.
    pub fn point(self, index: u32, count: u32) -> DVec3 {
        let spread = (f64::from(index) * GOLDEN_SHARE + 0.5).fract();
        match self {
            Self::Point => DVec3::ZERO,
            Self::Disc => on_rings(index, count).extend(0.0),
            Self::Rectangle => {
                let at = (f64::from(index) + 0.5) / f64::from(count.max(1));
                DVec3::new(2.0 * at - 1.0, 2.0 * spread - 1.0, 0.0)
            }
            Self::Ball => {
                let across = on_rings(index, count);
                across.extend((1.0 - across.length_squared()).sqrt() * (PI * (spread - 0.5)).sin())
            }
        }
    }
}

/// Point number `index` of `count` on a disc of radius 1, in m = √n/2 rings of the same width, each with as many points as
/// its area asks for and turned by half a step against the one within.
///
/// Half-planes that cover the disc in any direction cover as many points as they should within 1.4 % of 64 and 6.7 % of
/// 16, where edges are as soft as a thirtieth of it; of Vogel's spiral it is 2.0 and 9.3 %.
fn on_rings(index: u32, count: u32) -> DVec2 {
    if count < 2 {
        return DVec2::ZERO;
    }
    let all = f64::from(count);
    let rings = (all.sqrt() / 2.0).round().max(1.0);
    // Points up to the end of a ring.
    let within = |ring: f64| (all * ring * ring / (rings * rings)).round();
    let mut ring = 1.0;
    while f64::from(index) >= within(ring) {
        ring += 1.0;
    }
    let (first, end) = (within(ring - 1.0), within(ring));
    let step = (f64::from(index) - first + 0.5 * ring) / (end - first);
    DVec2::from_angle(TAU * step) * ((first + end) / (2.0 * all)).sqrt()
}

impl LightArea {
    /// The extent of a light that stands in `direction` as seen from the middle of the volume; `None` of a point.
    ///
    /// `half`: half its width and half its height. `upright`: where up is in the scene. `turn_deg`: how far the shape is
    /// turned counterclockwise, as seen from the volume.
    pub(super) fn new(
        (shape, half): (LightShape, DVec2),
        direction: DVec3,
        upright: DVec3,
        turn_deg: f64,
    ) -> Option<Self> {
        if shape == LightShape::Point || half.max_element() <= 0.0 {
            return None;
        }
        // Right above or below, where nothing is to the right of another, any direction will do.
        let across = direction.cross(upright).try_normalize();
        let across = across.unwrap_or_else(|| direction.any_orthonormal_vector());
        let up = across.cross(direction);
        let (sin, cos) = turn_deg.to_radians().sin_cos();
        let near = if shape == LightShape::Ball { -direction * half.x } else { DVec3::ZERO };
        Some(Self {
            shape,
            right: (across * cos + up * sin) * half.x,
            up: (up * cos - across * sin) * half.y,
            near,
        })
    }

    /// A place on the shape, from its middle.
    pub fn offset(&self, DVec3 { x, y, z }: DVec3) -> DVec3 {
        self.right * x + self.up * y + self.near * z
    }
}

impl SceneLight {
    /// The resolution of its light volume for a volume of so many voxels.
    pub fn resolution(&self, shadows: &Shadows, dims: [usize; 3]) -> Resolution {
        let Shadows { resolution, area, .. } = *shadows;
        if self.area.is_some() { resolution.max(shadows.soft(area.resolution, dims)) } else { resolution }
    }

    /// Point lights that stand for this one: `count` of them, or the light itself if it is a point.
    pub fn points(&self, count: u32) -> Vec<Self> {
        let Some(area) = &self.area else { return vec![*self] };
        (0..count).map(|index| self.moved(area.offset(area.shape.point(index, count)))).collect()
    }

    /// How many steps a ray nearby takes towards this light. One ray stands for those to all points, so that it ends where
    /// these have come 0.7 voxels apart from it: from there on their mean, the light volume, is nearer to the
    /// truth.
    pub fn near_steps(&self, near: NearField) -> u32 {
        let Some(area) = &self.area else { return near.steps() };
        let away = match self.kind {
            // Its extent is that of one at a distance of 1.
            LightKind::Parallel => 1.0,
            LightKind::Perspective => DVec3::from(self.position).length(),
        };
        let spread = (0.5 * (area.right.length_squared() + area.up.length_squared())).sqrt();
        near.steps_within(NEAR_SPREAD * away / spread)
    }

    /// The point light that far from the middle of this one.
    fn moved(&self, offset: DVec3) -> Self {
        let middle = match self.kind {
            LightKind::Parallel => self.direction(),
            LightKind::Perspective => self.position.into(),
        };
        Self { position: (middle + offset).into(), area: None, ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Camera, Light};

    fn light(shape: LightShape) -> Light {
        Light {
            kind: LightKind::Perspective,
            position: [0.0, -4.0, 0.0],
            shape,
            size: 2.0,
            aspect: 2.0,
            ..Light::default()
        }
    }

    fn points(light: &Light) -> Vec<DVec3> {
        let resolved = light.in_scene(&Camera::default());
        resolved.points(64).iter().map(|point| DVec3::from(point.position)).collect()
    }

    #[test]
    fn rays_nearby_end_before_the_ways_to_points_come_apart() {
        let steps = |light: &Light, near| light.in_scene(&Camera::default()).near_steps(near);
        let far = |angle_deg| Light { kind: LightKind::Parallel, angle_deg, ..light(LightShape::Disc) };
        for near in [NearField::Off, NearField::Short, NearField::Long] {
            assert_eq!(steps(&far(0.0), near), near.steps(), "a point");
            assert_eq!(steps(&far(5.0), near), near.steps(), "16 voxels");
        }
        // Three voxels, and 1.7, of which two steps have one.
        assert_eq!(steps(&far(25.0), NearField::Long), 4);
        assert_eq!(steps(&far(45.0), NearField::Short), 2);
        assert_eq!(steps(&far(90.0), NearField::Long), 2);
        assert_eq!(steps(&far(90.0), NearField::Off), 0);
        // As wide from a distance of 4 as that of 25 degrees.
        let lamp = Light { size: 8.0 * 12.5_f64.to_radians().tan(), ..light(LightShape::Ball) };
        assert_eq!(steps(&lamp, NearField::Long), 4);
    }

    #[test]
    fn points_lie_on_the_shape_and_around_its_middle() {
        for shape in [LightShape::Disc, LightShape::Rectangle, LightShape::Ball] {
            let points = points(&light(shape));
            let mean = points.iter().sum::<DVec3>() / 64.0;
            assert!((mean - DVec3::NEG_Y * 4.0).length() < 0.03, "{shape:?}: {mean}");
            for point in points {
                let from = point + DVec3::Y * 4.0;
                match shape {
                    LightShape::Rectangle => {
                        // Twice as wide as high, upright, facing the middle.
                        assert!(from.x.abs() < 1.0 && from.z.abs() < 0.5 && from.y.abs() < 1e-12, "{from}");
                    }
                    LightShape::Disc => assert!(from.length() < 1.0 && from.y.abs() < 1e-12, "{from}"),
                    _ => assert!(from.length() < 1.0, "{from}"),
                }
            }
        }
    }

    /// Half of the points and a quarter of the moment of inertia of what an even disc has, from every side.
    #[test]
    fn a_ball_casts_an_even_disc_along_every_direction() {
        let at: Vec<_> = (0..64).map(|index| LightShape::Ball.point(index, 64)).collect();
        for direction in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(1.0, 1.0, 1.0).normalize()] {
            let along = |point: &DVec3| point.dot(direction);
            let second = at.iter().map(|point| along(point).powi(2)).sum::<f64>() / 64.0;
            // ⟨x²⟩ of an even disc of radius 1 is ¼.
            assert!((second - 0.25).abs() < 0.02, "{direction}: {second}");
            let third = at.iter().map(|point| along(point).powi(3)).sum::<f64>() / 64.0;
            assert!(third.abs() < 0.05, "{direction}: {third}");
        }
    }

    #[test]
    fn a_parallel_light_is_as_wide_as_its_angle() {
        let sun =
            Light { kind: LightKind::Parallel, shape: LightShape::Disc, angle_deg: 20.0, ..Light::default() };
        let resolved = sun.in_scene(&Camera::default());
        let farthest = resolved
            .points(64)
            .iter()
            .map(|point| point.direction().angle_between(resolved.direction()).to_degrees())
            .fold(0.0, f64::max);
        // The outermost of four rings lies in the middle of its area, at √(50/64) of the radius.
        assert!((farthest - 8.86).abs() < 0.01, "{farthest}");
        // Further out it is as wide.
        let outside = Light { position: sun.position.map(|c| 3.0 * c), ..sun.clone() };
        assert_eq!(outside.in_scene(&Camera::default()).area, resolved.area);
    }

    #[test]
    fn what_has_no_size_is_a_point() {
        for flat in [Light { size: 0.0, ..light(LightShape::Ball) }, light(LightShape::Point)] {
            let resolved = flat.in_scene(&Camera::default());
            assert_eq!((resolved.area, resolved.points(64)), (None, vec![resolved]));
        }
    }

    #[test]
    fn a_rectangle_turns_with_its_setting_and_stands_upright_without() {
        let area = |turn_deg: f64| {
            let light = Light { turn_deg, ..light(LightShape::Rectangle) };
            light.in_scene(&Camera::default()).area.expect("an extent")
        };
        let upright = area(0.0);
        assert!(upright.right.abs_diff_eq(DVec3::NEG_X, 1e-12) || upright.right.abs_diff_eq(DVec3::X, 1e-12));
        assert!(upright.up.abs_diff_eq(DVec3::Z * 0.5, 1e-12), "{upright:?}");
        assert!(area(90.0).right.normalize().abs_diff_eq(DVec3::Z, 1e-12), "{:?}", area(90.0));
    }
}
