//! Benchmark of sky light, in relation to the light pass of one light.

use serde_json::{Map, Value, json};

use super::edits::EDIT_SHARE;
use super::report::{CaseTimings, round_to_microsecond};
use super::{STEP_DEG, VolumeBenchmark, WARM_UP_FRAMES};
use crate::cli::CliError;
use chiaroscuro_scene::{LightVolumeResolution, ReconstructionKernel, ReverseKernel, Settings, SkyMode};

/// Numbers of directions, and resolutions of the sky's volume, that are timed.
const BUILDS: [(u32, LightVolumeResolution); 6] = [
    (6, LightVolumeResolution::Quarter),
    (12, LightVolumeResolution::Quarter),
    (6, LightVolumeResolution::Half),
    (24, LightVolumeResolution::Half),
    (48, LightVolumeResolution::Half),
    (12, LightVolumeResolution::Full),
];

impl VolumeBenchmark<'_> {
    /// Measures the filling of the sky's volume in units of B, the filling of one parallel light with the B-spline
    /// both ways, and an orbit and an edit with a sky relative to those without. Frames alternate, so that other load
    /// on the machine slows all of them alike.
    pub(super) fn sky(
        &mut self,
        cases: &mut Vec<Value>,
        ratios: &mut Map<String, Value>,
    ) -> Result<(), CliError> {
        let lit = self.one_light_look();
        let under_a_sky = |directions: u32, resolution: LightVolumeResolution| {
            let mut settings = lit.clone();
            settings.sky.mode = SkyMode::Gradient;
            (settings.sky.directions, settings.sky.resolution) = (directions, resolution);
            settings
        };
        let looks = BUILDS.map(|(directions, resolution)| under_a_sky(directions, resolution));
        // Lights stay unchanged, so that only the sky is timed.
        let scale_density = |settings: &mut Settings, scale: f64| settings.sky.density_scale *= scale;
        let (one_light, builds) = self.time_fills(&lit, &looks, scale_density)?;
        let unit = one_light.light_build();
        ratios.insert("one_light_ms".to_owned(), json!(round_to_microsecond(unit)));
        for (((directions, resolution), samples), look) in BUILDS.into_iter().zip(&builds).zip(&looks) {
            self.frame(look, None)?;
            let asked = resolution.divisor();
            // Large volumes use larger blocks than requested.
            let divisor = self.renderer.sky_divisor().unwrap_or(asked);
            let instead = if divisor == asked { String::new() } else { format!("_for_1/{asked}") };
            let bound =
                if divisor == 1 { 1.3 } else { 2.0 } * f64::from(directions) / (divisor as f64).powi(3);
            ratios.insert(
                format!("sky_{directions}_directions_at_1/{divisor}{instead}"),
                json!({ "measured": round_to_microsecond(samples.sky() / unit), "bound": round_to_microsecond(bound) }),
            );
        }
        let pair = [lit.clone(), under_a_sky(24, LightVolumeResolution::Half)];
        let turned =
            |settings: &mut Settings, frame: usize| settings.camera.azimuth_deg += STEP_DEG * frame as f64;
        let [without, with] = self.time_alternately(&pair, turned)?;
        ratios.insert(
            "orbit_under_a_sky_over_orbit".to_owned(),
            json!(round_to_microsecond(with.cost() / without.cost())),
        );
        cases.push(self.case("orbit-one-light", &without, 0));
        cases.push(self.case("orbit-sky", &with, 0));
        let span = self.loaded.volume().shown_range().span();
        let edited = |settings: &mut Settings, frame: usize| {
            let step = (frame % 7) as f64 - 3.0;
            settings
                .layer_mut()
                .transfer
                .points
                .iter_mut()
                .for_each(|point| point.value += step * EDIT_SHARE * span);
        };
        let pair = [lit.clone(), under_a_sky(6, LightVolumeResolution::Quarter)];
        let [without, with] = self.time_alternately(&pair, edited)?;
        ratios.insert(
            "edit_under_a_sky_over_edit".to_owned(),
            json!(round_to_microsecond(with.cost() / without.cost())),
        );
        cases.push(self.case("tf-edit-one-light", &without, 0));
        cases.push(self.case("tf-edit-sky", &with, 0));
        Ok(())
    }

    /// Returns the look with only its first light, whose filling with the B-spline both ways is the unit B.
    pub(super) fn one_light_look(&self) -> Settings {
        let mut lit = self.settings.clone();
        lit.lights.truncate(1);
        lit.shadows.kernel = ReconstructionKernel::BSpline;
        lit.shadows.reverse_kernel = ReverseKernel::Forward;
        lit
    }

    /// Times filling the volume of one light and the volumes of other looks, alternately; each time `denser` scales
    /// the density of the latter, so that they are filled anew.
    pub(super) fn time_fills(
        &mut self,
        one_light: &Settings,
        looks: &[Settings],
        denser: impl Fn(&mut Settings, f64),
    ) -> Result<(CaseTimings, Vec<CaseTimings>), CliError> {
        let mut unit = CaseTimings::default();
        let mut builds: Vec<_> = looks.iter().map(|_| CaseTimings::default()).collect();
        for frame in 0..WARM_UP_FRAMES + usize::from(self.args.frames) {
            let timed = frame >= WARM_UP_FRAMES;
            let scale = 1.0 + 0.01 * (frame % 7) as f64;
            let mut lit = one_light.clone();
            lit.lights.iter_mut().for_each(|light| light.density_scale *= scale);
            self.frame(&lit, timed.then_some(&mut unit))?;
            for (look, samples) in looks.iter().zip(&mut builds) {
                let mut look = look.clone();
                denser(&mut look, scale);
                self.frame(&look, timed.then_some(samples))?;
            }
        }
        Ok((unit, builds))
    }

    /// Times frames of two looks alternately, each modified by `change` from frame to frame.
    pub(super) fn time_alternately(
        &mut self,
        looks: &[Settings; 2],
        change: impl Fn(&mut Settings, usize),
    ) -> Result<[CaseTimings; 2], CliError> {
        let mut samples = [CaseTimings::default(), CaseTimings::default()];
        for frame in 0..WARM_UP_FRAMES + usize::from(self.args.frames) {
            for (at, (look, samples)) in looks.iter().zip(&mut samples).enumerate() {
                let mut settings = look.clone();
                // Distinct densities, so that neither look reuses the light volumes of the other.
                settings.lights.iter_mut().for_each(|light| light.density_scale += 1e-6 * at as f64);
                change(&mut settings, frame);
                self.frame(&settings, (frame >= WARM_UP_FRAMES).then_some(samples))?;
            }
        }
        Ok(samples)
    }
}
