//! Main window of the viewer, built on egui and wgpu (feature `window`).
//!
//! Panels change one [`Settings`] value; the viewport turns it into a picture. All rendering runs on threads beside
//! the window's: the render worker, the loader, the light search, exports, contact sheets, slices of light volumes,
//! and the measurement of brightness. So does everything that visits all voxels (first looks for another kind of
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
pub use self::start::desktop_error::show_on_desktop;
pub use self::start::error::AppError;
pub use self::start::main_loop::{run, storage_folder, wgpu_setup};
pub use self::start::options::{SettingsAdjustment, WindowOptions};

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

use eframe::egui;

use self::common::commands::AppCommand;
use self::common::drag_cancel::DragCancel;
use self::common::{light_keys, reveal, shortcuts};
use self::document::Document;
use self::kept_views::KeptStrip;
use self::layout::WindowLayout;
use self::persistence::{PersistentState, RecentThumbnails};
use self::shell::automatic_changes::LightSearchTask;
use self::shell::file_tasks::FileTasks;
use self::shell::history::HistoryWindow;
use self::shell::messages::MessageLog;
use self::shell::opening::{NeighbourSearch, PendingLook};
use self::shell::status_file;
use self::shell::status_file::StatusFile;
use self::start::handover::HandoverSlot;
use self::transfer_editor::TransferEditor;
use self::viewport::camera_transition::CameraTransition;
use self::viewport::canvas::Canvas;
use self::viewport::compare::Compare;
use self::viewport::cut_handles::CutHandles;
use self::viewport::first_use_hints::FirstUseHints;
use self::viewport::light_handles::LightHandles;
use self::viewport::light_probe::LightProbe;
use self::viewport::mouse_navigation::OrbitDrag;
use self::viewport::overlay::ViewportOverlay;
use self::viewport::overlay::ct_preset_row::CtPresetRow;
use self::viewport::overlay::export_marks_preview::ExportMarksPreview;
use self::viewport::{Viewport, paint_callback};
use self::windows::contact_sheet::ContactSheetWindow;
use self::windows::device_loss::DeviceLossDialog;
use self::windows::export::ExportWindow;
use self::windows::file_dialogs;
use self::windows::file_dialogs::FileDialogs;
use self::windows::help::HelpWindows;
use self::windows::large_volume::LargeVolumeDialog;
use self::windows::light_slice::LightSliceWindow;
use self::windows::palette::CommandPalette;
use self::windows::quit_dialog::QuitDialog;
use self::windows::raw_dialog::RawDialog;
use self::windows::recovery::RecoveryDialog;
use self::windows::slices::SlicesWindow;
use self::windows::untrusted_path::UntrustedPathDialog;
use self::windows::volume_chooser::VolumeChooser;
use self::worker::background_task::{self, BackgroundTask};
use self::worker::loader::Loader;
use chiaroscuro_render::{GpuContext, GpuError, WindowPainter};
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::Dataset;

/// Duration of a frame on the window's thread, in ms, from which on the delay is felt and logged.
const SLOW_FRAME_MS: f64 = 50.0;

/// State of the main window, which implements [`eframe::App`].
pub struct App {
    document: Document,
    viewport: Viewport,
    /// Painter of the window's background colour.
    window: WindowPainter,
    /// Graphics device that draws the window.
    window_context: GpuContext,
    storage: Option<PathBuf>,
    /// State that this window hands over to its successor after a lost device.
    handover: HandoverSlot,
    /// Volume handed over from an earlier window, until the user has chosen how to go on.
    handed_over_dataset: Option<Dataset>,
    /// True once the device is lost; nothing is drawn any more.
    is_device_lost: bool,
    /// True if the next window is to be drawn by the CPU (software adapter).
    wants_cpu: bool,
    canvas: Option<Canvas>,
    loader: Loader,
    memory: PersistentState,
    recent_pictures: RecentThumbnails,
    /// True if the next volume keeps the current look instead of getting its own first look.
    keeps_look_for_next: bool,
    /// Look for the volume that is being opened, applied when the volume arrives.
    pending_look: Option<PendingLook>,
    balance: Option<BackgroundTask<Result<f64, GpuError>>>,
    file_tasks: FileTasks,
    light_search: Option<LightSearchTask>,
    export: ExportWindow,
    files: FileDialogs,
    recovery_dialog: RecoveryDialog,
    /// True while the default volume waits for the user's answer about reopening the last session.
    default_open_waits: bool,
    quit_dialog: QuitDialog,
    device_loss_dialog: DeviceLossDialog,
    /// True until the session's look has been applied over the first look.
    session_is_due: bool,
    adjust_first_look: Option<SettingsAdjustment>,
    history_list: HistoryWindow,
    handles: LightHandles,
    cut_handles: CutHandles,
    compare: Compare,
    overlay: ViewportOverlay,
    /// Preview of the marks that would be drawn over an exported picture.
    export_marks: ExportMarksPreview,
    orbit: OrbitDrag,
    camera_animation: CameraTransition,
    light_probe: LightProbe,
    palette: CommandPalette,
    light_slice: LightSliceWindow,
    slices: SlicesWindow,
    raw_dialog: RawDialog,
    large_volume_dialog: LargeVolumeDialog,
    untrusted_path_dialog: UntrustedPathDialog,
    /// True if volumes named by looks from outside are opened without asking the user.
    trusts_paths: bool,
    contact_sheet: ContactSheetWindow,
    volume_chooser: VolumeChooser,
    drag_cancel: DragCancel,
    /// Search for the next file in the folder, while it runs.
    next_file_search: Option<NeighbourSearch>,
    editor: TransferEditor,
    layout: WindowLayout,
    kept_strip: KeptStrip,
    help: HelpWindows,
    first_run_hints: FirstUseHints,
    ct_looks: CtPresetRow,
    messages: MessageLog,
    /// Longest frame so far on the window's thread, in ms; written by `status_file`.
    longest_ui_ms: f64,
    status_file: StatusFile,
}

/// Longest wait of a closing window for tasks that still use the graphics driver.
const TASK_SHUTDOWN_TIMEOUT: Duration = Duration::from_secs(10);

impl Drop for App {
    fn drop(&mut self) {
        // The results of these tasks are no longer needed.
        self.light_search = None;
        self.contact_sheet.discard();
        self.kept_strip.reset();
        // If another window replaces this one, that window waits for the tasks when it closes.
        if !self.is_device_lost {
            background_task::wait_for_all_tasks(TASK_SHUTDOWN_TIMEOUT);
        }
    }
}

impl std::fmt::Debug for App {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("App")
            .field("settings", &self.document.settings)
            .field("volume", &self.document.volume)
            .finish_non_exhaustive()
    }
}

impl App {
    /// Returns the current settings, that is the look.
    pub fn settings(&self) -> &Settings {
        &self.document.settings
    }

    /// Returns true if the full-quality picture of the current settings is on screen, nothing is being opened, the
    /// first look is finished, and the balance, if it is kept, has been measured for these settings.
    pub fn is_idle(&self) -> bool {
        self.is_complete()
            && !self.is_making_look()
            && !self.document.first_lights.is_due()
            && self.document.knows_outline(self.viewport.dataset().as_ref())
            && !self.document.keep_balanced.is_due(&self.document.settings)
    }

    /// Returns true while a requested look is computed on another thread: for another kind of data, or for the object
    /// turned to stand another way up.
    pub fn is_making_look(&self) -> bool {
        self.document.is_making_look()
    }

    /// Returns true if the full-quality picture of the current settings is on screen and nothing is being opened,
    /// read or corrected.
    fn is_complete(&self) -> bool {
        self.is_volume_ready() && self.viewport.is_idle(&self.compare.looks(&self.document.settings))
    }

    /// Returns true if no volume is being opened, read or corrected.
    fn is_volume_ready(&self) -> bool {
        self.loader.progress().is_none()
            && self.file_tasks.path().is_none()
            && !self.document.is_correcting(self.viewport.dataset().as_ref())
    }

    /// Rectangle of the picture in points, and its size in physical pixels.
    pub fn viewport_rect(&self) -> Option<(egui::Rect, [u32; 2])> {
        self.canvas.map(|canvas| (canvas.rect, canvas.size))
    }

    /// Positions of the handles of the enabled lights, in points.
    pub fn light_handle_positions(&self) -> &[egui::Pos2] {
        self.handles.positions()
    }

    /// Number of light volume refills since this volume was opened.
    pub fn light_rebuilds(&self) -> u64 {
        self.viewport.light_fill_count()
    }

    /// Number of previews of this volume that were followed by a full-quality picture.
    pub fn full_quality_pictures(&self) -> u64 {
        self.viewport.refinement_count()
    }

    /// Name of the open volume, or `None` if there is none.
    pub fn volume_name(&self) -> Option<&str> {
        self.document.volume.as_ref().map(|volume| volume.name.as_str())
    }

    /// Error messages since the volume was opened.
    pub fn errors(&self) -> &[String] {
        self.messages.errors()
    }

    /// Latest note in the status bar since the volume was opened, even if it has disappeared.
    pub fn latest_note(&self) -> Option<&str> {
        self.messages.latest_note()
    }

    /// Returns true while a note lies over the picture; notes disappear after some seconds.
    pub fn shows_note(&self) -> bool {
        self.messages.shows_note()
    }

    /// Exports the picture as the export window does, replacing an existing file.
    pub fn export(&mut self, path: &Path, size: [u32; 2], ctx: &egui::Context) {
        self.export.set_size(size);
        self.export.allow_replacing(path);
        self.start_export(ctx);
    }

    /// Returns true while an export is being rendered or written.
    pub fn is_exporting(&self) -> bool {
        self.export.is_busy()
    }
}

impl eframe::App for App {
    fn logic(&mut self, ctx: &egui::Context, _frame: &mut eframe::Frame) {
        self.inject_faults();
        // Checked before anything is drawn, because drawing on a lost device would panic.
        let is_lost = self.window_context.is_lost() || self.viewport.context().is_known_lost();
        if self.is_device_lost || is_lost {
            return self.close_for_successor(ctx);
        }
        self.collect_results(ctx);
        // Runs even while the window is hidden and nothing is drawn.
        self.autosave_look();
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        if self.is_device_lost {
            return;
        }
        let ctx = ui.ctx().clone();
        let start = std::time::Instant::now();
        ui.painter().add(paint_callback::fill_shape(
            ctx.viewport_rect(),
            &self.window,
            ui.visuals().panel_fill,
        ));
        self.drag_cancel.begin(&ctx, &self.document.settings);
        let mut commands = Vec::new();
        let dropped = file_dialogs::dropped_files(&ctx);
        if !dropped.is_empty() {
            commands.push(AppCommand::OpenDropped(dropped));
        }
        let facts = self.viewport.renderer_status(&self.compare.looks(&self.document.settings));
        self.palette.ui(&ctx, self.document.settings.camera.up, self.document.volume.as_ref(), &mut commands);
        self.volume_chooser.ui(&ctx, self.document.volume.as_ref(), self.loader.options(), &mut commands);
        self.show_outer_panels(ui, &facts, &mut commands);
        self.show_picture(ui, &facts, &mut commands);
        shortcuts::commands_from_keys(&ctx, &mut commands);
        light_keys::nudge(&ctx, &mut self.document.settings, self.document.selected_light);
        self.show_windows(frame, &ctx, &mut commands);
        self.drag_cancel.end(&mut self.document.settings);
        self.ask_for_volume(frame, &ctx);
        self.document.history.observe(&ctx, &self.document.history_step());
        commands.extend(self.finish_framing());
        commands.extend(self.update_outline(&ctx));
        let before = self.document.settings.camera.clone();
        for command in commands {
            self.execute(command, frame, &ctx);
        }
        self.camera_animation.begin(&before, &self.document.settings.camera, ctx.input(|input| input.time));
        self.cancel_files_by_key(&ctx);
        self.leave_picture_only(&ctx);
        self.update_corrections(&ctx);
        self.finish_first_look(&ctx);
        self.update_balance(&ctx);
        self.autosave_look();
        let ui_ms = start.elapsed().as_secs_f64() * 1000.0;
        if ui_ms > SLOW_FRAME_MS {
            log::debug!("the window's thread was busy for {ui_ms:.0} ms");
        }
        self.longest_ui_ms = self.longest_ui_ms.max(ui_ms);
        let idle = self.is_idle();
        if idle {
            self.loader.warm_up_rest();
        }
        let state = status_file::WindowStatus {
            longest_ui_ms: self.longest_ui_ms,
            response: self.viewport.response_times(),
            loading: self.loader.progress().is_some() || self.file_tasks.path().is_some(),
            idle,
            canvas: self.canvas.filter(|_| self.document.volume.is_some()),
            handles: self.handles.positions(),
            light_rebuilds: self.light_rebuilds(),
            errors: self.messages.errors(),
            path_window: self.files.typed_path_title(),
            places: if self.status_file.is_on() { reveal::reported_areas(&ctx) } else { BTreeMap::new() },
            pixels_per_point: ctx.pixels_per_point(),
        };
        self.status_file.update(&state);
        if self.loader.progress().is_some() || self.export.is_busy() {
            // The progress bar moves; and an export started by an earlier window cannot wake this one.
            ctx.request_repaint_after(std::time::Duration::from_millis(100));
        }
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        self.layout.store(storage);
    }

    fn on_exit(&mut self) {
        self.autosave_look();
        if self.is_device_lost {
            self.hand_over();
        } else {
            self.export.cancel_and_wait();
        }
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }
}
