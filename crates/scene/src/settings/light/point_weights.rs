//! Weights of an area light's points: each counts by the cosine of its direction to the normal of a surface near by.

use glam::{DVec2, DVec3};

use super::{LightGeometry, SceneLight};

/// Angular size (sin² of half the angle) from which points are weighted: half an angle of 5°.
///
/// Weights move the middle of a penumbra by ℓ tan ν sin² α / 3, at a distance ℓ behind the occluder, for a surface
/// that is turned away by ν from a disc of half the angle α. At ν = 45° and 40 voxels that is 0.1 voxels.
const MIN_WEIGHTED_SIZE: f64 = 0.0075;

impl SceneLight {
    /// Returns true if the light is so wide, from the middle of the volume, that its points are weighted on surfaces.
    pub fn has_weighted_points(&self) -> bool {
        self.angular_size(DVec3::ZERO) >= MIN_WEIGHTED_SIZE
    }

    /// Returns the coordinates of the points of [`Self::sample_lights`] on the light's area: 0 in its centre, and 1 at
    /// its right and its upper border.
    pub fn sample_coordinates(&self, samples: u32) -> Vec<DVec2> {
        let Some(area) = &self.area else { return vec![DVec2::ZERO] };
        let centre = match self.kind {
            LightGeometry::Parallel => self.direction(),
            LightGeometry::Perspective => self.position.into(),
        };
        let along = |way: DVec3, border: DVec3| way.dot(border) / border.length_squared();
        let coordinates = |point: &Self| {
            let way = DVec3::from(point.position) - centre;
            DVec2::new(along(way, area.right), along(way, area.up))
        };
        self.sample_lights(samples).iter().map(coordinates).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Camera, LightSettings, LightShape};

    #[test]
    fn coordinates_are_even_around_the_centre_and_within_the_borders() {
        for kind in [LightGeometry::Parallel, LightGeometry::Perspective] {
            for shape in [LightShape::Disc, LightShape::Rectangle, LightShape::Ball] {
                let light = LightSettings {
                    kind,
                    shape,
                    position: [1.0, -3.0, 2.0],
                    size: 2.0,
                    angle_deg: 40.0,
                    aspect: 2.0,
                    ..LightSettings::default()
                };
                let found = light.resolve(&Camera::default()).sample_coordinates(64);
                let sum: DVec2 = found.iter().sum();
                assert!(found.len() >= 44 && sum.length() < 1e-9, "{kind:?}, {shape:?}: {sum}");
                let farthest = found.iter().map(|at| at.abs().max_element()).fold(0.0, f64::max);
                assert!(farthest > 0.8 && farthest < 1.0, "{kind:?}, {shape:?}: {farthest}");
            }
        }
    }

    #[test]
    fn narrow_lights_and_points_are_not_weighted() {
        let sun = |angle_deg| LightSettings {
            kind: LightGeometry::Parallel,
            shape: LightShape::Disc,
            angle_deg,
            ..LightSettings::default()
        };
        for (angle_deg, expected) in [(0.0, false), (9.8, false), (10.2, true), (40.0, true)] {
            let light = sun(angle_deg).resolve(&Camera::default());
            assert_eq!(light.has_weighted_points(), expected, "{angle_deg}°");
        }
    }
}
