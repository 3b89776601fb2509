//! Statistics and state of the renderer, for display in the rest of the window.

use crate::app::viewport::Viewport;
use crate::app::worker::mailbox::FinerLevelStatus;
use crate::app::worker::request::ComparedLooks;
use chiaroscuro_files::sanitised;
use chiaroscuro_render::{LightVolumeStatistics, RenderStage};
use chiaroscuro_scene::MAX_NAME_CHARS;

/// Activity of the renderer, for the status bar.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum RendererActivity {
    /// No volume is open.
    Idle,
    /// The picture on screen has the quality of an export.
    FullQuality,
    /// A coarser picture is on screen, while the user is still changing something.
    Preview,
    /// The full-quality picture is in progress: its current stage, and the completed fraction.
    Refining(RenderStage, f32),
    /// The request could not be rendered.
    Failed,
    /// The GPU device is lost.
    DeviceLost,
}

/// Statistics and state of the renderer, for display.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RendererStatus {
    /// Name of the graphics adapter.
    pub adapter: String,
    /// Graphics API and driver, with version.
    pub driver: String,
    /// True if the adapter is a software driver on the CPU.
    pub is_software: bool,
    /// Time of the last full-quality picture, in milliseconds.
    pub full_ms: Option<f64>,
    /// Time of the last preview, in milliseconds.
    pub preview_ms: Option<f64>,
    /// Number of times that light volumes were filled.
    pub light_fill_count: u64,
    /// Number of light volumes in the cache.
    pub cached_light_volumes: usize,
    /// Share of the visible part of the last full-quality picture that is nearly black, 0 to 1.
    pub dark_share: Option<f64>,
    /// True if nothing of the volume is visible in the picture, or in the left one of a comparison.
    pub is_empty: bool,
    /// Number of footprints splatted for the last full-quality picture; 0 if it was gathered.
    pub splat_count: u64,
    /// Memory of the light volumes, in mebibytes.
    pub light_mebibytes: f64,
    /// Memory of all textures, in mebibytes.
    pub gpu_mebibytes: f64,
    /// Statistics of each light's volume, in the order of the lights; `None` for lights without one.
    pub light_volumes: Vec<Option<LightVolumeStatistics>>,
    /// Statistics of the sky-visibility volume, if there is one.
    pub sky: Option<LightVolumeStatistics>,
    /// Statistics of the volume of multiply scattered light, if there is one.
    pub bounces: Option<LightVolumeStatistics>,
    /// Current activity of the renderer.
    pub activity: RendererActivity,
    /// Finer resolution levels of the picture, if the one in memory is too coarse for it.
    pub finer_levels: Option<FinerLevelStatus>,
}

/// Cost of a light volume: time to fill it, and memory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LightCost {
    /// Time to fill it in milliseconds, if that was measured.
    pub ms: Option<f64>,
    /// Memory that it occupies, in mebibytes.
    pub mebibytes: f64,
}

impl LightCost {
    /// Returns the cost of a complete volume; `None` while it is being filled.
    fn from_figures(figures: &LightVolumeStatistics) -> Option<Self> {
        let mebibytes = figures.bytes as f64 / f64::from(1 << 20);
        figures.is_complete.then_some(Self { ms: figures.fill_ms, mebibytes })
    }

    /// Scales the cost to another resolution: voxels that are `times` as fine along each axis.
    pub(crate) fn at_resolution(self, times: f64) -> Self {
        let voxels = times.powi(3);
        Self { ms: self.ms.map(|ms| ms * voxels), mebibytes: self.mebibytes * voxels }
    }
}

/// Returns the cost of the most expensive volume, by time and then by memory.
fn most_expensive<'a>(volumes: impl Iterator<Item = &'a LightVolumeStatistics>) -> Option<LightCost> {
    volumes.filter_map(LightCost::from_figures).max_by(|a, b| {
        let ms = |cost: &LightCost| cost.ms.unwrap_or_default();
        ms(a).total_cmp(&ms(b)).then(a.mebibytes.total_cmp(&b.mebibytes))
    })
}

impl RendererStatus {
    /// Estimates the cost of one more light with shadows, as that of the most expensive present one; `None` if
    /// nothing was measured.
    pub(crate) fn light_cost(&self) -> Option<LightCost> {
        most_expensive(self.light_volumes.iter().flatten())
    }

    /// Returns the cost of the most expensive light among those for which `is_meant` is true.
    pub(crate) fn max_cost_where(&self, is_meant: impl Fn(usize) -> bool) -> Option<LightCost> {
        let meant = self.light_volumes.iter().enumerate().filter(|(light, _)| is_meant(*light));
        most_expensive(meant.filter_map(|(_, figures)| figures.as_ref()))
    }

    /// Returns the cost of the sky-visibility volume.
    pub(crate) fn sky_cost(&self) -> Option<LightCost> {
        self.sky.as_ref().and_then(LightCost::from_figures)
    }

    /// Returns the cost of the volume of multiply scattered light.
    pub(crate) fn bounces_cost(&self) -> Option<LightCost> {
        self.bounces.as_ref().and_then(LightCost::from_figures)
    }
}

impl Viewport {
    /// Collects the statistics and the state of the renderer.
    pub(crate) fn renderer_status(&self, looks: &ComparedLooks) -> RendererStatus {
        let info = &self.context.info;
        let figures = self.thread.statistics();
        RendererStatus {
            adapter: sanitised(&info.name, MAX_NAME_CHARS),
            driver: sanitised(
                format!("{:?} · {} {}", info.backend, info.driver, info.driver_info).trim(),
                MAX_NAME_CHARS,
            ),
            is_software: self.context.is_software(),
            full_ms: figures.full_ms,
            preview_ms: figures.preview_ms,
            light_fill_count: figures.light_rebuilds,
            cached_light_volumes: figures.cached_light_volumes,
            is_empty: figures.shows_nothing && self.dataset.is_some(),
            splat_count: figures.splats,
            light_mebibytes: figures.light_bytes as f64 / f64::from(1 << 20),
            dark_share: figures.dark_share,
            gpu_mebibytes: figures.gpu_bytes as f64 / f64::from(1 << 20),
            light_volumes: figures.light_volumes.clone(),
            sky: figures.sky,
            bounces: figures.bounces,
            activity: self.activity(looks, figures.refinement_progress),
            finer_levels: figures.finer_levels.clone(),
        }
    }

    /// Number of times that light volumes were filled.
    pub(crate) fn light_fill_count(&self) -> u64 {
        self.thread.statistics().light_rebuilds
    }

    /// Number of full-quality pictures that followed previews.
    #[cfg(feature = "testing")]
    pub(crate) fn refinement_count(&self) -> u64 {
        self.thread.statistics().refinements
    }

    fn activity(&self, looks: &ComparedLooks, refining: Option<(RenderStage, f32)>) -> RendererActivity {
        if self.is_device_lost {
            RendererActivity::DeviceLost
        } else if self.dataset.is_none() {
            RendererActivity::Idle
        } else if self.is_idle(looks) || refining.is_none() && self.displays_full_quality(looks) {
            RendererActivity::FullQuality
        } else if self.failed_request.is_some() && self.failed_request == self.frame_request {
            RendererActivity::Failed
        } else {
            refining
                .map_or(RendererActivity::Preview, |(stage, share)| RendererActivity::Refining(stage, share))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finer_volumes_cost_as_many_times_more_as_they_have_voxels() {
        let half = LightCost { ms: Some(10.0), mebibytes: 2.0 };
        assert_eq!(half.at_resolution(2.0), LightCost { ms: Some(80.0), mebibytes: 16.0 });
        assert_eq!(
            LightCost { ms: None, ..half }.at_resolution(0.5),
            LightCost { ms: None, mebibytes: 0.25 }
        );
    }
}
