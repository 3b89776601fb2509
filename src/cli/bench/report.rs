//! What a benchmark measured, as JSON and as a table.

use serde_json::{Value, json};

use crate::cli::process::process_cpu_ms;
use crate::gpu::Report;

/// Timings of one case.
#[derive(Debug, Default)]
pub(super) struct Samples {
    wall_ms: Vec<f64>,
    cpu_ms: Vec<f64>,
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
    /// Of the last frame: its pixels, and the coarsest light volume that it looked up.
    rendered: ([u32; 2], usize),
}

impl Samples {
    /// Runs one frame and keeps what it took.
    pub(super) fn time<E>(&mut self, frame: impl FnOnce() -> Result<Report, E>) -> Result<(), E> {
        let cpu = process_cpu_ms();
        let start = std::time::Instant::now();
        let report = frame()?;
        self.wall_ms.push(start.elapsed().as_secs_f64() * 1000.0);
        if let (Some(before), Some(after)) = (cpu, process_cpu_ms()) {
            self.cpu_ms.push(after - before);
        }
        self.eye_ms.push(report.eye_ms);
        self.light_march_ms.push(report.light_march_ms);
        self.light_backproject_ms.push(report.light_backproject_ms);
        self.light_raycast_ms.push(report.light_raycast_ms);
        self.sky_ms.push(report.sky_ms);
        self.bounces_ms.push(report.bounces_ms);
        self.bricks_ms.push(report.bricks_ms);
        self.upload_ms.push(report.upload_ms);
        self.eye_gpu_ms.extend(report.eye_gpu_ms);
        self.light_gpu_ms.extend(report.light_gpu_ms);
        self.rendered = (report.size, report.light_divisor);
        Ok(())
    }

    /// Median wall time of a frame.
    pub(super) fn wall_median(&self) -> f64 {
        median(&self.wall_ms)
    }

    /// Median CPU time of a frame, or wall time where that is not known.
    pub(super) fn cost(&self) -> f64 {
        if self.cpu_ms.is_empty() { self.wall_median() } else { median(&self.cpu_ms) }
    }

    /// Median of both halves of the light pass together, or of the rays in their place.
    pub(super) fn light_build(&self) -> f64 {
        let halves = self.light_march_ms.iter().zip(&self.light_backproject_ms);
        let all: Vec<f64> = halves.zip(&self.light_raycast_ms).map(|((a, b), c)| a + b + c).collect();
        median(&all)
    }

    /// Median of the filling of a sky's volume.
    pub(super) fn sky(&self) -> f64 {
        median(&self.sky_ms)
    }

    /// Median of the filling of a volume of bounced light.
    pub(super) fn bounces(&self) -> f64 {
        median(&self.bounces_ms)
    }

    /// Median of the eye pass.
    pub(super) fn eye(&self) -> f64 {
        median(&self.eye_ms)
    }

    /// Whether the frames had so many pixels, and no light volume was coarser than the data.
    pub(super) fn were_whole(&self, size: [u32; 2]) -> bool {
        self.rendered.0 == size && self.rendered.1 <= 1
    }

    /// Everything, as the JSON of a case.
    pub(super) fn json(&self) -> Value {
        json!({
            "frames": self.wall_ms.len(),
            "wall_ms": spread(&self.wall_ms),
            "cpu_ms": spread(&self.cpu_ms),
            "stages": {
                "eye": round(median(&self.eye_ms)),
                "light_march": round(median(&self.light_march_ms)),
                "light_backproject": round(median(&self.light_backproject_ms)),
                "light_raycast": round(median(&self.light_raycast_ms)),
                "sky": round(median(&self.sky_ms)),
                "bounces": round(median(&self.bounces_ms)),
                "bricks": round(median(&self.bricks_ms)),
                "upload": round(median(&self.upload_ms)),
            },
            // By the adapter's own clock.
            "gpu_ms": { "eye": spread(&self.eye_gpu_ms), "light": spread(&self.light_gpu_ms) },
        })
    }
}

/// Median, least and most; null of nothing.
pub(super) fn spread(values: &[f64]) -> Value {
    if values.is_empty() {
        return Value::Null;
    }
    let (min, max) = values.iter().fold((f64::INFINITY, 0f64), |(min, max), &v| (min.min(v), max.max(v)));
    json!({ "median": round(median(values)), "min": round(min), "max": round(max) })
}

/// The middle value; 0 of nothing.
pub(super) fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted.len() {
        0 => 0.0,
        n if n % 2 == 1 => sorted[n / 2],
        n => f64::midpoint(sorted[n / 2 - 1], sorted[n / 2]),
    }
}

/// To a microsecond.
pub(super) fn round(ms: f64) -> f64 {
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
