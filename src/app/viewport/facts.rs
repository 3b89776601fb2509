//! What the rest of the window may know of the renderer.

use super::Viewport;
use crate::model::Settings;

use super::super::refine::Look;

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
    Refining(&'static str, f32),
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
    /// GPU milliseconds of the last full-quality picture.
    pub full_ms: Option<f64>,
    /// GPU milliseconds of the last preview.
    pub preview_ms: Option<f64>,
    /// How often light volumes were filled.
    pub light_rebuilds: u64,
    /// Light volumes that are kept.
    pub cached_light_volumes: usize,
    /// Mebibytes of textures.
    pub gpu_mebibytes: f64,
    /// What is going on.
    pub doing: Doing,
}

impl Viewport {
    /// Figures about the renderer.
    pub(in crate::app) fn facts(&self, settings: &Settings) -> Facts {
        let info = &self.context.info;
        let renderer = self.scene.as_ref().map(|scene| &scene.renderer);
        Facts {
            adapter: info.name.clone(),
            driver: format!("{:?} · {} {}", info.backend, info.driver, info.driver_info).trim().to_owned(),
            software: self.context.is_software(),
            full_ms: self.full_ms,
            preview_ms: self.preview_ms,
            light_rebuilds: renderer.map_or(0, |renderer| renderer.light_rebuilds().iter().sum()),
            cached_light_volumes: renderer.map_or(0, crate::gpu::Renderer::cached_light_volumes),
            gpu_mebibytes: renderer.map_or(0.0, |renderer| renderer.gpu_bytes() as f64 / f64::from(1 << 20)),
            doing: self.doing(settings),
        }
    }

    fn doing(&self, settings: &Settings) -> Doing {
        if self.lost {
            Doing::Lost
        } else if self.scene.is_none() {
            Doing::Nothing
        } else if self.is_idle(settings) {
            Doing::FullQuality
        } else if self.failed.is_some() && self.failed == self.wanted {
            Doing::Failed
        } else {
            match &self.running {
                Some(running) if running.look == Look::FULL => {
                    let label = running.job.stage().map_or("drawing the picture", crate::gpu::Stage::label);
                    Doing::Refining(label, running.job.progress().clamp(0.0, 1.0))
                }
                _ => Doing::Preview,
            }
        }
    }
}
