//! Places for lights around the viewer, as a photographer says them: how far off the line of sight, and at which hour
//! of a clock face.

use glam::DVec3;

/// Where a light stands, as seen from the eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightPlace {
    /// Degrees between the line of sight and the way to the light: 0 is at the eye, 90 in the plane of the picture.
    pub aside_deg: f64,
    /// Degrees from straight up, clockwise as seen: -90 is on the left.
    pub round_deg: f64,
}

impl LightPlace {
    /// Where the key of a rig stands: 54° off the line of sight, and more to the side than up. Of places between 20° and
    /// 70°, those about 55° have one and a half to two times the shadows of 40° in pictures that are as rich in tones and
    /// no blacker; and shape is read best from light 20° to 30° above the eye, a little to the left (O'Shea, Agrawala &
    /// Banks 2010): here 50° left and 25° up.
    pub const USUAL: Self = Self { aside_deg: 54.368_957_6, round_deg: -58.670_230_1 };

    /// Twelve places in the upper half, at four hours and three distances from the line of sight: from where shadows
    /// begin to show to where they cover half of a ball. Three of four are on the left, where people expect light.
    pub fn to_try() -> Vec<Self> {
        // Ten to two, but for noon, which hides its shadows below what casts them; and half past nine.
        let hours = [-75.0, -45.0, -15.0, 45.0];
        let aside = [35.0, 50.0, 65.0];
        hours.into_iter().flat_map(|round_deg| aside.map(|aside_deg| Self { aside_deg, round_deg })).collect()
    }

    /// The way there: right, up and towards the eye, of length 1.
    pub fn in_view(self) -> DVec3 {
        let (aside, along) = self.aside_deg.to_radians().sin_cos();
        let (right, up) = self.round_deg.to_radians().sin_cos();
        DVec3::new(aside * right, aside * up, along)
    }

    /// Whether it is on the right, where the fill of a rig stands otherwise.
    pub fn is_right(self) -> bool {
        self.in_view().x > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_as_far_aside_as_they_say() {
        for place in LightPlace::to_try() {
            let way = place.in_view();
            assert!((way.length() - 1.0).abs() < 1e-12);
            assert!((way.z.acos().to_degrees() - place.aside_deg).abs() < 1e-9, "{place:?}");
            assert!(way.y > 0.0 && way.z > 0.0, "in the upper half, on the viewer's side: {place:?}");
        }
        assert_eq!(LightPlace::to_try().iter().filter(|place| place.is_right()).count(), 3);
        let noon = LightPlace { aside_deg: 90.0, round_deg: 0.0 }.in_view();
        assert!((noon - DVec3::Y).length() < 1e-12);
    }

    #[test]
    fn the_usual_place_is_to_the_left_and_a_little_up() {
        let (left, up) = (50f64.to_radians(), 25f64.to_radians());
        let meant = DVec3::new(-left.sin() * up.cos(), up.sin(), left.cos() * up.cos());
        assert!((LightPlace::USUAL.in_view() - meant).length() < 1e-8, "{:?}", LightPlace::USUAL.in_view());
    }
}
