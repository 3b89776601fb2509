//! Area lights: shapes, sample points and extent. The larger the angle of a light as seen from its shadow, the softer
//! the shadow's border.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use super::cube_axes::cube_axes;
use super::{LightGeometry, SceneLight};
use crate::{LightVolumeResolution, NearFieldRay, ShadowSettings};

/// Largest width of a light, in scene units: as wide as most rooms around a volume.
pub const MAX_LIGHT_SIZE: f64 = 20.0;

/// Largest angular width of a light at infinity, in degrees: 45° to each side of its centre.
pub const MAX_LIGHT_ANGLE_DEG: f64 = 90.0;

/// Largest aspect ratio of a rectangular light, width by height.
pub const MAX_LIGHT_ASPECT: f64 = 10.0;

/// Largest distance between a near-field ray to the light's centre and the rays to its sample points, in smallest
/// voxel edges, up to which it represents them: half of a disc's area lies within 0.7 of its radius.
const MAX_RAY_SPREAD: f64 = 0.7;

/// Step and start of the fractions that place the orbits of a ball's points along their chords. Of all steps and starts
/// these leave 16, 32 and 64 points closest to an even ball: their middle within 0.015 of its own, the mean square of
/// their depths 0.21 … 0.28 instead of 1/4, and the mean cube within 0.02 of 0.
const DEPTH_STEP: f64 = 0.68;
const DEPTH_START: f64 = 0.4;

/// Number of points up to which those of a disc are a single orbit.
const MAX_SINGLE_ORBIT: u32 = 8;

/// Shape of a light's emitting surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LightShape {
    /// Point light: shadows are as sharp as the volume.
    Point,
    /// Disc that faces the centre of the volume.
    Disc,
    /// Rectangle that faces the centre of the volume, such as a window.
    Rectangle,
    /// Ball, which looks the same from all directions.
    Ball,
}

/// Extent of an area light around its position in the scene: in scene units, or for a parallel light in tangents of
/// angles from its direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightArea {
    /// Shape of the light, never a point.
    pub shape: LightShape,
    /// Vector from the centre to the right border, as seen from the centre of the volume.
    pub right: DVec3,
    /// Vector from the centre to the upper border.
    pub up: DVec3,
    /// Vector from the centre to the border towards the centre of the volume: zero for flat shapes.
    pub near: DVec3,
}

impl LightShape {
    /// Returns sample point `index` of `count`, a multiple of four, on the shape: across, up and towards the volume,
    /// each −1 … 1, with even density in projection from any direction. Mirrored at both axes of the shape the points
    /// are the same, so that turned and mirrored scenes have the same shadows.
    ///
    /// Discs use rings of equal width; rectangles the points of Hammersley in each quarter; balls the disc, with each
    /// point moved along its chord by the arcsine law: density 1/√(1 − r²), whose projection along every direction is
    /// an even disc.
    pub fn sample_point(self, index: u32, count: u32) -> DVec3 {
        match self {
            Self::Point => DVec3::ZERO,
            Self::Disc => ring_point(index, count).across.extend(0.0),
            Self::Rectangle => rectangle_point(index, count).extend(0.0),
            Self::Ball => {
                let RingPoint { across, orbit } = ring_point(index, count);
                let fraction = if count <= MAX_SINGLE_ORBIT {
                    0.5
                } else {
                    (f64::from(orbit) * DEPTH_STEP + DEPTH_START).fract()
                };
                across.extend((1.0 - across.length_squared()).sqrt() * (PI * (fraction - 0.5)).sin())
            }
        }
    }
}

/// Returns the number of points that represent an area light if `samples` are asked for: a multiple of four, which
/// mirrors at two axes need, or a single one.
pub(super) fn area_light_points(samples: u32) -> u32 {
    if samples < 2 { 1 } else { samples.max(4) / 4 * 4 }
}

/// Point on a disc of radius 1 that is sampled in rings.
struct RingPoint {
    across: DVec2,
    /// Number of the orbit: points of the same orbit become each other when the disc is mirrored at its axes and their
    /// diagonals.
    orbit: u32,
}

/// Returns point `index` of `count` on a unit disc, in m = √n/2 rings of equal width, each with as many points as its
/// area requires, in fours, and rotated by half a step relative to the ring inside it.
///
/// For half-planes that cover the disc in any direction, the number of covered points is correct within 1.4 % of 64
/// and 6.7 % of 16 points, with edges as soft as a thirtieth of the disc; with Vogel's spiral, 2.0 and 9.3 %.
fn ring_point(index: u32, count: u32) -> RingPoint {
    if count < 2 {
        return RingPoint { across: DVec2::ZERO, orbit: 0 };
    }
    let all = f64::from(count);
    let rings = (all.sqrt() / 2.0).round().max(1.0);
    // Number of points up to the end of a ring.
    let points_up_to = |ring: f64| 4.0 * (all * ring * ring / (4.0 * rings * rings)).round();
    let mut ring = 1.0;
    while f64::from(index) >= points_up_to(ring) {
        ring += 1.0;
    }
    let (first, end) = (points_up_to(ring - 1.0), points_up_to(ring));
    // In half steps, of which an eighth of the ring has a quarter of its points.
    let half_steps = 2.0 * (f64::from(index) - first) + ring;
    let quarter = 0.5 * (end - first);
    let within = half_steps % quarter;
    let orbit = first / 4.0 + (within.min(quarter - within) / 2.0).floor();
    let angle = TAU * half_steps / (2.0 * (end - first));
    RingPoint { across: DVec2::from_angle(angle) * ((first + end) / (2.0 * all)).sqrt(), orbit: orbit as u32 }
}

/// Returns point `index` of `count` on a rectangle of half-edges 1: points of Hammersley in a quarter of it, whose
/// second coordinates are the first with their bits reversed, and their mirror images at both axes. If there are
/// 4 · 2ⁿ points, exchanging the axes leaves them the same.
fn rectangle_point(index: u32, count: u32) -> DVec2 {
    if count < 2 {
        return DVec2::ZERO;
    }
    let (place, number) = (index / 4, count / 4);
    let bits = number.next_power_of_two().trailing_zeros();
    // Shifted by half of the last bit, to the middle of its cell.
    let reversed = f64::from(place.reverse_bits()) / 2f64.powi(32) + 0.5 / f64::from(1_u32 << bits);
    let corner = DVec2::new((f64::from(place) + 0.5) / f64::from(number), reversed);
    let side = |bit: u32| if index >> bit & 1 == 0 { 1.0 } else { -1.0 };
    corner * DVec2::new(side(0), side(1))
}

impl LightArea {
    /// Creates the extent of a light in `direction` as seen from the centre of the volume; `None` for a point.
    ///
    /// `half`: half its width and half its height. `upright`: the scene's up direction. `turn_deg`: counterclockwise
    /// rotation of the shape, as seen from the volume.
    pub(super) fn new(
        (shape, half): (LightShape, DVec2),
        direction: DVec3,
        upright: DVec3,
        turn_deg: f64,
    ) -> Option<Self> {
        if shape == LightShape::Point || half.max_element() <= 0.0 {
            return None;
        }
        // Only the corners of a rectangle show its axes. Those of round shapes turn with the scene, and so do its own
        // directly above or below, where right is undefined.
        let [round, _] = cube_axes(direction);
        let upright = direction.cross(upright).try_normalize().filter(|_| shape == LightShape::Rectangle);
        let across = upright.unwrap_or(round);
        let up = across.cross(direction);
        let turn_deg = if shape == LightShape::Rectangle { turn_deg } else { 0.0 };
        let (sin, cos) = turn_deg.to_radians().sin_cos();
        let near = if shape == LightShape::Ball { -direction * half.x } else { DVec3::ZERO };
        Some(Self {
            shape,
            right: (across * cos + up * sin) * half.x,
            up: (up * cos - across * sin) * half.y,
            near,
        })
    }

    /// Returns the offset from the centre of a point in shape coordinates, for a light at a distance from the middle
    /// of the volume: 1 for a parallel one.
    ///
    /// All points count alike, and a surface that faces the light takes cos⁴ θ of what each part of a flat light emits.
    /// So points of wide lights lie denser in their middle: seen from the middle of the volume, they are even over the
    /// sine of the angle, not its tangent. With r tan α the tangent of a point on a disc of radius tan α, that is
    /// r sin α / √(1 − r² sin² α) = r tan α / √(1 + (1 − r²) tan² α). For rectangles it holds along each axis alone.
    pub fn offset(&self, DVec3 { x, y, z }: DVec3, distance: f64) -> DVec3 {
        let closer = |edge: DVec3, square: f64| {
            (1.0 + (1.0 - square) * edge.length_squared() / (distance * distance)).sqrt().recip()
        };
        let [right, up] = match self.shape {
            LightShape::Point | LightShape::Ball => [1.0; 2],
            LightShape::Disc => [closer(self.right, x * x + y * y); 2],
            LightShape::Rectangle => [closer(self.right, x * x), closer(self.up, y * y)],
        };
        self.right * (x * right) + self.up * (y * up) + self.near * z
    }
}

impl SceneLight {
    /// Returns the resolution of the light's volume for a data volume of `dims` voxels.
    pub fn volume_resolution(&self, shadows: &ShadowSettings, dims: [usize; 3]) -> LightVolumeResolution {
        let ShadowSettings { resolution, area, .. } = *shadows;
        if self.area.is_some() {
            resolution.max(shadows.soft_resolution(area.resolution, dims))
        } else {
            resolution
        }
    }

    /// Returns point lights that represent this one, [`Self::sample_count`] of them, or the light itself if it is
    /// a point.
    pub fn sample_lights(&self, samples: u32) -> Vec<Self> {
        let Some(area) = &self.area else { return vec![*self] };
        let count = self.sample_count(samples);
        (0..count)
            .map(|index| {
                let at = area.shape.sample_point(index, count);
                self.point_light_at(area.offset(at, self.distance()))
            })
            .collect()
    }

    /// Returns the number of near-field steps towards this light. One ray represents those to all sample points, so
    /// it ends where these have diverged from it by 0.7 voxels: beyond that, the light volume, which is their mean,
    /// is more accurate.
    pub fn near_field_steps(&self, near: NearFieldRay) -> u32 {
        let Some(area) = &self.area else { return near.step_count() };
        let distance = self.distance();
        let spread = (0.5 * (area.right.length_squared() + area.up.length_squared())).sqrt();
        near.steps_within(MAX_RAY_SPREAD * distance / spread)
    }

    /// Returns the distance from the middle of the volume. The extent of a parallel light is that of one at distance 1.
    pub(super) fn distance(&self) -> f64 {
        match self.kind {
            LightGeometry::Parallel => 1.0,
            LightGeometry::Perspective => DVec3::from(self.position).length(),
        }
    }

    /// Returns the point light at an offset from the centre of this light.
    fn point_light_at(&self, offset: DVec3) -> Self {
        let middle = match self.kind {
            LightGeometry::Parallel => self.direction(),
            LightGeometry::Perspective => self.position.into(),
        };
        Self { position: (middle + offset).into(), area: None, ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Camera, LightSettings};

    fn light(shape: LightShape) -> LightSettings {
        LightSettings {
            kind: LightGeometry::Perspective,
            position: [0.0, -4.0, 0.0],
            shape,
            size: 2.0,
            aspect: 2.0,
            ..LightSettings::default()
        }
    }

    fn points(light: &LightSettings) -> Vec<DVec3> {
        let resolved = light.resolve(&Camera::default());
        resolved.sample_lights(64).iter().map(|point| DVec3::from(point.position)).collect()
    }

    #[test]
    fn rays_nearby_end_before_the_ways_to_points_come_apart() {
        let steps = |light: &LightSettings, near| light.resolve(&Camera::default()).near_field_steps(near);
        let far =
            |angle_deg| LightSettings { kind: LightGeometry::Parallel, angle_deg, ..light(LightShape::Disc) };
        for near in [NearFieldRay::Off, NearFieldRay::Short, NearFieldRay::Long] {
            assert_eq!(steps(&far(0.0), near), near.step_count(), "a point");
            assert_eq!(steps(&far(5.0), near), near.step_count(), "16 voxels");
        }
        // Limits of 3 and 1.7 voxels: four steps have a length of 3, two steps of 1.
        assert_eq!(steps(&far(25.0), NearFieldRay::Long), 4);
        assert_eq!(steps(&far(45.0), NearFieldRay::Short), 2);
        assert_eq!(steps(&far(90.0), NearFieldRay::Long), 2);
        assert_eq!(steps(&far(90.0), NearFieldRay::Off), 0);
        // The same angular size from a distance of 4 as one of 25 degrees.
        let scene_light =
            LightSettings { size: 8.0 * 12.5_f64.to_radians().tan(), ..light(LightShape::Ball) };
        assert_eq!(steps(&scene_light, NearFieldRay::Long), 4);
    }

    #[test]
    fn points_lie_on_the_shape_and_around_its_middle() {
        for shape in [LightShape::Disc, LightShape::Rectangle, LightShape::Ball] {
            let points = points(&light(shape));
            let mean = points.iter().sum::<DVec3>() / points.len() as f64;
            assert!((mean - DVec3::NEG_Y * 4.0).length() < 0.03, "{shape:?}: {mean}");
            for point in points {
                let from = point + DVec3::Y * 4.0;
                match shape {
                    LightShape::Rectangle => {
                        // Twice as wide as high, upright, facing the centre.
                        assert!(from.x.abs() < 1.0 && from.z.abs() < 0.5 && from.y.abs() < 1e-12, "{from}");
                    }
                    LightShape::Disc => assert!(from.length() < 1.0 && from.y.abs() < 1e-12, "{from}"),
                    _ => assert!(from.length() < 1.0, "{from}"),
                }
            }
        }
    }

    #[test]
    fn points_are_mirror_images_of_each_other() {
        for shape in [LightShape::Disc, LightShape::Rectangle, LightShape::Ball] {
            for count in [4, 8, 16, 20, 32, 44, 64] {
                let at: Vec<_> = (0..count).map(|index| shape.sample_point(index, count)).collect();
                let has = |wanted: DVec3| at.iter().any(|found| found.distance(wanted) < 1e-9);
                let mirrored = |p: &DVec3| has(DVec3::new(-p.x, p.y, p.z)) && has(DVec3::new(p.x, -p.y, p.z));
                assert!(at.iter().all(mirrored), "{shape:?}, {count}");
                // Those of other rectangles need not be the same if their axes are exchanged.
                if shape != LightShape::Rectangle || (count / 4).is_power_of_two() {
                    assert!(at.iter().all(|p| has(DVec3::new(p.y, p.x, p.z))), "{shape:?}, {count}");
                }
                assert!(at.iter().all(|p| p.abs().max_element() < 1.0), "{shape:?}, {count}");
            }
        }
    }

    #[test]
    fn any_number_of_samples_makes_whole_fours() {
        assert_eq!([1, 2, 4, 7, 8, 16, 63, 64].map(area_light_points), [1, 4, 4, 4, 8, 16, 60, 64]);
    }

    /// Checks that points of a wide disc count alike for a surface that faces it: even over the sines of their angles,
    /// ⟨sin²⟩ = sin² α / 2.
    #[test]
    fn points_of_wide_discs_are_even_over_sines() {
        let sun = LightSettings { kind: LightGeometry::Parallel, angle_deg: 80.0, ..light(LightShape::Disc) };
        let resolved = sun.resolve(&Camera::default());
        let sine = |point: &SceneLight| point.direction().cross(resolved.direction()).length_squared();
        let mean = resolved.sample_lights(64).iter().map(sine).sum::<f64>() / 64.0;
        let whole = 40f64.to_radians().sin().powi(2);
        assert!((mean - 0.5 * whole).abs() < 1e-9, "{mean}");
    }

    /// Checks that the second and third moments of a ball's points are those of an even disc, along several
    /// directions.
    #[test]
    fn a_ball_casts_an_even_disc_along_every_direction() {
        let at: Vec<_> = (0..64).map(|index| LightShape::Ball.sample_point(index, 64)).collect();
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
        let sun = LightSettings {
            kind: LightGeometry::Parallel,
            shape: LightShape::Disc,
            angle_deg: 40.0,
            ..LightSettings::default()
        };
        let resolved = sun.resolve(&Camera::default());
        let farthest = resolved
            .sample_lights(64)
            .iter()
            .map(|point| point.direction().angle_between(resolved.direction()).to_degrees())
            .fold(0.0, f64::max);
        // The outermost of four rings lies in the middle of its area, at √(50/64) of the sine of 20°.
        assert!((farthest - 17.60).abs() < 0.01, "{farthest}");
        // The angular size does not depend on the distance.
        let outside = LightSettings { position: sun.position.map(|c| 3.0 * c), ..sun.clone() };
        assert_eq!(outside.resolve(&Camera::default()).area, resolved.area);
    }

    #[test]
    fn what_has_no_size_is_a_point() {
        for flat in [LightSettings { size: 0.0, ..light(LightShape::Ball) }, light(LightShape::Point)] {
            let resolved = flat.resolve(&Camera::default());
            assert_eq!((resolved.area, resolved.sample_lights(64)), (None, vec![resolved]));
        }
    }

    #[test]
    fn a_rectangle_turns_with_its_setting_and_stands_upright_without() {
        let area = |turn_deg: f64| {
            let light = LightSettings { turn_deg, ..light(LightShape::Rectangle) };
            light.resolve(&Camera::default()).area.expect("an extent")
        };
        let upright = area(0.0);
        assert!(upright.right.abs_diff_eq(DVec3::NEG_X, 1e-12) || upright.right.abs_diff_eq(DVec3::X, 1e-12));
        assert!(upright.up.abs_diff_eq(DVec3::Z * 0.5, 1e-12), "{upright:?}");
        assert!(area(90.0).right.normalize().abs_diff_eq(DVec3::Z, 1e-12), "{:?}", area(90.0));
    }
}
