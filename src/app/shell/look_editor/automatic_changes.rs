//! Automatic changes of the look: lights placed at the end of a first look, and the balance, measured on request or
//! kept. Their workers run on threads; the document decides which changes are due.

use std::time::Duration;

use eframe::egui;

use super::LookEditor;
use crate::app::document::auto_balance::{BalanceAction, BalanceFrame};
use crate::app::document::light_placement::{LightPlacementAction, LightPlacementFrame};
use crate::app::text;
use crate::app::worker::jobs::{JobControl, JobKind, JobSlot};
use crate::app::worker::mailbox::RefinementHold;
use chiaroscuro_render::{GpuError, LightSearch, LightSearchResult, Renderer, SearchedLight, ShaderLibrary};

/// Pause between two candidate positions: long enough for another thread to take the device.
const CANDIDATE_PAUSE: Duration = Duration::from_millis(1);

/// Returns true while the user holds a pointer button or a key, or edits text; automatic changes wait meanwhile.
fn is_user_active(ctx: &egui::Context) -> bool {
    ctx.input(|input| input.pointer.any_down() || !input.keys_down.is_empty()) || ctx.text_edit_focused()
}

/// Tasks whose results change the look.
#[derive(Default)]
pub(crate) struct LookTasks {
    /// Measurement of the balance that the user has asked for.
    pub balance: JobSlot<Result<f64, GpuError>>,
    /// Search for the lights of the first look.
    pub light_search: JobSlot<Result<Option<LightSearchResult>, GpuError>>,
}

impl LookEditor {
    /// Finishes the first look of the volume with the lights found, unless the user has edited it. The search uses
    /// compiled `shaders`, and waits while a file is opened or read (`is_opening`).
    pub(crate) fn finish_first_look(
        &mut self,
        is_opening: bool,
        shaders: &ShaderLibrary,
        ctx: &egui::Context,
    ) {
        if let Some(result) = self.look_tasks.light_search.take_result() {
            self.document.first_lights.set_result(result.unwrap_or_else(|panic| {
                log::error!("the search for a light position failed: {panic}");
                Ok(None)
            }));
        }
        if !self.document.first_lights.is_due() {
            self.look_tasks.light_search.discard();
        }
        let now_s = ctx.input(|input| input.time);
        let is_shown = !is_opening && self.viewport.displays(&self.shown_looks());
        let document = &mut self.document;
        let moment = LightPlacementFrame {
            now_s,
            settings: &document.settings,
            // The search refers to the picture with the final balance, so a pending change comes first.
            is_shown: is_shown && !document.keep_balanced.is_due(&document.settings),
            user_active: is_user_active(ctx),
            limit_s: self.light_search_limit_s,
        };
        match document.first_lights.next_action(moment) {
            LightPlacementAction::Nothing => {}
            LightPlacementAction::Search => {
                self.start_light_search(shaders, ctx);
                // The search may end without a result.
                ctx.request_repaint_after(
                    Duration::try_from_secs_f64(self.light_search_limit_s).unwrap_or(Duration::MAX),
                );
            }
            LightPlacementAction::Set(next) => {
                document.apply_placed_lights(*next, now_s);
                ctx.request_repaint();
            }
        }
    }

    /// Starts a light search on a thread, on the render device, whose pipelines are compiled already.
    fn start_light_search(&mut self, shaders: &ShaderLibrary, ctx: &egui::Context) {
        let Some(dataset) = self.viewport.dataset() else { return self.document.first_lights.stop() };
        let (shaders, settings) = (shaders.clone(), self.document.settings.clone());
        let task = move |job: &JobControl| -> Result<Option<LightSearchResult>, GpuError> {
            let mut search = LightSearch::new(shaders, &dataset, &settings, SearchedLight::KeyAndRim)?;
            while search.step()? {
                if job.token().is_cancelled() {
                    return Ok(None);
                }
                // Lets pictures that were requested meanwhile go first.
                std::thread::sleep(CANDIDATE_PAUSE);
            }
            Ok(search.finish())
        };
        if let Err(err) = self.look_tasks.light_search.start(JobKind::LightSearch, ctx, (), task) {
            log::warn!("the search for a light position could not start: {err}");
            self.document.first_lights.stop();
        }
    }

    /// Starts measuring the balance of the current settings, on a device of its own; does nothing without a volume.
    pub(crate) fn start_balance(&mut self, ctx: &egui::Context) {
        let Some(dataset) = self.viewport.dataset().filter(|_| !self.look_tasks.balance.is_running()) else {
            return;
        };
        let (context, settings) = (self.viewport.context().clone(), self.document.settings.clone());
        let task = move |_: &JobControl| {
            let mut renderer = Renderer::new(&context.second_device()?)?;
            chiaroscuro_render::measure_balance(&mut renderer, &dataset, &settings)
        };
        if let Err(err) = self.look_tasks.balance.start(JobKind::Balance, ctx, (), task) {
            self.messages.error(text::messages::BALANCE_NOT_MEASURED, err.to_string());
        }
    }

    /// Keeps the picture as bright as without shadows, if the setting is on and no file is opened or read.
    pub(crate) fn update_balance(&mut self, is_opening: bool, ctx: &egui::Context) {
        if self.plays_steps {
            return self.viewport.hold_refinement(RefinementHold::AtOnce);
        }
        let now_s = ctx.input(|input| input.time);
        let (held, busy, has_its_volume) =
            (is_user_active(ctx), self.look_tasks.balance.is_running(), !is_opening && !self.is_correcting());
        let is_due = self.document.keep_balanced.is_due(&self.document.settings);
        self.viewport.hold_refinement(if held || busy || !has_its_volume {
            RefinementHold::Off
        } else if self.document.first_lights.is_searching() {
            RefinementHold::AtOnce
        } else if is_due {
            RefinementHold::BeforeDrawing
        } else {
            RefinementHold::Off
        });
        let act = self.document.keep_balanced.next_action(BalanceFrame {
            now_s,
            settings: &self.document.settings,
            is_shown: has_its_volume && self.viewport.displays(&self.shown_looks()),
            user_active: held,
            busy,
        });
        match act {
            BalanceAction::Nothing => {}
            BalanceAction::Wait(wait_s) => ctx.request_repaint_after(Duration::from_secs_f64(wait_s)),
            BalanceAction::Measure => self.viewport.measure_balance(&self.document.settings),
            BalanceAction::Set(balance) => {
                self.document.apply_balance(balance, now_s);
                ctx.request_repaint();
            }
        }
    }

    /// Takes the results of the measurements of balance.
    pub(crate) fn take_balances(&mut self, ctx: &egui::Context) {
        if let Some(result) = self.look_tasks.balance.take_result() {
            match result.and_then(|balance| balance.map_err(|err| err.to_string())) {
                Ok(balance) => {
                    self.document.settings.shadows.balance = balance;
                    self.document.settings.sanitise();
                }
                Err(err) => self.messages.error(text::messages::BALANCE_NOT_MEASURED, err),
            }
        }
        if let Some(found) = self.viewport.take_balance() {
            self.document
                .keep_balanced
                .set_result(ctx.input(|input| input.time), found.as_ref().ok().copied());
            if let Err(err) = found {
                self.messages.error(text::messages::BALANCE_NOT_MEASURED, err.to_string());
            }
        }
    }
}
