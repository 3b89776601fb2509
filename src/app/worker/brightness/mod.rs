//! Brightness of pictures: measurement, and exposure compensation that makes previews as bright as full quality.

mod exposure_compensation;

use std::time::{Duration, Instant};

use self::exposure_compensation::{ExposureCompensation, PreviewClass};
use super::quality::QualityLevel;
use super::request::{FrameRequest, RenderScene};
use chiaroscuro_render::{
    GpuError, RenderOptions, RenderReport, dark_fraction, is_empty_light, mean_luminance,
    plan::{EyeKey, RenderRequest},
};
use chiaroscuro_scene::Settings;

/// Largest number of pixels of a preview whose brightness is measured: 2 ms on a software adapter.
const MAX_MEASURED_PIXELS: u64 = 1 << 18;

/// Interval between measurements of dark areas during interaction, on an adapter that previews at full quality: each
/// reads back 16 bytes per pixel.
const MEASURING_INTERVAL: Duration = Duration::from_millis(250);

/// Measured brightness of the pictures of one volume.
#[derive(Debug)]
pub(super) struct BrightnessTracker {
    exposures: ExposureCompensation,
    /// Time of the last measurement of dark areas.
    last_measurement: Instant,
    /// Key light and exposure of the last measurement.
    measured_key: Option<(EyeKey, f64)>,
    /// True if nothing of the volume was visible in the last measurement.
    is_empty: bool,
    /// Request of the last preview that was measured.
    last_preview: Option<FrameRequest>,
}

impl BrightnessTracker {
    /// Starts without any measurement.
    pub(super) fn new() -> Self {
        Self {
            exposures: ExposureCompensation::default(),
            last_measurement: Instant::now(),
            measured_key: None,
            is_empty: false,
            last_preview: None,
        }
    }

    /// Discards all measurements, after a change of volume.
    pub(super) fn reset(&mut self) {
        *self = Self { last_measurement: self.last_measurement, ..Self::new() };
    }

    /// Returns true if the last measured full-quality picture shows nothing of the volume.
    pub(super) fn is_picture_empty(&self) -> bool {
        self.is_empty
    }

    /// Returns the exposure factor for a picture; `None` if it is not compensated.
    pub(super) fn exposure(
        &self,
        frame_request: &FrameRequest,
        quality: QualityLevel,
        report: &RenderReport,
    ) -> Option<f32> {
        is_compensated(frame_request, quality)
            .then(|| self.exposures.factor(preview_class(quality, report)).unwrap_or(1.0) as f32)
    }

    /// Measures the share of a full-quality picture that is nearly black; `None` if it was not measured. Pictures at
    /// rest (`is_at_rest`) are always measured, others at intervals; a picture whose light equals that of the one
    /// before is not, for example after a change of the background.
    pub(super) fn measure_full(
        &mut self,
        scene: &RenderScene,
        frame_request: &FrameRequest,
        is_at_rest: bool,
    ) -> Result<Option<f64>, GpuError> {
        let exposure = frame_request.looks.left.output.exposure;
        let measured = (frame_request.keys().eye.clone(), exposure);
        let is_known =
            scene.renderer.report().step_counts.eye == 0 && self.measured_key.as_ref() == Some(&measured);
        if is_known || (!is_at_rest && self.last_measurement.elapsed() < MEASURING_INTERVAL) {
            return Ok(None);
        }
        self.last_measurement = Instant::now();
        self.measured_key = Some(measured);
        let light = scene.renderer.read_light()?;
        self.is_empty = is_empty_light(&light);
        if frame_request.looks.right.is_none() {
            let is_of_last_preview = self.last_preview.as_ref() == Some(frame_request);
            self.exposures.learn_full_quality(mean_luminance(&light), is_of_last_preview);
        }
        Ok(Some(dark_fraction(&light, exposure)))
    }

    /// Learns from a preview, and displays it again with the exposure that makes it as bright as the last
    /// full-quality picture (`last_full`).
    pub(super) fn measure_preview(
        &mut self,
        scene: &mut RenderScene,
        frame_request: &FrameRequest,
        quality: QualityLevel,
        request: &RenderRequest,
        options: &RenderOptions,
        full_quality_settings: Option<&Settings>,
    ) -> Result<(), GpuError> {
        let [width, height] = request.size;
        let is_small = u64::from(width) * u64::from(height) <= MAX_MEASURED_PIXELS;
        // Changes other than movements may alter the brightness, which should then be visible.
        let moves =
            full_quality_settings.is_some_and(|last_full| is_movement(last_full, &frame_request.looks.left));
        if !(is_compensated(frame_request, quality) && moves && is_small) {
            return Ok(());
        }
        let mean = mean_luminance(&scene.renderer.read_light()?);
        self.last_preview = Some(frame_request.clone());
        let kind = preview_class(quality, scene.renderer.report());
        if let Some(exposure) = self.exposures.learn_preview(kind, mean) {
            let mut options = options.clone();
            options.picture.exposure = exposure as f32;
            redisplay_with_exposure(scene, request, &options)?;
        }
        Ok(())
    }
}

/// Returns true for previews whose brightness is compensated; comparisons are excluded, since their difference
/// matters.
fn is_compensated(frame_request: &FrameRequest, quality: QualityLevel) -> bool {
    !quality.is_full() && frame_request.looks.right.is_none()
}

/// Returns true if two looks differ only in the camera and the positions of lights.
fn is_movement(from: &Settings, to: &Settings) -> bool {
    let mut moved = from.clone();
    moved.camera = to.camera.clone();
    for (light, target) in moved.lights.iter_mut().zip(&to.lights) {
        light.position = target.position;
    }
    moved == *to
}

/// Returns the class of a preview, which determines its brightness error.
fn preview_class(quality: QualityLevel, report: &RenderReport) -> PreviewClass {
    PreviewClass {
        scale: quality.scale,
        quick_eye: quality.prefiltered_eye,
        simplification: quality.simplification,
        light_divisor: report.light_divisor,
    }
}

/// Displays a picture again with another exposure: a display pass only.
fn redisplay_with_exposure(
    scene: &mut RenderScene,
    request: &RenderRequest,
    options: &RenderOptions,
) -> Result<(), GpuError> {
    let mut job = scene.renderer.begin(&scene.dataset, request.clone(), options)?;
    while job.step()? {}
    scene.renderer.context().wait()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_camera_and_lights_move() {
        let home = Settings::default();
        let changed = |change: fn(&mut Settings)| {
            let mut settings = home.clone();
            change(&mut settings);
            is_movement(&home, &settings)
        };
        assert!(changed(|settings| settings.camera.orbit(20.0, 5.0)));
        assert!(changed(|settings| settings.lights[0].position = [1.0, 2.0, 3.0]));
        assert!(!changed(|settings| settings.lights[0].intensity = 0.1));
        assert!(!changed(|settings| settings.shadows.gain = 2.0));
        assert!(!changed(|settings| settings.lights.clear()));
    }
}
