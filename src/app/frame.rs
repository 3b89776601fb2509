//! Frame of the window: collects results, shows panels, picture and windows, and executes the commands of the user.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use eframe::egui;

use super::common::commands::AppCommand;
use super::common::{light_keys, reveal, shortcuts};
use super::layout::outer_panels::OuterPanelInputs;
use super::shell::opening::VolumeOpener;
use super::shell::start_screen::stays_on_start;
use super::shell::status_file;
use super::viewport::paint_callback;
use super::windows::device_loss::DeviceLossAnswer;
use super::windows::recovery::RecoveryAnswer;
use super::windows::{ToolRequest, ToolScene, file_dialogs};
use super::{App, text};
use chiaroscuro_render::GpuError;
use chiaroscuro_scene::QualityPreset;

/// Duration of a frame on the window's thread, in ms, from which on the delay is felt and logged.
const SLOW_FRAME_MS: f64 = 50.0;

impl eframe::App for App {
    fn logic(&mut self, ctx: &egui::Context, _frame: &mut eframe::Frame) {
        self.device.inject_faults(self.editor.viewport.context());
        // Checked before anything is drawn, because drawing on a lost device would panic.
        if self.device.is_lost_with(self.editor.viewport.context()) {
            return self.device.close_for_successor(&self.editor.memory, ctx);
        }
        self.collect_results(ctx);
        // Runs even while the window is hidden and nothing is drawn.
        self.editor.autosave_look();
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        if self.device.is_lost {
            return;
        }
        let ctx = ui.ctx().clone();
        let start = Instant::now();
        ui.painter().add(paint_callback::fill_shape(
            ctx.viewport_rect(),
            &self.device.painter,
            ui.visuals().panel_fill,
        ));
        self.drag_cancel.begin(&ctx, &self.editor.document.settings);
        let mut commands = Vec::new();
        let dropped = file_dialogs::dropped_files(&ctx);
        if !dropped.is_empty() {
            commands.push(AppCommand::OpenDropped(dropped));
        }
        let facts = self.editor.viewport.renderer_status(&self.editor.shown_looks());
        self.windows.palette.ui(
            &ctx,
            self.editor.document.settings.camera.up,
            self.editor.document.volume.as_ref(),
            &mut commands,
        );
        self.windows.volume_chooser.ui(
            &ctx,
            self.editor.document.volume.as_ref(),
            self.opening.loader.options(),
            &mut commands,
        );
        let occupation = self.occupation();
        let shows_start = self.start_screen.update(occupation);
        let mut inputs = OuterPanelInputs {
            editor: &mut self.editor,
            opening: &self.opening,
            picture: &self.picture,
            windows: &mut self.windows,
            layout: &mut self.layout,
            facts: &facts,
            time_series: &mut self.time_series,
            commands: &mut commands,
            shows_start,
        };
        self.panels.show(ui, &mut inputs);
        self.editor.document.highlighted_material = self.panels.editor.take_hovered_material();
        if shows_start {
            self.show_start(ui, &mut commands);
        } else {
            let export_preview = self.windows.export.requested_image().filter(|_| !self.layout.picture_only);
            let drawn = self.picture.show_picture(
                ui,
                &mut self.editor,
                &mut self.windows.slices,
                export_preview,
                &facts,
                &mut commands,
            );
            if let Err(err) = drawn {
                self.handle_render_error(&err, &ctx);
            }
        }
        self.editor.document.update_shown_range(self.editor.viewport.dataset().as_ref());
        let mut from_keys = Vec::new();
        shortcuts::commands_from_keys(&ctx, &mut from_keys);
        if shows_start {
            // Keys for the picture have no effect while it is hidden.
            from_keys.retain(stays_on_start);
        } else {
            light_keys::nudge(&ctx, &mut self.editor.document.settings, self.editor.document.selected_light);
        }
        commands.extend(from_keys);
        self.show_windows(frame, &ctx, &mut commands);
        self.drag_cancel.end(&mut self.editor.document.settings);
        let mut opener = VolumeOpener { state: &mut self.opening, editor: &mut self.editor, ctx: &ctx };
        opener.ask_for_volume(&mut self.dialogs.files, frame);
        self.editor.document.history.observe(&ctx, &self.editor.document.history_step());
        commands.extend(self.editor.finish_framing());
        commands.extend(self.editor.update_outline(self.opening.is_opening(), &ctx));
        let before = self.editor.document.settings.camera.clone();
        for command in commands {
            if shows_start && !stays_on_start(&command) {
                self.start_screen.close();
            }
            self.execute(command, frame, &ctx);
        }
        if shows_start && occupation.has_volume && !occupation.is_opening {
            self.start_screen.close_by_key(&ctx);
        }
        self.picture.camera_animation.begin(
            &before,
            &self.editor.document.settings.camera,
            ctx.input(|input| input.time),
        );
        self.opener(&ctx).cancel_files_by_key();
        self.drop_pictures_of_replaced();
        self.update_time_series(&ctx);
        self.layout.leave_picture_only(&ctx);
        let has_other_fields = self.editor.update_fields();
        if self.editor.update_corrections(&ctx) || has_other_fields {
            self.windows.contact_sheet.discard();
        }
        let is_opening = self.opening.is_opening();
        self.editor.finish_first_look(is_opening, self.opening.loader.shaders(), &ctx);
        self.editor.update_balance(is_opening, &ctx);
        self.editor.autosave_look();
        self.update_status(start.elapsed(), &ctx);
        if self.opening.loader.progress().is_some() || self.windows.export.is_busy() {
            // The progress bar moves; and an export started by an earlier window cannot wake this one.
            ctx.request_repaint_after(Duration::from_millis(100));
        }
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        self.layout.store(storage);
    }

    fn on_exit(&mut self) {
        self.editor.autosave_look();
        self.editor.save_on_close();
        if self.device.is_lost {
            self.device.hand_over(
                &mut self.editor,
                &mut self.opening,
                &mut self.windows,
                &self.layout,
                &self.jobs,
                self.picture.light_probe.is_active,
            );
        } else {
            self.windows.export.cancel_and_wait();
        }
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }
}

impl App {
    /// Reads and shows the time steps that the user wants to see.
    fn update_time_series(&mut self, ctx: &egui::Context) {
        if self.time_series.update(&mut self.editor, ctx) {
            self.windows.contact_sheet.discard();
            ctx.request_repaint();
        }
    }

    /// Shows the start screen in place of the picture, with the messages over it.
    fn show_start(&mut self, ui: &mut egui::Ui, commands: &mut Vec<AppCommand>) {
        self.editor.report_notices();
        let recent = self.editor.memory.recent();
        let context = Some(self.editor.viewport.context()).filter(|_| !self.opening.is_opening());
        let thumbnails = &mut self.panels.recent_pictures;
        let area = self.start_screen.show(ui, context, recent, thumbnails, commands);
        self.picture.canvas = None;
        self.editor.messages.notice(ui.ctx(), area);
        self.editor.messages.list(ui.ctx());
    }

    /// Shows the windows over the picture, and acts on the answers that they return.
    fn show_windows(&mut self, frame: &eframe::Frame, ctx: &egui::Context, commands: &mut Vec<AppCommand>) {
        if let Some(answer) = self.dialogs.recovery.ui(ctx) {
            self.editor.memory.acknowledge_crashes();
            if let RecoveryAnswer::Restore(look) = answer {
                self.opener(ctx).open_record(&look);
            }
        }
        self.windows.history.show(ctx, &self.editor.document, commands);
        self.dialogs.quit.ui(ctx, self.windows.export.is_busy());
        if let Some(answer) = self.dialogs.device_loss.ui(ctx, self.editor.viewport.context().is_software()) {
            self.answer_loss(answer, ctx);
        }
        self.windows.show_contact_sheet(&mut self.editor, ctx, commands);
        self.opener(ctx).show_questions();
        if let Some((purpose, path)) = self.dialogs.files.typed_path_ui(ctx) {
            self.handle_chosen_file(purpose, &path, ctx);
        }
        let scene = ToolScene {
            settings: &self.editor.document.settings,
            volume: self.editor.document.volume.as_ref(),
            dataset: self.editor.viewport.dataset(),
            context: self.editor.viewport.context(),
            picture_size: self.picture.available_size(),
            is_idle: !self.opening.is_opening() && self.editor.is_complete(),
            step_count: self.editor.series.as_ref().map_or(0, |series| series.steps.count() as u32),
        };
        let requests = self.windows.scene_tools().map(|tool| tool.show(ctx, &scene));
        for request in requests.into_iter().flatten() {
            match request {
                ToolRequest::AskFile(purpose) => self.dialogs.files.open_dialog(purpose, frame, ctx),
                ToolRequest::Export => self.windows.start_export(&mut self.editor, ctx),
                ToolRequest::Report(headline, details) => self.editor.messages.error(headline, details),
            }
        }
    }

    /// Executes the user's answer after the device was lost again within a short time.
    fn answer_loss(&mut self, answer: DeviceLossAnswer, ctx: &egui::Context) {
        match answer {
            DeviceLossAnswer::TryAgain => self.restore_volume(ctx),
            DeviceLossAnswer::LowerQuality => {
                QualityPreset::Fast.apply(&mut self.editor.document.settings);
                self.restore_volume(ctx);
            }
            DeviceLossAnswer::UseCpu => {
                self.device.wants_cpu = true;
                self.device.close_for_successor(&self.editor.memory, ctx);
            }
            DeviceLossAnswer::Quit => ctx.send_viewport_cmd(egui::ViewportCommand::Close),
        }
    }

    /// Shows the volume again that the earlier window had open.
    fn restore_volume(&mut self, ctx: &egui::Context) {
        let dataset = self.device.handed_over_dataset.take();
        self.opener(ctx).restore(dataset);
    }

    /// Handles an error of the renderer. After the loss of the device, another window takes the place of this one.
    fn handle_render_error(&mut self, err: &GpuError, ctx: &egui::Context) {
        if self.editor.viewport.is_lost() {
            self.device.close_for_successor(&self.editor.memory, ctx);
        } else {
            self.editor.messages.error(text::messages::NOT_RENDERED, err.to_string());
        }
    }

    /// Updates the status file after a frame that has kept the window's thread busy for the given time, and goes on
    /// with preparations if nothing else is to be done.
    fn update_status(&mut self, busy: Duration, ctx: &egui::Context) {
        let ui_ms = busy.as_secs_f64() * 1000.0;
        if ui_ms > SLOW_FRAME_MS {
            log::debug!("the window's thread was busy for {ui_ms:.0} ms");
        }
        self.status_file.longest_ui_ms = self.status_file.longest_ui_ms.max(ui_ms);
        let idle = self.is_idle();
        if idle {
            self.opening.loader.warm_up_rest(ctx);
        }
        let state = status_file::WindowStatus {
            response: self.editor.viewport.response_times(),
            loading: self.opening.is_opening(),
            idle,
            canvas: self.picture.canvas.filter(|_| self.editor.document.volume.is_some()),
            handles: self.picture.handles.positions(),
            light_rebuilds: self.light_rebuilds(),
            errors: self.editor.messages.errors(),
            path_window: self.dialogs.files.typed_path_title(),
            places: if self.status_file.is_on() { reveal::reported_areas(ctx) } else { BTreeMap::new() },
            pixels_per_point: ctx.pixels_per_point(),
        };
        self.status_file.update(&state);
    }
}
