//! Main window of the viewer, built on egui and wgpu (feature `window`).
//!
//! Panels change one [`Settings`] value; the viewport turns it into a picture. All rendering runs on threads beside
//! the window's: the render worker, the loader, the light search, exports, contact sheets, slices of light volumes,
//! and the measurement of brightness. So does everything that visits all voxels (first looks for another kind of
//! data, or for an object that stands another way up) and everything that reads untrusted files, looks and sessions
//! included. Panels see settings and read-only facts.

mod common;
mod kept;
mod layout;
mod memory;
mod panels;
mod shell;
mod start;
mod text;
mod transfer_editor;
mod viewport;
mod windows;
mod worker;

#[cfg(feature = "cli")]
pub(crate) use self::memory::end_in_a_hurry;
pub use self::start::error::AppError;
pub use self::start::no_adapter::show_on_desktop;
pub use self::start::options::{Adjustment, Options};
pub use self::start::run::{run, storage_folder, wgpu_setup};

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

use eframe::egui;

use self::common::give_up::GiveUp;
use self::common::{light_keys, reveal, shortcuts};
use self::shell::file_tasks::FileTasks;
use self::shell::status_file;
use self::windows::files;

use self::common::commands::Command;
use self::common::volume_facts::VolumeFacts;
use self::kept::Strip;
use self::layout::Layout;
use self::memory::{Memory, RecentPictures};
use self::shell::first_lights::{FirstLights, Seeking};
use self::shell::history::{History, Listed};
use self::shell::keep_balanced::KeepBalanced;
use self::shell::messages::Messages;
use self::shell::object::corrected::Corrected;
use self::shell::object::framed::Framed;
use self::shell::object::treat_as::Treated;
use self::shell::object::upright::Upright;
use self::shell::opening::{Neighbour, PendingLook};
use self::shell::session::Session;
use self::shell::status_file::StatusFile;
use self::start::carried::Legacy;
use self::transfer_editor::TransferEditor;
use self::viewport::canvas::Canvas;
use self::viewport::compare::Compare;
use self::viewport::cut_handles::CutHandles;
use self::viewport::hints::Hints;
use self::viewport::light_handles::LightHandles;
use self::viewport::light_probe::LightProbe;
use self::viewport::orbit::Orbit;
use self::viewport::overlay::Overlay;
use self::viewport::overlay::ct_looks::CtLooks;
use self::viewport::overlay::export_marks::ExportMarks;
use self::viewport::turning::Turning;
use self::viewport::{Viewport, paint_callback};
use self::windows::chooser::Chooser;
use self::windows::contact_sheet::ContactSheet;
use self::windows::export::Export;
use self::windows::files::Files;
use self::windows::foreign_path::ForeignPath;
use self::windows::help::Help;
use self::windows::light_slice::LightSlice;
use self::windows::lost_again::LostAgain;
use self::windows::palette::Palette;
use self::windows::quit::Quit;
use self::windows::raw_dialog::RawDialog;
use self::windows::recovery::Recovery;
use self::windows::roomy::Roomy;
use self::windows::slices::Slices;
use self::worker::loader::Loader;
use self::worker::task::{self, Work};
use crate::data::Dataset;
use crate::gpu::{Context, GpuError, WindowPainter};
use crate::model::Settings;

/// Duration of a frame on the window's thread, in ms, from which on the delay is felt and logged.
const LONG_FRAME_MS: f64 = 50.0;

/// State of the main window, which implements [`eframe::App`].
pub struct App {
    settings: Settings,
    /// First look at the open volume, which the reset buttons restore.
    defaults: Settings,
    volume: Option<VolumeFacts>,
    treated: Treated,
    upright: Upright,
    corrected: Corrected,
    framed: Framed,
    viewport: Viewport,
    /// Painter of the window's background colour.
    window: WindowPainter,
    /// Graphics device that draws the window.
    window_context: Context,
    storage: Option<PathBuf>,
    /// State that this window hands over to its successor after a lost device.
    legacy: Legacy,
    /// Volume handed over from an earlier window, until the user has chosen how to go on.
    waiting: Option<Dataset>,
    /// True once the device is lost; nothing is drawn any more.
    is_ending: bool,
    /// True if the next window is to be drawn by the CPU (software adapter).
    wants_cpu: bool,
    canvas: Option<Canvas>,
    loader: Loader,
    memory: Memory,
    recent_pictures: RecentPictures,
    /// True if the next volume keeps the current look instead of getting its own first look.
    keeps_look: bool,
    /// Look for the volume that is being opened, applied when the volume arrives.
    pending: Option<PendingLook>,
    balance: Option<Work<Result<f64, GpuError>>>,
    file_tasks: FileTasks,
    keep_balanced: KeepBalanced,
    first_lights: FirstLights,
    light_search: Option<Seeking>,
    export: Export,
    files: Files,
    session: Option<Session>,
    recovery: Recovery,
    /// True while the default volume waits for the user's answer about reopening the last session.
    first_waits: bool,
    quit: Quit,
    lost_again: LostAgain,
    /// True until the session's look has been applied over the first look.
    session_is_due: bool,
    adjust: Option<Adjustment>,
    history: History,
    listed: Listed,
    handles: LightHandles,
    cut_handles: CutHandles,
    compare: Compare,
    overlay: Overlay,
    /// Preview of the marks that would be drawn over an exported picture.
    export_marks: ExportMarks,
    orbit: Orbit,
    turning: Turning,
    probe: LightProbe,
    palette: Palette,
    light_slice: LightSlice,
    slices: Slices,
    raw_dialog: RawDialog,
    roomy: Roomy,
    foreign_path: ForeignPath,
    /// True if volumes named by looks from outside are opened without asking the user.
    trusts_paths: bool,
    contact_sheet: ContactSheet,
    chooser: Chooser,
    give_up: GiveUp,
    /// Search for the next file in the folder, while it runs.
    neighbour: Option<Neighbour>,
    editor: TransferEditor,
    selected_light: usize,
    layout: Layout,
    strip: Strip,
    help: Help,
    hints: Hints,
    ct_looks: CtLooks,
    messages: Messages,
    /// Longest frame so far on the window's thread, in ms; written by `status_file`.
    longest_ui_ms: f64,
    status_file: StatusFile,
}

/// Longest wait of a closing window for tasks that still use the graphics driver.
const LAST_TASKS: Duration = Duration::from_secs(10);

impl Drop for App {
    fn drop(&mut self) {
        // The results of these tasks are no longer needed.
        self.light_search = None;
        self.contact_sheet.forget();
        self.strip.forget();
        // If another window replaces this one, that window waits for the tasks when it closes.
        if !self.is_ending {
            task::wait_for_all(LAST_TASKS);
        }
    }
}

impl std::fmt::Debug for App {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("App")
            .field("settings", &self.settings)
            .field("volume", &self.volume)
            .finish_non_exhaustive()
    }
}

impl App {
    /// Returns the current settings, that is the look.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Returns true if the full-quality picture of the current settings is on screen, nothing is being opened, the
    /// first look is finished, and the balance, if it is kept, has been measured for these settings.
    pub fn is_idle(&self) -> bool {
        self.is_complete()
            && !self.is_making_look()
            && !self.first_lights.is_due()
            && self.knows_outline()
            && !self.keep_balanced.is_due(&self.settings)
    }

    /// Returns true while a requested look is computed on another thread: for another kind of data, or for the object
    /// turned to stand another way up.
    pub fn is_making_look(&self) -> bool {
        self.treated.is_busy() || self.upright.is_busy()
    }

    /// Returns true if the full-quality picture of the current settings is on screen and nothing is being opened,
    /// read or corrected.
    fn is_complete(&self) -> bool {
        self.has_its_volume() && self.viewport.is_idle(&self.compare.looks(&self.settings))
    }

    /// Returns true if no volume is being opened, read or corrected.
    fn has_its_volume(&self) -> bool {
        self.loader.progress().is_none() && self.file_tasks.path().is_none() && !self.is_correcting()
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
        self.viewport.light_rebuilds()
    }

    /// Number of previews of this volume that were followed by a full-quality picture.
    pub fn refinements(&self) -> u64 {
        self.viewport.refinements()
    }

    /// Name of the open volume, or `None` if there is none.
    pub fn volume_name(&self) -> Option<&str> {
        self.volume.as_ref().map(|volume| volume.name.as_str())
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
        self.export.agree_to(path);
        self.start_export(ctx);
    }

    /// Returns true while an export is being rendered or written.
    pub fn is_exporting(&self) -> bool {
        self.export.is_busy()
    }
}

impl eframe::App for App {
    fn logic(&mut self, ctx: &egui::Context, _frame: &mut eframe::Frame) {
        self.fail_on_purpose();
        // Checked before anything is drawn, because drawing on a lost device would panic.
        let is_lost = self.window_context.is_lost() || self.viewport.context().was_lost();
        if self.is_ending || is_lost {
            return self.end_for_another(ctx);
        }
        self.collect(ctx);
        // Runs even while the window is hidden and nothing is drawn.
        self.keep_look();
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        if self.is_ending {
            return;
        }
        let ctx = ui.ctx().clone();
        let start = std::time::Instant::now();
        ui.painter().add(paint_callback::fill(ctx.viewport_rect(), &self.window, ui.visuals().panel_fill));
        self.give_up.begin(&ctx, &self.settings);
        let mut commands = Vec::new();
        let dropped = files::dropped(&ctx);
        if !dropped.is_empty() {
            commands.push(Command::OpenDropped(dropped));
        }
        let facts = self.viewport.facts(&self.compare.looks(&self.settings));
        self.palette.ui(&ctx, self.settings.camera.up, self.volume.as_ref(), &mut commands);
        self.chooser.ui(&ctx, self.volume.as_ref(), self.loader.options(), &mut commands);
        self.around(ui, &facts, &mut commands);
        self.picture(ui, &facts, &mut commands);
        shortcuts::from_keys(&ctx, &mut commands);
        light_keys::nudge(&ctx, &mut self.settings, self.selected_light);
        self.windows(frame, &ctx, &mut commands);
        self.give_up.end(&mut self.settings);
        self.ask_for_volume(frame, &ctx);
        self.history.observe(&ctx, &self.step());
        commands.extend(self.take_framed());
        commands.extend(self.follow_outline(&ctx));
        let before = self.settings.camera.clone();
        for command in commands {
            self.execute(command, frame, &ctx);
        }
        self.turning.begin(&before, &self.settings.camera, ctx.input(|input| input.time));
        self.cancel_files_by_key(&ctx);
        self.leave_picture_only(&ctx);
        self.follow_corrections(&ctx);
        self.finish_first_look(&ctx);
        self.keep_balanced(&ctx);
        self.keep_look();
        let ui_ms = start.elapsed().as_secs_f64() * 1000.0;
        if ui_ms > LONG_FRAME_MS {
            log::debug!("the window's thread was busy for {ui_ms:.0} ms");
        }
        self.longest_ui_ms = self.longest_ui_ms.max(ui_ms);
        let idle = self.is_idle();
        if idle {
            self.loader.prepare();
        }
        let state = status_file::State {
            longest_ui_ms: self.longest_ui_ms,
            response: self.viewport.response(),
            loading: self.loader.progress().is_some() || self.file_tasks.path().is_some(),
            idle,
            canvas: self.canvas.filter(|_| self.volume.is_some()),
            handles: self.handles.positions(),
            light_rebuilds: self.light_rebuilds(),
            errors: self.messages.errors(),
            path_window: self.files.path_window(),
            places: if self.status_file.is_on() { reveal::reported(&ctx) } else { BTreeMap::new() },
            pixels_per_point: ctx.pixels_per_point(),
        };
        self.status_file.update(&state);
        if self.loader.progress().is_some() || self.export.is_busy() {
            // The progress bar moves; and an export started by an earlier window cannot wake this one.
            ctx.request_repaint_after(std::time::Duration::from_millis(100));
        }
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        self.layout.keep(storage);
    }

    fn on_exit(&mut self) {
        self.keep_look();
        if self.is_ending {
            self.leave();
        } else {
            self.export.abandon();
        }
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }
}
