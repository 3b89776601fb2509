//! State that a window hands over to its successor after the loss of its graphics device.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui;

use super::error::AppError;
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::layout::Layout;
use crate::app::memory::Memory;
use crate::app::shell::first_lights::FirstLights;
use crate::app::shell::history::History;
use crate::app::shell::messages::Messages;
use crate::app::shell::object::corrected::Corrected;
use crate::app::shell::object::treat_as::Treated;
use crate::app::shell::opening::PendingLook;
use crate::app::shell::session::Session;
use crate::app::viewport::compare::Compare;
use crate::app::windows::export::Export;
use crate::app::windows::lost_again::Answer;
use crate::app::worker::loader::Reading;
use crate::app::{App, text};
use crate::data::Dataset;
use crate::data::load::LoadOptions;
use crate::model::{Quality, Settings};

/// State of the user's work: the look with its history, the volume in host memory, and the session file.
#[derive(Debug)]
pub(in crate::app) struct Carried {
    settings: Settings,
    defaults: Settings,
    history: History,
    treated: Treated,
    corrected: Corrected,
    first_lights: FirstLights,
    volume: Option<VolumeFacts>,
    dataset: Option<Dataset>,
    session: Option<Session>,
    session_is_due: bool,
    trusts_paths: bool,
    memory: Memory,
    keeps_look: bool,
    compare: Compare,
    selected_light: usize,
    /// All messages since the start.
    messages: Messages,
    layout: Layout,
    /// True while the probe is on.
    probes: bool,
    /// Running export, which goes on: it has a device of its own.
    export: Export,
    /// File that was being opened, with its options.
    opening: Option<(PathBuf, Reading)>,
    pending: Option<PendingLook>,
    pub load: LoadOptions,
    pub storage: Option<PathBuf>,
    /// True if the user has chosen the software adapter (CPU).
    pub on_cpu: bool,
}

/// Slot in which a window leaves its state for a successor.
pub(in crate::app) type Legacy = Arc<Mutex<Option<Carried>>>;

impl App {
    /// Ends this window without drawing any further after the loss of its device; a successor takes its place.
    pub(in crate::app) fn end_for_another(&mut self, ctx: &egui::Context) {
        if !self.is_ending {
            log::warn!("{}", text::messages::DEVICE_LOST);
            self.is_ending = true;
            if let Some(words) = self.memory.last_words() {
                words.write();
            }
        }
        ctx.send_viewport_cmd(egui::ViewportCommand::Close);
        ctx.request_repaint();
    }

    /// Leaves the state for the successor window.
    pub(in crate::app) fn leave(&mut self) {
        let opening =
            self.loader.progress().map(|progress| (progress.source.to_owned(), progress.reading.clone()));
        let carried = Carried {
            settings: std::mem::take(&mut self.settings),
            defaults: std::mem::take(&mut self.defaults),
            history: std::mem::take(&mut self.history),
            treated: std::mem::take(&mut self.treated),
            corrected: std::mem::take(&mut self.corrected),
            first_lights: std::mem::take(&mut self.first_lights),
            volume: self.volume.take(),
            dataset: self.viewport.dataset(),
            session: self.session.take(),
            session_is_due: self.session_is_due,
            trusts_paths: self.trusts_paths,
            memory: std::mem::take(&mut self.memory),
            keeps_look: self.keeps_look,
            compare: self.compare.clone(),
            selected_light: self.selected_light,
            messages: std::mem::take(&mut self.messages),
            layout: self.layout.clone(),
            probes: self.probe.on,
            export: std::mem::take(&mut self.export),
            opening,
            pending: self.pending.take(),
            load: self.loader.options().clone(),
            storage: self.storage.clone(),
            on_cpu: self.wants_cpu,
        };
        *self.legacy.lock().unwrap_or_else(PoisonError::into_inner) = Some(carried);
    }

    /// Starts a successor window with the state of a window whose device was lost. After losses in short succession
    /// (`asks`) the user is asked first.
    pub(in crate::app) fn go_on(
        cc: &eframe::CreationContext<'_>,
        carried: Carried,
        legacy: Legacy,
        asks: bool,
    ) -> Result<Self, AppError> {
        let Carried {
            settings,
            defaults,
            history,
            treated,
            corrected,
            first_lights,
            volume,
            dataset,
            session,
            session_is_due,
            trusts_paths,
            memory,
            keeps_look,
            compare,
            selected_light,
            messages,
            layout,
            probes,
            export,
            opening,
            pending,
            load,
            storage,
            on_cpu: _,
        } = carried;
        let mut app = Self::build(cc, load, storage, memory, legacy)?;
        app.keep_balanced.accept(&settings);
        (app.settings, app.defaults, app.history) = (settings, defaults, history);
        (app.treated, app.corrected, app.first_lights) = (treated, corrected, first_lights.again());
        (app.volume, app.session, app.session_is_due) = (volume, session, session_is_due);
        (app.keeps_look, app.compare, app.selected_light) = (keeps_look, compare, selected_light);
        (app.pending, app.trusts_paths, app.export) = (pending, trusts_paths, export);
        app.waiting = dataset;
        layout.apply(&cc.egui_ctx);
        (app.messages, app.layout, app.probe.on) = (messages, layout, probes);
        if asks {
            app.lost_again.ask();
        } else {
            app.messages.note(text::messages::DEVICE_IS_BACK);
            app.show_again(&cc.egui_ctx);
        }
        if let Some((source, reading)) = opening {
            app.start_loading(&source, reading, &cc.egui_ctx);
        } else if app.volume.is_none() {
            app.open_first(None, None, &cc.egui_ctx);
        }
        Ok(app)
    }

    /// Shows the volume again that the earlier window had open.
    pub(in crate::app) fn show_again(&mut self, ctx: &egui::Context) {
        if let Some(dataset) = self.waiting.take()
            && let Err(err) = self.loader.show(dataset, ctx)
        {
            self.messages.error(text::messages::NOT_RENDERED, err);
        }
    }

    /// Executes the user's answer after the device was lost again within a short time.
    pub(in crate::app) fn answer_loss(&mut self, answer: Answer, ctx: &egui::Context) {
        match answer {
            Answer::TryAgain => self.show_again(ctx),
            Answer::LowerQuality => {
                Quality::Fast.apply(&mut self.settings);
                self.show_again(ctx);
            }
            Answer::UseCpu => {
                self.wants_cpu = true;
                self.end_for_another(ctx);
            }
            Answer::Quit => ctx.send_viewport_cmd(egui::ViewportCommand::Close),
        }
    }
}
