//! Benchmark of multiple scattering, in relation to the light pass of one light.

use serde_json::{Map, Value, json};

use super::report::round_to_microsecond;
use super::{STEP_DEG, VolumeBenchmark};
use crate::cli::CliError;
use chiaroscuro_scene::{LightVolumeResolution, Settings, SkyMode};

/// Configuration of the scattering volume that is timed.
struct ScatteringBuild {
    bounces: u32,
    directions: u32,
    resolution: LightVolumeResolution,
    /// True if material and light are grey, so that one colour channel suffices.
    one_color: bool,
    /// Agreed upper bound of the time in units of one light, if there is one.
    bound: Option<f64>,
}

const fn build(bounces: u32, directions: u32, resolution: LightVolumeResolution) -> ScatteringBuild {
    ScatteringBuild { bounces, directions, resolution, one_color: false, bound: None }
}

const BUILDS: [ScatteringBuild; 6] = [
    build(3, 12, LightVolumeResolution::Quarter),
    ScatteringBuild { bound: Some(4.0), ..build(8, 12, LightVolumeResolution::Quarter) },
    ScatteringBuild { bound: Some(2.5), one_color: true, ..build(8, 12, LightVolumeResolution::Quarter) },
    build(4, 48, LightVolumeResolution::Quarter),
    build(8, 48, LightVolumeResolution::Quarter),
    build(4, 48, LightVolumeResolution::Half),
];

impl ScatteringBuild {
    /// Returns a look that uses this configuration.
    fn look(&self, lit: &Settings) -> Settings {
        let Self { bounces, directions, resolution, one_color, bound: _ } = *self;
        let mut settings = lit.clone();
        settings.scattering.bounces = bounces;
        (settings.scattering.directions, settings.scattering.resolution) = (directions, resolution);
        if one_color {
            for light in &mut settings.lights {
                light.color = [1.0; 3];
            }
            for point in &mut settings.layer_mut().transfer.points {
                point.color = [point.color[1]; 3];
            }
        }
        settings
    }

    fn name(&self) -> String {
        let Self { bounces, directions, resolution, one_color, bound: _ } = self;
        let colors = if *one_color { "_of_one_color" } else { "" };
        format!("{bounces}_bounces{colors}_in_{directions}_directions_at_1/{}", resolution.divisor())
    }
}

impl VolumeBenchmark<'_> {
    /// Measures the filling of the scattering volume in units of B, the filling of one parallel light with the
    /// B-spline both ways, and an orbit with sky and scattering relative to one without. Frames alternate, so that
    /// other load on the machine slows all of them alike.
    pub(super) fn scattering(
        &mut self,
        cases: &mut Vec<Value>,
        ratios: &mut Map<String, Value>,
    ) -> Result<(), CliError> {
        let lit = self.one_light_look();
        let looks = BUILDS.map(|build| build.look(&lit));
        // Lights stay unchanged, so that only scattering is timed.
        let denser = |settings: &mut Settings, scale: f64| settings.scattering.density_scale *= scale;
        let (one_light, builds) = self.time_fills(&lit, &looks, denser)?;
        let unit = one_light.light_build();
        ratios.insert("one_light_ms".to_owned(), json!(round_to_microsecond(unit)));
        for (build, samples) in BUILDS.iter().zip(&builds) {
            let mut found = json!({ "measured": round_to_microsecond(samples.bounces() / unit) });
            if let Some(bound) = build.bound {
                found["bound"] = json!(bound);
            }
            ratios.insert(build.name(), found);
        }
        let mut everything = build(8, 12, LightVolumeResolution::Quarter).look(&lit);
        everything.sky.mode = SkyMode::Gradient;
        let pair = [lit.clone(), everything];
        let turned =
            |settings: &mut Settings, frame: usize| settings.camera.azimuth_deg += STEP_DEG * frame as f64;
        let [without, with] = self.time_alternately(&pair, turned)?;
        ratios.insert(
            "orbit_with_everything_over_orbit".to_owned(),
            json!(round_to_microsecond(with.cost() / without.cost())),
        );
        cases.push(self.case("orbit-one-light", &without, 0));
        cases.push(self.case("orbit-everything", &with, 0));
        Ok(())
    }
}
