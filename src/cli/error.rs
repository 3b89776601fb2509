//! Errors of the command line and their exit codes.

use std::path::PathBuf;

use crate::data::SurroundingsError;
use crate::data::load::{LoadError, LoadErrorKind};
use crate::export::{ExportError, ReadPictureError};
use crate::gpu::GpuError;
use crate::model::PresetError;

/// Why a command failed.
#[derive(Debug, thiserror::Error)]
pub enum CliError {
    /// The arguments do not make sense.
    #[error("{0}")]
    Usage(String),
    /// The volume could not be loaded.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// A preset or session could not be used.
    #[error(
        "{what}: {source} ({path}); `chiaroscuro render FILE -o OUT.png --report REPORT.json` shows the names of all settings"
    )]
    Preset {
        /// Preset or session.
        what: &'static str,
        /// The file.
        path: String,
        /// Why not.
        source: PresetError,
    },
    /// A file could not be read.
    #[error("{what}: {source} ({path}); a file that exists and can be read helps")]
    Read {
        /// What was to be read.
        what: &'static str,
        /// The file.
        path: String,
        /// Why not.
        source: std::io::Error,
    },
    /// A panorama cannot serve as surroundings.
    #[error(transparent)]
    Surroundings(#[from] SurroundingsError),
    /// The GPU could not do it.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// A picture could not be read.
    #[error(transparent)]
    Picture(#[from] ReadPictureError),
    /// A picture cannot be made again.
    #[error("{path}: {why}; a picture that was exported by this program, beside its volume, helps")]
    Replay {
        /// The picture.
        path: String,
        /// What is missing.
        why: String,
    },
    /// A picture names a volume that is not opened without a word of the user.
    #[error("{}: its volume {volume} is not opened: {why}; {help}", picture.display())]
    VolumeElsewhere {
        /// The picture.
        picture: PathBuf,
        /// What it names.
        volume: String,
        /// Why that is not opened.
        why: &'static str,
        /// What helps.
        help: &'static str,
    },
    /// No volume is left of one that is corrected.
    #[error("{path} could not be corrected ({by}): {why}; other values of `volume.…` help")]
    Uncorrectable {
        /// The volume.
        path: String,
        /// How it was to be corrected.
        by: String,
        /// Why that cannot be.
        why: String,
    },
    /// A picture that was made again is not as it was.
    #[error("{0}")]
    Differs(String),
    /// The result could not be written.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// What is told could not be written.
    #[error("could not write to standard output: {0}; room where it goes helps")]
    Output(std::io::Error),
    /// There are to be no threads.
    #[error("no thread could be started ({0}); fewer limits (`ulimit -u`, `ulimit -v`) help")]
    Threads(String),
    /// The window could not be opened.
    #[error("{0}; `chiaroscuro render FILE -o OUT.png` needs no window")]
    Window(String),
}

impl CliError {
    /// 1 a check that did not hold, 2 usage, 3 bad input, 4 no adapter, 5 out of memory or over a limit, 6 input or output.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Differs(_) => 1,
            Self::Usage(_) => 2,
            Self::Preset { .. }
            | Self::Replay { .. }
            | Self::VolumeElsewhere { .. }
            | Self::Uncorrectable { .. } => 3,
            // A region is said by nobody but the command line.
            Self::Load(err) if err.is_about("--region") => 2,
            Self::Load(err) => match err.kind() {
                LoadErrorKind::BadInput => 3,
                LoadErrorKind::Limit => 5,
                LoadErrorKind::Io | LoadErrorKind::Cancelled => 6,
            },
            Self::Gpu(
                GpuError::OutOfMemory { .. } | GpuError::FewAddresses { .. } | GpuError::OverLimit { .. },
            )
            | Self::Threads(_) => 5,
            Self::Surroundings(err) => match err {
                SurroundingsError::Io { .. } => 6,
                SurroundingsError::TooLarge { .. } => 5,
                SurroundingsError::Broken { .. }
                | SurroundingsError::Shape { .. }
                | SurroundingsError::Black { .. } => 3,
            },
            Self::Gpu(_) | Self::Window(_) => 4,
            Self::Read { .. } | Self::Export(_) | Self::Picture(_) | Self::Output(_) => 6,
        }
    }
}
