//! The export window.

use std::fmt::Display;

use crate::app::text::{Named, named};

pub(crate) const TITLE: &str = "Export picture or turntable";

/// What is written over a picture.
pub(crate) const MARKS: &str = "Marks";
pub(crate) const SCALE_BAR: Named = named("Scale bar", "How long things are, at the middle of the view");
pub(crate) const LETTERS: Named =
    named("Orientation letters", "Which side of a body is where, if the file says it");
/// The tip where there are none.
pub(crate) const NO_LETTERS_TIP: &str = "The file does not say which side of a body is where";
pub(crate) const LEGEND: Named = named("Legend", "Which colour stands for which value or label");
pub(crate) const SHOW_IN_FOLDER: &str = "Show in folder";
pub(crate) const COPY_PATH: &str = "Copy path";
pub(crate) const NO_FOLDER: &str = "The folder cannot be shown";
pub(crate) const NO_BYTES: &str = "the picture has no bytes";
pub(crate) const EXPORT: &str = "Export";

/// What is made.
pub(crate) const STILL: Named = named("Picture", "What the window shows, at any size");
pub(crate) const TURNTABLE: Named =
    named("Turntable", "The camera goes once around the volume; the light stays");
pub(crate) const LIGHT_TURN: Named =
    named("Light turntable", "The selected light goes once around the vertical axis");

/// Files for a picture.
pub(crate) const PNG: Named = named("PNG", "For papers, slides and the web");
pub(crate) const PNG_16: Named =
    named("PNG, 16 bit", "For prints and for changing colours afterwards: smooth shading stays smooth");
pub(crate) const EXR: Named =
    named("EXR", "Light before the tone map, linear, for programs that grade and composite");

/// Files for a turn.
pub(crate) const APNG: Named = named("Animated PNG", "Every colour, and transparency; browsers show it");
pub(crate) const GIF: Named = named("GIF", "256 colours; everything shows it");
pub(crate) const MP4: Named = named("MP4", "A video for slides; needs ffmpeg on this computer");
pub(crate) const FOLDER: Named = named("Image sequence", "A folder of PNG files, for video programs");

pub(crate) const SIZE: &str = "Size";
pub(crate) const WIDTH: &str = "Width";
pub(crate) const HEIGHT: &str = "Height";
/// Behind the width and the height.
pub(crate) const PIXELS: &str = " px";

/// Sizes to choose from.
pub(crate) const WINDOW: &str = "Window";
pub(crate) const TWICE_WINDOW: &str = "2 × window";
pub(crate) const FULL_HD: &str = "1920 × 1080";
pub(crate) const ULTRA_HD: &str = "3840 × 2160";
pub(crate) const ULTRA_HD_8K: &str = "7680 × 4320";

pub(crate) const SAMPLES: Named = named(
    "Samples per pixel",
    "More samples smooth edges and thin structures, and take as many times longer",
);

/// The length of a turntable.
pub(crate) const TURN_PICTURES: &str = "Frames";
pub(crate) const TURN_PICTURES_UNIT: &str = " frames";
/// How fast a turntable goes by.
pub(crate) const RATE: &str = "Frame rate";
pub(crate) const RATE_UNIT: &str = " per second";

pub(crate) const TRANSPARENT: Named =
    named("Transparent background", "Leaves the background out, for placing the picture on something else");
/// The tip while it cannot be had.
pub(crate) const NOT_TRANSPARENT_TIP: &str = "MP4 has no transparency";

pub(crate) const FILE: &str = "File";
/// Opens a dialog for the file.
pub(crate) const CHOOSE: &str = "Choose…";

/// What is being done while nothing can be counted.
pub(crate) const RENDERING: &str = "rendering at full quality";

/// How large a picture is in print.
pub(crate) fn on_paper(width_mm: f64, height_mm: f64) -> String {
    format!("{width_mm:.0} × {height_mm:.0} mm at 300 dpi")
}

/// What screen readers call a choice of samples.
pub(crate) fn samples(count: u32) -> String {
    format!("{count} samples per pixel")
}

/// How long a turn takes.
pub(crate) fn seconds(seconds: f64) -> String {
    format!("{seconds:.1} s")
}

/// How far the export of a picture is.
pub(crate) fn parts_done(done: u32, total: u32) -> String {
    format!("{done} of {total} parts")
}

/// How far the export of a turntable is.
pub(crate) fn pictures_done(done: u32, total: u32) -> String {
    format!("{done} of {total} frames")
}

/// The system is out of threads.
pub(crate) fn no_thread(err: impl Display) -> String {
    format!("no thread for the export: {err}")
}

/// Where a file goes.
pub(crate) fn goes_to(path: &std::path::Path) -> String {
    format!("Goes to {}", path.display())
}

/// How long an export still takes.
pub(crate) fn left(left: std::time::Duration) -> String {
    match left.as_secs() {
        0..90 => format!("{} s left", left.as_secs().max(1)),
        seconds => format!("{} min left", (seconds + 30) / 60),
    }
}
