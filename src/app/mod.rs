//! Main window of the viewer, built on egui and wgpu (feature `window`).
//!
//! The document holds the look, the facts about its volume and the undo history. `LookEditor` joins it with its
//! picture and the messages, and `VolumeOpener` opens volumes into it; beside them are the window's own parts, each
//! with its methods. A frame is in `frame.rs`, the effect of commands in `shell/execute.rs`.
//!
//! Panels change one [`Settings`] value; the viewport turns it into a picture. All rendering runs on threads beside the
//! window's: the render worker, the loader, the light search, exports, contact sheets, slices of light volumes, and the
//! measurement of brightness. So does everything that visits all voxels (first looks for another kind of data, or for
//! an object that stands another way up) and everything that reads untrusted files, looks and sessions included. Panels
//! see settings and read-only facts.

mod common;
mod document;
mod frame;
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

use std::path::Path;
use std::time::Duration;

use eframe::egui;

use self::common::drag_cancel::DragCancel;
use self::layout::WindowLayout;
use self::layout::outer_panels::OuterPanels;
use self::shell::look_editor::LookEditor;
use self::shell::opening::{OpeningState, VolumeOpener};
use self::shell::picture_area::PictureTools;
use self::shell::start_screen::{StartScreen, WindowOccupation};
use self::shell::status_file::StatusFile;
use self::shell::time_series::TimeSeries;
use self::shell::tool_windows::{AppDialogs, ToolWindows};
use self::start::window_device::WindowDevice;
use self::worker::jobs::Jobs;
#[cfg(feature = "testing")]
use chiaroscuro_files::fault;
use chiaroscuro_scene::Settings;
#[cfg(feature = "testing")]
use chiaroscuro_volume::ValueRanges;

/// State of the main window, which implements [`eframe::App`].
pub struct App {
    /// Look that is edited, with its volume, its picture and the messages about it; boxed, as it would make the frame of
    /// the constructor too large.
    editor: Box<LookEditor>,
    /// Requests for the next volume, and files that are being read.
    opening: OpeningState,
    /// Handles, overlays and other tools over the picture; boxed, as they would make the frame of the constructor too
    /// large.
    picture: Box<PictureTools>,
    windows: Box<ToolWindows>,
    dialogs: AppDialogs,
    /// Panels around the picture.
    panels: OuterPanels,
    /// Panels and tool windows that are shown, as stored between runs.
    layout: WindowLayout,
    /// Cancelling of drags by Escape.
    drag_cancel: DragCancel,
    /// Running background tasks of this window, and of those that it has replaced.
    jobs: Jobs,
    /// Graphics device that draws the window.
    device: WindowDevice,
    status_file: StatusFile,
    /// Time steps of the open volume, and their playback.
    time_series: Box<TimeSeries>,
    /// Screen with the built-in scenes and recent files, while no volume is open; boxed, as it would make the frame of
    /// the constructor too large.
    start_screen: Box<StartScreen>,
}

/// Longest wait of a closing window for jobs that still use the graphics driver.
const JOB_SHUTDOWN_TIMEOUT: Duration = Duration::from_secs(10);

impl Drop for App {
    fn drop(&mut self) {
        // If another window replaces this one, that window waits for the jobs when it closes.
        if !self.device.is_lost {
            self.jobs.cancel_and_wait(JOB_SHUTDOWN_TIMEOUT);
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
    /// The start screen is idle as soon as it is open.
    pub fn is_idle(&self) -> bool {
        let is_shown = self.editor.is_complete() && !self.editor.is_changing();
        !self.opening.is_opening() && !self.time_series.is_busy() && (is_shown || self.start_screen.is_open())
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

    /// Reads a volume on a thread and shows it with the open one as the last layer.
    pub fn add_layer(&mut self, path: &Path, ctx: &egui::Context) {
        self.opener(ctx).add_layer(path);
    }

    /// Reads an environment map on a thread and lights the scene by it; supersedes one that is still being read.
    pub fn read_environment_map(&mut self, path: &Path, ctx: &egui::Context) {
        self.opener(ctx).read_environment_map(path);
    }

    /// Returns the opener of volumes and looks for this window.
    fn opener<'a>(&'a mut self, ctx: &'a egui::Context) -> VolumeOpener<'a> {
        VolumeOpener { state: &mut self.opening, editor: &mut self.editor, ctx }
    }

    /// Drops the pictures of the volume before, if another one has replaced it.
    fn drop_pictures_of_replaced(&mut self) {
        if self.opening.take_opened() {
            self.start_screen.close();
            self.panels.recent_pictures.clear();
            self.windows.contact_sheet.discard();
            self.panels.kept_strip.reset();
            self.time_series.reset(self.editor.document.volume.as_ref(), self.opening.loader.options());
        }
    }

    /// Returns what decides on whether the start screen is shown.
    fn occupation(&self) -> WindowOccupation {
        let is_kept = self.device.handed_over_dataset.is_some() || self.editor.viewport.dataset().is_some();
        WindowOccupation {
            has_volume: self.editor.document.volume.is_some() || is_kept,
            is_opening: self.opening.is_opening(),
            has_question: self.dialogs.recovery.is_open() || self.dialogs.device_loss.is_open(),
        }
    }

    /// Number of light volume refills since this volume was opened.
    pub fn light_rebuilds(&self) -> u64 {
        self.editor.viewport.light_fill_count()
    }

    /// Records a notice from before there was a window to show it.
    fn add_notice(&mut self, notice: String) {
        self.editor.memory.add_notice(notice);
    }
}

/// State of the window that only its tests inspect.
#[cfg(feature = "testing")]
impl App {
    /// Rectangle of the picture in points, and its size in physical pixels.
    pub fn viewport_rect(&self) -> Option<(egui::Rect, [u32; 2])> {
        self.picture.canvas.map(|canvas| (canvas.rect, canvas.size))
    }

    /// Positions of the handles of the enabled lights, in points.
    pub fn light_handle_positions(&self) -> &[egui::Pos2] {
        self.picture.handles.positions()
    }

    /// Number of previews of this volume that were followed by a full-quality picture.
    pub fn full_quality_pictures(&self) -> u64 {
        self.editor.viewport.refinement_count()
    }

    /// Ranges of the open volume's values, or `None` if there is none.
    pub fn ranges(&self) -> Option<ValueRanges> {
        self.editor.viewport.dataset().map(|dataset| dataset.volume().ranges())
    }

    /// Returns true while the start screen is open.
    pub fn shows_start(&self) -> bool {
        self.start_screen.is_open()
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

    /// Blocks the reading of files while the returned guard lives.
    pub fn block_file_tasks() -> impl Sized {
        /// Guard that lets the files be read when dropped.
        struct HeldFilesGuard;
        impl Drop for HeldFilesGuard {
            fn drop(&mut self) {
                fault::set_faults(Vec::new());
            }
        }
        fault::set_faults(vec![fault::InjectedFault::HeldFiles]);
        HeldFilesGuard
    }

    /// Returns the index of the time step that is shown, and the number of steps; `None` if the open volume is alone.
    pub fn time_step(&self) -> Option<(usize, usize)> {
        self.time_series.shown_of()
    }

    /// Returns the names of the volumes that are open, in the order of their layers.
    pub fn volume_names(&self) -> Vec<&str> {
        let Some(open) = &self.editor.document.volume else { return Vec::new() };
        let further = open.further.iter().map(|volume| volume.facts.name.as_str());
        std::iter::once(open.name.as_str()).chain(further).collect()
    }

    /// Path of the file that is being read.
    pub fn file_being_read(&self) -> Option<&Path> {
        self.opening.file_tasks.path()
    }
}
