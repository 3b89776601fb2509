//! Execution of commands, and collection of the results of worker threads.

mod files;
mod looks;
mod results;

use eframe::egui::{self, gui_zoom};

use crate::app::App;
use crate::app::common::commands::AppCommand;
use crate::app::common::light_keys;
use crate::app::windows::contact_sheet::ContactSheetKind;
use crate::app::windows::file_dialogs::FileDialogPurpose;

impl App {
    /// Executes a command of the user.
    pub(crate) fn execute(&mut self, command: AppCommand, frame: &eframe::Frame, ctx: &egui::Context) {
        match command {
            AppCommand::OpenDialog => self.ask_file(FileDialogPurpose::OpenVolume, frame, ctx),
            AppCommand::OpenFolder => self.ask_file(FileDialogPurpose::OpenFolder, frame, ctx),
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
            AppCommand::ReopenLast => self.reopen_last(ctx),
            AppCommand::CancelOpening => self.cancel_files(ctx),
            AppCommand::SaveSettings => self.save_session(frame, ctx),
            AppCommand::LoadSettings => self.ask_file(FileDialogPurpose::LoadSettings, frame, ctx),
            AppCommand::Export => self.open_export(),
            AppCommand::CancelExport => self.windows.export.cancel(),
            AppCommand::CopyPicture => self.copy_picture(ctx),
            AppCommand::ToggleKeepLook => self.opening.requests.keeps_look ^= true,
            AppCommand::Quit => ctx.send_viewport_cmd(egui::ViewportCommand::Close),
            AppCommand::Undo => self.undo_or_redo(true, ctx),
            AppCommand::Redo => self.undo_or_redo(false, ctx),
            AppCommand::ToggleHistory => self.windows.history.open ^= true,
            AppCommand::GoSteps(steps) => self.go_steps(steps, ctx),
            AppCommand::ToggleMessages => self.messages.list_open ^= true,
            AppCommand::ResetView => self.reset_view(ctx),
            AppCommand::AddLight => self.add_light(),
            AppCommand::AutomaticTransfer => self.use_automatic_transfer(ctx),
            AppCommand::TreatAs(kind) => self.treat_as(kind, ctx),
            AppCommand::UsePreset(preset) => self.use_preset(&preset),
            AppCommand::UseColors(at, reversed) => self.document.use_colors(at, reversed),
            AppCommand::ImportTransfer => self.ask_file(FileDialogPurpose::ImportTransfer, frame, ctx),
            AppCommand::ExportTransfer => self.ask_file(FileDialogPurpose::ExportTransfer, frame, ctx),
            AppCommand::InvertTransfer => self.document.settings.layer_mut().transfer.mirror(),
            AppCommand::ToggleCrop => self.toggle_crop(ctx),
            AppCommand::TogglePlane => self.toggle_plane(ctx),
            AppCommand::FacePlane => self.document.face_plane(),
            AppCommand::ToggleFloor => self.toggle_floor(ctx),
            AppCommand::Balance => self.start_balance(ctx),
            AppCommand::FrameAll => self.frame_all(ctx),
            AppCommand::TurnObject(turn) => self.turn_object(turn, ctx),
            AppCommand::RotateObject => self.rotate_object(ctx),
            AppCommand::LookFrom(view) => self.look_from(view, ctx),
            AppCommand::ToggleProjection => self.document.settings.camera.toggle_projection(),
            AppCommand::SaveView => self.save_view(),
            AppCommand::SaveLookInStrip => self.save_look(),
            AppCommand::StoreView(slot) => self.save_view_under(slot),
            AppCommand::RecallView(slot) => self.apply_kept_digit(slot, ctx),
            AppCommand::GoToSaved(at, with_view) => self.apply_kept_item(at, with_view, ctx),
            AppCommand::ReplaceSaved(at) => self.replace_kept_item(at),
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
            AppCommand::UseRig(rig) => self.document.use_rig(rig),
            AppCommand::UseLights(lights) => self.document.use_lights(lights),
            AppCommand::UseLook(look) => self.document.use_look(*look),
            AppCommand::TryLooks => self.try_looks(ctx),
            AppCommand::TryLights => self.windows.contact_sheet.open(ContactSheetKind::Lights),
            AppCommand::UseEnvironmentMap => self.ask_file(FileDialogPurpose::EnvironmentMap, frame, ctx),
            AppCommand::SuggestLight => self.windows.contact_sheet.open(ContactSheetKind::Suggestions),
            AppCommand::TryPresets => self.windows.contact_sheet.open(ContactSheetKind::Presets),
            AppCommand::NextLight => self.document.step_light(1),
            AppCommand::PreviousLight => self.document.step_light(-1),
            AppCommand::Solo => self.document.solo_light(),
            AppCommand::Mute => self.document.change_light(|light| light.on ^= true),
            AppCommand::Brighter => self.document.change_light(|light| light_keys::brighten(light, 1)),
            AppCommand::Dimmer => self.document.change_light(|light| light_keys::brighten(light, -1)),
            AppCommand::ToggleSide => self.layout.side ^= true,
            AppCommand::ToggleTransfer => self.layout.transfer ^= true,
            AppCommand::TogglePictureOnly => self.toggle_picture_only(),
            AppCommand::ToggleHandles => self.picture.handles.is_hidden ^= true,
            AppCommand::ToggleCompare => self.toggle_compare(ctx),
            AppCommand::Reveal(place) => self.reveal(place, ctx),
            AppCommand::ShowSlices => self.windows.slices.open ^= true,
            AppCommand::ShowLightVolume => self.windows.light_slice.open = true,
            AppCommand::CompareWithFile => self.ask_file(FileDialogPurpose::CompareSettings, frame, ctx),
            AppCommand::ShowHelp => self.windows.help.keys_open ^= true,
            AppCommand::ShowAbout => self.windows.help.about_open = true,
        }
        ctx.request_repaint();
    }
}

/// Switches full screen on or off.
fn toggle_full_screen(ctx: &egui::Context) {
    let is_full = ctx.input(|input| input.viewport().fullscreen.unwrap_or(false));
    ctx.send_viewport_cmd(egui::ViewportCommand::Fullscreen(!is_full));
}
