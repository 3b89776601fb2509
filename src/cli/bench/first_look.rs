//! Benchmark of the first look, in figures: the object's coverage and brightness, the share that shadows of the
//! chosen lights darken, hues, the visible share of the volume's box, whether a patient is seen from the front, and
//! the CPU time to find the look and to draw it under simplified and complete light, with bounds.

use serde_json::{Map, Value, json};

use super::report::round_to_microsecond;
use super::{MAX_FIGURE_SIZE, STEP_DEG, VolumeBenchmark};
use crate::cli::CliError;
use crate::cli::process::process_cpu_ms;
use chiaroscuro_render::{
    GpuContext, LightSearch, RenderOptions, Renderer, SearchedLight, dark_fraction, first_look,
    mean_luminance, shadowed_fraction, visible_fraction,
};
use chiaroscuro_scene::{
    LightSimplification, Settings, ShadowAlgorithm, first_look, lch_from_lab, oklab_from_linear,
};
use chiaroscuro_volume::{DataKind, Dataset, synthetic};

/// Built-in volume of the scene whose orbit frame is the unit of the bound, its edge in voxels, and that of its picture
/// in pixels: a sparse volume as large as that of the other cases.
const UNIT_VOLUME: &str = "chair";
const UNIT_VOXELS: usize = 256;
const UNIT_PIXELS: u32 = 512;

/// Number of orbit frames of that scene, of which the quickest counts.
const UNIT_FRAMES: usize = 4;

/// Bounds of the CPU time to a first picture under simplified light: orbit frames of that scene, and milliseconds
/// per voxel for reading and statistics.
const ORBIT_FRAMES: f64 = 10.0;
const VOXEL_MS: f64 = 0.25e-3;

/// Bound of the CPU time of complete light beyond that, in milliseconds for 800 × 600 pixels.
const SOFT_LIGHT_MS: f64 = 2000.0;

/// Chroma in Oklab from which a pixel has a hue, width of a class of hues in degrees, and share of the visible pixels
/// from which a class counts.
const MIN_CHROMA: f64 = 0.03;
const HUE_CLASS_DEG: f64 = 30.0;
const MIN_HUE_SHARE: f64 = 0.03;

/// Returns the CPU time of an orbit frame of a scene of 256 voxels, in milliseconds: the unit of the bound.
pub(super) fn unit_orbit_ms(context: &GpuContext) -> Result<f64, CliError> {
    let dataset = Dataset::new(synthetic::builtin(UNIT_VOLUME, Some(UNIT_VOXELS))?);
    let first = first_look::first_settings(dataset.volume(), dataset.histogram());
    let mut settings = LightSimplification::ALL.apply(&first);
    let mut renderer = Renderer::new(context)?;
    let mut quickest = f64::INFINITY;
    // The first frame fills the light volume.
    for frame in 0..=UNIT_FRAMES {
        settings.camera.azimuth_deg += STEP_DEG;
        let mut clock = CpuClock::start();
        renderer.draw(&dataset, &settings, [UNIT_PIXELS; 2], &RenderOptions::default())?;
        context.wait()?;
        if let Some(ms) = clock.lap().filter(|_| frame > 0) {
            quickest = quickest.min(ms);
        }
    }
    Ok(quickest)
}

/// Returns the number of classes of hues in a picture of linear, premultiplied light.
fn count_hues(light: &[[f32; 4]]) -> usize {
    let mut classes = [0usize; (360.0 / HUE_CLASS_DEG) as usize];
    let seen: Vec<_> = light.iter().filter(|texel| texel[3] > 0.5).collect();
    for [r, g, b, a] in &seen {
        let rgb = [r, g, b].map(|channel| f64::from(*channel / a));
        let [_, chroma, hue_deg] = lch_from_lab(oklab_from_linear(rgb));
        if chroma >= MIN_CHROMA {
            classes[(hue_deg.rem_euclid(360.0) / HUE_CLASS_DEG) as usize % classes.len()] += 1;
        }
    }
    classes.iter().filter(|count| **count as f64 >= MIN_HUE_SHARE * seen.len().max(1) as f64).count()
}

impl VolumeBenchmark<'_> {
    /// Measures the first look, independently of the look of the benchmark.
    ///
    /// `orbit_ms`: result of [`unit_orbit_ms`].
    pub(super) fn first_look(
        &mut self,
        orbit_ms: f64,
        cases: &mut Vec<Value>,
        ratios: &mut Map<String, Value>,
    ) -> Result<(), CliError> {
        let volume = self.loaded.volume();
        let mut cpu_ms = CpuClock::start();
        first_look::first_settings(volume, self.loaded.histogram());
        let found_ms = cpu_ms.lap();
        let first = first_look(&mut self.renderer, self.loaded)?;
        let first_ms = cpu_ms.lap();
        let found = LightSearch::new(self.renderer.shaders(), self.loaded, &first, SearchedLight::KeyAndRim)?
            .run()?;
        let search_ms = cpu_ms.lap();
        let settings = found.as_ref().map_or_else(|| first.clone(), |found| found.apply(&first));
        let [simple_ms, soft_ms] = self.draw_steps(&settings)?;
        let bounded = |measured: Option<f64>, bound: f64| json!({ "measured": measured.map(round_to_microsecond), "bound": round_to_microsecond(bound) });
        let total = [first_ms, search_ms, simple_ms].into_iter().sum::<Option<f64>>();
        ratios.insert(
            "first_picture_cpu_ms".to_owned(),
            bounded(total, ORBIT_FRAMES * orbit_ms + VOXEL_MS * volume.voxel_count() as f64),
        );
        ratios.insert("soft_light_cpu_ms".to_owned(), bounded(soft_ms, SOFT_LIGHT_MS));
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
            "simple_picture_cpu_ms": simple_ms,
            "soft_light_cpu_ms": soft_ms,
            "hues": count_hues(&with),
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

impl VolumeBenchmark<'_> {
    /// Returns the CPU times of the first full picture under simplified light, and of completing its light, in
    /// milliseconds.
    fn draw_steps(&self, look: &Settings) -> Result<[Option<f64>; 2], CliError> {
        let mut renderer = Renderer::with_shaders(self.renderer.context(), self.renderer.shaders())?;
        let mut clock = CpuClock::start();
        let mut draw = |look: &Settings| {
            renderer.draw(self.loaded, look, self.args.size, &RenderOptions::default())?;
            renderer.context().wait()?;
            Ok::<_, CliError>(clock.lap())
        };
        Ok([draw(&LightSimplification::ALL.apply(look))?, draw(look)?])
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
                "{:<24} {:>6} {:>8} {:>10} {:>6} {:>9} {:>4} {:>6} {:>5} {:>10} {:>10} {:>14} {:>6} {:>9} {:>9} {:>9} \
                 {:>9}",
                case["volume"].as_str().unwrap_or_default().chars().take(24).collect::<String>(),
                number("seen_share"),
                number("exposure"),
                number("mean_luminance"),
                number("dark_share"),
                number("shadowed_share"),
                case["hues"],
                yes_no("lights_moved"),
                yes_no("floor"),
                number("blockness"),
                from,
                case["kind"].as_str().unwrap_or_default(),
                case["labels_lost"].as_u64().map_or("–".to_owned(), |lost| lost.to_string()),
                milliseconds("found_cpu_ms"),
                milliseconds("search_cpu_ms"),
                milliseconds("simple_picture_cpu_ms"),
                milliseconds("soft_light_cpu_ms"),
            )
        })
        .collect();
    if !lines.is_empty() {
        lines.insert(
            0,
            "first look                 seen exposure  luminance   dark  shadowed hues  moved floor  blockness       \
              from           kind   lost  found ms search ms simple ms   soft ms"
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
