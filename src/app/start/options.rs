//! What a window is opened with.

use std::path::PathBuf;

use crate::data::load::LoadOptions;
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
    /// Where things are kept from one run to the next; see [`super::run::storage_folder`].
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
