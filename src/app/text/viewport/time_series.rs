//! Texts of the bar under the picture that shows the time steps of a series.

use crate::app::text::{ControlText, control_text};
use chiaroscuro_volume::ValueRange;

pub(crate) const PLAY: ControlText = control_text("Play", "Show the time steps one after the other (Y)");
pub(crate) const PAUSE: ControlText = control_text("Pause", "Stop at this time step (Y)");
pub(crate) const PREVIOUS: ControlText = control_text("‹", "Back by one time step");
pub(crate) const NEXT: ControlText = control_text("›", "Forward by one time step");
pub(crate) const STEP: ControlText = control_text("Time step", "Drag to go through the series");
pub(crate) const LOOP: ControlText = control_text("Loop", "Begin again after the last time step");
pub(crate) const RATE: ControlText =
    control_text("Speed", "Time steps per second; a slow computer shows fewer, and leaves none out");
pub(crate) const RATE_UNIT: &str = " steps/s";
pub(crate) const RANGE: ControlText = control_text(
    "Range of all steps",
    "Read the series, and give colours and opacities the range of values that all time steps have together",
);
pub(crate) const CANCEL_RANGE: &str = "Cancel";
pub(crate) const CLOSE: ControlText =
    control_text("Close", "Show this file alone, without the numbered files beside it");
/// Message when no file beside the open one has the same name but for its number.
pub(crate) const NO_SERIES: &str =
    "One time step is open, and no file beside it has the same name but for a number";
pub(crate) const RANGE_NOT_READ: &str = "The range of all time steps was not read";

/// Number of the step that is shown, and its name.
pub(crate) fn step_of(index: usize, count: usize, name: &str) -> String {
    let number = format!("{} of {count}", index + 1);
    if name.is_empty() { number } else { format!("{number} · {name}") }
}

/// Step that is being read while another one is shown.
pub(crate) fn is_read(index: usize) -> String {
    format!("reading step {}…", index + 1)
}

/// Headline of the error of a step that was not read.
pub(crate) fn not_read(index: usize, name: &str) -> String {
    let number = index + 1;
    if name.is_empty() {
        format!("Time step {number} was not read")
    } else {
        format!("Time step {number}, {name}, was not read")
    }
}

/// Progress of reading the series for its range.
pub(crate) fn range_progress(done: u32, total: u32) -> String {
    format!("range: step {done} of {total}")
}

/// Message when the range of the series is used.
pub(crate) fn range_used(steps: usize, range: ValueRange) -> String {
    format!("Values from {:.4} to {:.4}, as {steps} time steps have them", range.low, range.high)
}
