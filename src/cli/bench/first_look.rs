//! Benchmark of the first look, in figures: the object's coverage and brightness, the share that shadows of the
//! chosen lights darken, the visible share of the volume's box, whether a patient is seen from the front, and the CPU
//! time to find the look.

use serde_json::{Value, json};

use super::report::round_to_microsecond;
use super::{MAX_FIGURE_SIZE, VolumeBenchmark};
use crate::cli::CliError;
use crate::cli::process::process_cpu_ms;
use chiaroscuro_render::{
    LightSearch, RenderOptions, SearchedLight, dark_fraction, first_look, mean_luminance, shadowed_fraction,
    visible_fraction,
};
use chiaroscuro_scene::{ShadowAlgorithm, first_look};
use chiaroscuro_volume::DataKind;

impl VolumeBenchmark<'_> {
    /// Measures the first look, independently of the look of the benchmark.
    pub(super) fn first_look(&mut self, cases: &mut Vec<Value>) -> Result<(), CliError> {
        let volume = self.loaded.volume();
        let mut cpu_ms = CpuClock::start();
        first_look::first_settings(volume, self.loaded.histogram());
        let found_ms = cpu_ms.lap();
        let first = first_look(&mut self.renderer, self.loaded)?;
        let first_ms = cpu_ms.lap();
        let found =
            LightSearch::new(self.renderer.shaders(), self.loaded, &first, SearchedLight::KeyAndFill)?
                .run()?;
        let search_ms = cpu_ms.lap();
        let settings = found.as_ref().map_or_else(|| first.clone(), |found| found.apply(&first));
        let mut unshadowed = settings.clone();
        unshadowed.shadows.algorithm = ShadowAlgorithm::Off;
        let size = fit_size(self.args.size, MAX_FIGURE_SIZE);
        let mut light = |settings| {
            self.renderer
                .render(self.loaded, settings, size, &RenderOptions::default())
                .map(|seen| seen.linear)
        };
        let (with, without) = (light(&settings)?, light(&unshadowed)?);
        let towards_eye = settings.camera.scene_from_view().z_axis;
        cases.push(json!({
            "name": "first-look",
            "volume": volume.name(),
            "dims": volume.dims(),
            "found_cpu_ms": found_ms,
            "first_cpu_ms": first_ms,
            "search_cpu_ms": search_ms,
            "seen_share": round_to_microsecond(visible_fraction(&with)),
            "exposure": round_to_microsecond(settings.output.exposure),
            "mean_luminance": round_to_microsecond(settings.output.exposure * mean_luminance(&with)),
            "dark_share": round_to_microsecond(dark_fraction(&with, settings.output.exposure)),
            "lights_moved": settings.lights != first.lights,
            "floor": settings.floor.on,
            "shadowed_share": round_to_microsecond(shadowed_fraction(&with, &without)),
            "blockness": round_to_microsecond(first_look::box_share(&settings, volume)),
            "kind": volume.kind().kind.name().key(),
            "labels_lost": matches!(volume.kind().kind, DataKind::LabelMap { .. })
                .then(|| first_look::count_lost_labels(&settings, volume)),
            // World space is right-anterior-superior.
            "from_the_front": volume.is_anatomical().then_some(towards_eye.y > 0.0),
        }));
        Ok(())
    }
}

/// Scales a size down so that its longest edge is at most `most`, keeping the aspect ratio.
fn fit_size(size: [u32; 2], most: u32) -> [u32; 2] {
    let longest = size[0].max(size[1]);
    if longest <= most {
        return size;
    }
    size.map(|edge| ((f64::from(edge) * f64::from(most) / f64::from(longest)).round() as u32).max(1))
}

/// Stopwatch for the CPU time of this process, from one call to the next.
struct CpuClock {
    last: Option<f64>,
}

impl CpuClock {
    fn start() -> Self {
        Self { last: process_cpu_ms() }
    }

    /// Milliseconds since the last call; `None` if the system does not report CPU times.
    fn lap(&mut self) -> Option<f64> {
        let before = std::mem::replace(&mut self.last, process_cpu_ms());
        self.last.zip(before).map(|(after, before)| round_to_microsecond(after - before))
    }
}

/// Formats the rows of the first-look table.
pub(super) fn first_look_table(cases: &[Value]) -> Vec<String> {
    let looks = cases.iter().filter(|case| case["name"] == "first-look");
    let mut lines: Vec<String> = looks
        .map(|case| {
            let number =
                |name: &str| case[name].as_f64().map_or("–".to_owned(), |value| format!("{value:.3}"));
            let milliseconds =
                |name: &str| case[name].as_f64().map_or("–".to_owned(), |ms| format!("{ms:.0}"));
            let yes_no = |name: &str| if case[name] == true { "yes" } else { "no" };
            let from = match case["from_the_front"].as_bool() {
                Some(true) => "front",
                Some(false) => "elsewhere",
                None => "–",
            };
            format!(
                "{:<24} {:>6} {:>8} {:>10} {:>6} {:>9} {:>6} {:>5} {:>10} {:>10} {:>14} {:>6} {:>9} {:>9}",
                case["volume"].as_str().unwrap_or_default().chars().take(24).collect::<String>(),
                number("seen_share"),
                number("exposure"),
                number("mean_luminance"),
                number("dark_share"),
                number("shadowed_share"),
                yes_no("lights_moved"),
                yes_no("floor"),
                number("blockness"),
                from,
                case["kind"].as_str().unwrap_or_default(),
                case["labels_lost"].as_u64().map_or("–".to_owned(), |lost| lost.to_string()),
                milliseconds("found_cpu_ms"),
                milliseconds("search_cpu_ms"),
            )
        })
        .collect();
    if !lines.is_empty() {
        lines.insert(
            0,
            "first look                 seen exposure  luminance   dark  shadowed  moved floor  blockness       \
              from           kind   lost  found ms search ms"
                .to_owned(),
        );
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_pictures_keep_their_shape() {
        for (size, expected) in [
            ([512, 512], [400, 400]),
            ([1600, 900], [400, 225]),
            ([900, 1600], [225, 400]),
            ([300, 200], [300, 200]),
            ([10_000, 1], [400, 1]),
        ] {
            assert_eq!(fit_size(size, 400), expected, "{size:?}");
        }
    }
}
