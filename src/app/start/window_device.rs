//! Graphics device that draws the window, and what is left for a successor window when it is lost.

use std::path::PathBuf;

use super::handover::HandoverSlot;
use chiaroscuro_render::{GpuContext, WindowPainter};
use chiaroscuro_volume::Dataset;

/// Graphics device of the window, with the state of its loss.
pub(crate) struct WindowDevice {
    /// Painter of the window's background colour.
    pub painter: WindowPainter,
    /// Graphics device that draws the window.
    pub context: GpuContext,
    /// Storage folder for the state that outlives a run.
    pub storage: Option<PathBuf>,
    /// State that this window hands over to its successor after a lost device.
    pub handover: HandoverSlot,
    /// Volume handed over from an earlier window, until the user has chosen how to go on.
    pub handed_over_dataset: Option<Dataset>,
    /// True once the device is lost; nothing is drawn any more.
    pub is_lost: bool,
    /// True if the next window is to be drawn by the CPU (software adapter).
    pub wants_cpu: bool,
}

impl WindowDevice {
    /// Creates the state of a window that draws with `painter`, on the device `context`.
    pub(super) fn new(
        painter: WindowPainter,
        context: GpuContext,
        storage: Option<PathBuf>,
        handover: HandoverSlot,
    ) -> Self {
        Self {
            painter,
            context,
            storage,
            handover,
            handed_over_dataset: None,
            is_lost: false,
            wants_cpu: false,
        }
    }
}
