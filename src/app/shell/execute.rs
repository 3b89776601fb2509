//! Distribution of the window's inputs to its parts: commands of the user, files that were chosen, and the results of
//! worker threads.

use std::path::Path;

use eframe::egui::{self, gui_zoom};

use crate::app::common::commands::AppCommand;
use crate::app::common::{light_keys, reveal};
use crate::app::text::sections::{COMPARE, CUTS, DATA, FLOOR};
use crate::app::windows::contact_sheet::ContactSheetKind;
use crate::app::windows::file_dialogs::FileDialogPurpose;
use crate::app::{App, text};
use chiaroscuro_scene::{CutShapeKind, RenderMode};
use chiaroscuro_volume::{ChoiceAspect, FileDimension};

impl App {
    /// Executes a command of the user.
    pub(crate) fn execute(&mut self, command: AppCommand, frame: &eframe::Frame, ctx: &egui::Context) {
        match command {
            AppCommand::OpenDialog => self.ask_file(FileDialogPurpose::OpenVolume, frame, ctx),
            AppCommand::OpenFolder => self.ask_file(FileDialogPurpose::OpenFolder, frame, ctx),
            AppCommand::OpenDropped(paths) => self.opener(ctx).open_dropped(&paths),
            AppCommand::NextFile => self.opener(ctx).seek_neighbour(true),
            AppCommand::PreviousFile => self.opener(ctx).seek_neighbour(false),
            AppCommand::OpenPath => self.dialogs.files.open_typed_path(FileDialogPurpose::OpenVolume),
            AppCommand::Open(source) => self.opener(ctx).open(&source),
            AppCommand::OpenScene(scene) => self.opener(ctx).open_scene(&scene),
            AppCommand::ShowStart => self.start_screen.open(),
            AppCommand::OpenAgain(path, choice) => self.opener(ctx).open_again(&path, &choice),
            AppCommand::ShowChooser(aspect) => self.windows.show_chooser(aspect, &mut self.editor),
            AppCommand::StepChoice(aspect, is_forward) => self.step_choice(aspect, is_forward, ctx),
            AppCommand::OpenChoice(choice, keeps_look) => self.opener(ctx).open_choice(&choice, keeps_look),
            AppCommand::TogglePlayback => self.toggle_playback(ctx),
            AppCommand::UseNumberedFiles => self.use_numbered_files(),
            AppCommand::MeasureSeriesRange => self.time_series.ask_for_range(),
            AppCommand::Subsample(thinning) => self.opener(ctx).reload_subsampled(thinning),
            AppCommand::ReopenLast => self.opener(ctx).reopen_last(),
            AppCommand::CancelOpening => self.cancel_files(ctx),
            AppCommand::SaveSettings => self.save_session(frame, ctx),
            AppCommand::LoadSettings => self.ask_file(FileDialogPurpose::LoadSettings, frame, ctx),
            AppCommand::Export => self.open_export(),
            AppCommand::CancelExport => self.windows.export.cancel(),
            AppCommand::CopyPicture => {
                self.windows.copy_picture(self.picture.available_size(), &mut self.editor, ctx);
            }
            AppCommand::ToggleKeepLook => self.opening.requests.keeps_look ^= true,
            AppCommand::Quit => ctx.send_viewport_cmd(egui::ViewportCommand::Close),
            AppCommand::Undo => self.go_steps(-1, ctx),
            AppCommand::Redo => self.go_steps(1, ctx),
            AppCommand::ToggleHistory => self.windows.history.open ^= true,
            AppCommand::GoSteps(steps) => self.go_steps(steps, ctx),
            AppCommand::ToggleMessages => self.editor.messages.list_open ^= true,
            AppCommand::ResetView => self.editor.reset_view(ctx),
            AppCommand::AddLight => self.editor.add_light(),
            AppCommand::AutomaticTransfer => self.editor.use_automatic_transfer(ctx),
            AppCommand::TreatAs(kind) => self.editor.treat_as(kind, ctx),
            AppCommand::UsePreset(preset) => self.editor.use_preset(&preset),
            AppCommand::UseColors(at, reversed) => self.editor.document.use_colors(at, reversed),
            AppCommand::AddLayer => self.ask_file(FileDialogPurpose::AddLayer, frame, ctx),
            AppCommand::ShowTogether(aspect) => self.opener(ctx).add_all_of(aspect),
            AppCommand::RemoveLayer => self.editor.remove_layer(),
            AppCommand::ImportTransfer => self.ask_file(FileDialogPurpose::ImportTransfer, frame, ctx),
            AppCommand::ExportTransfer => self.ask_file(FileDialogPurpose::ExportTransfer, frame, ctx),
            AppCommand::InvertTransfer => self.editor.document.selected_layer_mut().transfer.mirror(),
            AppCommand::ToggleCrop => self.layout.show_section(ctx, CUTS, self.editor.toggle_crop()),
            AppCommand::TogglePlane => self.layout.show_section(ctx, CUTS, self.editor.toggle_plane()),
            AppCommand::FacePlane => self.editor.document.face_plane(),
            AppCommand::CutByShape(kind @ (CutShapeKind::Box | CutShapeKind::HalfSpace)) => {
                self.editor.document.cut_near_part(kind);
                self.layout.show_section(ctx, CUTS, true);
            }
            AppCommand::CutByShape(kind) => {
                self.layout.show_section(ctx, CUTS, self.picture.shape_cuts.toggle(kind));
            }
            AppCommand::PickMaterials => self.picture.material_picker.toggle(),
            AppCommand::RemoveShapeCuts => self.editor.document.settings.cuts.shapes.clear(),
            AppCommand::ToggleFloor => self.layout.show_section(ctx, FLOOR, self.editor.toggle_floor()),
            AppCommand::ToggleTable => self.layout.show_section(ctx, DATA, self.editor.toggle_table()),
            AppCommand::Balance => self.editor.start_balance(ctx),
            AppCommand::FrameAll => self.editor.frame_all(ctx),
            AppCommand::TurnObject(turn) => self.editor.turn_object(turn, ctx),
            AppCommand::RotateObject => self.editor.rotate_object(ctx),
            AppCommand::LookFrom(view) => self.editor.look_from(view, ctx),
            AppCommand::ToggleProjection => self.editor.document.settings.camera.toggle_projection(),
            AppCommand::NextRenderMode => self.next_render_mode(ctx),
            AppCommand::UseRenderMode(mode) => self.editor.use_render_mode(mode, None),
            AppCommand::SaveView => self.layout.kept |= self.editor.save_view(),
            AppCommand::SaveLookInStrip => self.layout.kept |= self.editor.save_look(),
            AppCommand::StoreView(slot) => self.layout.kept |= self.editor.save_view_under(slot),
            AppCommand::RecallView(slot) => self.editor.apply_saved_digit(slot, ctx),
            AppCommand::GoToSaved(at, with_view) => self.editor.apply_saved(at, with_view, ctx),
            AppCommand::ReplaceSaved(at) => self.editor.replace_saved(at),
            AppCommand::CompareSaved(left, right) => self.compare_saved(left, right, ctx),
            AppCommand::ExportContactSheet => self.ask_file(FileDialogPurpose::ExportKept, frame, ctx),
            AppCommand::ToggleStrip => self.layout.kept ^= true,
            AppCommand::Scale(1) => gui_zoom::zoom_in(ctx),
            AppCommand::Scale(-1) => gui_zoom::zoom_out(ctx),
            AppCommand::Scale(_) => ctx.set_zoom_factor(1.0),
            AppCommand::ToggleFullScreen => toggle_full_screen(ctx),
            AppCommand::ToggleOverlay => self.picture.overlay.visible ^= true,
            AppCommand::ToggleProbe => self.picture.light_probe.is_active ^= true,
            AppCommand::ShowPalette => self.windows.palette.open(),
            AppCommand::UseRig(rig) => self.editor.document.use_rig(rig),
            AppCommand::UseLights(lights) => self.editor.document.use_lights(lights),
            AppCommand::UseLook(look) => self.editor.document.use_look(*look),
            AppCommand::TryLooks => self.try_looks(ctx),
            AppCommand::TryLights => self.windows.contact_sheet.open(ContactSheetKind::Lights),
            AppCommand::UseEnvironmentMap => self.ask_file(FileDialogPurpose::EnvironmentMap, frame, ctx),
            AppCommand::SuggestLight => self.windows.contact_sheet.open(ContactSheetKind::Suggestions),
            AppCommand::TryPresets => self.windows.contact_sheet.open(ContactSheetKind::Presets),
            AppCommand::NextLight => self.editor.document.step_light(1),
            AppCommand::PreviousLight => self.editor.document.step_light(-1),
            AppCommand::Solo => self.editor.document.solo_light(),
            AppCommand::Mute => self.editor.document.change_light(|light| light.on ^= true),
            AppCommand::Brighter => self.editor.document.change_light(|light| light_keys::brighten(light, 1)),
            AppCommand::Dimmer => self.editor.document.change_light(|light| light_keys::brighten(light, -1)),
            AppCommand::ToggleSide => self.layout.side ^= true,
            AppCommand::ToggleTransfer => self.layout.transfer ^= true,
            AppCommand::TogglePictureOnly => self.layout.toggle_picture_only(&mut self.editor.messages),
            AppCommand::ToggleHandles => self.picture.handles.is_hidden ^= true,
            AppCommand::ToggleCompare => self.layout.show_section(ctx, COMPARE, self.editor.toggle_compare()),
            AppCommand::Reveal(place) => self.layout.reveal(place, ctx),
            AppCommand::ShowSlices => self.windows.slices.open ^= true,
            AppCommand::ShowLightVolume => self.windows.light_slice.open = true,
            AppCommand::CompareWithFile => self.ask_file(FileDialogPurpose::CompareSettings, frame, ctx),
            AppCommand::ShowHelp => self.windows.help.keys_open ^= true,
            AppCommand::ShowAbout => self.windows.help.about_open = true,
        }
        ctx.request_repaint();
    }

    /// Shows the volume in the next render mode; a surface lies at the value under the pointer.
    fn next_render_mode(&mut self, ctx: &egui::Context) {
        let next = self.editor.document.settings.mode.kind.next();
        let is_surface = next == RenderMode::Surface;
        let value = is_surface.then(|| self.picture.value_under_pointer(&self.editor, ctx)).flatten();
        self.editor.use_render_mode(next, value);
    }

    /// Asks for a file in a dialog of the desktop.
    fn ask_file(&mut self, purpose: FileDialogPurpose, frame: &eframe::Frame, ctx: &egui::Context) {
        self.dialogs.files.open_dialog(purpose, frame, ctx);
    }

    /// Opens the next or the previous volume of the open file.
    fn step_choice(&mut self, aspect: ChoiceAspect, is_forward: bool, ctx: &egui::Context) {
        let keeps_look = self.windows.volume_chooser.keeps_look(aspect);
        let is_step = aspect == ChoiceAspect::Dimension(FileDimension::Frame) && keeps_look;
        if is_step && self.time_series.step(is_forward) {
            return;
        }
        let mut opener = self.opener(ctx);
        if let Some(choice) = opener.neighbour_choice(aspect, is_forward) {
            opener.open_choice(&choice, keeps_look);
        }
    }

    /// Plays the time steps of the open volume, or stops at the one that is shown.
    fn toggle_playback(&mut self, ctx: &egui::Context) {
        if self.time_series.steps().is_none() {
            return self.use_numbered_files();
        }
        let plays = !self.time_series.is_playing();
        self.time_series.set_playing(plays, ctx.input(|input| input.time));
    }

    /// Shows the numbered files beside the open one as time steps.
    fn use_numbered_files(&mut self) {
        let volume = self.editor.document.volume.as_ref();
        let options = self.opening.loader.options();
        if !volume.is_some_and(|volume| self.time_series.use_numbered_files(volume, options)) {
            self.editor.messages.note(text::time_series::NO_SERIES);
        }
    }

    /// Goes the given number of undo steps forward, or back if it is negative.
    fn go_steps(&mut self, steps: i32, ctx: &egui::Context) {
        // Without panels there is no status bar.
        self.editor.go_steps(steps, !self.layout.picture_only, ctx);
    }

    /// Saves the session to its file, or asks for a file.
    fn save_session(&mut self, frame: &eframe::Frame, ctx: &egui::Context) {
        match self.editor.session_to_save() {
            Some(path) => self.editor.save_settings(&path),
            None => self.ask_file(FileDialogPurpose::SaveSettings, frame, ctx),
        }
    }

    /// Cancels opening a volume and reading other files.
    fn cancel_files(&mut self, ctx: &egui::Context) {
        self.opener(ctx).cancel_files();
        self.drop_pictures_of_replaced();
    }

    /// Shows the export dialog for pictures and turntables.
    fn open_export(&mut self) {
        let (size, folder) = (self.picture.available_size(), self.layout.exports.as_deref());
        self.windows.export.open(size, folder, self.editor.document.volume_name());
    }

    /// Shows the contact sheet of looks, which derive from the first look; it must have the current up axis.
    fn try_looks(&mut self, ctx: &egui::Context) {
        if self.editor.ensure_first_look_up(Some(AppCommand::TryLooks), ctx) {
            self.windows.contact_sheet.open(ContactSheetKind::Looks);
        }
    }

    /// Compares two saved views or looks, or the picture (`None`) with one.
    fn compare_saved(&mut self, left: Option<usize>, right: usize, ctx: &egui::Context) {
        self.editor.compare_saved(left, right);
        reveal::show_section(ctx, COMPARE, true);
    }

    /// Collects the results that worker threads have finished.
    pub(crate) fn collect_results(&mut self, ctx: &egui::Context) {
        self.opener(ctx).take_outcome();
        self.opener(ctx).take_neighbour();
        self.editor.finish_kind_task(ctx);
        self.opener(ctx).finish_file_tasks();
        self.drop_pictures_of_replaced();
        self.editor.take_balances(ctx);
        if let Some(path) = self.windows.take_export(&mut self.editor.messages, ctx) {
            self.layout.remember_export(&path);
        }
        if self.dialogs.files.take_refused() {
            self.editor.messages.note(text::files::DIALOG_IS_OPEN);
        }
        if let Some((purpose, path)) = self.dialogs.files.take_choice(ctx) {
            self.handle_chosen_file(purpose, &path, ctx);
            if purpose == FileDialogPurpose::ExportPicture {
                // The desktop's file dialog has already asked before overwriting.
                self.windows.export.allow_replacing(&path);
            }
        }
    }

    /// Handles a file that was chosen in a dialog or typed.
    pub(crate) fn handle_chosen_file(
        &mut self,
        purpose: FileDialogPurpose,
        path: &Path,
        ctx: &egui::Context,
    ) {
        match purpose {
            FileDialogPurpose::OpenVolume | FileDialogPurpose::OpenFolder => self.opener(ctx).open(path),
            FileDialogPurpose::AddLayer => self.opener(ctx).add_layer(path),
            FileDialogPurpose::VolumeOfLook => self.opener(ctx).open_for_look(path),
            FileDialogPurpose::ExportPicture => self.windows.export.set_path(path),
            FileDialogPurpose::SaveSettings => self.editor.save_settings(path),
            FileDialogPurpose::ExportKept => self.windows.export_kept_sheet(path, &mut self.editor, ctx),
            FileDialogPurpose::ExportLight => self.windows.export_light(path, &mut self.editor),
            FileDialogPurpose::LoadSettings => self.opener(ctx).load_settings(path),
            FileDialogPurpose::EnvironmentMap => self.opener(ctx).read_environment_map(path),
            FileDialogPurpose::ImportTransfer => self.opener(ctx).import_transfer(path),
            FileDialogPurpose::ExportTransfer => self.editor.export_transfer(path),
            FileDialogPurpose::CompareSettings => self.opener(ctx).compare_with_file(path),
        }
    }
}

/// Switches full screen on or off.
fn toggle_full_screen(ctx: &egui::Context) {
    let is_full = ctx.input(|input| input.viewport().fullscreen.unwrap_or(false));
    ctx.send_viewport_cmd(egui::ViewportCommand::Fullscreen(!is_full));
}
