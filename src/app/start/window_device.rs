//! Graphics device that draws the window, and what is left for a successor window when it is lost.

use std::path::PathBuf;
use std::sync::PoisonError;

use eframe::egui;

use super::handover::{HandoverSlot, WindowHandover};
use crate::app::layout::WindowLayout;
use crate::app::persistence::PersistentState;
use crate::app::shell::look_editor::LookEditor;
use crate::app::shell::opening::OpeningState;
use crate::app::shell::tool_windows::ToolWindows;
use crate::app::text;
use crate::app::worker::jobs::Jobs;
use chiaroscuro_files::fault::{self, FaultEvent, FaultThread, InjectedFault, panic_if_injected};
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
    handover: HandoverSlot,
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

    /// Returns true if nothing can be drawn any more, because the device is lost or that of the `renderer`.
    pub(crate) fn is_lost_with(&self, renderer: &GpuContext) -> bool {
        let is_lost = self.context.is_lost() || renderer.is_known_lost();
        self.is_lost || is_lost
    }

    /// Ends the window without drawing any further after the loss of a device; a successor takes its place.
    pub(crate) fn close_for_successor(&mut self, memory: &PersistentState, ctx: &egui::Context) {
        if !self.is_lost {
            log::warn!("{}", text::messages::DEVICE_LOST);
            self.is_lost = true;
            if let Some(words) = memory.emergency_save() {
                words.write();
            }
        }
        ctx.send_viewport_cmd(egui::ViewportCommand::Close);
        ctx.request_repaint();
    }

    /// Leaves the state of the window for its successor; `probe_on` is true while the probe is on.
    pub(crate) fn hand_over(
        &self,
        editor: &mut LookEditor,
        opening: &mut OpeningState,
        windows: &mut ToolWindows,
        layout: &WindowLayout,
        jobs: &Jobs,
        probe_on: bool,
    ) {
        let progress = opening.loader.progress();
        let in_progress = progress.map(|progress| (progress.source.to_owned(), progress.reading.clone()));
        let carried = WindowHandover {
            document: std::mem::take(&mut editor.document),
            dataset: editor.viewport.dataset(),
            requests: std::mem::take(&mut opening.requests),
            opening: in_progress,
            memory: std::mem::take(&mut editor.memory),
            messages: std::mem::take(&mut editor.messages),
            layout: layout.clone(),
            compare: editor.viewport.compare.clone(),
            probe_on,
            export: std::mem::take(&mut windows.export),
            jobs: jobs.clone(),
            load: opening.loader.options().clone(),
            storage: self.storage.clone(),
            on_cpu: self.wants_cpu,
        };
        *self.handover.lock().unwrap_or_else(PoisonError::into_inner) = Some(carried);
    }

    /// Injects the faults that `--fault` asks for, into this device or that of the `renderer`.
    pub(crate) fn inject_faults(&self, renderer: &GpuContext) {
        panic_if_injected(FaultThread::Window);
        std::thread::sleep(fault::frame_delay());
        let frame = fault::count(FaultEvent::WindowFrame);
        if fault::is_on(InjectedFault::DeviceLost(frame)) {
            self.context.destroy_device();
        }
        if fault::is_on(InjectedFault::DeviceLost(frame))
            || fault::is_on(InjectedFault::RendererDeviceLost(frame))
        {
            renderer.destroy_device();
        }
    }
}
