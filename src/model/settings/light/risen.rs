//! What of a light that has a size stands above the horizon of a surface that it shines at.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

use super::{LightKind, SceneLight};

/// A light as a plane sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Risen {
    /// Unit vector towards the middle of what stands above the plane's horizon; towards the light's own middle as far as it
    /// is no surface.
    pub towards: DVec3,
    /// Cosine between the plane's normal and the direction to the light's own middle …
    pub middle: f64,
    /// … and the mean of those to all that stands above.
    pub facing: f64,
    /// The share of the light that does, 0 … 1; 1 of a point, which `facing` tells more of.
    pub share: f64,
}

/// So little above a disc's lower end, what has risen is a thin segment: of 1.5 % of its area.
const THIN: f64 = 0.02;

/// Of a disc of radius 1 whose middle stands at a height above the horizon, −1 … 1: the share that has risen, and how high
/// the middle of that stands.
///
/// With u the height, the share is (π/2 + asin u + u√(1 − u²)) / π, and the mean of max(0, u + y) over the disc is
/// (u (π/2 + asin u) + √(1 − u²) (2 + u²) / 3) / π. The middle stands at their ratio; that of a thin segment at 2/5 of its
/// height.
fn risen_disc(height: f64) -> (f64, f64) {
    let (quarter, root) = (FRAC_PI_2 + height.asin(), (1.0 - height * height).sqrt());
    let share = (quarter + height * root) / PI;
    let moment = (height * quarter + root * (2.0 + height * height) / 3.0) / PI;
    (share, if height > THIN - 1.0 { moment / share } else { 0.4 * (1.0 + height) })
}

impl SceneLight {
    /// Unit vector from a place to the light's middle.
    pub fn towards(&self, place: DVec3) -> DVec3 {
        match self.kind {
            LightKind::Parallel => self.direction(),
            LightKind::Perspective => (DVec3::from(self.position) - place).normalize_or(DVec3::Z),
        }
    }

    /// sin² of half the width of the light as it is seen from a place; 0 of a point.
    pub fn width_seen(&self, place: DVec3) -> f64 {
        let Some(area) = self.area else { return 0.0 };
        let away = match self.kind {
            // Its extent is that of one at a distance of 1.
            LightKind::Parallel => 1.0,
            LightKind::Perspective => DVec3::from(self.position).distance(place),
        };
        let tangent = 0.5 * (area.right.length_squared() + area.up.length_squared()) / (away * away);
        tangent / (1.0 + tangent)
    }

    /// What a plane at a place sees of the light, whatever its shape as if that were a disc. `normal`: to where the plane
    /// faces, a unit vector; `weight`: how much of a surface it is, which turns the direction.
    pub fn risen(&self, place: DVec3, normal: DVec3, weight: f64) -> Risen {
        let towards = self.towards(place);
        let half_width = self.width_seen(place).sqrt();
        let middle = normal.dot(towards);
        if half_width <= middle.max(0.0) {
            return Risen { towards, middle, facing: middle, share: 1.0 };
        }
        let height = middle / half_width;
        // Where nothing has risen there is nothing to turn to; it turns back by and by.
        let (share, risen, up) = if height > -1.0 {
            let (share, risen) = risen_disc(height);
            (share, risen, risen - height)
        } else {
            (0.0, 0.0, (2.0 + height).max(0.0))
        };
        let towards = (towards + normal * (up * half_width * weight)).normalize_or(towards);
        Risen { towards, middle, facing: risen * half_width, share }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Camera, Light, LightShape};

    /// Against a disc of small squares.
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
            let (share, middle) = risen_disc(height);
            assert!((share - count / all).abs() < 1e-4, "{height}: {share} {}", count / all);
            assert!((middle - sum / count).abs() < 1e-3, "{height}: {middle} {}", sum / count);
        }
    }

    #[test]
    fn lights_rise_by_and_by() {
        let light = Light {
            kind: LightKind::Parallel,
            position: [1.0, 0.0, 0.0],
            shape: LightShape::Disc,
            angle_deg: 40.0,
            ..Light::default()
        };
        let light = light.in_scene(&Camera::default());
        let seen = |height: f64, weight| {
            let normal = DVec3::new(height, 0.0, (1.0 - height * height).sqrt());
            (light.risen(DVec3::ZERO, normal, weight), normal)
        };
        let half_width = 20_f64.to_radians().sin();
        let mut last = 0.0;
        for step in 0..60 {
            let (risen, normal) = seen(half_width * (f64::from(step) / 20.0 - 1.5), 1.0);
            assert!(risen.share >= last && risen.share <= 1.0, "{step}");
            last = risen.share;
            let facing = normal.dot(risen.towards);
            assert!(if risen.share > 0.0 { facing > 0.0 } else { facing < 1e-6 }, "{step}: {facing}");
            assert!((facing - risen.facing).abs() < 0.01 || risen.share == 0.0, "{step}: {facing} {risen:?}");
        }
        assert!(last == 1.0);
        let (half, _) = seen(0.0, 1.0);
        assert!(
            (half.share - 0.5).abs() < 1e-9 && (half.facing - 4.0 / (3.0 * PI) * half_width).abs() < 1e-9
        );
        // What is no surface is not turned to, and points are risen or not.
        assert_eq!(seen(-half_width, 0.0).0.towards, DVec3::X);
        let point = SceneLight { area: None, ..light }.risen(DVec3::ZERO, DVec3::NEG_X, 1.0);
        assert_eq!(point, Risen { towards: DVec3::X, middle: -1.0, facing: -1.0, share: 1.0 });
    }
}
