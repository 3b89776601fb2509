//! What a window is opened with, and how.

use std::path::PathBuf;
use std::sync::Arc;

use eframe::egui;

use super::icon;
use crate::app::{App, text};
use crate::data::load::LoadOptions;
use crate::gpu::{GpuError, device_descriptor};
use crate::model::Settings;

/// Changes settings once.
pub type Adjustment = Box<dyn FnOnce(Settings) -> Settings + Send>;

/// What the command line says about the window.
#[derive(Default)]
pub struct Options {
    /// A volume: a file or `builtin:NAME[:N]`; or a session or an exported picture. The built-in scene when not given.
    pub source: Option<PathBuf>,
    /// How files are read.
    pub load: LoadOptions,
    /// Where settings are saved; laid over the first look if the file exists.
    pub session: Option<PathBuf>,
    /// The volume of the look that `source` or `session` is, instead of the one that it names.
    pub volume: Option<PathBuf>,
    /// Whether the volumes of looks are opened wherever they are, without a question.
    pub trust_paths: bool,
    /// Applied to the first volume's settings, after the session.
    pub adjust: Option<Adjustment>,
    /// Where things are kept from one run to the next; see [`storage_folder`].
    pub storage: Option<PathBuf>,
}

impl std::fmt::Debug for Options {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Options")
            .field("source", &self.source)
            .field("session", &self.session)
            .finish_non_exhaustive()
    }
}

/// Why there is no window.
#[derive(Debug, thiserror::Error)]
pub enum AppError {
    /// No device that can be used.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The window system refused.
    #[error("the window could not be opened: {0}; a running desktop session is needed")]
    Window(#[from] eframe::Error),
    /// The operating system gave no thread.
    #[error("no thread could be started: {0}")]
    Thread(#[from] std::io::Error),
}

/// Names our window to the desktop, and the folder in which we keep things.
const APP_ID: &str = "chiaroscuro";

/// The folder in which this user's system keeps what programs remember.
pub fn storage_folder() -> Option<PathBuf> {
    eframe::storage_dir(APP_ID)
}

/// How the window's device is opened: with the limits and features that the renderer can use.
pub fn wgpu_setup() -> eframe::egui_wgpu::WgpuSetupCreateNew {
    let mut setup = eframe::egui_wgpu::WgpuSetupCreateNew::without_display_handle();
    setup.device_descriptor = Arc::new(device_descriptor);
    setup
}

/// Opens the window and returns when it is closed.
///
/// # Errors
/// When there is no display or no usable graphics adapter.
pub fn run(options: Options) -> Result<(), AppError> {
    let viewport = egui::ViewportBuilder::default()
        .with_title(text::opening::PROGRAM)
        .with_app_id(APP_ID)
        .with_inner_size([1280.0, 800.0])
        .with_min_inner_size([560.0, 420.0])
        .with_icon(icon::icon());
    let wgpu_options =
        eframe::egui_wgpu::WgpuConfiguration { wgpu_setup: wgpu_setup().into(), ..Default::default() };
    // Without dithering the picture reaches the screen byte for byte.
    let native = eframe::NativeOptions { viewport, wgpu_options, dithering: false, ..Default::default() };
    eframe::run_native(text::opening::PROGRAM, native, Box::new(|cc| Ok(Box::new(App::new(cc, options)?))))?;
    Ok(())
}
