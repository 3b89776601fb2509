//! State that a window hands over to its successor after the loss of its graphics device.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui;

use super::error::AppError;
use crate::app::document::Document;
use crate::app::layout::WindowLayout;
use crate::app::persistence::PersistentState;
use crate::app::shell::messages::MessageLog;
use crate::app::shell::opening::OpenRequests;
use crate::app::viewport::compare::Compare;
use crate::app::windows::device_loss::DeviceLossAnswer;
use crate::app::windows::export::ExportWindow;
use crate::app::worker::loader::ReadChoices;
use crate::app::{App, text};
use chiaroscuro_scene::QualityPreset;
use chiaroscuro_volume::Dataset;
use chiaroscuro_volume_io::LoadOptions;

/// State of the user's work: the document with its volume in host memory, and what is being opened or exported.
#[derive(Debug)]
pub(crate) struct WindowHandover {
    document: Document,
    dataset: Option<Dataset>,
    requests: OpenRequests,
    /// File that was being opened, with its options.
    opening: Option<(PathBuf, ReadChoices)>,
    memory: PersistentState,
    /// All messages since the start.
    messages: MessageLog,
    layout: WindowLayout,
    compare: Compare,
    /// True while the probe is on.
    probe_on: bool,
    /// Running export, which goes on: it has a device of its own.
    export: ExportWindow,
    pub load: LoadOptions,
    pub storage: Option<PathBuf>,
    /// True if the user has chosen the software adapter (CPU).
    pub on_cpu: bool,
}

/// Slot in which a window leaves its state for a successor.
pub(crate) type HandoverSlot = Arc<Mutex<Option<WindowHandover>>>;

impl App {
    /// Ends this window without drawing any further after the loss of its device; a successor takes its place.
    pub(crate) fn close_for_successor(&mut self, ctx: &egui::Context) {
        if !self.device.is_lost {
            log::warn!("{}", text::messages::DEVICE_LOST);
            self.device.is_lost = true;
            if let Some(words) = self.editor.memory.emergency_save() {
                words.write();
            }
        }
        ctx.send_viewport_cmd(egui::ViewportCommand::Close);
        ctx.request_repaint();
    }

    /// Leaves the state for the successor window.
    pub(crate) fn hand_over(&mut self) {
        let opening = self
            .opening
            .loader
            .progress()
            .map(|progress| (progress.source.to_owned(), progress.reading.clone()));
        let carried = WindowHandover {
            document: std::mem::take(&mut self.editor.document),
            dataset: self.editor.viewport.dataset(),
            requests: std::mem::take(&mut self.opening.requests),
            opening,
            memory: std::mem::take(&mut self.editor.memory),
            messages: std::mem::take(&mut self.editor.messages),
            layout: self.layout.clone(),
            compare: self.editor.viewport.compare.clone(),
            probe_on: self.picture.light_probe.is_active,
            export: std::mem::take(&mut self.windows.export),
            load: self.opening.loader.options().clone(),
            storage: self.device.storage.clone(),
            on_cpu: self.device.wants_cpu,
        };
        *self.device.handover.lock().unwrap_or_else(PoisonError::into_inner) = Some(carried);
    }

    /// Starts a successor window with the state of a window whose device was lost. After losses in short succession
    /// (`asks`) the user is asked first.
    pub(crate) fn resume(
        cc: &eframe::CreationContext<'_>,
        carried: WindowHandover,
        legacy: HandoverSlot,
        asks: bool,
    ) -> Result<Self, AppError> {
        let mut app = Self::build(cc, carried.load, carried.storage, carried.memory, legacy)?;
        app.editor.document = carried.document.restarted();
        app.opening.requests = carried.requests;
        app.device.handed_over_dataset = carried.dataset;
        carried.layout.apply(&cc.egui_ctx);
        (app.editor.messages, app.layout) = (carried.messages, carried.layout);
        (app.editor.viewport.compare, app.picture.light_probe.is_active) =
            (carried.compare, carried.probe_on);
        app.windows.export = carried.export;
        if asks {
            app.dialogs.device_loss.open();
        } else {
            app.editor.messages.note(text::messages::DEVICE_REPLACED);
            app.restore_volume(&cc.egui_ctx);
        }
        if let Some((source, reading)) = carried.opening {
            app.opener(&cc.egui_ctx).start_loading(&source, reading);
        } else if app.editor.document.volume.is_none() {
            app.opener(&cc.egui_ctx).open_first(None, None);
        }
        Ok(app)
    }

    /// Shows the volume again that the earlier window had open.
    pub(crate) fn restore_volume(&mut self, ctx: &egui::Context) {
        let dataset = self.device.handed_over_dataset.take();
        self.opener(ctx).restore(dataset);
    }

    /// Executes the user's answer after the device was lost again within a short time.
    pub(crate) fn answer_loss(&mut self, answer: DeviceLossAnswer, ctx: &egui::Context) {
        match answer {
            DeviceLossAnswer::TryAgain => self.restore_volume(ctx),
            DeviceLossAnswer::LowerQuality => {
                QualityPreset::Fast.apply(&mut self.editor.document.settings);
                self.restore_volume(ctx);
            }
            DeviceLossAnswer::UseCpu => {
                self.device.wants_cpu = true;
                self.close_for_successor(ctx);
            }
            DeviceLossAnswer::Quit => ctx.send_viewport_cmd(egui::ViewportCommand::Close),
        }
    }
}
