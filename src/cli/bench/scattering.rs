//! What light that bounces takes, beside that of one light.

use serde_json::{Map, Value, json};

use super::report::round;
use super::{Bench, STEP_DEG};
use crate::cli::CliError;
use crate::model::{Resolution, Settings, SkyMode};

/// Bounces, directions and resolutions that are timed.
const BUILDS: [(u32, u32, Resolution); 4] = [
    (3, 14, Resolution::Quarter),
    (4, 64, Resolution::Quarter),
    (8, 64, Resolution::Quarter),
    (4, 64, Resolution::Half),
];

impl Bench<'_> {
    /// Fillings of the volume of bounced light in units of B, the filling of one parallel light with the B-spline both ways;
    /// an orbit with everything over one without. In turn, so that a busy machine slows all of them.
    pub(super) fn scattering(
        &mut self,
        cases: &mut Vec<Value>,
        ratios: &mut Map<String, Value>,
    ) -> Result<(), CliError> {
        let lit = self.under_one_light();
        let bouncing = |bounces: u32, directions: u32, resolution: Resolution| {
            let mut settings = lit.clone();
            settings.scattering.bounces = bounces;
            (settings.scattering.directions, settings.scattering.resolution) = (directions, resolution);
            settings
        };
        let looks = BUILDS.map(|(bounces, directions, resolution)| bouncing(bounces, directions, resolution));
        // Lights stay as they are: what is timed is what bounces.
        let denser = |settings: &mut Settings, scale: f64| settings.scattering.density_scale *= scale;
        let (one_light, builds) = self.fillings(&lit, &looks, denser)?;
        let unit = one_light.light_build();
        ratios.insert("one_light_ms".to_owned(), json!(round(unit)));
        for ((bounces, directions, resolution), samples) in BUILDS.into_iter().zip(&builds) {
            let divisor = resolution.divisor();
            ratios.insert(
                format!("{bounces}_bounces_in_{directions}_directions_at_1/{divisor}"),
                json!({ "measured": round(samples.bounces() / unit) }),
            );
        }
        let mut everything = bouncing(8, 14, Resolution::Quarter);
        everything.sky.mode = SkyMode::Gradient;
        let pair = [lit.clone(), everything];
        let turned =
            |settings: &mut Settings, frame: usize| settings.camera.azimuth_deg += STEP_DEG * frame as f64;
        let [without, with] = self.in_turn(&pair, turned)?;
        ratios.insert(
            "orbit_with_everything_over_orbit".to_owned(),
            json!(round(with.cost() / without.cost())),
        );
        cases.push(self.case("orbit-one-light", &without, 0));
        cases.push(self.case("orbit-everything", &with, 0));
        Ok(())
    }
}
