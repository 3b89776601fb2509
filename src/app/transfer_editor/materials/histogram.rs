//! Cache of the histogram of values and of their changes, counted on a thread, and its picture.

use std::sync::Arc;

use eframe::egui::{self, Color32, ColorImage, TextureHandle, TextureOptions};

use crate::app::common::volume_facts::VolumeFacts;
use crate::app::worker::jobs::{JobKind, JobSlot};
use chiaroscuro_volume::{ChangeHistogram, DensityMapping, Volume};

/// Volume and mapping of its values to densities, which the histogram is of.
#[derive(Debug, Clone)]
struct HistogramInputs {
    volume: Arc<Volume>,
    shown: DensityMapping,
}

impl HistogramInputs {
    fn new(volume: &VolumeFacts) -> Self {
        Self { volume: Arc::clone(&volume.volume), shown: volume.shown }
    }

    fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.volume, &other.volume) && self.shown == other.shown
    }
}

/// Histogram of a volume, with the texture that shows it.
#[derive(Default)]
pub(super) struct HistogramCache {
    counting: JobSlot<Option<ChangeHistogram>, HistogramInputs>,
    known: Option<(HistogramInputs, ChangeHistogram)>,
    texture: Option<TextureHandle>,
}

impl std::fmt::Debug for HistogramCache {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("HistogramCache").field("counting", &self.counting).finish_non_exhaustive()
    }
}

impl HistogramCache {
    /// Takes a histogram that was counted, and begins to count that of a volume unless it is known. An earlier one is
    /// shown meanwhile if it is of the same volume.
    pub(super) fn update(&mut self, ctx: &egui::Context, volume: &VolumeFacts) {
        let wanted = HistogramInputs::new(volume);
        if let Some((inputs, Ok(Some(histogram)))) = self.counting.take_ended() {
            self.texture = Some(ctx.load_texture("changes", picture(&histogram), TextureOptions::LINEAR));
            self.known = Some((inputs, histogram));
        }
        if self.known.as_ref().is_some_and(|(known, _)| !Arc::ptr_eq(&known.volume, &wanted.volume)) {
            self.known = None;
        }
        let is_known = self.known.as_ref().is_some_and(|(known, _)| known.is_same(&wanted));
        if is_known || self.counting.inputs().is_some_and(|inputs| inputs.is_same(&wanted)) {
            return;
        }
        let of = Arc::clone(&wanted.volume);
        let count =
            move |job: &crate::app::worker::jobs::JobControl| ChangeHistogram::from_volume(&of, job.token());
        if let Err(err) = self.counting.start(JobKind::Histogram, ctx, wanted, count) {
            log::warn!("changes of values cannot be counted: {err}");
        }
    }

    /// Returns the largest change of the axis, as a share of the range of values.
    pub(super) fn largest_change(&self) -> f64 {
        self.known.as_ref().map_or(ASSUMED_LARGEST, |(_, histogram)| histogram.largest)
    }

    /// Returns the picture of the histogram, if it was counted.
    pub(super) fn texture(&self) -> Option<&TextureHandle> {
        self.texture.as_ref().filter(|_| self.known.is_some())
    }
}

/// Largest change of the axis until the histogram is counted: a quarter of the values, at sharp borders of scans.
const ASSUMED_LARGEST: f64 = 0.25;

/// Returns the picture of a histogram, with the largest changes above: logarithmic, since borders have few voxels.
fn picture(histogram: &ChangeHistogram) -> ColorImage {
    let [columns, rows] = ChangeHistogram::SIZE;
    let most = f64::from(histogram.counts.iter().copied().max().unwrap_or(1)).ln_1p().max(1e-9);
    let pixel = |at: usize| {
        let (row, column) = (rows - 1 - at / columns, at % columns);
        let share = f64::from(histogram.counts[row * columns + column]).ln_1p() / most;
        Color32::from_white_alpha((share * 220.0).round() as u8)
    };
    ColorImage::new([columns, rows], (0..columns * rows).map(pixel).collect())
}
