//! Scene to export, and the time series of which its volume is a step.

use std::path::PathBuf;
use std::sync::Arc;

use crate::app::worker::request::VolumeFile;
use chiaroscuro_render::{GpuContext, downsample_to_fit};
use chiaroscuro_scene::{Settings, first_look::ObjectOutline};
use chiaroscuro_volume::{CancelToken, Dataset, LoadControl, Volume};
use chiaroscuro_volume_io::{LoadOptions, StepReadOptions, TimeSteps};

/// Scene to export: volume, settings and device.
#[derive(Debug, Clone)]
pub(crate) struct ExportScene {
    /// Window's device, of which the worker opens a sibling.
    pub context: GpuContext,
    /// Open volume with its derived data.
    pub dataset: Dataset,
    /// Settings of the whole look.
    pub settings: Settings,
    /// First look at the volume.
    pub first_look: Settings,
    /// Path or name that was opened.
    pub source: PathBuf,
    /// Index of the selected light, for a turntable of the light.
    pub selected_light: usize,
    /// Outline of the visible object, if it is known.
    pub outline: Option<Arc<ObjectOutline>>,
    /// Time series of which the open volume is one step, if it is.
    pub series: Option<ReadableSeries>,
    /// File of the volume, of which finer levels are read where pictures show them.
    pub file: Option<VolumeFile>,
}

/// Time steps, with what is needed to read them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ReadableSeries {
    /// Steps, one of which is open.
    pub steps: Arc<TimeSteps>,
    /// Options by which the open one was read.
    pub options: LoadOptions,
}

impl ReadableSeries {
    /// Reads a step, with the look of the one that is shown.
    pub(crate) fn read(
        &self,
        index: usize,
        shown: &Dataset,
        (context, token): (&GpuContext, &CancelToken),
    ) -> Result<Dataset, String> {
        self.read_by(shown, (context, token), |by| {
            self.steps.open_like(index, shown, by).map_err(|err| err.to_string())
        })
    }

    /// Calls a function with the options for reading steps, which are averaged if the one that is shown had to be.
    pub(crate) fn read_by<T>(
        &self,
        shown: &Dataset,
        (context, token): (&GpuContext, &CancelToken),
        function: impl FnOnce(&StepReadOptions<'_>) -> T,
    ) -> T {
        let is_averaged = shown.volume().dims() != shown.volume().file_dims();
        let fit = |volume: Volume| {
            let fitting = is_averaged.then(|| downsample_to_fit(context, volume.clone()));
            fitting.and_then(Result::ok).unwrap_or(volume)
        };
        let control = LoadControl::with_token(token.clone());
        function(&StepReadOptions { load: &self.options, control: &control, fit: &fit })
    }
}
