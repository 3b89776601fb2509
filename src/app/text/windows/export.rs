//! Texts of the export dialog for pictures and turntables.

use std::fmt::Display;

use crate::app::text::{ControlText, control_text};

pub(crate) const TITLE: &str = "Export picture or turntable";

/// Annotations drawn over an exported picture.
pub(crate) const ANNOTATIONS: &str = "Marks";
pub(crate) const SCALE_BAR: ControlText =
    control_text("Scale bar", "Shows lengths, exact at the depth of the view's centre");
pub(crate) const LETTERS: ControlText =
    control_text("Orientation letters", "Name the sides of a body, if the file states its orientation");
/// Tooltip where the orientation of the body is unknown.
pub(crate) const NO_LETTERS_TIP: &str = "The file does not state the orientation of a body";
pub(crate) const LEGEND: ControlText = control_text("Legend", "The colours of the values or labels");
pub(crate) const SHOW_IN_FOLDER: &str = "Show in folder";
pub(crate) const COPY_PATH: &str = "Copy path";
pub(crate) const NO_FOLDER: &str = "The folder cannot be shown";
pub(crate) const EMPTY_PICTURE: &str = "the picture has no 8-bit colours";
pub(crate) const EXPORT: &str = "Export";

/// Subject of the export: a picture or an animation.
pub(crate) const STILL: ControlText = control_text("Picture", "The view in the window, at any size");
pub(crate) const TURNTABLE: ControlText =
    control_text("Turntable", "The camera goes once around the volume; the light stays");
pub(crate) const LIGHT_TURN: ControlText =
    control_text("Light turntable", "The selected light goes once around the vertical axis");

pub(crate) const TIME_SERIES: ControlText =
    control_text("Time series", "All time steps of the open volume, one after the other");

/// Number of frames of a time series.
pub(crate) fn steps(count: u32) -> String {
    format!("{count} time steps")
}

/// File formats of a picture, with their tooltips.
pub(crate) const PNG: ControlText = control_text("PNG", "For papers, slides and the web");
pub(crate) const PNG_16: ControlText = control_text(
    "PNG, 16 bit",
    "For prints and for changing colours afterwards: smooth shading stays smooth",
);
pub(crate) const EXR: ControlText =
    control_text("EXR", "Linear light, before tone mapping, for grading and compositing");

/// File formats of a turntable, with their tooltips.
pub(crate) const APNG: ControlText =
    control_text("Animated PNG", "All colours, and transparency; for browsers");
pub(crate) const GIF: ControlText = control_text("GIF", "256 colours; works everywhere");
pub(crate) const MP4: ControlText = control_text("MP4", "A video for slides; needs ffmpeg on this computer");
pub(crate) const FOLDER: ControlText =
    control_text("Image sequence", "A folder of PNG files, for video programs");

pub(crate) const SIZE: &str = "Size";
pub(crate) const WIDTH: &str = "Width";
pub(crate) const HEIGHT: &str = "Height";
/// Suffix of width and height.
pub(crate) const PIXELS: &str = " px";

/// Sizes offered for the picture.
pub(crate) const WINDOW: &str = "Window";
pub(crate) const TWICE_WINDOW: &str = "2 × window";
pub(crate) const FULL_HD: &str = "1920 × 1080";
pub(crate) const ULTRA_HD: &str = "3840 × 2160";
pub(crate) const ULTRA_HD_8K: &str = "7680 × 4320";

pub(crate) const SAMPLES: ControlText = control_text(
    "Samples per pixel",
    "More samples smooth edges and thin structures; twice as many take twice as long",
);

/// Number of frames of a turntable.
pub(crate) const FRAMES: &str = "Frames";
pub(crate) const TURN_PICTURES_UNIT: &str = " frames";
/// Frame rate of a turntable, in frames per second.
pub(crate) const RATE: &str = "Frame rate";
pub(crate) const RATE_UNIT: &str = " per second";

pub(crate) const TRANSPARENT: ControlText = control_text(
    "Transparent background",
    "Leaves the background out, for placing the picture on something else",
);
/// Tooltip while transparency is unavailable.
pub(crate) const NOT_TRANSPARENT_TIP: &str = "MP4 has no transparency";

pub(crate) const FILE: &str = "File";
/// Button that opens the file dialog.
pub(crate) const CHOOSE: &str = "Choose…";

/// Progress text while there is nothing to count.
pub(crate) const RENDERING: &str = "rendering at full quality";

/// Print size of a picture at 300 dpi, in mm.
pub(crate) fn print_size(width_mm: f64, height_mm: f64) -> String {
    format!("{width_mm:.0} × {height_mm:.0} mm at 300 dpi")
}

/// Accessible name of a number of samples per pixel.
pub(crate) fn samples(count: u32) -> String {
    format!("{count} samples per pixel")
}

/// Duration of one turn, in seconds.
pub(crate) fn seconds(seconds: f64) -> String {
    format!("{seconds:.1} s")
}

/// Progress of a picture, in tiles.
pub(crate) fn parts_done(done: u32, total: u32) -> String {
    format!("{done} of {total} parts")
}

/// Progress of a turntable, in frames.
pub(crate) fn frames_done(done: u32, total: u32) -> String {
    format!("{done} of {total} frames")
}

/// Error when the export thread cannot be spawned.
pub(crate) fn no_thread(err: impl Display) -> String {
    format!("could not start the export thread: {err}")
}

/// Path of the file that will be written.
pub(crate) fn target_path(path: &std::path::Path) -> String {
    format!("Saves as {}", path.display())
}

/// Estimated remaining time of an export.
pub(crate) fn time_left(left: std::time::Duration) -> String {
    match left.as_secs() {
        0..90 => format!("{} s left", left.as_secs().max(1)),
        seconds => format!("{} min left", (seconds + 30) / 60),
    }
}
