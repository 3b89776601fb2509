//! Loader of volumes: opens files on a separate thread, up to the first look.

mod load_job;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui;

use self::load_job::LoadJob;
use super::jobs::{JobControl, JobKind, JobProgress, JobSlot};
use super::memory_estimate::{MemoryEstimate, PendingMemoryDecision, memory_checking_control};
use super::warm_up::PipelineWarmUp;
use crate::app::persistence::{CorrectedFile, FileStamp};
use crate::app::text;
use chiaroscuro_render::{GpuContext, Renderer, ShaderLibrary};
use chiaroscuro_scene::{SceneAxis, Settings};
use chiaroscuro_volume::{Dataset, LoadControl, VolumeChoice, memory_budget_bytes};
use chiaroscuro_volume_io::{LoadOptions, RawFormat, RawGuess};

/// Options for reading a volume that the user has chosen.
#[derive(Debug, Clone, Default)]
pub(crate) struct ReadChoices {
    /// Format of the voxels in a headerless (raw) file.
    pub raw: Option<RawFormat>,
    /// Choice among several volumes of a file, and of the portion that is read.
    pub choice: Option<VolumeChoice>,
    /// True if the volume may use all free memory.
    pub takes_all_memory: bool,
    /// Subset of a folder's files that are opened.
    pub subset: Option<Arc<[PathBuf]>>,
}

/// Settings of a file that were remembered from earlier sessions.
#[derive(Debug, Clone, Default)]
pub(crate) struct RememberedFileSettings {
    /// Axis of the scene that points up, unless the file defines one; `None` without a choice.
    pub up: Option<SceneAxis>,
    /// Corrections that were applied to the volume.
    pub corrections: Option<CorrectedFile>,
}

/// Opened volume that is ready to be displayed.
#[derive(Debug)]
pub(crate) struct OpenedVolume {
    /// Path of the file, or name of a built-in volume.
    pub source: PathBuf,
    /// Options with which the volume was read.
    pub reading: ReadChoices,
    /// Dataset of the volume, downsampled no more than the adapter requires.
    pub dataset: Dataset,
    /// Original number of voxels along x, y and z, if the volume was downsampled to fit the adapter.
    pub original_dims: Option<[usize; 3]>,
    /// Renderer that has the volume on the GPU.
    pub renderer: Renderer,
    /// Settings of the first look.
    pub settings: Settings,
    /// Size and modification time of the file before it was read.
    pub stamp: FileStamp,
}

/// Result of an attempt to open a volume.
#[derive(Debug)]
pub(crate) enum LoadOutcome {
    /// The volume was opened.
    Opened(Box<OpenedVolume>),
    /// The user cancelled the attempt.
    Cancelled,
    /// A file of bare voxels whose format is unknown or does not match.
    UnknownRawFormat { path: PathBuf, why: String, guess: RawGuess },
    /// The volume barely fits into memory, or does not, and the user must choose a portion of it.
    NeedsMemoryDecision { source: PathBuf, reading: Box<ReadChoices>, weighed: MemoryEstimate },
    /// A volume that was open in an earlier window has been uploaded to the device of this one.
    Uploaded { renderer: Box<Renderer>, dataset: Dataset },
    /// Loading failed: message in one line, and all details.
    Failed { short: String, details: String },
}

/// Volume that is being opened.
#[derive(Debug)]
struct LoadInputs {
    source: PathBuf,
    reading: ReadChoices,
    control: Arc<LoadControl>,
}

/// Progress of the volume that is being opened.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LoadProgress<'a> {
    /// Path of the volume, and the options for reading it.
    pub source: &'a Path,
    pub reading: &'a ReadChoices,
    /// Description of the current phase.
    pub phase: &'static str,
    /// Completed fraction of the phase, 0 to 1, if it is known.
    pub fraction: Option<f32>,
    /// Bytes of voxels read so far and in total, during the reading phase.
    pub bytes: Option<[u64; 2]>,
}

/// Loader that opens one volume at a time; a new request replaces the previous one.
#[derive(Debug)]
pub(crate) struct Loader {
    context: GpuContext,
    /// Shader pipelines of the device, shared by the renderers of all volumes.
    shaders: ShaderLibrary,
    options: LoadOptions,
    running: JobSlot<LoadOutcome, LoadInputs>,
    warm_up: PipelineWarmUp,
}

/// Names of the phases, for the status bar; a load reports the index of its phase as its progress.
const PHASES: [&str; 5] = [
    text::opening::READING,
    text::opening::MEASURING_ADAPTER,
    text::opening::COUNTING,
    text::opening::UPLOADING,
    text::opening::FIRST_LOOK,
];

impl Loader {
    /// Creates a loader for volumes to be displayed on a device, and begins to compile its pipelines.
    pub(crate) fn new(
        context: GpuContext,
        options: LoadOptions,
        storage: Option<&Path>,
        ctx: &egui::Context,
    ) -> std::io::Result<Self> {
        let shaders = storage.map_or_else(
            || ShaderLibrary::new(&context),
            |folder| ShaderLibrary::with_cache(&context, &folder.join("pipelines")),
        );
        let mut warm_up = PipelineWarmUp::default();
        warm_up.start(&shaders, ShaderLibrary::warm_up, ctx)?;
        Ok(Self { context, shaders, options, running: JobSlot::default(), warm_up })
    }

    /// Creates a loader for the device of a library of pipelines, which compiles none before they are needed.
    pub(crate) fn with_pipelines(shaders: ShaderLibrary, options: LoadOptions) -> Self {
        let (context, mut warm_up) = (shaders.context().clone(), PipelineWarmUp::default());
        warm_up.is_complete = true;
        Self { context, shaders, options, running: JobSlot::default(), warm_up }
    }

    /// Returns the shader pipelines of the device that renders pictures.
    pub(crate) fn shaders(&self) -> &ShaderLibrary {
        &self.shaders
    }

    /// Compiles pipelines that may be needed later, once; to be called when the window is idle.
    pub(crate) fn warm_up_rest(&mut self, ctx: &egui::Context) {
        self.warm_up.start_rest(&self.shaders, ctx);
    }

    /// Starts to open a file or a built-in volume, with the corrections and the up axis that are remembered for it.
    pub(crate) fn open_on_thread(
        &mut self,
        source: &Path,
        reading: ReadChoices,
        known: RememberedFileSettings,
        ctx: &egui::Context,
    ) -> Result<(), String> {
        self.cancel();
        let mut options = self.options.clone();
        // Limited to the memory that is free now.
        options.memory_budget_bytes = options.memory_budget_bytes.min(memory_budget_bytes());
        let question = PendingMemoryDecision::default();
        let control = Arc::new(if reading.takes_all_memory {
            options.memory_budget_bytes = options.memory_budget_bytes / 3 * 4;
            LoadControl::new()
        } else {
            memory_checking_control(self.context.clone(), options.memory_budget_bytes, question.clone())
        });
        options.raw = reading.raw.unwrap_or(options.raw);
        options.choice = reading.choice.clone().unwrap_or(options.choice);
        options.only_files.clone_from(&reading.subset);
        options.level = options.level.or_beside_pages(self.context.is_software());
        let opening = LoadJob {
            source: source.to_owned(),
            reading: reading.clone(),
            known,
            options,
            context: self.context.clone(),
            shaders: self.shaders.clone(),
            control: Arc::clone(&control),
            question,
        };
        let inputs = LoadInputs { source: source.to_owned(), reading, control };
        self.start(inputs, 0, ctx, move |job| job.token().run(|| load_job::open(opening, job)))
    }

    /// Displays a volume that is already in memory on this device.
    pub(crate) fn upload(&mut self, dataset: Dataset, ctx: &egui::Context) -> Result<(), String> {
        self.cancel();
        let (context, shaders) = (self.context.clone(), self.shaders.clone());
        let source = PathBuf::from(dataset.volume().name());
        let short = text::opening::not_shown(&source);
        let inputs = LoadInputs { source, reading: ReadChoices::default(), control: Arc::default() };
        self.start(inputs, 3, ctx, move |_| match Renderer::with_shaders(&context, shaders) {
            Ok(renderer) => LoadOutcome::Uploaded { renderer: Box::new(renderer), dataset },
            Err(err) => LoadOutcome::Failed { short, details: err.to_string() },
        })
    }

    /// Starts a load in one of the [`PHASES`].
    fn start(
        &mut self,
        inputs: LoadInputs,
        phase: u32,
        ctx: &egui::Context,
        task: impl FnOnce(&JobControl) -> LoadOutcome + Send + 'static,
    ) -> Result<(), String> {
        let begin = JobProgress { done: phase, ..JobProgress::default() };
        let control = JobControl::with_token(inputs.control.token().clone(), begin);
        self.running.start_with(JobKind::Load, ctx, control, inputs, task).map_err(text::opening::no_thread)
    }

    /// Returns the options with which files are read.
    pub(crate) fn options(&self) -> &LoadOptions {
        &self.options
    }

    /// Cancels opening; the current volume stays.
    pub(crate) fn cancel(&self) {
        self.running.cancel();
    }

    /// Takes the result, if the attempt has ended; returns it only once.
    pub(crate) fn take_outcome(&mut self) -> Option<LoadOutcome> {
        if self.running.is_cancelled() {
            self.running.discard(); // Its thread notices the cancellation at the next piece of work and ends.
            return Some(LoadOutcome::Cancelled);
        }
        let (inputs, result) = self.running.take_ended()?;
        Some(result.unwrap_or_else(|panic| LoadOutcome::Failed {
            short: text::opening::loader_panicked(&inputs.source),
            details: text::opening::panic_details(&panic),
        }))
    }

    /// Returns the progress of the volume that is being opened.
    pub(crate) fn progress(&self) -> Option<LoadProgress<'_>> {
        let LoadInputs { source, reading, control } = self.running.inputs()?;
        let phase = (self.running.progress()?.done as usize).min(PHASES.len() - 1);
        let read = control.bytes().filter(|_| phase == 0);
        // After the last byte has been read, the values are counted.
        let bytes = read.filter(|[done, total]| done < total);
        let phase = if read.is_some() && bytes.is_none() { 2 } else { phase };
        Some(LoadProgress {
            source,
            reading,
            phase: PHASES[phase],
            fraction: bytes.map(|[done, total]| done as f32 / total as f32),
            bytes,
        })
    }
}
