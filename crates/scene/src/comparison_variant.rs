//! Comparison variants: the current look with one thing changed, such as the shadow algorithm, another look or
//! another camera.

use crate::{Camera, ObjectRotation, RenderEngine, Settings, ShadowAlgorithm};

/// Difference of a compared look from the current one.
#[derive(Debug, Clone, PartialEq)]
pub enum ComparisonVariant {
    /// Unchanged, for reference.
    Current,
    /// Without shadows: light is not attenuated.
    Off,
    /// Shadows from a light volume filled by splatting.
    Splat,
    /// Shadows from a light volume filled by ray casting.
    Raycast,
    /// Shadows by a ray to the light from every sample.
    Direct,
    /// Scattering engine instead of the gathering one.
    Scatter,
    /// First touch: voxels take the light of the first sheet that touches them.
    FirstTouch,
    /// Another complete look, with the current camera.
    Look(Box<Settings>),
    /// Current look, seen with another camera.
    View(Box<Camera>),
}

impl ComparisonVariant {
    /// Variants that carry no data.
    pub const WITHOUT_DATA: [Self; 7] =
        [Self::Current, Self::Off, Self::Splat, Self::Raycast, Self::Direct, Self::Scatter, Self::FirstTouch];

    /// Returns the variant's name on the command line.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Current => "current",
            Self::Off => "off",
            Self::Splat => "splat",
            Self::Raycast => "raycast",
            Self::Direct => "direct",
            Self::Scatter => "scatter",
            Self::FirstTouch => "first-touch",
            Self::Look(_) => "look",
            Self::View(_) => "view",
        }
    }

    /// Returns the settings to render in place of the current ones.
    #[must_use]
    pub fn apply(&self, current: &Settings) -> Settings {
        let mut settings = current.clone();
        let shadows = &mut settings.shadows;
        match self {
            Self::Current => {}
            Self::Off => shadows.algorithm = ShadowAlgorithm::Off,
            Self::Splat => {
                (shadows.algorithm, shadows.first_touch) = (ShadowAlgorithm::Splat, false);
                settings.sampling.engine = RenderEngine::Gather;
            }
            Self::Raycast => shadows.algorithm = ShadowAlgorithm::Raycast,
            Self::Direct => shadows.algorithm = ShadowAlgorithm::Direct,
            Self::Scatter => {
                (shadows.algorithm, shadows.first_touch) = (ShadowAlgorithm::Splat, false);
                settings.sampling.engine = RenderEngine::Scatter;
            }
            Self::FirstTouch => {
                (shadows.algorithm, shadows.first_touch) = (ShadowAlgorithm::Splat, true);
            }
            Self::Look(look) => {
                settings = Settings::clone(look);
                if look.camera.up != current.camera.up {
                    // The lights stay with the viewer when the object's orientation differs, and the floor stays
                    // below the object.
                    settings.rotate_object(ObjectRotation::MakeUpright(current.camera.up));
                    settings.floor.height = current.floor.height;
                }
                settings.camera.clone_from(&current.camera);
                // Corrections belong to the file, which is the same.
                settings.volume = current.volume;
            }
            Self::View(camera) => {
                if camera.up != current.camera.up {
                    settings.rotate_object(ObjectRotation::MakeUpright(camera.up));
                }
                settings.camera = Camera::clone(camera);
            }
        }
        settings
    }
}

impl Settings {
    /// Returns a saved look in place of this one, with the current camera; the saved entries and the file's
    /// corrections stay.
    #[must_use]
    pub fn with_saved_look(&self, look: &Self) -> Self {
        let under = ComparisonVariant::Look(Box::new(look.clone())).apply(self);
        Self { kept: self.kept.clone(), ..under }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SceneAxis;
    use glam::DVec3;

    #[test]
    fn looks_at_an_object_that_stood_otherwise_keep_their_light() {
        let look = Settings::default();
        let mut current = look.clone();
        current.rotate_object(ObjectRotation::MakeUpright(SceneAxis::MinusX));
        current.floor.height = -0.7;
        let shown = ComparisonVariant::Look(Box::new(look.clone())).apply(&current);
        assert_eq!((&shown.camera, shown.floor.height), (&current.camera, -0.7));
        let seen = |settings: &Settings| {
            let light = settings.lights[0].resolve(&settings.camera).position;
            settings.camera.scene_from_view().transpose() * DVec3::from(light)
        };
        assert!((seen(&shown) - seen(&look)).length() < 1e-9);
    }

    #[test]
    fn views_differ_from_the_picture_in_where_the_eye_is_alone() {
        let current = Settings::default();
        let elsewhere = Camera { azimuth_deg: 123.0, distance: 2.5, ..current.camera.clone() };
        let shown = ComparisonVariant::View(Box::new(elsewhere.clone())).apply(&current);
        assert_eq!(shown, Settings { camera: elsewhere.clone(), ..current.clone() });
        // With another axis up, light comes from where the viewer had it.
        let lying = Camera { up: SceneAxis::MinusX, ..elsewhere };
        let shown = ComparisonVariant::View(Box::new(lying.clone())).apply(&current);
        assert!(shown.camera == lying && shown.lights != current.lights);
    }

    #[test]
    fn variants_differ_from_each_other_and_keep_the_camera() {
        let mut current = Settings::default();
        current.camera.azimuth_deg = 77.0;
        let mut looks: Vec<Settings> =
            ComparisonVariant::WITHOUT_DATA.iter().map(|variant| variant.apply(&current)).collect();
        // The default look uses splatting.
        assert_eq!(looks[2], looks[0]);
        looks.remove(2);
        let mut other = Settings::default();
        other.shading.ambient = 0.5;
        looks.push(ComparisonVariant::Look(Box::new(other)).apply(&current));
        for (at, look) in looks.iter().enumerate() {
            assert_eq!(look.camera, current.camera);
            assert!(looks[..at].iter().all(|earlier| earlier != look), "{at}");
        }
    }
}
