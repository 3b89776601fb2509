//! Benchmark of loading: the time from a file to its first picture in another file, stage by stage, and the memory
//! that it takes.
//!
//! *Instance* and *device* open the adapter. *Read* ends when all voxels are decoded and in native byte order.
//! *Statistics* are computed from the voxels: the range of values and its robust part, content id, histogram, bounds
//! of bricks and cells, kind of data. *First look* chooses the settings, *light search* the lights and their
//! brightness by small pictures. *Upload* is the transfer to the adapter, with the pyramid. *Picture* fills the light
//! volumes and draws at full quality, *encoding* makes a PNG, and *file* writes it. *Shaders* is what all of them
//! waited for pipelines, which each repetition compiles anew, from the cache of the driver if it has one.
//!
//! `render` does the same, but opens the adapter while it reads.

use std::path::Path;
use std::time::Instant;

use serde_json::{Value, json};

use super::report::{CaseTimings, round_to_microsecond, spread_json};
use super::{BenchArgs, VolumeBenchmark, case_json};
use crate::cli::CliError;
use crate::cli::output::open_destination;
use crate::cli::process::StageTimes;
use crate::cli::scene::control_with_size_warning;
use chiaroscuro_files::{OutputDestination, write_atomically};
use chiaroscuro_media::encode_shown;
use chiaroscuro_render::{
    GpuContext, RenderOptions, RenderReport, RenderStage, Renderer, ShaderLibrary, WorkOptions,
    plan::RenderRequest,
};
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::{Dataset, LoadControl};

/// Names of the stages, in their order.
pub(super) const STAGES: [&str; 11] = [
    "instance",
    "device",
    "shaders",
    "read",
    "statistics",
    "upload",
    "first_look",
    "light_search",
    "picture",
    "encoding",
    "file",
];

/// Maximum number of frames: loading takes seconds, and a median needs no more.
const MAX_FRAMES: usize = 3;

/// Milliseconds of each of [`STAGES`], one per repetition.
#[derive(Debug, Default)]
struct LoadStageTimes([Vec<f64>; STAGES.len()]);

impl LoadStageTimes {
    /// Adds the times of a repetition, of the stages that it has.
    fn add(&mut self, took_ms: impl Fn(&str) -> Option<f64>) {
        for (stage, all) in STAGES.iter().zip(&mut self.0) {
            all.extend(took_ms(stage));
        }
    }

    fn json(&self) -> Value {
        STAGES.iter().zip(&self.0).map(|(name, all)| ((*name).to_owned(), spread_json(all))).collect()
    }
}

/// Memory on the adapter in bytes: in total, of light volumes, and at its peak.
#[derive(Debug, Default)]
struct AdapterMemory {
    all: u64,
    light: u64,
    peak: u64,
}

/// Renderer that has drawn the first picture of a file, with all that is freed with it.
struct FirstPicture {
    times: StageTimes,
    renderer: Renderer,
    report: RenderReport,
    _dataset: Dataset,
    _output: OutputDestination,
}

/// Stopwatch for the wall-clock time since the last call.
struct LapTimer(Instant);

impl LapTimer {
    fn start() -> Self {
        Self(Instant::now())
    }

    fn lap_ms(&mut self) -> f64 {
        let now = Instant::now();
        now.duration_since(std::mem::replace(&mut self.0, now)).as_secs_f64() * 1000.0
    }
}

/// Splits the time since the last call into reading the file and statistics gathered while reading, in milliseconds.
fn split_read_time(lap: &mut LapTimer, control: &LoadControl) -> [f64; 2] {
    let looking = control.analysis_time().as_secs_f64() * 1000.0;
    [lap.lap_ms() - looking, looking]
}

/// Times reading and statistics of files, which need no adapter.
pub(super) fn read(args: &BenchArgs, source: &Path, cases: &mut Vec<Value>) -> Result<(), CliError> {
    let mut stages = LoadStageTimes::default();
    // The first repetition fills the file cache and starts the threads.
    for frame in 0..=usize::from(args.frames) {
        let mut lap = LapTimer::start();
        let control = control_with_size_warning(source);
        let volume = args.look.read_volume(source, &control)?;
        let [read, mut looking] = split_read_time(&mut lap, &control);
        let (name, dims, voxel_type) =
            (volume.name().to_owned(), volume.dims(), volume.samples().voxel_type().name());
        let dataset = Dataset::new(volume);
        dataset.volume().kind();
        looking += lap.lap_ms();
        if frame > 0 {
            stages.add(|stage| match stage {
                "read" => Some(read),
                "statistics" => Some(looking),
                _ => None,
            });
        }
        if frame == usize::from(args.frames) {
            cases.push(json!({
                "name": "read",
                "volume": name,
                "dims": dims,
                "type": voxel_type,
                "frames": frame,
                "load_ms": stages.json(),
            }));
        }
    }
    Ok(())
}

/// Uploads a volume to the adapter without rendering a picture.
fn upload(renderer: &mut Renderer, loaded: &Dataset, settings: &Settings) -> Result<(), CliError> {
    let options = RenderOptions::from(WorkOptions { timed: true, ..WorkOptions::default() });
    let (volume, settings) = (loaded.id(), settings.clone());
    // The smallest size, since the picture is not drawn.
    let request = RenderRequest { volume, settings, size: [1; 2], preview_resolution: None };
    let mut job = renderer.begin(loaded, request, &options)?;
    while matches!(job.stage(), Some(RenderStage::Upload | RenderStage::Pyramid)) {
        job.step()?;
    }
    Ok(())
}

impl VolumeBenchmark<'_> {
    /// Times the way from a file, or the formula of a built-in volume, to its first picture at full quality in a file,
    /// and measures its memory.
    pub(super) fn load(
        &self,
        source: &Path,
        wants: impl Fn(&str) -> bool,
        cases: &mut Vec<Value>,
    ) -> Result<(), CliError> {
        let (mut samples, mut stages) = (CaseTimings::default(), LoadStageTimes::default());
        for frame in 0..=usize::from(self.args.frames).min(MAX_FRAMES) {
            let mut first = CaseTimings::default();
            let timings = if frame == 0 { &mut first } else { &mut samples };
            let mut last = None;
            timings.time(|| {
                let picture = self.first_picture(source)?;
                let report = picture.report.clone();
                // Freed after the clock has stopped.
                last = Some(picture);
                Ok::<_, CliError>(report)
            })?;
            let Some(FirstPicture { times, renderer, report, .. }) = last else { continue };
            if frame == 0 && wants("memory") {
                cases.push(self.memory(&AdapterMemory {
                    all: renderer.gpu_bytes(),
                    light: renderer.light_bytes(),
                    peak: report.peak_gpu_bytes,
                }));
                if !wants("load") {
                    return Ok(());
                }
            }
            if frame > 0 {
                stages.add(|stage| Some(times.ms(stage)));
            }
        }
        let mut case = case_json("load", self.loaded, self.args.size, &self.settings, &samples, 1);
        case["load_ms"] = stages.json();
        cases.push(case);
        Ok(())
    }

    /// Makes the first picture of a file, from the opening of the adapter on, and writes it to a temporary file.
    fn first_picture(&self, source: &Path) -> Result<FirstPicture, CliError> {
        let mut times = StageTimes::from_now();
        let output = open_destination(Path::new("-"), "png")?;
        let context = GpuContext::headless()?;
        times.end("device");
        times.attribute("device", "instance", context.opening_times().instance_ms);
        let shaders = ShaderLibrary::new(&context);
        times.end("shaders");
        let mut compiled = 0.0;
        let mut end = |times: &mut StageTimes, stage: &'static str| {
            times.end(stage);
            let compile_ms = shaders.compile_ms();
            times.attribute(stage, "shaders", compile_ms - std::mem::replace(&mut compiled, compile_ms));
        };
        let control = control_with_size_warning(source);
        let volume = self.args.look.read_volume(source, &control)?;
        times.end("read");
        times.attribute("read", "statistics", control.analysis_time().as_secs_f64() * 1000.0);
        let dataset = self.args.look.adapter_dataset(source, volume, &context)?;
        dataset.volume().kind();
        times.end("statistics");
        let look = self.args.look.look(&dataset)?;
        times.end("first_look");
        let mut renderer = Renderer::with_shaders(&context, shaders.clone())?;
        upload(&mut renderer, &dataset, &self.settings)?;
        let uploaded = renderer.report().upload_ms;
        end(&mut times, "upload");
        let settings = look.settings(&mut renderer, &dataset)?;
        end(&mut times, "light_search");
        let options = RenderOptions::from(WorkOptions { timed: true, ..WorkOptions::default() });
        renderer.draw(&dataset, &settings, self.args.size, &options)?;
        let mut report = renderer.report().clone();
        report.upload_ms += uploaded;
        let shown = renderer.read_display()?;
        end(&mut times, "picture");
        let bytes = encode_shown(self.args.size, &shown, false, None)?;
        times.end("encoding");
        write_atomically(output.path(), &bytes)?;
        times.end("file");
        Ok(FirstPicture { times, renderer, report, _dataset: dataset, _output: output })
    }

    fn memory(&self, &AdapterMemory { all, light, peak }: &AdapterMemory) -> Value {
        let volume = self.loaded.volume();
        let per_voxel = |bytes: u64| round_to_microsecond(bytes as f64 / volume.voxel_count() as f64);
        json!({
            "name": "memory",
            "volume": volume.name(),
            "dims": volume.dims(),
            "gpu_bytes": all,
            "peak_gpu_bytes": peak,
            "bytes_per_voxel": { "all": per_voxel(all), "light": per_voxel(light), "peak": per_voxel(peak) },
        })
    }
}

/// Formats the rows of the table of loading stages.
pub(super) fn load_table(cases: &[Value]) -> Vec<String> {
    let timed = cases.iter().filter(|case| case["load_ms"].is_object());
    let mut lines: Vec<String> = timed
        .map(|case| {
            let stage = |name: &&str| {
                let median = case["load_ms"][name]["median"].as_f64();
                format!(" {:>10}", median.map_or("–".to_owned(), |ms| format!("{ms:.1}")))
            };
            let [x, y, z] = [0, 1, 2].map(|axis| case["dims"][axis].as_u64().unwrap_or_default());
            let name = case["volume"].as_str().unwrap_or_default();
            let name: String = format!("{name} {x} x {y} x {z}").chars().take(40).collect();
            format!("{name:<40}{}", STAGES.iter().map(stage).collect::<String>())
        })
        .collect();
    if !lines.is_empty() {
        let names = STAGES.map(|name| format!(" {:>10}", name.replace('_', " "))).concat();
        lines.insert(0, format!("{:<40}{names}", "loading, ms"));
    }
    lines
}
