//! Main window of the viewer, built on egui and wgpu (feature `window`).
//!
//! The document holds the look, the facts about its volume and the undo history; beside it are the window's own
//! parts. Panels change one [`Settings`] value; the viewport turns it into a picture. All rendering runs on threads
//! beside the window's: the render worker, the loader, the light search, exports, contact sheets, slices of light
//! volumes, and the measurement of brightness. So does everything that visits all voxels (first looks for another kind of
//! data, or for an object that stands another way up) and everything that reads untrusted files, looks and sessions
//! included. Panels see settings and read-only facts.

mod common;
mod document;
mod kept_views;
mod layout;
mod panels;
mod persistence;
mod shell;
mod start;
mod text;
mod transfer_editor;
mod viewport;
mod windows;
mod worker;

#[cfg(feature = "cli")]
pub(crate) use self::persistence::save_before_termination;
pub use self::shell::opening::SettingsAdjustment;
pub use self::start::desktop_error::show_on_desktop;
pub use self::start::error::AppError;
pub use self::start::main_loop::{run, storage_folder, wgpu_setup};
pub use self::start::options::WindowOptions;

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

use eframe::egui;

use self::common::commands::AppCommand;
use self::common::drag_cancel::DragCancel;
use self::common::{light_keys, reveal, shortcuts};
use self::layout::WindowLayout;
use self::layout::outer_panels::{OuterPanelInputs, OuterPanels};
use self::shell::look_editor::LookEditor;
use self::shell::opening::{OpeningState, VolumeOpener};
use self::shell::picture_area::PictureTools;
use self::shell::status_file;
use self::shell::status_file::StatusFile;
use self::shell::tool_windows::{AppDialogs, ToolWindows};
use self::start::window_device::WindowDevice;
use self::viewport::paint_callback;
use self::windows::file_dialogs;
use self::worker::background_task;
use chiaroscuro_render::GpuError;
use chiaroscuro_scene::Settings;

/// Duration of a frame on the window's thread, in ms, from which on the delay is felt and logged.
const SLOW_FRAME_MS: f64 = 50.0;

/// State of the main window, which implements [`eframe::App`].
pub struct App {
    /// Look that is edited, with its volume, its picture and the messages about it.
    editor: LookEditor,
    /// Requests for the next volume, and files that are being read.
    opening: OpeningState,
    /// Handles, overlays and other tools over the picture.
    picture: PictureTools,
    windows: ToolWindows,
    dialogs: AppDialogs,
    /// Panels around the picture.
    panels: OuterPanels,
    /// Panels and tool windows that are shown, as stored between runs.
    layout: WindowLayout,
    /// Cancelling of drags by Escape.
    drag_cancel: DragCancel,
    /// Graphics device that draws the window.
    device: WindowDevice,
    status_file: StatusFile,
}

/// Longest wait of a closing window for tasks that still use the graphics driver.
const TASK_SHUTDOWN_TIMEOUT: Duration = Duration::from_secs(10);

impl Drop for App {
    fn drop(&mut self) {
        // The results of these tasks are no longer needed.
        self.editor.look_tasks.light_search = None;
        self.windows.contact_sheet.discard();
        self.panels.kept_strip.reset();
        // If another window replaces this one, that window waits for the tasks when it closes.
        if !self.device.is_lost {
            background_task::wait_for_all_tasks(TASK_SHUTDOWN_TIMEOUT);
        }
    }
}

impl std::fmt::Debug for App {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("App")
            .field("settings", &self.editor.document.settings)
            .field("volume", &self.editor.document.volume)
            .finish_non_exhaustive()
    }
}

impl App {
    /// Returns the current settings, that is the look.
    pub fn settings(&self) -> &Settings {
        &self.editor.document.settings
    }

    /// Returns true if the full-quality picture of the current settings is on screen, nothing is being opened, the
    /// first look is finished, and the balance, if it is kept, has been measured for these settings.
    pub fn is_idle(&self) -> bool {
        !self.opening.is_opening() && self.editor.is_complete() && !self.editor.is_changing()
    }

    /// Returns true while a requested look is computed on another thread: for another kind of data, or for the object
    /// turned to stand another way up.
    pub fn is_making_look(&self) -> bool {
        self.editor.document.is_making_look()
    }

    /// Opens a file or a built-in volume, or the volume of a session or exported picture with the look stored there.
    /// The open volume stays until the new one is ready.
    pub fn open(&mut self, source: impl AsRef<Path>, ctx: &egui::Context) {
        self.opener(ctx).open(source.as_ref());
    }

    /// Reads a transfer function of another program on a thread and applies it to the look.
    pub fn import_transfer(&mut self, path: &Path, ctx: &egui::Context) {
        self.opener(ctx).import_transfer(path);
    }

    /// Reads an environment map on a thread and lights the scene by it; supersedes one that is still being read.
    pub fn read_environment_map(&mut self, path: &Path, ctx: &egui::Context) {
        self.opener(ctx).read_environment_map(path);
    }

    /// Blocks the reading of files while the returned guard lives.
    #[cfg(feature = "testing")]
    pub fn block_file_tasks() -> impl Sized {
        self::shell::opening::file_tasks::test_lock::wait()
    }

    /// Path of the file that is being read.
    #[cfg(feature = "testing")]
    pub fn file_being_read(&self) -> Option<&Path> {
        self.opening.file_tasks.path()
    }

    /// Returns the opener of volumes and looks for this window.
    fn opener<'a>(&'a mut self, ctx: &'a egui::Context) -> VolumeOpener<'a> {
        VolumeOpener { state: &mut self.opening, editor: &mut self.editor, ctx }
    }

    /// Handles an error of the renderer. After the loss of the device, another window takes the place of this one.
    fn handle_render_error(&mut self, err: &GpuError, ctx: &egui::Context) {
        if self.editor.viewport.is_lost() {
            self.device.close_for_successor(&self.editor.memory, ctx);
        } else {
            self.editor.messages.error(text::messages::NOT_RENDERED, err.to_string());
        }
    }

    /// Drops the pictures of the volume before, if another one has replaced it.
    fn drop_pictures_of_replaced(&mut self) {
        if self.opening.take_opened() {
            self.panels.recent_pictures.clear();
            self.windows.contact_sheet.discard();
            self.panels.kept_strip.reset();
        }
    }

    /// Rectangle of the picture in points, and its size in physical pixels.
    pub fn viewport_rect(&self) -> Option<(egui::Rect, [u32; 2])> {
        self.picture.canvas.map(|canvas| (canvas.rect, canvas.size))
    }

    /// Positions of the handles of the enabled lights, in points.
    pub fn light_handle_positions(&self) -> &[egui::Pos2] {
        self.picture.handles.positions()
    }

    /// Number of light volume refills since this volume was opened.
    pub fn light_rebuilds(&self) -> u64 {
        self.editor.viewport.light_fill_count()
    }

    /// Number of previews of this volume that were followed by a full-quality picture.
    pub fn full_quality_pictures(&self) -> u64 {
        self.editor.viewport.refinement_count()
    }

    /// Name of the open volume, or `None` if there is none.
    pub fn volume_name(&self) -> Option<&str> {
        self.editor.document.volume.as_ref().map(|volume| volume.name.as_str())
    }

    /// Error messages since the volume was opened.
    pub fn errors(&self) -> &[String] {
        self.editor.messages.errors()
    }

    /// Latest note in the status bar since the volume was opened, even if it has disappeared.
    pub fn latest_note(&self) -> Option<&str> {
        self.editor.messages.latest_note()
    }

    /// Returns true while a note lies over the picture; notes disappear after some seconds.
    pub fn shows_note(&self) -> bool {
        self.editor.messages.shows_note()
    }

    /// Records a notice from before there was a window to show it.
    fn add_notice(&mut self, notice: String) {
        self.editor.memory.add_notice(notice);
    }

    /// Exports the picture as the export window does, replacing an existing file.
    pub fn export(&mut self, path: &Path, size: [u32; 2], ctx: &egui::Context) {
        self.windows.export.set_size(size);
        self.windows.export.allow_replacing(path);
        self.windows.start_export(&mut self.editor, ctx);
    }

    /// Returns true while an export is being rendered or written.
    pub fn is_exporting(&self) -> bool {
        self.windows.export.is_busy()
    }
}

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
        let start = std::time::Instant::now();
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
        let mut inputs = OuterPanelInputs {
            editor: &mut self.editor,
            opening: &self.opening,
            picture: &self.picture,
            windows: &mut self.windows,
            layout: &mut self.layout,
            facts: &facts,
            commands: &mut commands,
        };
        self.panels.show(ui, &mut inputs);
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
        self.editor.document.update_shown_range(self.editor.viewport.dataset().as_ref());
        shortcuts::commands_from_keys(&ctx, &mut commands);
        light_keys::nudge(&ctx, &mut self.editor.document.settings, self.editor.document.selected_light);
        self.show_windows(frame, &ctx, &mut commands);
        self.drag_cancel.end(&mut self.editor.document.settings);
        let mut opener = VolumeOpener { state: &mut self.opening, editor: &mut self.editor, ctx: &ctx };
        opener.ask_for_volume(&mut self.dialogs.files, frame);
        self.editor.document.history.observe(&ctx, &self.editor.document.history_step());
        commands.extend(self.editor.finish_framing());
        commands.extend(self.editor.update_outline(self.opening.is_opening(), &ctx));
        let before = self.editor.document.settings.camera.clone();
        for command in commands {
            self.execute(command, frame, &ctx);
        }
        self.picture.camera_animation.begin(
            &before,
            &self.editor.document.settings.camera,
            ctx.input(|input| input.time),
        );
        self.opener(&ctx).cancel_files_by_key();
        self.drop_pictures_of_replaced();
        self.layout.leave_picture_only(&ctx);
        if self.editor.update_corrections(&ctx) {
            self.windows.contact_sheet.discard();
        }
        let is_opening = self.opening.is_opening();
        self.editor.finish_first_look(is_opening, self.opening.loader.shaders(), &ctx);
        self.editor.update_balance(is_opening, &ctx);
        self.editor.autosave_look();
        let ui_ms = start.elapsed().as_secs_f64() * 1000.0;
        if ui_ms > SLOW_FRAME_MS {
            log::debug!("the window's thread was busy for {ui_ms:.0} ms");
        }
        self.status_file.longest_ui_ms = self.status_file.longest_ui_ms.max(ui_ms);
        let idle = self.is_idle();
        if idle {
            self.opening.loader.warm_up_rest();
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
            places: if self.status_file.is_on() { reveal::reported_areas(&ctx) } else { BTreeMap::new() },
            pixels_per_point: ctx.pixels_per_point(),
        };
        self.status_file.update(&state);
        if self.opening.loader.progress().is_some() || self.windows.export.is_busy() {
            // The progress bar moves; and an export started by an earlier window cannot wake this one.
            ctx.request_repaint_after(std::time::Duration::from_millis(100));
        }
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        self.layout.store(storage);
    }

    fn on_exit(&mut self) {
        self.editor.autosave_look();
        if self.device.is_lost {
            self.device.hand_over(
                &mut self.editor,
                &mut self.opening,
                &mut self.windows,
                &self.layout,
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
