//! Options with which a window is opened.

use std::path::PathBuf;

use crate::app::shell::opening::SettingsAdjustment;
use chiaroscuro_render::ShaderLibrary;
use chiaroscuro_volume_io::LoadOptions;

/// Options of the window, from the command line.
#[derive(Default)]
pub struct WindowOptions {
    /// Source to open: a volume file, `builtin:NAME[:N]`, a session or an exported picture. The start screen is
    /// shown if `None`.
    pub source: Option<PathBuf>,
    /// Options for reading volume files.
    pub load: LoadOptions,
    /// Session file of Ctrl+S; applied to the first look if the file exists.
    pub session: Option<PathBuf>,
    /// True if the session is written when the window is closed.
    pub saves_on_close: bool,
    /// Volume for the look in `source` or `session`, in place of the one that it names.
    pub volume: Option<PathBuf>,
    /// True if `source` is deleted when the window is closed, so that it is not listed among the recent files.
    pub is_temporary: bool,
    /// True if looks may open volumes anywhere without a confirmation.
    pub trust_paths: bool,
    /// Change of the first volume's settings, after the session.
    pub adjust: Option<SettingsAdjustment>,
    /// Longest time from the first picture to the movement of its lights, in seconds; `None` for two seconds.
    pub light_search_limit_s: Option<f64>,
    /// Pipelines that another window may have compiled, with the device for the pictures. None are compiled before they
    /// are needed then. `None` for a device and pipelines of its own.
    pub pipelines: Option<ShaderLibrary>,
    /// Storage folder for the state that outlives a run; see [`super::main_loop::storage_folder`].
    pub storage: Option<PathBuf>,
}

impl std::fmt::Debug for WindowOptions {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Options")
            .field("source", &self.source)
            .field("session", &self.session)
            .finish_non_exhaustive()
    }
}
