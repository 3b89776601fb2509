//! State that a window hands over to its successor after the loss of its graphics device.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui;

use super::error::AppError;
use crate::app::document::Document;
use crate::app::layout::WindowLayout;
use crate::app::persistence::PersistentState;
use crate::app::shell::messages::MessageLog;
use crate::app::shell::opening::PendingLook;
use crate::app::viewport::compare::Compare;
use crate::app::windows::device_loss::DeviceLossAnswer;
use crate::app::windows::export::ExportWindow;
use crate::app::worker::loader::ReadChoices;
use crate::app::{App, text};
use chiaroscuro_scene::QualityPreset;
use chiaroscuro_volume::Dataset;
use chiaroscuro_volume_io::LoadOptions;

/// State of the user's work: the look with its history, the volume in host memory, and the session file.
#[derive(Debug)]
pub(crate) struct WindowHandover {
    document: Document,
    dataset: Option<Dataset>,
    session_is_due: bool,
    trusts_paths: bool,
    memory: PersistentState,
    keeps_look: bool,
    compare: Compare,
    /// All messages since the start.
    messages: MessageLog,
    layout: WindowLayout,
    /// True while the probe is on.
    probe_on: bool,
    /// Running export, which goes on: it has a device of its own.
    export: ExportWindow,
    /// File that was being opened, with its options.
    opening: Option<(PathBuf, ReadChoices)>,
    pending: Option<PendingLook>,
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
        if !self.is_device_lost {
            log::warn!("{}", text::messages::DEVICE_LOST);
            self.is_device_lost = true;
            if let Some(words) = self.memory.emergency_save() {
                words.write();
            }
        }
        ctx.send_viewport_cmd(egui::ViewportCommand::Close);
        ctx.request_repaint();
    }

    /// Leaves the state for the successor window.
    pub(crate) fn hand_over(&mut self) {
        let opening =
            self.loader.progress().map(|progress| (progress.source.to_owned(), progress.reading.clone()));
        let carried = WindowHandover {
            document: std::mem::take(&mut self.document),
            dataset: self.viewport.dataset(),
            session_is_due: self.session_is_due,
            trusts_paths: self.trusts_paths,
            memory: std::mem::take(&mut self.memory),
            keeps_look: self.keeps_look_for_next,
            compare: self.compare.clone(),
            messages: std::mem::take(&mut self.messages),
            layout: self.layout.clone(),
            probe_on: self.light_probe.is_active,
            export: std::mem::take(&mut self.export),
            opening,
            pending: self.pending_look.take(),
            load: self.loader.options().clone(),
            storage: self.storage.clone(),
            on_cpu: self.wants_cpu,
        };
        *self.handover.lock().unwrap_or_else(PoisonError::into_inner) = Some(carried);
    }

    /// Starts a successor window with the state of a window whose device was lost. After losses in short succession
    /// (`asks`) the user is asked first.
    pub(crate) fn resume(
        cc: &eframe::CreationContext<'_>,
        carried: WindowHandover,
        legacy: HandoverSlot,
        asks: bool,
    ) -> Result<Self, AppError> {
        let WindowHandover {
            document,
            dataset,
            session_is_due,
            trusts_paths,
            memory,
            keeps_look,
            compare,
            messages,
            layout,
            probe_on: probes,
            export,
            opening,
            pending,
            load,
            storage,
            on_cpu: _,
        } = carried;
        let mut app = Self::build(cc, load, storage, memory, legacy)?;
        app.document = document.restarted();
        app.session_is_due = session_is_due;
        (app.keeps_look_for_next, app.compare) = (keeps_look, compare);
        (app.pending_look, app.trusts_paths, app.export) = (pending, trusts_paths, export);
        app.handed_over_dataset = dataset;
        layout.apply(&cc.egui_ctx);
        (app.messages, app.layout, app.light_probe.is_active) = (messages, layout, probes);
        if asks {
            app.device_loss_dialog.open();
        } else {
            app.messages.note(text::messages::DEVICE_REPLACED);
            app.restore_volume(&cc.egui_ctx);
        }
        if let Some((source, reading)) = opening {
            app.start_loading(&source, reading, &cc.egui_ctx);
        } else if app.document.volume.is_none() {
            app.open_first(None, None, &cc.egui_ctx);
        }
        Ok(app)
    }

    /// Shows the volume again that the earlier window had open.
    pub(crate) fn restore_volume(&mut self, ctx: &egui::Context) {
        if let Some(dataset) = self.handed_over_dataset.take()
            && let Err(err) = self.loader.upload(dataset, ctx)
        {
            self.messages.error(text::messages::NOT_RENDERED, err);
        }
    }

    /// Executes the user's answer after the device was lost again within a short time.
    pub(crate) fn answer_loss(&mut self, answer: DeviceLossAnswer, ctx: &egui::Context) {
        match answer {
            DeviceLossAnswer::TryAgain => self.restore_volume(ctx),
            DeviceLossAnswer::LowerQuality => {
                QualityPreset::Fast.apply(&mut self.document.settings);
                self.restore_volume(ctx);
            }
            DeviceLossAnswer::UseCpu => {
                self.wants_cpu = true;
                self.close_for_successor(ctx);
            }
            DeviceLossAnswer::Quit => ctx.send_viewport_cmd(egui::ViewportCommand::Close),
        }
    }
}
