//! Execution of commands, and collection of the results of worker threads.

use std::path::{Path, PathBuf};

use eframe::egui::{self, gui_zoom};

use crate::app::common::commands::Command;
use crate::app::common::{light_keys, reveal};
use crate::app::text;
use crate::app::viewport::orbit::Orbit;
use crate::app::windows::contact_sheet::Sheet;
use crate::app::windows::export;
use crate::app::windows::export::Exported;
use crate::app::windows::files::{self, Purpose};
use crate::app::worker::loader::Outcome;
use crate::app::worker::task::Work;
use crate::app::{App, panels};
use crate::gpu::GpuError;
use crate::model::{COLOR_MAPS, Camera, Settings};

impl App {
    /// Executes a command of the user.
    pub(crate) fn execute(&mut self, command: Command, frame: &eframe::Frame, ctx: &egui::Context) {
        match command {
            Command::OpenDialog => self.files.ask(Purpose::OpenVolume, frame, ctx),
            Command::OpenFolder => self.files.ask(Purpose::OpenFolder, frame, ctx),
            Command::OpenDropped(paths) => self.open_dropped(&paths, ctx),
            Command::NextFile => self.seek_neighbour(true, ctx),
            Command::PreviousFile => self.seek_neighbour(false, ctx),
            Command::OpenPath => self.files.type_path(Purpose::OpenVolume),
            Command::Open(source) => self.open(&source, ctx),
            Command::OpenAgain(path, choice) => self.open_again(&path, &choice, ctx),
            Command::Choose(aspect) => self.choose(aspect),
            Command::StepChoice(aspect, is_forward) => self.step_choice(aspect, is_forward, ctx),
            Command::TakeChoice(choice, keeps_look) => self.take_choice(&choice, keeps_look, ctx),
            Command::Thin(thinning) => self.thin(thinning, ctx),
            Command::GoOn => match self.memory.before() {
                Some(path) => self.open_record(&path, ctx),
                None => self.messages.note(text::messages::NOTHING_TO_GO_ON_WITH),
            },
            Command::CancelOpening => self.cancel_files(ctx),
            Command::SaveSettings => match self.session_to_save() {
                Some(path) => self.save_settings(&path),
                None => self.files.ask(Purpose::SaveSettings, frame, ctx),
            },
            Command::LoadSettings => self.files.ask(Purpose::LoadSettings, frame, ctx),
            Command::Export => {
                let size = self.viewport_size();
                let volume = self.volume.as_ref().map_or("", |volume| volume.name.as_str());
                self.export.open(size, self.layout.exports.as_deref(), volume);
            }
            Command::CancelExport => self.export.cancel(),
            Command::CopyPicture => self.copy_picture(ctx),
            Command::KeepLook => self.keeps_look ^= true,
            Command::Quit => ctx.send_viewport_cmd(egui::ViewportCommand::Close),
            Command::Undo | Command::Redo => self.go(command == Command::Undo, ctx),
            Command::ToggleHistory => self.listed.open ^= true,
            Command::GoSteps(steps) => self.go_steps(steps, ctx),
            Command::ToggleMessages => self.messages.lists ^= true,
            Command::ResetView => {
                if self.first_look_stands(Some(command), ctx) {
                    self.settings.camera = self.defaults.camera.clone();
                }
            }
            Command::AddLight => {
                if let Some(index) = panels::add_light(&mut self.settings) {
                    self.selected_light = index;
                }
            }
            Command::AutomaticTransfer => self.use_automatic_transfer(ctx),
            Command::TreatAs(kind) => self.treat_as(kind, ctx),
            Command::UsePreset(preset) => {
                if let Some(volume) = &self.volume {
                    match preset.apply(&self.settings, &volume.ranges) {
                        Ok(settings) => self.settings = settings,
                        Err(err) => self.messages.error(text::messages::PRESET_NOT_APPLIED, err.to_string()),
                    }
                }
            }
            Command::UseColors(at, reversed) => {
                if let Some(map) = COLOR_MAPS.get(at) {
                    self.settings.transfer.color_by(map, reversed);
                }
            }
            Command::ImportTransfer => self.files.ask(Purpose::ImportTransfer, frame, ctx),
            Command::ExportTransfer => self.files.ask(Purpose::ExportTransfer, frame, ctx),
            Command::InvertTransfer => self.settings.transfer.invert(),
            Command::ToggleCrop => {
                self.settings.cuts.crop.on ^= true;
                self.show_section(ctx, text::sections::CUTS, self.settings.cuts.crop.on);
            }
            Command::TogglePlane => {
                self.settings.cuts.plane.on ^= true;
                self.show_section(ctx, text::sections::CUTS, self.settings.cuts.plane.on);
            }
            Command::FacePlane => {
                let Camera { target, .. } = self.settings.camera;
                self.settings.cuts.plane.face(self.settings.camera.scene_from_view().z_axis, target.into());
            }
            Command::ToggleFloor => {
                self.settings.floor.on ^= true;
                self.show_section(ctx, text::sections::FLOOR, self.settings.floor.on);
            }
            Command::Balance => self.start_balance(ctx),
            Command::FrameAll => {
                if self.can_frame(command, ctx) {
                    self.frame_object();
                }
            }
            Command::TurnObject(turn) => self.turn_object(turn, ctx),
            Command::TurnRound => {
                if self.can_frame(command, ctx) {
                    let outline = self.outline();
                    let orbit = Orbit::begin(&self.settings.camera, outline.as_deref());
                    self.settings.camera.orbit(90.0, 0.0);
                    orbit.keep_in_frame(&mut self.settings.camera, outline.as_deref());
                }
            }
            Command::LookFrom(view) => {
                if self.can_frame(command, ctx) {
                    if self.volume.as_ref().is_some_and(|volume| volume.is_anatomical) {
                        self.settings.camera.look_at_body(view);
                    } else {
                        self.settings.camera.look_from(view);
                    }
                    self.frame_object();
                }
            }
            Command::ToggleProjection => self.settings.camera.toggle_projection(),
            Command::KeepView => self.keep_view(),
            Command::KeepInStrip => self.keep_look_in_strip(),
            Command::StoreView(slot) => self.keep_view_under(slot),
            Command::RecallView(slot) => self.go_to_digit(slot, ctx),
            Command::GoToKept(at, with_view) => self.go_to_kept(at, with_view, ctx),
            Command::ReplaceKept(at) => self.replace_kept(at),
            Command::CompareKept(left, right) => {
                self.compare_kept(left, right);
                reveal::show_section(ctx, text::sections::COMPARE, true);
            }
            Command::ExportKept => self.files.ask(Purpose::ExportKept, frame, ctx),
            Command::ToggleKept => self.layout.kept ^= true,
            Command::Scale(1) => gui_zoom::zoom_in(ctx),
            Command::Scale(-1) => gui_zoom::zoom_out(ctx),
            Command::Scale(_) => ctx.set_zoom_factor(1.0),
            Command::ToggleFullScreen => {
                let is_full = ctx.input(|input| input.viewport().fullscreen.unwrap_or(false));
                ctx.send_viewport_cmd(egui::ViewportCommand::Fullscreen(!is_full));
            }
            Command::ToggleOverlay => self.overlay.on ^= true,
            Command::ToggleProbe => self.probe.on ^= true,
            Command::ShowPalette => self.palette.open(),
            Command::UseRig(rig) => {
                self.settings.lights = rig.lights(&self.settings.camera);
                self.selected_light = 0;
            }
            Command::UseLights(lights) => {
                self.selected_light = self.selected_light.min(lights.len().saturating_sub(1));
                self.settings.lights = lights;
            }
            Command::UseLook(look) => {
                // A suggested look leaves saved views, render quality, cuts and corrections of the file as they are.
                let look = look.drawn_as(&self.settings);
                let Settings { cuts, kept, volume, .. } = std::mem::take(&mut self.settings);
                self.settings = Settings { cuts, kept, volume, ..look };
                self.selected_light = 0;
            }
            Command::TryLooks => {
                // Suggested looks derive from the first look, which must have the current up axis.
                if self.first_look_stands(Some(command), ctx) {
                    self.contact_sheet.open(Sheet::Looks);
                }
            }
            Command::TryLights => self.contact_sheet.open(Sheet::Lights),
            Command::UseSurroundings => self.files.ask(Purpose::Surroundings, frame, ctx),
            Command::SuggestLight => self.contact_sheet.open(Sheet::Suggestions),
            Command::TryPresets => self.contact_sheet.open(Sheet::Presets),
            Command::NextLight | Command::PreviousLight => {
                let by = if command == Command::NextLight { 1 } else { -1 };
                let count = self.settings.lights.len();
                self.selected_light = light_keys::cycle(count, self.selected_light, by);
            }
            Command::Solo => light_keys::solo(&mut self.settings.lights, self.selected_light),
            Command::Mute | Command::Brighter | Command::Dimmer => {
                if let Some(light) = self.settings.lights.get_mut(self.selected_light) {
                    match command {
                        Command::Mute => light.on ^= true,
                        Command::Brighter => light_keys::brighten(light, 1),
                        _ => light_keys::brighten(light, -1),
                    }
                }
            }
            Command::ToggleSide => self.layout.side ^= true,
            Command::ToggleTransfer => self.layout.transfer ^= true,
            Command::TogglePictureOnly => self.toggle_picture_only(),
            Command::ToggleHandles => self.handles.hidden ^= true,
            Command::ToggleCompare => {
                self.compare.on ^= true;
                self.show_section(ctx, text::sections::COMPARE, self.compare.on);
            }
            Command::Reveal(place) => {
                let is_of_editor = [text::transfer::TITLE, text::labels::TITLE].contains(&place.section);
                *(if is_of_editor { &mut self.layout.transfer } else { &mut self.layout.side }) = true;
                self.layout.picture_only = false;
                reveal::reveal(ctx, place);
            }
            Command::ShowSlices => self.slices.open ^= true,
            Command::ShowLightVolume => self.light_slice.open = true,
            Command::CompareWithFile => self.files.ask(Purpose::CompareSettings, frame, ctx),
            Command::ShowHelp => self.help.keys ^= true,
            Command::ShowAbout => self.help.about = true,
        }
        ctx.request_repaint();
    }

    /// Opens a section and the side panel when its feature is switched on, unless only the picture is shown.
    fn show_section(&mut self, ctx: &egui::Context, section: &'static str, is_on: bool) {
        self.layout.side |= is_on && !self.layout.picture_only;
        reveal::show_section(ctx, section, is_on);
    }

    /// Collects the results that worker threads have finished.
    pub(crate) fn collect(&mut self, ctx: &egui::Context) {
        match self.loader.take() {
            None => {}
            Some(Outcome::Opened(opened)) => self.take_in_with_session(*opened, ctx),
            Some(Outcome::Shown { renderer, dataset }) => self.viewport.set_scene(*renderer, dataset),
            Some(Outcome::Cancelled) => {
                self.pending = None;
                self.messages.note(text::messages::OPENING_CANCELLED);
            }
            Some(Outcome::NotDescribed { path, why, guess }) => {
                self.raw_dialog.ask(&path, why, guess, ctx);
            }
            // A look that is pending for this volume stays pending.
            Some(Outcome::Weighed { source, reading, weighed }) => self.roomy.ask(source, *reading, weighed),
            Some(Outcome::Failed { short, details }) => {
                self.pending = None;
                self.messages.error(short, details);
            }
        }
        self.take_neighbour(ctx);
        self.take_treated(ctx);
        self.take_files(ctx);
        if let Some(result) = self.balance.as_ref().and_then(Work::take) {
            self.balance = None;
            match result {
                Ok(Ok(balance)) => {
                    self.settings.shadows.balance = balance;
                    self.settings.sanitise();
                }
                Ok(Err(err)) => self.messages.error(text::messages::BALANCE_NOT_MEASURED, err.to_string()),
                Err(panic) => self.messages.error(text::messages::BALANCE_NOT_MEASURED, panic),
            }
        }
        if let Some(found) = self.viewport.take_balance() {
            self.keep_balanced.found(ctx.input(|input| input.time), found.as_ref().ok().copied());
            if let Err(err) = found {
                self.messages.error(text::messages::BALANCE_NOT_MEASURED, err.to_string());
            }
        }
        match self.export.take() {
            None => {}
            Some(Ok(Exported::File(path))) => {
                self.layout.exports =
                    std::path::absolute(&path).ok().and_then(|path| Some(path.parent()?.to_owned()));
                self.messages.note(text::messages::exported(&path));
            }
            Some(Ok(Exported::Picture(picture))) => {
                ctx.copy_image(picture);
                self.messages.note(text::messages::PICTURE_COPIED);
            }
            Some(Ok(Exported::Cancelled)) => self.messages.note(text::messages::EXPORT_CANCELLED),
            Some(Err(err)) => self.messages.error(text::messages::PICTURE_NOT_EXPORTED, err),
        }
        if self.files.take_refusal() {
            self.messages.note(text::files::DIALOG_IS_OPEN);
        }
        if let Some((purpose, path)) = self.files.take(ctx) {
            self.chosen(purpose, &path, ctx);
            if purpose == Purpose::ExportPicture {
                // The desktop's file dialog has already asked before overwriting.
                self.export.agree_to(&path);
            }
        }
    }

    pub(in crate::app) fn viewport_size(&self) -> [u32; 2] {
        // Before there is a picture: the resolution of the smallest common screens.
        self.canvas.map_or([1280, 720], |canvas| canvas.room.map(|n| n.max(1)))
    }

    /// Handles a file that was chosen in a dialog or typed.
    pub(in crate::app) fn chosen(&mut self, purpose: Purpose, path: &Path, ctx: &egui::Context) {
        match purpose {
            Purpose::OpenVolume | Purpose::OpenFolder => self.open(path, ctx),
            Purpose::VolumeOfLook => self.open_for_look(path, ctx),
            Purpose::ExportPicture => self.export.set_path(path),
            Purpose::SaveSettings => self.save_settings(path),
            Purpose::ExportKept => {
                if let Some(subject) = self.subject()
                    && let Err(err) = self.export.sheet(subject, path, ctx)
                {
                    self.messages.error(text::messages::PICTURE_NOT_EXPORTED, err);
                }
            }
            Purpose::ExportLight => {
                let Some(dataset) = self.viewport.dataset() else { return };
                match self.light_slice.export(path, dataset.volume()) {
                    Ok(()) => self.messages.note(text::messages::exported(path)),
                    Err(err) => self.messages.error(text::messages::LIGHT_VOLUME_NOT_EXPORTED, err),
                }
            }
            Purpose::LoadSettings => self.load_settings(path, ctx),
            Purpose::Surroundings => self.read_surroundings(path, ctx),
            Purpose::ImportTransfer => self.import_transfer(path, ctx),
            Purpose::ExportTransfer => {
                match files::export_transfer(path, &self.settings, &self.value_ranges()) {
                    Ok(()) => self.messages.note(text::messages::wrote(path)),
                    Err(err) => self.messages.error(text::messages::TRANSFER_NOT_WRITTEN, err),
                }
            }
            Purpose::CompareSettings => self.compare_with_file(path, ctx),
        }
    }

    /// Returns the subject of an export; shows a message if there is no picture.
    pub(in crate::app) fn subject(&mut self) -> Option<export::Subject> {
        let Some(dataset) = self.viewport.dataset() else {
            self.messages.note(text::messages::NO_PICTURE);
            return None;
        };
        // Ignores a correction in progress: the picture shows the volume that is loaded.
        let settings = Settings { volume: *dataset.volume().corrections(), ..self.settings.clone() };
        Some(export::Subject {
            context: self.viewport.context().clone(),
            dataset,
            settings,
            first: self.defaults.clone(),
            source: self.volume.as_ref().map_or_else(PathBuf::new, |volume| volume.source.clone()),
            selected_light: self.selected_light,
            outline: self.outline(),
        })
    }

    pub(crate) fn start_export(&mut self, ctx: &egui::Context) {
        if let Some(subject) = self.subject()
            && let Err(err) = self.export.start(subject, ctx)
        {
            self.messages.error(text::messages::PICTURE_NOT_EXPORTED, err);
        }
    }

    fn copy_picture(&mut self, ctx: &egui::Context) {
        if self.export.is_busy() {
            self.messages.note(text::messages::EXPORT_RUNS);
        } else if let Some(subject) = self.subject()
            && let Err(err) = self.export.copy(subject, self.viewport_size(), ctx)
        {
            self.messages.error(text::messages::PICTURE_NOT_COPIED, err);
        }
    }

    /// Handles an error of the renderer. After the loss of the device, another window takes the place of this one.
    pub(crate) fn rendering_failed(&mut self, err: &GpuError, ctx: &egui::Context) {
        if self.viewport.is_lost() {
            self.end_for_another(ctx);
        } else {
            self.messages.error(text::messages::NOT_RENDERED, err.to_string());
        }
    }
}
