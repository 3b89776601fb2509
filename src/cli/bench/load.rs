//! Benchmark of loading: the time from a file to its first picture, stage by stage, and the memory that it takes.
//!
//! *Read* ends when all voxels are decoded and in native byte order. *Statistics* are computed from the voxels: the
//! range of values and its robust part, content id, histogram, bounds of bricks and cells, kind of data. *Upload* is
//! the transfer to the adapter, with the pyramid. *First look* is the additional time for the automatic look, and
//! *picture* that for a light volume and a picture at full quality.

use std::path::Path;
use std::time::Instant;

use serde_json::{Value, json};

use super::report::{CaseTimings, round_to_microsecond, spread_json};
use super::{BenchArgs, VolumeBenchmark, case_json};
use crate::cli::CliError;
use crate::cli::scene::control_with_size_warning;
use chiaroscuro_render::{
    GpuContext, RenderOptions, RenderStage, Renderer, ShaderLibrary, WorkOptions, first_look,
    plan::RenderRequest,
};
use chiaroscuro_scene::{Settings, first_look};
use chiaroscuro_volume::{Dataset, LoadControl};

/// Names of the stages, in their order.
pub(super) const STAGES: [&str; 5] = ["read", "statistics", "upload", "first_look", "picture"];

/// Maximum number of frames: loading takes seconds, and a median needs no more.
const MAX_FRAMES: usize = 3;

/// Milliseconds of each of [`STAGES`], one per repetition.
#[derive(Debug, Default)]
struct LoadStageTimes([Vec<f64>; STAGES.len()]);

impl LoadStageTimes {
    fn add(&mut self, took_ms: &[f64]) {
        for (all, &took) in self.0.iter_mut().zip(took_ms) {
            all.push(took);
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
            stages.add(&[read, looking]);
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
    let (volume, settings) = (loaded.volume().id(), settings.clone());
    // The smallest size, since the picture is not drawn.
    let request = RenderRequest { volume, settings, size: [1; 2], preview_resolution: None };
    let mut job = renderer.begin(loaded, request, &options)?;
    while matches!(job.stage(), Some(RenderStage::Upload | RenderStage::Pyramid)) {
        job.step()?;
    }
    Ok(())
}

impl VolumeBenchmark<'_> {
    /// Times the way from a file, or the formula of a built-in volume, to its first picture at full quality, and
    /// measures its memory. Pipelines are compiled beforehand.
    pub(super) fn load(
        &self,
        context: &GpuContext,
        source: &Path,
        wants: impl Fn(&str) -> bool,
        cases: &mut Vec<Value>,
    ) -> Result<(), CliError> {
        let shaders = ShaderLibrary::new(context);
        let (mut samples, mut stages) = (CaseTimings::default(), LoadStageTimes::default());
        let options = RenderOptions::from(WorkOptions { timed: true, ..WorkOptions::default() });
        for frame in 0..=usize::from(self.args.frames).min(MAX_FRAMES) {
            let mut took = [0.0; STAGES.len()];
            let mut bytes = AdapterMemory::default();
            let mut warm_up = CaseTimings::default();
            let keep = if frame == 0 { &mut warm_up } else { &mut samples };
            let mut loaded = None;
            keep.time(|| {
                let mut lap = LapTimer::start();
                let control = control_with_size_warning(source);
                let volume = self.args.look.read_volume(source, &control)?;
                [took[0], took[1]] = split_read_time(&mut lap, &control);
                let dataset = self.args.look.adapter_dataset(source, volume, context)?;
                dataset.volume().kind();
                took[1] += lap.lap_ms();
                let mut renderer = Renderer::with_shaders(context, shaders.clone())?;
                upload(&mut renderer, &dataset, &self.settings)?;
                let uploaded = renderer.report().upload_ms;
                took[2] = lap.lap_ms();
                renderer.draw(&dataset, &self.settings, self.args.size, &options)?;
                took[4] = lap.lap_ms();
                let mut report = renderer.report().clone();
                report.upload_ms += uploaded;
                bytes = AdapterMemory {
                    all: renderer.gpu_bytes(),
                    light: renderer.light_bytes(),
                    peak: report.peak_gpu_bytes,
                };
                loaded = Some(dataset);
                Ok::<_, CliError>(report)
            })?;
            if frame == 0 && wants("memory") {
                cases.push(self.memory(&bytes));
                if !wants("load") {
                    return Ok(());
                }
            }
            if let Some(dataset) = loaded {
                took[3] = first_look_ms(context, &shaders, &dataset)?;
            }
            if frame > 0 {
                stages.add(&took);
            }
        }
        let mut case = case_json("load", self.loaded, self.args.size, &self.settings, &samples, 1);
        case["load_ms"] = stages.json();
        cases.push(case);
        Ok(())
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

/// Returns the time of a first look, in milliseconds, for a volume that has been uploaded but nothing else.
fn first_look_ms(context: &GpuContext, shaders: &ShaderLibrary, dataset: &Dataset) -> Result<f64, CliError> {
    let mut renderer = Renderer::with_shaders(context, shaders.clone())?;
    let settings = first_look::first_settings(dataset.volume(), dataset.histogram());
    upload(&mut renderer, dataset, &settings)?;
    let mut lap = LapTimer::start();
    first_look(&mut renderer, dataset)?;
    Ok(lap.lap_ms())
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
