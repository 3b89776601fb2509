//! Command `chiaroscuro bench`: times pictures and light volumes, and compares them within one run.
//!
//! Cases: *orbit* (shadows from the cache) and *orbit-unshadowed*, with alternating frames; *light-drag* (the light
//! moves, so its volume is filled for every frame); *light-build* (the two halves of the light pass of those frames);
//! *tf-edit* (a transfer function changes); *cut-edit* (a cut by a shape moves); *background* (only the background does); *load* (from a file to its first
//! picture, stage by stage) and *memory*; *read* (the stages of *load* that need no adapter); *growth* (light volumes
//! of clouds of growing size, splatted and by rays, with all optimisations and without); *sky*, *area* and
//! *scattering* (light volumes of the sky, of area lights and of multiple scattering, in units of one light's);
//! *paper* (the table of P §5: light volume and picture by each of the three shadow algorithms); *first-look*
//! (figures of the picture that a volume is opened with).

use std::path::PathBuf;

use clap::Args;
use serde_json::{Value, json};

mod area_lights;
mod edits;
mod first_look;
mod growth;
mod load;
mod paper;
mod report;
mod scattering;
mod sky;

use super::CliError;
use super::output::print_line;
use super::scene::{LookArgs, control_with_size_warning, parse_size};
use chiaroscuro_render::{GpuContext, RenderOptions, Renderer, WorkOptions};
use chiaroscuro_scene::{
    LightVolumeResolution, NearFieldRay, ReconstructionKernel, Settings, ShadowAlgorithm,
};
use chiaroscuro_volume::Dataset;
use report::{CaseTimings, round_to_microsecond};

/// Number of untimed frames at the start, which compile pipelines and fill caches.
const WARM_UP_FRAMES: usize = 2;

/// Rotation of the camera or light per frame, in degrees.
const STEP_DEG: f64 = 12.0;

/// Names of the benchmark cases.
const CASES: [&str; 15] = [
    "orbit",
    "light-drag",
    "light-build",
    "tf-edit",
    "cut-edit",
    "background",
    "load",
    "read",
    "memory",
    "growth",
    "paper",
    "sky",
    "area",
    "scattering",
    "first-look",
];

/// Longest edge of pictures from which only figures are computed, in pixels.
const MAX_FIGURE_SIZE: u32 = 400;

/// Arguments of `bench`.
#[derive(Debug, Args)]
pub(super) struct BenchArgs {
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    // Not a doc comment, here and at other volumes: rustdoc takes [:N] for a link.
    #[arg(
        long = "volume",
        value_name = "FILE",
        default_value = "builtin:chair:128",
        help = "Volume: a file, or builtin:NAME[:N]; may be repeated"
    )]
    volumes: Vec<PathBuf>,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "512x512", value_parser = parse_size)]
    size: [u32; 2],
    /// Timed frames per case
    #[arg(long, default_value_t = 7, value_parser = clap::value_parser!(u16).range(1..=1000))]
    frames: u16,
    /// Run only this case; growth (takes minutes), first-look, read, sky, area and scattering run only if they are
    /// named here
    #[arg(long, value_name = "CASE", value_parser = CASES)]
    only: Option<String>,
    /// Allow cases that are not rendered at full resolution and quality
    #[arg(long)]
    reduced: bool,
    #[command(flatten)]
    look: LookArgs,
}

/// Runs the selected cases and prints their results.
pub(super) fn run(args: &BenchArgs) -> Result<(), CliError> {
    let wants = |case: &str| {
        args.only
            .as_deref()
            .map_or(!["growth", "first-look", "sky", "area", "scattering"].contains(&case), |only| {
                only == case
            })
    };
    let mut cases = Vec::new();
    if args.only.as_deref() == Some("read") {
        for volume in &args.volumes {
            load::read(args, volume, &mut cases)?;
        }
        return print_result(args, &json!({ "cases": cases, "ratios": {} }));
    }
    let mut ratios = serde_json::Map::new();
    let context = GpuContext::headless()?;
    let mut orbits = Vec::new();
    let mut unit_orbit_ms = None;
    for volume in args.volumes.iter().filter(|_| args.only.as_deref() != Some("growth")) {
        let opened = args.look.read_volume(volume, &control_with_size_warning(volume))?;
        let loaded = args.look.adapter_dataset(volume, opened, &context)?;
        let mut renderer = Renderer::new(&context)?;
        let settings = args.look.look(&loaded)?.settings(&mut renderer, &loaded)?;
        let mut bench = VolumeBenchmark { args, loaded: &loaded, renderer, settings };
        let mut found = serde_json::Map::new();
        if wants("orbit") || wants("light-drag") || wants("light-build") {
            let (with, without) = bench.orbit(&mut cases)?;
            orbits.push(with.cost());
            found.insert(
                "shadowed_over_unshadowed_frame".to_owned(),
                json!(round_to_microsecond(with.cost() / without.cost())),
            );
            if wants("light-drag") || wants("light-build") {
                let drag = bench.light_drag(&mut cases)?;
                let ratio = drag.light_build() / without.eye();
                found.insert(
                    "light_build_over_unshadowed_frame".to_owned(),
                    json!(round_to_microsecond(ratio)),
                );
            }
        }
        if wants("tf-edit") {
            bench.transfer_edit(&mut cases)?;
        }
        if wants("cut-edit") {
            bench.cut_edit(&mut cases)?;
        }
        if wants("background") {
            bench.background(&mut cases)?;
        }
        if wants("load") || wants("memory") {
            bench.load(volume, wants, &mut cases)?;
        }
        if wants("paper") {
            bench.paper(&mut cases, &mut found)?;
        }
        if wants("area") {
            bench.area_lights(&mut cases, &mut found)?;
        }
        if wants("sky") {
            bench.sky(&mut cases, &mut found)?;
        }
        if wants("scattering") {
            bench.scattering(&mut cases, &mut found)?;
        }
        if wants("first-look") {
            let orbit_ms = match unit_orbit_ms {
                Some(known_ms) => known_ms,
                None => first_look::unit_orbit_ms(&context)?,
            };
            unit_orbit_ms = Some(orbit_ms);
            bench.first_look(orbit_ms, &mut cases, &mut found)?;
        }
        let several = args.volumes.len() > 1;
        let name = |ratio| if several { format!("{}: {ratio}", loaded.volume().name()) } else { ratio };
        ratios.extend(found.into_iter().map(|(ratio, value)| (name(ratio), value)));
    }
    if wants("growth") {
        growth::run(&context, usize::from(args.frames), &mut cases, &mut ratios)?;
    }
    if let [first, .., last] = orbits[..] {
        ratios.insert(
            "orbit_frame_last_volume_over_first".to_owned(),
            json!(round_to_microsecond(last / first)),
        );
    }
    if let Some(case) = cases.iter().find(|case| case["full_quality"] == false)
        && !args.reduced
    {
        return Err(CliError::Usage(format!(
            "case {} was not rendered at full resolution and quality ({}); use full settings, or --reduced to \
             measure it anyway",
            case["name"], case["rendered"],
        )));
    }
    let result = json!({
        "adapter": context.info.name,
        "driver": format!("{} {}", context.info.driver, context.info.driver_info).trim(),
        "cases": cases,
        "ratios": ratios,
    });
    print_result(args, &result)
}

fn print_result(args: &BenchArgs, result: &Value) -> Result<(), CliError> {
    if args.json { print_line(&result.to_string()) } else { print_table(result) }
}

struct VolumeBenchmark<'a> {
    args: &'a BenchArgs,
    loaded: &'a Dataset,
    renderer: Renderer,
    settings: Settings,
}

impl VolumeBenchmark<'_> {
    /// Draws a frame without reading it back, as the viewer does.
    fn frame(&mut self, settings: &Settings, samples: Option<&mut CaseTimings>) -> Result<(), CliError> {
        let options = RenderOptions::from(WorkOptions { timed: true, ..WorkOptions::default() });
        let size = self.args.size;
        let mut draw = || {
            self.renderer.draw(self.loaded, settings, size, &options)?;
            Ok::<_, CliError>(self.renderer.report().clone())
        };
        match samples {
            Some(samples) => samples.time(draw),
            None => draw().map(|_| ()),
        }
    }

    /// Number of frames of a case that is timed by [`Self::alternate`].
    fn alternating_frames(&self) -> std::ops::Range<usize> {
        0..WARM_UP_FRAMES + 2 * usize::from(self.args.frames)
    }

    /// Draws frame number `frame` of a case. After those of the warm-up, frames are drawn as users see them, of which
    /// the whole is timed, and waiting after each step, of which the stages are. Returns true if the whole was timed.
    fn alternate(
        &mut self,
        frame: usize,
        settings: &Settings,
        samples: &mut CaseTimings,
    ) -> Result<bool, CliError> {
        if frame >= WARM_UP_FRAMES && frame % 2 == 1 {
            self.frame(settings, None)?;
            samples.add_stages(self.renderer.report());
            return Ok(false);
        }
        let mut draw = || {
            self.renderer.draw(self.loaded, settings, self.args.size, &RenderOptions::default())?;
            Ok::<_, CliError>(self.renderer.report().clone())
        };
        if frame < WARM_UP_FRAMES {
            return draw().map(|_| false);
        }
        let report = samples.time_whole(draw)?;
        samples.add_host(&report);
        Ok(true)
    }

    /// Times an orbit of the camera, alternately with and without shadows, so that other load on the machine slows
    /// both alike.
    fn orbit(&mut self, cases: &mut Vec<Value>) -> Result<(CaseTimings, CaseTimings), CliError> {
        let (mut with, mut without) = (CaseTimings::default(), CaseTimings::default());
        let mut rebuilds = 0;
        for frame in self.alternating_frames() {
            let mut settings = self.settings.clone();
            settings.camera.azimuth_deg += STEP_DEG * frame as f64;
            let mut unshadowed = settings.clone();
            unshadowed.shadows.algorithm = ShadowAlgorithm::Off;
            let before: u64 = self.renderer.light_rebuilds().iter().sum();
            self.alternate(frame, &settings, &mut with)?;
            if self.alternate(frame, &unshadowed, &mut without)? {
                rebuilds += self.renderer.light_rebuilds().iter().sum::<u64>() - before;
            }
        }
        cases.push(self.case("orbit", &with, rebuilds));
        cases.push(self.case("orbit-unshadowed", &without, 0));
        Ok((with, without))
    }

    /// Times frames in which the first light turns about the vertical axis.
    fn light_drag(&mut self, cases: &mut Vec<Value>) -> Result<CaseTimings, CliError> {
        let mut samples = CaseTimings::default();
        let mut rebuilds = 0;
        for frame in self.alternating_frames() {
            let mut settings = self.settings.clone();
            if let Some(light) = settings.lights.first_mut() {
                let turn = glam::DQuat::from_rotation_z((STEP_DEG * (frame + 1) as f64).to_radians());
                light.position = (turn * glam::DVec3::from(light.position)).into();
            }
            let before: u64 = self.renderer.light_rebuilds().iter().sum();
            if self.alternate(frame, &settings, &mut samples)? {
                rebuilds += self.renderer.light_rebuilds().iter().sum::<u64>() - before;
            }
        }
        cases.push(self.case("light-drag", &samples, rebuilds));
        let mut build = self.case("light-build", &samples, rebuilds);
        build["wall_ms"] = json!({ "median": round_to_microsecond(samples.light_build()) });
        build["cpu_ms"] = Value::Null;
        build["host_ms"] = Value::Null;
        cases.push(build);
        Ok(samples)
    }

    fn case(&self, name: &str, samples: &CaseTimings, rebuilds: u64) -> Value {
        case_json(name, self.loaded, self.args.size, &self.settings, samples, rebuilds)
    }
}

fn case_json(
    name: &str,
    loaded: &Dataset,
    size: [u32; 2],
    settings: &Settings,
    samples: &CaseTimings,
    rebuilds: u64,
) -> Value {
    let mut case = json!({
        "name": name,
        "volume": loaded.volume().name(),
        "dims": loaded.volume().dims(),
        "size": size,
        "light_rebuilds": rebuilds,
        "rendered": {
            "kernel": settings.sampling.kernel,
            "slab": settings.sampling.slab,
            "slabs": settings.sampling.slabs,
            "light_kernel": settings.shadows.kernel,
            "light_slab": settings.shadows.slab,
            "light_resolution": settings.shadows.resolution,
            "file_dims": loaded.volume().file_dims(),
        },
        "full_quality": is_full_quality(settings)
            && samples.is_full_resolution(size)
            && loaded.volume().dims() == loaded.volume().file_dims(),
    });
    if let (Value::Object(case), Value::Object(timings)) = (&mut case, samples.json()) {
        case.extend(timings);
    }
    case
}

/// Returns true if settings use exact kernels, slabs no thicker than voxels and light volumes of full resolution.
/// Light volumes may use the prefiltered kernel if near-field rays restore the blurred detail.
fn is_full_quality(settings: &Settings) -> bool {
    let (sampling, shadows) = (&settings.sampling, &settings.shadows);
    let exact =
        |kernel: ReconstructionKernel, slab: f64| kernel != ReconstructionKernel::Prefiltered && slab <= 1.0;
    exact(sampling.kernel, sampling.slab)
        && (exact(shadows.kernel, shadows.slab)
            || settings.effective_near_field() != NearFieldRay::Off && shadows.slab <= 1.0)
        && shadows.resolution == LightVolumeResolution::Full
}

fn print_table(result: &Value) -> Result<(), CliError> {
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    if result["adapter"].is_string() {
        print_line(&format!("{} ({})", text(&result["adapter"]), text(&result["driver"])))?;
    }
    let cases = result["cases"].as_array().map_or(&[][..], Vec::as_slice);
    for line in first_look::first_look_table(cases).iter().chain(&load::load_table(cases)) {
        print_line(line)?;
    }
    // The first-look and read cases have tables of their own.
    let has_own_table = |case: &&Value| case["name"] == "first-look" || case["name"] == "read";
    let timed: Vec<&Value> = cases.iter().filter(|case| !has_own_table(case)).collect();
    if !timed.is_empty() {
        print_line(
            "case                        volume         wall ms    cpu ms  host ms    eye    march  back-project     rays",
        )?;
    }
    for case in timed {
        let number = |value: &Value| value.as_f64().map_or("–".to_owned(), |ms| format!("{ms:.1}"));
        print_line(&format!(
            "{:<27} {:<13} {:>8} {:>9} {:>8} {:>6} {:>8} {:>13} {:>8}",
            text(&case["name"]),
            format!("{} {}", text(&case["volume"]), case["dims"][0]),
            number(&case["wall_ms"]["median"]),
            number(&case["cpu_ms"]["median"]),
            case["host_ms"]["median"].as_f64().map_or("–".to_owned(), |ms| format!("{ms:.2}")),
            number(&case["stages"]["eye"]),
            number(&case["stages"]["light_march"]),
            number(&case["stages"]["light_backproject"]),
            number(&case["stages"]["light_raycast"]),
        ))?;
    }
    let memory = |case: &&Value| case["name"] == "memory";
    for case in result["cases"].as_array().into_iter().flatten().filter(memory) {
        print_line(&format!("memory of {}: {} bytes per voxel", case["volume"], case["bytes_per_voxel"]))?;
    }
    for (name, ratio) in result["ratios"].as_object().into_iter().flatten() {
        print_line(&format!("{name:<40} {ratio}"))?;
    }
    Ok(())
}
