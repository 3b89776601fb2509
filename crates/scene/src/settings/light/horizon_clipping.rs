//! Horizon clipping of area lights: the part of a light above the horizon of a surface that it illuminates.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

use super::{LightGeometry, SceneLight};

/// Visible part of a light above the horizon of a plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VisibleLight {
    /// Unit vector towards the centroid of the part above the plane's horizon; towards the light's own centre to the
    /// degree that the sample is not a surface.
    pub direction: DVec3,
    /// Cosine between the plane's normal and the direction to the light's own centre.
    pub centre_cosine: f64,
    /// Mean cosine between the plane's normal and the directions to the visible part.
    pub mean_cosine: f64,
    /// Visible share of the light, 0 … 1; 1 for a point, for which `facing` decides.
    pub visible_share: f64,
}

/// Height above a disc's lower end up to which the visible part is a thin segment: 1.5 % of its area.
const THIN_SEGMENT: f64 = 0.02;

/// Returns the share of a unit disc above the horizon, and the height of that part's centroid above the horizon, for
/// a disc centre at `height` −1 … 1.
///
/// With u the height, the share is (π/2 + asin u + u√(1 − u²)) / π, and the mean of max(0, u + y) over the disc is
/// (u (π/2 + asin u) + √(1 − u²) (2 + u²) / 3) / π. The centroid lies at their ratio; that of a thin segment at 2/5
/// of its
/// height.
fn disc_above_horizon(height: f64) -> (f64, f64) {
    let (quarter, root) = (FRAC_PI_2 + height.asin(), (1.0 - height * height).sqrt());
    let share = (quarter + height * root) / PI;
    let moment = (height * quarter + root * (2.0 + height * height) / 3.0) / PI;
    (share, if height > THIN_SEGMENT - 1.0 { moment / share } else { 0.4 * (1.0 + height) })
}

impl SceneLight {
    /// Returns the unit vector from a point in the scene to the light's centre.
    pub fn direction_from(&self, place: DVec3) -> DVec3 {
        match self.kind {
            LightGeometry::Parallel => self.direction(),
            LightGeometry::Perspective => (DVec3::from(self.position) - place).normalize_or(DVec3::Z),
        }
    }

    /// Returns sin² of half the angular width of the light as seen from a point in the scene; 0 for a point light.
    pub fn angular_size(&self, place: DVec3) -> f64 {
        let Some(area) = self.area else { return 0.0 };
        let away = match self.kind {
            // The extent of a parallel light is that of one at distance 1.
            LightGeometry::Parallel => 1.0,
            LightGeometry::Perspective => DVec3::from(self.position).distance(place),
        };
        let tangent = 0.5 * (area.right.length_squared() + area.up.length_squared()) / (away * away);
        tangent / (1.0 + tangent)
    }

    /// Returns the part of the light above the horizon of a plane at `place`, with any shape treated as a disc.
    /// `normal`: unit normal of the plane; `weight`: degree to which the sample is a surface, which tilts the
    /// direction.
    pub fn above_horizon(&self, place: DVec3, normal: DVec3, weight: f64) -> VisibleLight {
        let towards = self.direction_from(place);
        let half_width = self.angular_size(place).sqrt();
        let middle = normal.dot(towards);
        if half_width <= middle.max(0.0) {
            return VisibleLight {
                direction: towards,
                centre_cosine: middle,
                mean_cosine: middle,
                visible_share: 1.0,
            };
        }
        let height = middle / half_width;
        // Nothing is visible, so there is no centroid; the direction returns gradually.
        let (share, risen, up) = if height > -1.0 {
            let (share, risen) = disc_above_horizon(height);
            (share, risen, risen - height)
        } else {
            (0.0, 0.0, (2.0 + height).max(0.0))
        };
        let towards = (towards + normal * (up * half_width * weight)).normalize_or(towards);
        VisibleLight {
            direction: towards,
            centre_cosine: middle,
            mean_cosine: risen * half_width,
            visible_share: share,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Camera, LightSettings, LightShape};

    /// Compares with a disc of small squares.
    #[test]
    fn middles_are_those_of_what_has_risen() {
        for height in [-0.995, -0.9, -0.5, 0.0, 0.3, 0.8, 1.0] {
            let (mut count, mut all, mut sum) = (0.0, 0.0, 0.0);
            for at in 0..4_000_000_u32 {
                let [x, y] = [at % 2000, at / 2000].map(|c| (f64::from(c) + 0.5) / 1000.0 - 1.0);
                if x * x + y * y < 1.0 {
                    all += 1.0;
                    if height + y > 0.0 {
                        count += 1.0;
                        sum += height + y;
                    }
                }
            }
            let (share, middle) = disc_above_horizon(height);
            assert!((share - count / all).abs() < 1e-4, "{height}: {share} {}", count / all);
            assert!((middle - sum / count).abs() < 1e-3, "{height}: {middle} {}", sum / count);
        }
    }

    #[test]
    fn lights_rise_by_and_by() {
        let light = LightSettings {
            kind: LightGeometry::Parallel,
            position: [1.0, 0.0, 0.0],
            shape: LightShape::Disc,
            angle_deg: 40.0,
            ..LightSettings::default()
        };
        let light = light.resolve(&Camera::default());
        let seen = |height: f64, weight| {
            let normal = DVec3::new(height, 0.0, (1.0 - height * height).sqrt());
            (light.above_horizon(DVec3::ZERO, normal, weight), normal)
        };
        let half_width = 20_f64.to_radians().sin();
        let mut last = 0.0;
        for step in 0..60 {
            let (risen, normal) = seen(half_width * (f64::from(step) / 20.0 - 1.5), 1.0);
            assert!(risen.visible_share >= last && risen.visible_share <= 1.0, "{step}");
            last = risen.visible_share;
            let facing = normal.dot(risen.direction);
            assert!(if risen.visible_share > 0.0 { facing > 0.0 } else { facing < 1e-6 }, "{step}: {facing}");
            assert!(
                (facing - risen.mean_cosine).abs() < 0.01 || risen.visible_share == 0.0,
                "{step}: {facing} {risen:?}"
            );
        }
        assert!(last == 1.0);
        let (half, _) = seen(0.0, 1.0);
        assert!(
            (half.visible_share - 0.5).abs() < 1e-9
                && (half.mean_cosine - 4.0 / (3.0 * PI) * half_width).abs() < 1e-9
        );
        // Without a surface the direction is not tilted, and points are either visible or not.
        assert_eq!(seen(-half_width, 0.0).0.direction, DVec3::X);
        let point = SceneLight { area: None, ..light }.above_horizon(DVec3::ZERO, DVec3::NEG_X, 1.0);
        assert_eq!(
            point,
            VisibleLight { direction: DVec3::X, centre_cosine: -1.0, mean_cosine: -1.0, visible_share: 1.0 }
        );
    }
}
