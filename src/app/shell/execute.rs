//! Execution of commands, and collection of the results of worker threads.

use std::path::{Path, PathBuf};

use eframe::egui::{self, gui_zoom};

use crate::app::common::commands::AppCommand;
use crate::app::common::{light_keys, reveal};
use crate::app::kept_views::compare_kept_items;
use crate::app::text;
use crate::app::viewport::mouse_navigation::OrbitDrag;
use crate::app::windows::contact_sheet::ContactSheetKind;
use crate::app::windows::export;
use crate::app::windows::export::ExportOutcome;
use crate::app::windows::file_dialogs::{self, FileDialogPurpose};
use crate::app::worker::loader::LoadOutcome;
use crate::app::{App, panels};
use chiaroscuro_render::GpuError;
use chiaroscuro_scene::{COLOR_MAPS, Camera, Settings};

impl App {
    /// Executes a command of the user.
    pub(crate) fn execute(&mut self, command: AppCommand, frame: &eframe::Frame, ctx: &egui::Context) {
        match command {
            AppCommand::OpenDialog => {
                self.dialogs.files.open_dialog(FileDialogPurpose::OpenVolume, frame, ctx)
            }
            AppCommand::OpenFolder => {
                self.dialogs.files.open_dialog(FileDialogPurpose::OpenFolder, frame, ctx)
            }
            AppCommand::OpenDropped(paths) => self.open_dropped(&paths, ctx),
            AppCommand::NextFile => self.seek_neighbour(true, ctx),
            AppCommand::PreviousFile => self.seek_neighbour(false, ctx),
            AppCommand::OpenPath => self.dialogs.files.open_typed_path(FileDialogPurpose::OpenVolume),
            AppCommand::Open(source) => self.open(&source, ctx),
            AppCommand::OpenAgain(path, choice) => self.open_again(&path, &choice, ctx),
            AppCommand::ShowChooser(aspect) => self.show_chooser(aspect),
            AppCommand::StepChoice(aspect, is_forward) => self.step_choice(aspect, is_forward, ctx),
            AppCommand::OpenChoice(choice, keeps_look) => self.open_choice(&choice, keeps_look, ctx),
            AppCommand::Subsample(thinning) => self.reload_subsampled(thinning, ctx),
            AppCommand::ReopenLast => match self.memory.previous_look() {
                Some(path) => self.open_record(&path, ctx),
                None => self.messages.note(text::messages::NO_SESSION_TO_REOPEN),
            },
            AppCommand::CancelOpening => self.cancel_files(ctx),
            AppCommand::SaveSettings => match self.session_to_save() {
                Some(path) => self.save_settings(&path),
                None => self.dialogs.files.open_dialog(FileDialogPurpose::SaveSettings, frame, ctx),
            },
            AppCommand::LoadSettings => {
                self.dialogs.files.open_dialog(FileDialogPurpose::LoadSettings, frame, ctx)
            }
            AppCommand::Export => {
                let size = self.viewport_size();
                self.windows.export.open(size, self.layout.exports.as_deref(), self.document.volume_name());
            }
            AppCommand::CancelExport => self.windows.export.cancel(),
            AppCommand::CopyPicture => self.copy_picture(ctx),
            AppCommand::ToggleKeepLook => self.opening.requests.keeps_look ^= true,
            AppCommand::Quit => ctx.send_viewport_cmd(egui::ViewportCommand::Close),
            AppCommand::Undo | AppCommand::Redo => self.undo_or_redo(command == AppCommand::Undo, ctx),
            AppCommand::ToggleHistory => self.windows.history.open ^= true,
            AppCommand::GoSteps(steps) => self.go_steps(steps, ctx),
            AppCommand::ToggleMessages => self.messages.list_open ^= true,
            AppCommand::ResetView => {
                if self.ensure_first_look_up(Some(command), ctx) {
                    self.document.settings.camera = self.document.defaults.camera.clone();
                }
            }
            AppCommand::AddLight => {
                if let Some(index) = panels::add_light(&mut self.document.settings) {
                    self.document.selected_light = index;
                }
            }
            AppCommand::AutomaticTransfer => {
                let started = self.document.use_automatic_transfer(self.viewport.dataset(), ctx);
                self.messages.report(text::messages::LOOK_NOT_MADE, started);
            }
            AppCommand::TreatAs(kind) => {
                let started = self.document.treat_as(kind, self.viewport.dataset(), ctx);
                self.messages.report(text::messages::LOOK_NOT_MADE, started);
            }
            AppCommand::UsePreset(preset) => {
                if let Some(volume) = &self.document.volume {
                    match preset.apply(&self.document.settings, &volume.ranges) {
                        Ok(settings) => self.document.settings = settings,
                        Err(err) => self.messages.error(text::messages::PRESET_NOT_APPLIED, err.to_string()),
                    }
                }
            }
            AppCommand::UseColors(at, reversed) => {
                if let Some(map) = COLOR_MAPS.get(at) {
                    self.document.settings.transfer.apply_color_map(map, reversed);
                }
            }
            AppCommand::ImportTransfer => {
                self.dialogs.files.open_dialog(FileDialogPurpose::ImportTransfer, frame, ctx);
            }
            AppCommand::ExportTransfer => {
                self.dialogs.files.open_dialog(FileDialogPurpose::ExportTransfer, frame, ctx);
            }
            AppCommand::InvertTransfer => self.document.settings.transfer.mirror(),
            AppCommand::ToggleCrop => {
                self.document.settings.cuts.crop.on ^= true;
                self.show_section(ctx, text::sections::CUTS, self.document.settings.cuts.crop.on);
            }
            AppCommand::TogglePlane => {
                self.document.settings.cuts.plane.on ^= true;
                self.show_section(ctx, text::sections::CUTS, self.document.settings.cuts.plane.on);
            }
            AppCommand::FacePlane => {
                let Camera { target, .. } = self.document.settings.camera;
                self.document
                    .settings
                    .cuts
                    .plane
                    .place_facing(self.document.settings.camera.scene_from_view().z_axis, target.into());
            }
            AppCommand::ToggleFloor => {
                self.document.settings.floor.on ^= true;
                self.show_section(ctx, text::sections::FLOOR, self.document.settings.floor.on);
            }
            AppCommand::Balance => self.start_balance(ctx),
            AppCommand::FrameAll => {
                if self.can_frame(command, ctx) {
                    self.document.frame_object(self.viewport.dataset().as_ref());
                }
            }
            AppCommand::TurnObject(turn) => {
                let started = self.document.turn_object(turn, self.viewport.dataset(), ctx);
                self.messages.report(text::messages::TURN_FAILED, started);
            }
            AppCommand::RotateObject => {
                if self.can_frame(command, ctx) {
                    let outline = self.document.outline(self.viewport.dataset().as_ref());
                    let orbit = OrbitDrag::begin(&self.document.settings.camera, outline.as_deref());
                    self.document.settings.camera.orbit(90.0, 0.0);
                    orbit.keep_in_frame(&mut self.document.settings.camera, outline.as_deref());
                }
            }
            AppCommand::LookFrom(view) => {
                if self.can_frame(command, ctx) {
                    if self.document.is_anatomical() {
                        self.document.settings.camera.set_standard_view_of_body(view);
                    } else {
                        self.document.settings.camera.set_standard_view(view);
                    }
                    self.document.frame_object(self.viewport.dataset().as_ref());
                }
            }
            AppCommand::ToggleProjection => self.document.settings.camera.toggle_projection(),
            AppCommand::SaveView => {
                let note = self.document.save_current_view();
                self.report_kept_item(note);
            }
            AppCommand::SaveLookInStrip => {
                let note = self.document.save_current_look();
                self.report_kept_item(note);
            }
            AppCommand::StoreView(slot) => {
                let note = self.document.save_view_under(slot);
                self.report_kept_item(note);
            }
            AppCommand::RecallView(slot) => self.apply_kept_digit(slot, ctx),
            AppCommand::GoToSaved(at, with_view) => self.apply_kept_item(at, with_view, ctx),
            AppCommand::ReplaceSaved(at) => {
                if !self.document.replace_saved_item(at) {
                    self.messages.error(text::saved_views::TOO_MANY, String::new());
                }
            }
            AppCommand::CompareSaved(left, right) => {
                compare_kept_items(&mut self.picture.compare, &self.document.settings, left, right);
                reveal::show_section(ctx, text::sections::COMPARE, true);
            }
            AppCommand::ExportContactSheet => {
                self.dialogs.files.open_dialog(FileDialogPurpose::ExportKept, frame, ctx);
            }
            AppCommand::ToggleStrip => self.layout.kept ^= true,
            AppCommand::Scale(1) => gui_zoom::zoom_in(ctx),
            AppCommand::Scale(-1) => gui_zoom::zoom_out(ctx),
            AppCommand::Scale(_) => ctx.set_zoom_factor(1.0),
            AppCommand::ToggleFullScreen => {
                let is_full = ctx.input(|input| input.viewport().fullscreen.unwrap_or(false));
                ctx.send_viewport_cmd(egui::ViewportCommand::Fullscreen(!is_full));
            }
            AppCommand::ToggleOverlay => self.picture.overlay.visible ^= true,
            AppCommand::ToggleProbe => self.picture.light_probe.is_active ^= true,
            AppCommand::ShowPalette => self.windows.palette.open(),
            AppCommand::UseRig(rig) => {
                self.document.settings.lights = rig.lights(&self.document.settings.camera);
                self.document.selected_light = 0;
            }
            AppCommand::UseLights(lights) => {
                self.document.selected_light =
                    self.document.selected_light.min(lights.len().saturating_sub(1));
                self.document.settings.lights = lights;
            }
            AppCommand::UseLook(look) => {
                // A suggested look leaves saved views, render quality, cuts and corrections of the file as they are.
                let look = look.with_quality_of(&self.document.settings);
                let Settings { cuts, kept, volume, .. } = std::mem::take(&mut self.document.settings);
                self.document.settings = Settings { cuts, kept, volume, ..look };
                self.document.selected_light = 0;
            }
            AppCommand::TryLooks => {
                // Suggested looks derive from the first look, which must have the current up axis.
                if self.ensure_first_look_up(Some(command), ctx) {
                    self.windows.contact_sheet.open(ContactSheetKind::Looks);
                }
            }
            AppCommand::TryLights => self.windows.contact_sheet.open(ContactSheetKind::Lights),
            AppCommand::UseEnvironmentMap => {
                self.dialogs.files.open_dialog(FileDialogPurpose::EnvironmentMap, frame, ctx);
            }
            AppCommand::SuggestLight => self.windows.contact_sheet.open(ContactSheetKind::Suggestions),
            AppCommand::TryPresets => self.windows.contact_sheet.open(ContactSheetKind::Presets),
            AppCommand::NextLight | AppCommand::PreviousLight => {
                let by = if command == AppCommand::NextLight { 1 } else { -1 };
                let count = self.document.settings.lights.len();
                self.document.selected_light = light_keys::cycle(count, self.document.selected_light, by);
            }
            AppCommand::Solo => {
                light_keys::solo(&mut self.document.settings.lights, self.document.selected_light)
            }
            AppCommand::Mute | AppCommand::Brighter | AppCommand::Dimmer => {
                if let Some(light) = self.document.settings.lights.get_mut(self.document.selected_light) {
                    match command {
                        AppCommand::Mute => light.on ^= true,
                        AppCommand::Brighter => light_keys::brighten(light, 1),
                        _ => light_keys::brighten(light, -1),
                    }
                }
            }
            AppCommand::ToggleSide => self.layout.side ^= true,
            AppCommand::ToggleTransfer => self.layout.transfer ^= true,
            AppCommand::TogglePictureOnly => self.toggle_picture_only(),
            AppCommand::ToggleHandles => self.picture.handles.is_hidden ^= true,
            AppCommand::ToggleCompare => {
                self.picture.compare.on ^= true;
                self.show_section(ctx, text::sections::COMPARE, self.picture.compare.on);
            }
            AppCommand::Reveal(place) => {
                let is_of_editor = [text::transfer::TITLE, text::labels::TITLE].contains(&place.section);
                *(if is_of_editor { &mut self.layout.transfer } else { &mut self.layout.side }) = true;
                self.layout.picture_only = false;
                reveal::reveal(ctx, place);
            }
            AppCommand::ShowSlices => self.windows.slices.open ^= true,
            AppCommand::ShowLightVolume => self.windows.light_slice.open = true,
            AppCommand::CompareWithFile => {
                self.dialogs.files.open_dialog(FileDialogPurpose::CompareSettings, frame, ctx);
            }
            AppCommand::ShowHelp => self.windows.help.keys_open ^= true,
            AppCommand::ShowAbout => self.windows.help.about_open = true,
        }
        ctx.request_repaint();
    }

    /// Opens a section and the side panel when its feature is switched on, unless only the picture is shown.
    fn show_section(&mut self, ctx: &egui::Context, section: &'static str, is_on: bool) {
        self.layout.side |= is_on && !self.layout.picture_only;
        reveal::show_section(ctx, section, is_on);
    }

    /// Collects the results that worker threads have finished.
    pub(crate) fn collect_results(&mut self, ctx: &egui::Context) {
        match self.loader.take_outcome() {
            None => {}
            Some(LoadOutcome::Opened(opened)) => self.show_opened_with_session(*opened, ctx),
            Some(LoadOutcome::Uploaded { renderer, dataset }) => self.viewport.set_scene(*renderer, dataset),
            Some(LoadOutcome::Cancelled) => {
                self.opening.requests.pending_look = None;
                self.messages.note(text::messages::OPENING_CANCELLED);
            }
            Some(LoadOutcome::UnknownRawFormat { path, why, guess }) => {
                self.dialogs.raw.open(&path, why, guess, ctx);
            }
            // A look that is pending for this volume stays pending.
            Some(LoadOutcome::NeedsMemoryDecision { source, reading, weighed }) => {
                self.dialogs.large_volume.open(source, *reading, weighed);
            }
            Some(LoadOutcome::Failed { short, details }) => {
                self.opening.requests.pending_look = None;
                self.messages.error(short, details);
            }
        }
        self.take_neighbour(ctx);
        self.finish_kind_task(ctx);
        self.finish_file_tasks(ctx);
        self.take_balances(ctx);
        match self.windows.export.take_result() {
            None => {}
            Some(Ok(ExportOutcome::File(path))) => {
                self.layout.exports =
                    std::path::absolute(&path).ok().and_then(|path| Some(path.parent()?.to_owned()));
                self.messages.note(text::messages::exported(&path));
            }
            Some(Ok(ExportOutcome::Picture(picture))) => {
                ctx.copy_image(picture);
                self.messages.note(text::messages::PICTURE_COPIED);
            }
            Some(Ok(ExportOutcome::Cancelled)) => self.messages.note(text::messages::EXPORT_CANCELLED),
            Some(Err(err)) => self.messages.error(text::messages::PICTURE_NOT_EXPORTED, err),
        }
        if self.dialogs.files.take_refused() {
            self.messages.note(text::files::DIALOG_IS_OPEN);
        }
        if let Some((purpose, path)) = self.dialogs.files.take_choice(ctx) {
            self.handle_chosen_file(purpose, &path, ctx);
            if purpose == FileDialogPurpose::ExportPicture {
                // The desktop's file dialog has already asked before overwriting.
                self.windows.export.allow_replacing(&path);
            }
        }
    }

    pub(crate) fn viewport_size(&self) -> [u32; 2] {
        // Before there is a picture: the resolution of the smallest common screens.
        self.picture.canvas.map_or([1280, 720], |canvas| canvas.available_size.map(|n| n.max(1)))
    }

    /// Handles a file that was chosen in a dialog or typed.
    pub(crate) fn handle_chosen_file(
        &mut self,
        purpose: FileDialogPurpose,
        path: &Path,
        ctx: &egui::Context,
    ) {
        match purpose {
            FileDialogPurpose::OpenVolume | FileDialogPurpose::OpenFolder => self.open(path, ctx),
            FileDialogPurpose::VolumeOfLook => self.open_for_look(path, ctx),
            FileDialogPurpose::ExportPicture => self.windows.export.set_path(path),
            FileDialogPurpose::SaveSettings => self.save_settings(path),
            FileDialogPurpose::ExportKept => {
                if let Some(subject) = self.export_subject()
                    && let Err(err) = self.windows.export.export_kept_sheet(subject, path, ctx)
                {
                    self.messages.error(text::messages::PICTURE_NOT_EXPORTED, err);
                }
            }
            FileDialogPurpose::ExportLight => {
                let Some(dataset) = self.viewport.dataset() else { return };
                match self.windows.light_slice.export(path, dataset.volume()) {
                    Ok(()) => self.messages.note(text::messages::exported(path)),
                    Err(err) => self.messages.error(text::messages::LIGHT_VOLUME_NOT_EXPORTED, err),
                }
            }
            FileDialogPurpose::LoadSettings => self.load_settings(path, ctx),
            FileDialogPurpose::EnvironmentMap => self.read_environment_map(path, ctx),
            FileDialogPurpose::ImportTransfer => self.import_transfer(path, ctx),
            FileDialogPurpose::ExportTransfer => {
                match file_dialogs::export_transfer_file(
                    path,
                    &self.document.settings,
                    &self.document.value_ranges(),
                ) {
                    Ok(()) => self.messages.note(text::messages::written(path)),
                    Err(err) => self.messages.error(text::messages::TRANSFER_NOT_WRITTEN, err),
                }
            }
            FileDialogPurpose::CompareSettings => self.compare_with_file(path, ctx),
        }
    }

    /// Returns the subject of an export; shows a message if there is no picture.
    pub(crate) fn export_subject(&mut self) -> Option<export::ExportScene> {
        let Some(dataset) = self.viewport.dataset() else {
            self.messages.note(text::messages::NO_PICTURE);
            return None;
        };
        // Ignores a correction in progress: the picture shows the volume that is loaded.
        let settings = Settings { volume: *dataset.volume().corrections(), ..self.document.settings.clone() };
        Some(export::ExportScene {
            context: self.viewport.context().clone(),
            dataset,
            settings,
            first_look: self.document.defaults.clone(),
            source: self.document.volume.as_ref().map_or_else(PathBuf::new, |volume| volume.source.clone()),
            selected_light: self.document.selected_light,
            outline: self.document.outline(self.viewport.dataset().as_ref()),
        })
    }

    pub(crate) fn start_export(&mut self, ctx: &egui::Context) {
        if let Some(subject) = self.export_subject()
            && let Err(err) = self.windows.export.start(subject, ctx)
        {
            self.messages.error(text::messages::PICTURE_NOT_EXPORTED, err);
        }
    }

    fn copy_picture(&mut self, ctx: &egui::Context) {
        if self.windows.export.is_busy() {
            self.messages.note(text::messages::EXPORT_RUNS);
        } else if let Some(subject) = self.export_subject()
            && let Err(err) = self.windows.export.copy_to_clipboard(subject, self.viewport_size(), ctx)
        {
            self.messages.error(text::messages::PICTURE_NOT_COPIED, err);
        }
    }

    /// Handles an error of the renderer. After the loss of the device, another window takes the place of this one.
    pub(crate) fn handle_render_error(&mut self, err: &GpuError, ctx: &egui::Context) {
        if self.viewport.is_lost() {
            self.close_for_successor(ctx);
        } else {
            self.messages.error(text::messages::NOT_RENDERED, err.to_string());
        }
    }
}
