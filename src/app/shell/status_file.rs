//! Status file: state of the window as JSON, for test automation.
//!
//! With `CHIAROSCURO_STATUS=PATH` in the environment this small JSON file is rewritten whenever it changes:
//! `{"state": "idle" | "refining" | "loading", "viewport": {"x", "y", "width", "height"}, "light_handles": [{"x",
//! "y"}, …], "light_rebuilds": n, "longest_ui_ms": n, "response_ms": {"count": n, "mean": n, "worst": n}, "errors":
//! […], "path_window": TITLE | null, "places": {NAME: {"x", "y", "width", "height"}, …}}`. A response is the time
//! from the frame that reads an input to the one that shows its effect, preview or not. The path window is the dialog
//! in which a path is typed; places are sections of the side panel by their titles, rows as `Data/Spacing`, and the
//! icons above them as `Go to Data`. Lengths are physical pixels from the window's inner top left. `idle` means that
//! the full-quality picture of the current settings is on screen, and that their balance is not going to change
//! automatically.

use std::collections::BTreeMap;
use std::path::PathBuf;

use eframe::egui::{Pos2, Rect};
use serde_json::{Map, Value, json};

use crate::app::viewport::ResponseTimes;
use crate::app::viewport::canvas::Canvas;

/// Environment variable that names the file.
const STATUS_PATH_VARIABLE: &str = "CHIAROSCURO_STATUS";

/// Contents of the status file.
#[derive(Debug)]
pub(crate) struct WindowStatus<'a> {
    /// True while a volume is being opened.
    pub loading: bool,
    /// True if the full-quality picture is on screen.
    pub idle: bool,
    /// Area of the picture in the window.
    pub canvas: Option<Canvas>,
    /// Positions of the light handles, in points.
    pub handles: &'a [Pos2],
    /// Number of times light volumes were filled.
    pub light_rebuilds: u64,
    /// Statistics of the response times, in ms.
    pub response: ResponseTimes,
    /// Errors since the last volume was opened.
    pub errors: &'a [String],
    /// Title of the dialog in which a path is typed, if it is open.
    pub path_window: Option<&'static str>,
    /// Areas of the side panel's sections, rows and buttons by name, in points.
    pub places: BTreeMap<String, Rect>,
    /// Number of physical pixels per point.
    pub pixels_per_point: f32,
}

impl WindowStatus<'_> {
    /// Content of the file; `longest_ui_ms` is the longest time that one frame has occupied the thread, in ms.
    fn json(&self, longest_ui_ms: f64) -> Value {
        let pixels = |points: f32| (points * self.pixels_per_point).round() as i64;
        let viewport = self.canvas.map(|canvas| {
            let at = canvas.rect.min;
            json!({"x": pixels(at.x), "y": pixels(at.y), "width": canvas.size[0], "height": canvas.size[1]})
        });
        let handles: Vec<Value> =
            self.handles.iter().map(|at| json!({"x": pixels(at.x), "y": pixels(at.y)})).collect();
        let state = if self.loading {
            "loading"
        } else if self.idle {
            "idle"
        } else {
            "refining"
        };
        let area = |area: &Rect| {
            let [x, y, width, height] = [area.min.x, area.min.y, area.width(), area.height()].map(pixels);
            json!({"x": x, "y": y, "width": width, "height": height})
        };
        let places: Map<String, Value> =
            self.places.iter().map(|(name, place)| (name.clone(), area(place))).collect();
        json!({
            "state": state,
            "viewport": viewport,
            "light_handles": handles,
            "light_rebuilds": self.light_rebuilds,
            "longest_ui_ms": longest_ui_ms.round(),
            "response_ms": {
                "count": self.response.count,
                "mean": self.response.mean_ms.round(),
                "worst": self.response.max_ms.round(),
            },
            "errors": self.errors,
            "path_window": self.path_window,
            "places": places,
        })
    }
}

/// Writer of the status file, if the environment names one.
#[derive(Debug)]
pub(crate) struct StatusFile {
    /// Longest frame so far on the window's thread, in ms.
    pub longest_ui_ms: f64,
    path: Option<PathBuf>,
    written: String,
}

impl StatusFile {
    /// Creates the writer for the path in the environment.
    pub(crate) fn from_environment() -> Self {
        let path = std::env::var_os(STATUS_PATH_VARIABLE).map(PathBuf::from);
        Self { longest_ui_ms: 0.0, path, written: String::new() }
    }

    /// True if the environment names a status file.
    pub(crate) fn is_on(&self) -> bool {
        self.path.is_some()
    }

    /// Rewrites the file if anything has changed.
    pub(crate) fn update(&mut self, state: &WindowStatus<'_>) {
        let Some(path) = &self.path else { return };
        let text = state.json(self.longest_ui_ms).to_string();
        if text != self.written {
            // Atomic write: readers never see half of it.
            if let Err(err) = chiaroscuro_files::write_atomically(path, text.as_bytes()) {
                log::warn!("{STATUS_PATH_VARIABLE}: {err}");
                self.path = None;
            }
            self.written = text;
        }
    }
}
