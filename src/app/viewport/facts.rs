//! What the rest of the window may know of the renderer.

use crate::app::viewport::Viewport;
use crate::app::worker::request::Looks;
use crate::data::plain;
use crate::gpu::{LightFigures, Stage};
use crate::model::MAX_NAME;

/// What is going on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::app) enum Doing {
    /// There is nothing to show.
    Nothing,
    /// The picture is as good as an export.
    FullQuality,
    /// A coarser picture is on screen; the user is still moving something.
    Preview,
    /// The full-quality picture is on its way: what is done now, and the share that is done.
    Refining(Stage, f32),
    /// It could not be rendered.
    Failed,
    /// The device is gone.
    Lost,
}

/// Figures about the renderer, for display.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::app) struct Facts {
    /// Name of the adapter.
    pub adapter: String,
    /// Driver and interface.
    pub driver: String,
    /// Whether the adapter is the CPU.
    pub software: bool,
    /// Milliseconds of the last full-quality picture.
    pub full_ms: Option<f64>,
    /// Milliseconds of the last preview.
    pub preview_ms: Option<f64>,
    /// How often light volumes were filled.
    pub light_rebuilds: u64,
    /// Light volumes that are kept.
    pub cached_light_volumes: usize,
    /// Share of what the last full-quality picture shows that is nearly black.
    pub dark_share: Option<f64>,
    /// The picture, or the left one of two, shows nothing of the volume.
    pub shows_nothing: bool,
    /// Footprints that the last full-quality picture has splatted; 0 of one that gathers.
    pub splats: u64,
    /// Mebibytes of light volumes.
    pub light_mebibytes: f64,
    /// Mebibytes of textures.
    pub gpu_mebibytes: f64,
    /// The light volume of each light of the picture, if it has one.
    pub light_volumes: Vec<Option<LightFigures>>,
    /// The volume of the sky, if there is one.
    pub sky: Option<LightFigures>,
    /// That of light that has bounced.
    pub bounces: Option<LightFigures>,
    /// What the renderer does now.
    pub doing: Doing,
}

/// What a light volume costs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::app) struct LightCost {
    /// Milliseconds until it is filled, where that was measured.
    pub ms: Option<f64>,
    /// Mebibytes that it takes.
    pub mebibytes: f64,
}

impl LightCost {
    /// What a filled volume took; none of one that is being filled.
    fn of(figures: &LightFigures) -> Option<Self> {
        let mebibytes = figures.bytes as f64 / f64::from(1 << 20);
        figures.complete.then_some(Self { ms: figures.fill_ms, mebibytes })
    }

    /// At another resolution: voxels that are so many times as fine along each axis.
    pub(in crate::app) fn finer(self, times: f64) -> Self {
        let voxels = times.powi(3);
        Self { ms: self.ms.map(|ms| ms * voxels), mebibytes: self.mebibytes * voxels }
    }
}

/// The dearest of some volumes.
fn dearest<'a>(volumes: impl Iterator<Item = &'a LightFigures>) -> Option<LightCost> {
    volumes.filter_map(LightCost::of).max_by(|a, b| {
        let ms = |cost: &LightCost| cost.ms.unwrap_or_default();
        ms(a).total_cmp(&ms(b)).then(a.mebibytes.total_cmp(&b.mebibytes))
    })
}

impl Facts {
    /// What one more light that casts shadows would cost, as the dearest does that there is; none where nothing was
    /// measured.
    pub(in crate::app) fn light_cost(&self) -> Option<LightCost> {
        dearest(self.light_volumes.iter().flatten())
    }

    /// What one of these lights takes: the dearest.
    pub(in crate::app) fn cost_of(&self, is_meant: impl Fn(usize) -> bool) -> Option<LightCost> {
        let meant = self.light_volumes.iter().enumerate().filter(|(light, _)| is_meant(*light));
        dearest(meant.filter_map(|(_, figures)| figures.as_ref()))
    }

    /// What the sky takes.
    pub(in crate::app) fn sky_cost(&self) -> Option<LightCost> {
        self.sky.as_ref().and_then(LightCost::of)
    }

    /// What light takes that bounces.
    pub(in crate::app) fn bounces_cost(&self) -> Option<LightCost> {
        self.bounces.as_ref().and_then(LightCost::of)
    }
}

impl Viewport {
    /// Figures about the renderer.
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

    /// How often light volumes were filled.
    pub(in crate::app) fn light_rebuilds(&self) -> u64 {
        self.thread.figures().light_rebuilds
    }

    /// How many pictures at full quality were made after previews.
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
