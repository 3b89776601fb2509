//! Light directions relative to the viewer, in a photographer's terms: the angle off the line of sight, and the hour
//! on a clock face.

use glam::DVec3;

/// Direction of a light relative to the camera, in polar angles about the line of sight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightDirection {
    /// Angle in degrees between the line of sight and the direction to the light: 0 is at the camera, 90 in the image
    /// plane.
    pub off_axis_deg: f64,
    /// Angle in degrees from straight up, clockwise as seen by the viewer: −90 is on the left.
    pub clock_deg: f64,
}

impl LightDirection {
    /// Direction of the key light in lighting rigs: 54° off the line of sight, and more to the side than up. Of
    /// directions between 20° and 70°, those about 55° have one and a half to two times the shadows of 40° in images
    /// that are as rich in tones and no blacker; and shape is read best from light 20° to 30° above the camera, a
    /// little to the left (O'Shea, Agrawala & Banks 2010): here 50° left and 25° up.
    pub const DEFAULT_KEY: Self = Self { off_axis_deg: 54.368_957_6, clock_deg: -58.670_230_1 };

    /// Clock angles of the light search, of 9:30, 10:30, 11:30 and 1:30; noon is left out, because the object hides the
    /// shadows below itself. Three of four are on the left, where people expect light.
    const SEARCHED_CLOCK_DEG: [f64; 4] = [-75.0, -45.0, -15.0, 45.0];

    /// Angles off the line of sight of the light search, from where shadows begin to show to where they cover half of a
    /// ball; the middle one is tried first.
    const SEARCHED_OFF_AXIS_DEG: [f64; 3] = [35.0, 50.0, 65.0];

    /// Returns the twelve candidates of the light search, in the upper half.
    pub fn search_candidates() -> Vec<Self> {
        let at = |clock_deg| Self::SEARCHED_OFF_AXIS_DEG.map(|off_axis_deg| Self { off_axis_deg, clock_deg });
        Self::SEARCHED_CLOCK_DEG.into_iter().flat_map(at).collect()
    }

    /// Returns the candidates of a first round of the light search: those in the middle between the others.
    pub fn first_candidates() -> Vec<Self> {
        let [_, off_axis_deg, _] = Self::SEARCHED_OFF_AXIS_DEG;
        Self::SEARCHED_CLOCK_DEG.map(|clock_deg| Self { off_axis_deg, clock_deg }).to_vec()
    }

    /// Returns the candidates of a second round of the light search: those beside a candidate of the first.
    pub fn neighbouring_candidates(self) -> Vec<Self> {
        let [near, _, far] = Self::SEARCHED_OFF_AXIS_DEG;
        [near, far].map(|off_axis_deg| Self { off_axis_deg, ..self }).to_vec()
    }

    /// Returns the unit vector towards the light in view axes: right, up and towards the camera.
    pub fn view_direction(self) -> DVec3 {
        let (aside, along) = self.off_axis_deg.to_radians().sin_cos();
        let (right, up) = self.clock_deg.to_radians().sin_cos();
        DVec3::new(aside * right, aside * up, along)
    }

    /// Returns true if the light is on the right, where a rig's fill light stands otherwise.
    pub fn is_right(self) -> bool {
        self.view_direction().x > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_as_far_aside_as_they_say() {
        for place in LightDirection::search_candidates() {
            let way = place.view_direction();
            assert!((way.length() - 1.0).abs() < 1e-12);
            assert!((way.z.acos().to_degrees() - place.off_axis_deg).abs() < 1e-9, "{place:?}");
            assert!(way.y > 0.0 && way.z > 0.0, "in the upper half, on the viewer's side: {place:?}");
        }
        assert_eq!(LightDirection::search_candidates().iter().filter(|place| place.is_right()).count(), 3);
        let noon = LightDirection { off_axis_deg: 90.0, clock_deg: 0.0 }.view_direction();
        assert!((noon - DVec3::Y).length() < 1e-12);
    }

    #[test]
    fn the_usual_place_is_to_the_left_and_a_little_up() {
        let (left, up) = (50f64.to_radians(), 25f64.to_radians());
        let meant = DVec3::new(-left.sin() * up.cos(), up.sin(), left.cos() * up.cos());
        assert!(
            (LightDirection::DEFAULT_KEY.view_direction() - meant).length() < 1e-8,
            "{:?}",
            LightDirection::DEFAULT_KEY.view_direction()
        );
    }
}
