//! Weights of an area light's points on a surface: each counts by its cosine to the normal.
//!
//! Points are even over the sines of their angles to the middle l of the light, so that each gives the same to a
//! surface that faces it; one with the normal n takes n·ω / ((n·l) (l·ω)) of that from a point in direction ω.

use glam::{DVec2, DVec3};

use chiaroscuro_scene::{LightGeometry, SceneLight};

/// Smallest cosine between the directions to a point and to the middle of its light that is used.
const MIN_COSINE: f64 = 0.1;

/// Weights of the points of a light at one place.
pub(crate) struct PointWeights<'a> {
    light: &'a SceneLight,
    place: DVec3,
    /// Unit normal of the surface, on either side.
    normal: DVec3,
    /// Unit vector to the middle of the light.
    middle: DVec3,
    /// Distance to the middle; 1 for a parallel light.
    distance: f64,
    /// Share of the weights in effect: how much of a surface there is, unless the light sets behind it.
    share: f64,
}

impl<'a> PointWeights<'a> {
    /// Creates the weights of a light at a place of the scene; `normal` is as long as there is a surface, 0 … 1.
    pub(crate) fn new(light: &'a SceneLight, place: DVec3, normal: DVec3) -> Self {
        let away = match light.kind {
            LightGeometry::Parallel => light.direction(),
            LightGeometry::Perspective => DVec3::from(light.position) - place,
        };
        let mut weights = Self {
            light,
            place,
            normal: normal.normalize_or_zero(),
            middle: away.normalize_or_zero(),
            distance: away.length(),
            share: 0.0,
        };
        if let Some(area) = &light.area
            && weights.normal.dot(weights.middle) != 0.0
        {
            let lowest = DVec2::new(weights.change(area.right), weights.change(area.up)).length();
            let t = (3.0 * lowest - 2.0).clamp(0.0, 1.0);
            weights.share = normal.length() * (1.0 - t * t * (3.0 - 2.0 * t));
        }
        weights
    }

    /// Returns the change of the weight from the middle of the light to a point at an offset from there, to first order.
    fn change(&self, offset: DVec3) -> f64 {
        let cosine = self.normal.dot(self.middle);
        (self.normal.dot(offset) / cosine - self.middle.dot(offset)) / self.distance
    }

    /// Returns the weight of a point by its offset from the middle, which is 1 on average over the light.
    pub(crate) fn by_offset(&self, point: &SceneLight) -> f64 {
        if self.share == 0.0 {
            return 1.0;
        }
        let middle = match self.light.kind {
            LightGeometry::Parallel => self.light.direction(),
            LightGeometry::Perspective => self.light.position.into(),
        };
        // Points on balls are those of a disc, moved along their chords.
        let offset = (DVec3::from(point.position) - middle).reject_from(self.light.direction());
        1.0 + self.share * self.change(offset)
    }

    /// Returns the weight of a point by the direction to it.
    pub(crate) fn by_direction(&self, point: &SceneLight) -> f64 {
        if self.share == 0.0 {
            return 1.0;
        }
        let towards = point.direction_from(self.place);
        let facing = self.normal.dot(towards) / self.normal.dot(self.middle);
        let along = self.middle.dot(towards);
        (1.0 + self.share * (facing - along) / along.max(MIN_COSINE)).max(0.0)
    }
}
