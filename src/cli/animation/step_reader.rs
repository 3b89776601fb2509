//! Reader of the time steps of a series, each with the look of the one that is open.

use std::path::Path;

use crate::cli::CliError;
use crate::cli::scene::SceneArgs;
use chiaroscuro_render::{GpuContext, downsample_to_fit};
use chiaroscuro_scene::VolumeRecord;
use chiaroscuro_volume::{Dataset, FileDimension, LoadControl, Volume, VolumeChoice};
use chiaroscuro_volume_io::{LoadOptions, StepReadOptions, TimeSteps};

/// Largest number of steps whose values are read before the first frame is drawn: those in between rarely have values
/// far beyond, and a long series is not read twice.
const MAX_RANGE_STEPS: usize = 16;

/// Reader of the time steps of a series.
pub(super) struct StepReader<'a> {
    steps: TimeSteps,
    /// Index of the step that is open.
    open_index: usize,
    options: LoadOptions,
    context: &'a GpuContext,
}

impl<'a> StepReader<'a> {
    /// Finds the time steps of a volume that is open: those that its file holds, or otherwise files with one step each.
    ///
    /// # Errors
    /// Returns an error if there is a single step.
    pub(super) fn new(
        scene: &SceneArgs,
        opened: &Dataset,
        context: &'a GpuContext,
    ) -> Result<Self, CliError> {
        let (path, contents) = (scene.source(), opened.volume().contents());
        let choice = contents.choice();
        let held = contents.alternatives_in(FileDimension::Frame);
        let found = match held.zip(TimeSteps::from_contents(path, contents)) {
            Some((held, steps)) => Some((steps, held.selected)),
            None => numbered_files(path, &choice),
        };
        let (steps, open_index) = found.ok_or_else(|| {
            CliError::Usage(format!(
                "{} holds one time step, and no other file in its folder has a name that differs in a number alone; \
                 give a file of several time steps, or one of numbered files such as t001.nrrd and t002.nrrd",
                path.display()
            ))
        })?;
        Ok(Self { steps, open_index, options: scene.load_options()?, context })
    }

    /// Returns the number of steps, at least two.
    pub(super) fn count(&self) -> u32 {
        u32::try_from(self.steps.count()).unwrap_or(u32::MAX)
    }

    /// Returns the files of all steps; a file with several is returned as often.
    pub(super) fn paths(&self) -> impl Iterator<Item = &Path> {
        (0..self.steps.count()).map(|index| self.steps.path(index))
    }

    /// Returns the open dataset with the ranges of values of the whole series, from at most [`MAX_RANGE_STEPS`] steps.
    /// `progress` is called with the number of steps that are read, and their total.
    ///
    /// # Errors
    /// When a step cannot be read.
    pub(super) fn with_series_ranges(
        &self,
        opened: &Dataset,
        mut progress: impl FnMut(usize, usize),
    ) -> Result<Dataset, CliError> {
        self.read(|by| {
            let shown = (opened, self.open_index);
            let read = self.steps.with_series_ranges(shown, MAX_RANGE_STEPS, by, &mut progress);
            read.map_err(|err| self.failure(err.index, err.source.into()))
        })
    }

    /// Reads a step, with the corrections and the ranges of values of `shown`, which is the open dataset.
    ///
    /// # Errors
    /// When the step cannot be read, or the corrections do not apply to it.
    pub(super) fn dataset(&self, shown: &Dataset, index: usize) -> Result<Dataset, CliError> {
        if index == self.open_index {
            return Ok(shown.clone());
        }
        self.read(|by| {
            let read = self.steps.open_like(index, shown, by);
            read.map_err(|err| self.failure(index, err.into()))
        })
    }

    /// Calls a function with the options for reading steps, which are downsampled where the adapter cannot hold them, as the
    /// open one is.
    fn read<T>(&self, function: impl FnOnce(&StepReadOptions<'_>) -> T) -> T {
        let fit = |whole: Volume| downsample_to_fit(self.context, whole.clone()).unwrap_or(whole);
        function(&StepReadOptions { load: &self.options, control: &LoadControl::new(), fit: &fit })
    }

    /// Returns the record of a step that has been read, for a picture in `folder`.
    pub(super) fn record(&self, step: &Dataset, index: usize, folder: Option<&Path>) -> VolumeRecord {
        let volume = step.volume();
        VolumeRecord::new(self.steps.path(index), volume.opened_id(), folder)
            .with_choice(volume.contents().choice())
            .with_layers_of(step, folder)
    }

    /// Names the step in an error.
    fn failure(&self, index: usize, source: CliError) -> CliError {
        let name = self.steps.name(index);
        let step = if name.is_empty() { index.to_string() } else { format!("{index} ({name})") };
        CliError::TimeStep { step, source: Box::new(source) }
    }
}

/// Returns the files that are numbered as `path` is, and its index among them; `None` if there is no other.
fn numbered_files(path: &Path, choice: &VolumeChoice) -> Option<(TimeSteps, usize)> {
    // Folders and names of built-in volumes may have numbers as well.
    let steps = TimeSteps::from_numbered_files(path, choice.clone()).filter(|_| path.is_file())?;
    let index = steps.index_of(path, choice)?;
    Some((steps, index))
}
