//! Benchmark of the first look, in figures: the object's coverage and brightness, the share that shadows of the
//! chosen lights darken, the visible share of the volume's box, whether a patient is seen from the front, and the CPU
//! time to find the look.

use serde_json::{Value, json};

use super::report::round;
use super::{Bench, MOST_SIZE};
use crate::cli::CliError;
use crate::cli::process::process_cpu_ms;
use crate::data::DataKind;
use crate::gpu::{
    LightSearch, RenderOptions, Sought, dark_share, first_look, mean_luminance, seen_share, shadowed_share,
};
use crate::model::{ShadowAlgorithm, auto};

impl Bench<'_> {
    /// Measures the first look, independently of the look of the benchmark.
    pub(super) fn first_look(&mut self, cases: &mut Vec<Value>) -> Result<(), CliError> {
        let volume = self.loaded.volume();
        let mut cpu_ms = CpuClock::start();
        auto::first_settings(volume, self.loaded.histogram());
        let found_ms = cpu_ms.lap();
        let first = first_look(&mut self.renderer, self.loaded)?;
        let first_ms = cpu_ms.lap();
        let found =
            LightSearch::new(self.renderer.shaders(), self.loaded, &first, Sought::KeyAndFill)?.run()?;
        let search_ms = cpu_ms.lap();
        let settings = found.as_ref().map_or_else(|| first.clone(), |found| found.apply(&first));
        let mut unshadowed = settings.clone();
        unshadowed.shadows.algorithm = ShadowAlgorithm::Off;
        let size = within(self.args.size, MOST_SIZE);
        let mut light = |settings| {
            self.renderer
                .render(self.loaded, settings, size, &RenderOptions::default())
                .map(|seen| seen.light)
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
            "seen_share": round(seen_share(&with)),
            "exposure": round(settings.output.exposure),
            "mean_luminance": round(settings.output.exposure * mean_luminance(&with)),
            "dark_share": round(dark_share(&with, settings.output.exposure)),
            "lights_moved": settings.lights != first.lights,
            "floor": settings.floor.on,
            "shadowed_share": round(shadowed_share(&with, &without)),
            "blockness": round(auto::blockness(&settings, volume)),
            "kind": volume.kind().kind.name().key(),
            "labels_lost": matches!(volume.kind().kind, DataKind::LabelMap { .. })
                .then(|| auto::labels_lost(&settings, volume)),
            // World space is right-anterior-superior.
            "from_the_front": volume.is_anatomical().then_some(towards_eye.y > 0.0),
        }));
        Ok(())
    }
}

/// Scales a size down so that its longest edge is at most `most`, keeping the aspect ratio.
fn within(size: [u32; 2], most: u32) -> [u32; 2] {
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
        self.last.zip(before).map(|(after, before)| round(after - before))
    }
}

/// Formats the rows of the first-look table.
pub(super) fn lines(cases: &[Value]) -> Vec<String> {
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
            assert_eq!(within(size, 400), expected, "{size:?}");
        }
    }
}
