//! Cache of the histogram of values and of their changes, counted on a thread, and its picture.

use std::sync::{Arc, Weak};

use eframe::egui::{self, Color32, ColorImage, TextureHandle, TextureOptions};

use crate::app::common::volume_facts::VolumeFacts;
use crate::app::worker::jobs::{JobControl, JobKind, JobSlot};
use chiaroscuro_volume::{ChangeHistogram, Volume};

/// Histogram of a volume, with the texture that shows it.
#[derive(Default)]
pub(super) struct HistogramCache {
    counting: JobSlot<Option<ChangeHistogram>, Weak<Volume>>,
    /// Volume that was counted last, which is another one for another range of values, and its histogram; `None` if it
    /// could not be counted. A closed volume is not held.
    known: Option<(Weak<Volume>, Option<ChangeHistogram>)>,
    texture: Option<TextureHandle>,
}

impl std::fmt::Debug for HistogramCache {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("HistogramCache").field("counting", &self.counting).finish_non_exhaustive()
    }
}

impl HistogramCache {
    /// Takes a histogram that was counted, and begins to count that of a volume unless it is known.
    pub(super) fn update(&mut self, ctx: &egui::Context, volume: &VolumeFacts) {
        let wanted = Arc::downgrade(&volume.volume);
        if let Some((of, counted)) = self.counting.take_ended() {
            let histogram = counted.ok().flatten();
            let picture = histogram.as_ref().map(picture);
            self.texture =
                picture.map(|picture| ctx.load_texture("changes", picture, TextureOptions::LINEAR));
            self.known = Some((of, histogram));
        }
        self.known = self.known.take().filter(|(known, _)| known.ptr_eq(&wanted));
        if self.known.is_some() || self.counting.inputs().is_some_and(|of| of.ptr_eq(&wanted)) {
            return;
        }
        let of = Arc::clone(&volume.volume);
        let count = move |job: &JobControl| ChangeHistogram::from_volume(&of, job.token());
        if let Err(err) = self.counting.start(JobKind::Histogram, ctx, wanted, count) {
            log::warn!("changes of values cannot be counted: {err}");
        }
    }

    fn histogram(&self) -> Option<&ChangeHistogram> {
        self.known.as_ref()?.1.as_ref()
    }

    /// Returns the largest change of the axis, as a share of the range of values.
    pub(super) fn largest_change(&self) -> f64 {
        self.histogram().map_or(ASSUMED_LARGEST, |histogram| histogram.largest)
    }

    /// Returns the picture of the histogram, if it was counted.
    pub(super) fn texture(&self) -> Option<&TextureHandle> {
        self.texture.as_ref().filter(|_| self.histogram().is_some())
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
