//! Benchmark of area lights in relation to point lights, and of coloured shadows in relation to grey ones.

use serde_json::{Map, Value, json};

use super::report::round_to_microsecond;
use super::{STEP_DEG, VolumeBenchmark};
use crate::cli::CliError;
use chiaroscuro_scene::{LightShape, LightVolumeResolution, Settings};

/// Numbers of points on the light, and resolutions of its volume, that are timed.
const BUILDS: [(u32, LightVolumeResolution); 4] = [
    (16, LightVolumeResolution::Quarter),
    (16, LightVolumeResolution::Half),
    (64, LightVolumeResolution::Half),
    (16, LightVolumeResolution::Full),
];

/// Angular diameter of the light, in degrees.
const ANGLE_DEG: f64 = 15.0;

/// Transmission of coloured shadows; its value does not affect the time.
const TRANSMISSION: f64 = 0.8;

impl VolumeBenchmark<'_> {
    /// Measures the filling of a disc light's volume in units of B, the filling of one parallel light with the
    /// B-spline both ways; an orbit under a disc relative to one without; and coloured shadows relative to grey ones.
    /// Frames alternate, so that other load on the machine slows all of them alike.
    pub(super) fn area_lights(
        &mut self,
        cases: &mut Vec<Value>,
        ratios: &mut Map<String, Value>,
    ) -> Result<(), CliError> {
        let mut lit = self.settings.clone();
        lit.lights.truncate(1);
        let unit = self.one_light_look();
        let under_a_disc = |samples: u32, resolution: LightVolumeResolution| {
            let mut settings = lit.clone();
            settings.lights.iter_mut().for_each(|light| {
                (light.shape, light.angle_deg) = (LightShape::Disc, ANGLE_DEG);
            });
            (settings.shadows.area.samples, settings.shadows.area.resolution) = (samples, resolution);
            settings
        };
        let mut colored = lit.clone();
        colored.shadows.transmission = TRANSMISSION;
        let mut looks = BUILDS.map(|(points, resolution)| under_a_disc(points, resolution)).to_vec();
        looks.extend([lit.clone(), colored.clone()]);
        let denser = |settings: &mut Settings, scale: f64| {
            settings.lights.iter_mut().for_each(|light| light.density_scale *= scale);
        };
        let (one_light, builds) = self.time_fills(&unit, &looks, denser)?;
        let unit = one_light.light_build();
        ratios.insert("one_light_ms".to_owned(), json!(round_to_microsecond(unit)));
        for ((points, resolution), samples) in BUILDS.into_iter().zip(&builds) {
            let divisor = resolution.divisor();
            ratios.insert(
                format!("disc_{points}_points_at_1/{divisor}"),
                json!({ "measured": round_to_microsecond(samples.light_build() / unit) }),
            );
        }
        if let [.., grey, colored] = &builds[..] {
            let ratio = round_to_microsecond(colored.light_build() / grey.light_build());
            ratios.insert("coloured_light_over_grey_light".to_owned(), json!(ratio));
        }
        let pair = [lit.clone(), under_a_disc(64, LightVolumeResolution::Half)];
        let turned =
            |settings: &mut Settings, frame: usize| settings.camera.azimuth_deg += STEP_DEG * frame as f64;
        let [without, with] = self.time_alternately(&pair, turned)?;
        ratios.insert(
            "orbit_under_a_disc_over_orbit".to_owned(),
            json!(round_to_microsecond(with.cost() / without.cost())),
        );
        let [grey, colored] = self.time_alternately(&[lit, colored], turned)?;
        let ratio = round_to_microsecond(colored.cost() / grey.cost());
        ratios.insert("orbit_with_coloured_shadows_over_orbit".to_owned(), json!(ratio));
        cases.push(self.case("orbit-point", &without, 0));
        Ok(())
    }
}
