//! Statistics and state of the renderer, for display in the rest of the window.

use crate::app::viewport::Viewport;
use crate::app::worker::request::Looks;
use crate::data::plain;
use crate::gpu::{LightFigures, Stage};
use crate::model::MAX_NAME;

/// Activity of the renderer, for the status bar.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::app) enum Doing {
    /// No volume is open.
    Nothing,
    /// The picture on screen has the quality of an export.
    FullQuality,
    /// A coarser picture is on screen, while the user is still changing something.
    Preview,
    /// The full-quality picture is in progress: its current stage, and the completed fraction.
    Refining(Stage, f32),
    /// The request could not be rendered.
    Failed,
    /// The GPU device is lost.
    Lost,
}

/// Statistics and state of the renderer, for display.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::app) struct Facts {
    /// Name of the graphics adapter.
    pub adapter: String,
    /// Graphics API and driver, with version.
    pub driver: String,
    /// True if the adapter is a software driver on the CPU.
    pub software: bool,
    /// Time of the last full-quality picture, in milliseconds.
    pub full_ms: Option<f64>,
    /// Time of the last preview, in milliseconds.
    pub preview_ms: Option<f64>,
    /// Number of times that light volumes were filled.
    pub light_rebuilds: u64,
    /// Number of light volumes in the cache.
    pub cached_light_volumes: usize,
    /// Share of the visible part of the last full-quality picture that is nearly black, 0 to 1.
    pub dark_share: Option<f64>,
    /// True if nothing of the volume is visible in the picture, or in the left one of a comparison.
    pub shows_nothing: bool,
    /// Number of footprints splatted for the last full-quality picture; 0 if it was gathered.
    pub splats: u64,
    /// Memory of the light volumes, in mebibytes.
    pub light_mebibytes: f64,
    /// Memory of all textures, in mebibytes.
    pub gpu_mebibytes: f64,
    /// Statistics of each light's volume, in the order of the lights; `None` for lights without one.
    pub light_volumes: Vec<Option<LightFigures>>,
    /// Statistics of the sky-visibility volume, if there is one.
    pub sky: Option<LightFigures>,
    /// Statistics of the volume of multiply scattered light, if there is one.
    pub bounces: Option<LightFigures>,
    /// Current activity of the renderer.
    pub doing: Doing,
}

/// Cost of a light volume: time to fill it, and memory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::app) struct LightCost {
    /// Time to fill it in milliseconds, if that was measured.
    pub ms: Option<f64>,
    /// Memory that it occupies, in mebibytes.
    pub mebibytes: f64,
}

impl LightCost {
    /// Returns the cost of a complete volume; `None` while it is being filled.
    fn of(figures: &LightFigures) -> Option<Self> {
        let mebibytes = figures.bytes as f64 / f64::from(1 << 20);
        figures.complete.then_some(Self { ms: figures.fill_ms, mebibytes })
    }

    /// Scales the cost to another resolution: voxels that are `times` as fine along each axis.
    pub(in crate::app) fn finer(self, times: f64) -> Self {
        let voxels = times.powi(3);
        Self { ms: self.ms.map(|ms| ms * voxels), mebibytes: self.mebibytes * voxels }
    }
}

/// Returns the cost of the most expensive volume, by time and then by memory.
fn dearest<'a>(volumes: impl Iterator<Item = &'a LightFigures>) -> Option<LightCost> {
    volumes.filter_map(LightCost::of).max_by(|a, b| {
        let ms = |cost: &LightCost| cost.ms.unwrap_or_default();
        ms(a).total_cmp(&ms(b)).then(a.mebibytes.total_cmp(&b.mebibytes))
    })
}

impl Facts {
    /// Estimates the cost of one more light with shadows, as that of the most expensive present one; `None` if
    /// nothing was measured.
    pub(in crate::app) fn light_cost(&self) -> Option<LightCost> {
        dearest(self.light_volumes.iter().flatten())
    }

    /// Returns the cost of the most expensive light among those for which `is_meant` is true.
    pub(in crate::app) fn cost_of(&self, is_meant: impl Fn(usize) -> bool) -> Option<LightCost> {
        let meant = self.light_volumes.iter().enumerate().filter(|(light, _)| is_meant(*light));
        dearest(meant.filter_map(|(_, figures)| figures.as_ref()))
    }

    /// Returns the cost of the sky-visibility volume.
    pub(in crate::app) fn sky_cost(&self) -> Option<LightCost> {
        self.sky.as_ref().and_then(LightCost::of)
    }

    /// Returns the cost of the volume of multiply scattered light.
    pub(in crate::app) fn bounces_cost(&self) -> Option<LightCost> {
        self.bounces.as_ref().and_then(LightCost::of)
    }
}

impl Viewport {
    /// Collects the statistics and the state of the renderer.
    pub(in crate::app) fn facts(&self, looks: &Looks) -> Facts {
        let info = &self.context.info;
        let figures = self.thread.figures();
        Facts {
            adapter: plain(&info.name, MAX_NAME),
            driver: plain(
                format!("{:?} · {} {}", info.backend, info.driver, info.driver_info).trim(),
                MAX_NAME,
            ),
            software: self.context.is_software(),
            full_ms: figures.full_ms,
            preview_ms: figures.preview_ms,
            light_rebuilds: figures.light_rebuilds,
            cached_light_volumes: figures.cached_light_volumes,
            shows_nothing: figures.shows_nothing && self.dataset.is_some(),
            splats: figures.splats,
            light_mebibytes: figures.light_bytes as f64 / f64::from(1 << 20),
            dark_share: figures.dark_share,
            gpu_mebibytes: figures.gpu_bytes as f64 / f64::from(1 << 20),
            light_volumes: figures.light_volumes.clone(),
            sky: figures.sky,
            bounces: figures.bounces,
            doing: self.doing(looks, figures.refining),
        }
    }

    /// Number of times that light volumes were filled.
    pub(in crate::app) fn light_rebuilds(&self) -> u64 {
        self.thread.figures().light_rebuilds
    }

    /// Number of full-quality pictures that followed previews.
    pub(in crate::app) fn refinements(&self) -> u64 {
        self.thread.figures().refinements
    }

    fn doing(&self, looks: &Looks, refining: Option<(Stage, f32)>) -> Doing {
        if self.lost {
            Doing::Lost
        } else if self.dataset.is_none() {
            Doing::Nothing
        } else if self.is_idle(looks) {
            Doing::FullQuality
        } else if self.failed.is_some() && self.failed == self.frame_request {
            Doing::Failed
        } else {
            refining.map_or(Doing::Preview, |(stage, share)| Doing::Refining(stage, share))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finer_volumes_cost_as_many_times_more_as_they_have_voxels() {
        let half = LightCost { ms: Some(10.0), mebibytes: 2.0 };
        assert_eq!(half.finer(2.0), LightCost { ms: Some(80.0), mebibytes: 16.0 });
        assert_eq!(LightCost { ms: None, ..half }.finer(0.5), LightCost { ms: None, mebibytes: 0.25 });
    }
}
