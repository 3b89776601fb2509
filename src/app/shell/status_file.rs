//! The state of the window for test automation.
//!
//! With `CHIAROSCURO_STATUS=PATH` in the environment this small JSON file is rewritten whenever it
//! changes: `{"state": "idle" | "refining" | "loading", "viewport": {"x", "y", "width", "height"},
//! "light_handles": [{"x", "y"}, …], "light_rebuilds": n, "longest_ui_ms": n, "response_ms":
//! {"count": n, "mean": n, "worst": n}, "errors": […], "path_window": TITLE | null, "places": {NAME: {"x", "y", "width",
//! "height"}, …}}`. A response is from the frame that reads an input to the
//! one that shows its effect, preview or not. The path window is that in which a path is typed; places are sections of the
//! side panel by their titles, their rows as `Data/Spacing`, and the drawings above as `Go to Data`.
//! Lengths are physical pixels from the window's inner top left. `idle` means that the full-quality picture of the
//! current settings is on screen, and that their balance will not change by itself.

use std::collections::BTreeMap;
use std::path::PathBuf;

use eframe::egui::{Pos2, Rect};
use serde_json::{Map, Value, json};

use crate::app::viewport::Response;
use crate::app::viewport::canvas::Canvas;

/// Names the file.
const VARIABLE: &str = "CHIAROSCURO_STATUS";

/// What the file says.
#[derive(Debug)]
pub(crate) struct State<'a> {
    /// A volume is being opened.
    pub loading: bool,
    /// The full-quality picture is on screen.
    pub idle: bool,
    /// Where the picture is.
    pub canvas: Option<Canvas>,
    /// Where the handles are, in points.
    pub handles: &'a [Pos2],
    /// How often light volumes were filled.
    pub light_rebuilds: u64,
    /// The longest that one frame of the window kept its thread, in milliseconds.
    pub longest_ui_ms: f64,
    /// How long pictures took to show what was done.
    pub response: Response,
    /// Errors so far.
    pub errors: &'a [String],
    /// Title of the window in which a path is typed, if it is open.
    pub path_window: Option<&'static str>,
    /// Where things of the side panel are, in points.
    pub places: BTreeMap<String, Rect>,
    /// Physical pixels per point.
    pub pixels_per_point: f32,
}

impl State<'_> {
    fn json(&self) -> Value {
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
            "longest_ui_ms": self.longest_ui_ms.round(),
            "response_ms": {
                "count": self.response.count,
                "mean": self.response.mean_ms.round(),
                "worst": self.response.worst_ms.round(),
            },
            "errors": self.errors,
            "path_window": self.path_window,
            "places": places,
        })
    }
}

/// The file, if the environment names one.
#[derive(Debug)]
pub(crate) struct StatusFile {
    path: Option<PathBuf>,
    written: String,
}

impl StatusFile {
    /// The file named in the environment.
    pub(crate) fn from_environment() -> Self {
        Self { path: std::env::var_os(VARIABLE).map(PathBuf::from), written: String::new() }
    }

    /// Whether somebody watches.
    pub(crate) fn is_on(&self) -> bool {
        self.path.is_some()
    }

    /// Rewrites the file if anything changed.
    pub(crate) fn update(&mut self, state: &State<'_>) {
        let Some(path) = &self.path else { return };
        let text = state.json().to_string();
        if text != self.written {
            // Readers must never see half of it.
            if let Err(err) = crate::export::write_atomically(path, text.as_bytes()) {
                log::warn!("{VARIABLE}: {err}");
                self.path = None;
            }
            self.written = text;
        }
    }
}
