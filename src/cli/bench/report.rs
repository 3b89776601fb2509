//! Results of a benchmark case, as JSON and as a table.

use serde_json::{Value, json};

use crate::cli::process::process_cpu_ms;
use chiaroscuro_render::RenderReport;

/// Timings of one benchmark case, one entry per frame.
#[derive(Debug, Default)]
pub(super) struct CaseTimings {
    wall_ms: Vec<f64>,
    cpu_ms: Vec<f64>,
    host_ms: Vec<f64>,
    eye_ms: Vec<f64>,
    light_march_ms: Vec<f64>,
    light_backproject_ms: Vec<f64>,
    light_raycast_ms: Vec<f64>,
    sky_ms: Vec<f64>,
    bounces_ms: Vec<f64>,
    bricks_ms: Vec<f64>,
    upload_ms: Vec<f64>,
    eye_gpu_ms: Vec<f64>,
    light_gpu_ms: Vec<f64>,
    /// Size of the last frame in pixels, and the divisor of the coarsest light volume that it looked up.
    rendered: ([u32; 2], usize),
}

impl CaseTimings {
    /// Runs one frame and records its timings, with those of its stages.
    pub(super) fn time<E>(&mut self, frame: impl FnOnce() -> Result<RenderReport, E>) -> Result<(), E> {
        let report = self.time_whole(frame)?;
        self.add_stages(&report);
        self.add_host(&report);
        Ok(())
    }

    /// Runs one frame, records its times as a whole, and returns its report.
    pub(super) fn time_whole<E>(
        &mut self,
        frame: impl FnOnce() -> Result<RenderReport, E>,
    ) -> Result<RenderReport, E> {
        let cpu = process_cpu_ms();
        let start = std::time::Instant::now();
        let report = frame()?;
        self.wall_ms.push(start.elapsed().as_secs_f64() * 1000.0);
        if let (Some(before), Some(after)) = (cpu, process_cpu_ms()) {
            self.cpu_ms.push(after - before);
        }
        self.rendered = (report.size, report.light_divisor);
        Ok(report)
    }

    /// Records the host's share of a frame.
    pub(super) fn add_host(&mut self, report: &RenderReport) {
        self.host_ms.push(report.host_ms);
    }

    /// Records the times of a frame's stages.
    pub(super) fn add_stages(&mut self, report: &RenderReport) {
        self.eye_ms.push(report.eye_ms);
        self.light_march_ms.push(report.light_march_ms);
        self.light_backproject_ms.push(report.light_backproject_ms);
        self.light_raycast_ms.push(report.light_raycast_ms);
        self.sky_ms.push(report.sky_ms);
        self.bounces_ms.push(report.bounces_ms);
        self.bricks_ms.push(report.tables_ms);
        self.upload_ms.push(report.upload_ms);
        self.eye_gpu_ms.extend(report.eye_gpu_ms);
        self.light_gpu_ms.extend(report.light_gpu_ms);
        self.rendered = (report.size, report.light_divisor);
    }

    /// Median wall-clock time of a frame, in milliseconds.
    pub(super) fn wall_median(&self) -> f64 {
        median(&self.wall_ms)
    }

    /// Median CPU time of a frame in milliseconds, or wall-clock time if CPU time is not available.
    pub(super) fn cost(&self) -> f64 {
        if self.cpu_ms.is_empty() { self.wall_median() } else { median(&self.cpu_ms) }
    }

    /// Median time of the light pass in milliseconds: the sum of march and back-projection, or the rays instead.
    pub(super) fn light_build(&self) -> f64 {
        let halves = self.light_march_ms.iter().zip(&self.light_backproject_ms);
        let all: Vec<f64> = halves.zip(&self.light_raycast_ms).map(|((a, b), c)| a + b + c).collect();
        median(&all)
    }

    /// Median time to fill a sky-visibility volume, in milliseconds.
    pub(super) fn sky(&self) -> f64 {
        median(&self.sky_ms)
    }

    /// Median time to fill a volume of multiply scattered light, in milliseconds.
    pub(super) fn bounces(&self) -> f64 {
        median(&self.bounces_ms)
    }

    /// Median time of the eye pass, in milliseconds.
    pub(super) fn eye(&self) -> f64 {
        median(&self.eye_ms)
    }

    /// Returns true if the last frame had the given size and used no light volume coarser than the data.
    pub(super) fn is_full_resolution(&self, size: [u32; 2]) -> bool {
        self.rendered.0 == size && self.rendered.1 <= 1
    }

    /// Returns all timings as the JSON of a case.
    pub(super) fn json(&self) -> Value {
        json!({
            "frames": self.wall_ms.len(),
            "wall_ms": spread_json(&self.wall_ms),
            "cpu_ms": spread_json(&self.cpu_ms),
            // Layout, recording and submission, without waiting for the adapter.
            "host_ms": spread_json(&self.host_ms),
            "stages": {
                "eye": round_to_microsecond(median(&self.eye_ms)),
                "light_march": round_to_microsecond(median(&self.light_march_ms)),
                "light_backproject": round_to_microsecond(median(&self.light_backproject_ms)),
                "light_raycast": round_to_microsecond(median(&self.light_raycast_ms)),
                "sky": round_to_microsecond(median(&self.sky_ms)),
                "bounces": round_to_microsecond(median(&self.bounces_ms)),
                "bricks": round_to_microsecond(median(&self.bricks_ms)),
                "upload": round_to_microsecond(median(&self.upload_ms)),
            },
            // Measured by the adapter's timestamp queries.
            "gpu_ms": { "eye": spread_json(&self.eye_gpu_ms), "light": spread_json(&self.light_gpu_ms) },
        })
    }
}

/// Returns median, minimum and maximum as JSON; null for an empty slice.
pub(super) fn spread_json(values: &[f64]) -> Value {
    if values.is_empty() {
        return Value::Null;
    }
    let (min, max) = values.iter().fold((f64::INFINITY, 0f64), |(min, max), &v| (min.min(v), max.max(v)));
    json!({ "median": round_to_microsecond(median(values)), "min": round_to_microsecond(min), "max": round_to_microsecond(max) })
}

/// Returns the median; 0 for an empty slice.
pub(super) fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted.len() {
        0 => 0.0,
        n if n % 2 == 1 => sorted[n / 2],
        n => f64::midpoint(sorted[n / 2 - 1], sorted[n / 2]),
    }
}

/// Rounds milliseconds to a microsecond.
pub(super) fn round_to_microsecond(ms: f64) -> f64 {
    (ms * 1000.0).round() / 1000.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians() {
        assert_eq!(median(&[]), 0.0);
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
    }
}
