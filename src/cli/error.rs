//! Errors of the command line, and their exit codes.

use std::path::PathBuf;

use chiaroscuro_files::WriteError;
use chiaroscuro_media::{EnvironmentMapError, ExportError, ReadPictureError};
use chiaroscuro_render::{BandError, GpuError};
use chiaroscuro_scene::PresetError;
use chiaroscuro_volume::{AddFieldError, LoadError, LoadErrorKind, StepError};

/// Reason for the failure of a command.
#[derive(Debug, thiserror::Error)]
pub enum CliError {
    /// The arguments are invalid or contradict each other.
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
        /// Kind of the file: preset or session.
        what: &'static str,
        /// Path of the file.
        path: String,
        /// Cause of the failure.
        source: PresetError,
    },
    /// A file could not be read.
    #[error("could not read the {what}: {source} ({path}); check that the file exists and can be read")]
    Read {
        /// Purpose of the file that was to be read.
        what: &'static str,
        /// Path of the file.
        path: String,
        /// Cause of the failure.
        source: std::io::Error,
    },
    /// A panorama cannot serve as an environment map.
    #[error(transparent)]
    Surroundings(#[from] EnvironmentMapError),
    /// The GPU reported an error.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// A part of a picture reads more pages of finer levels than fit into memory.
    #[error("{0}; --pool allows more memory")]
    PoolTooSmall(BandError),
    /// A picture file could not be read.
    #[error(transparent)]
    Picture(#[from] ReadPictureError),
    /// A picture cannot be reproduced from its record.
    #[error("{path}: {why}; expected a picture exported by this program, together with its volume")]
    Replay {
        /// Path of the picture.
        path: String,
        /// Missing information or file.
        why: String,
    },
    /// A picture refers to a volume that is only opened with the user's consent.
    #[error("{}: its volume {volume} is not opened: {why}; {help}", picture.display())]
    UntrustedVolumePath {
        /// Path of the picture.
        picture: PathBuf,
        /// Path of the volume in the picture's record.
        volume: String,
        /// Reason for not opening the volume.
        why: &'static str,
        /// Command-line option that resolves the problem.
        help: &'static str,
    },
    /// A volume cannot be shown with the first one.
    #[error("{} is not shown as a layer: {source}", path.display())]
    Layer {
        /// Path of the volume.
        path: PathBuf,
        /// Reason why it is not.
        source: AddFieldError,
    },
    /// A time step of a series could not be read or shown.
    #[error("time step {step}: {source}")]
    TimeStep {
        /// Number of the step in the series, from 0, and its name if it has one.
        step: String,
        /// Cause of the failure.
        source: Box<Self>,
    },
    /// A time step does not go together with the volumes that are shown.
    #[error(transparent)]
    Step(#[from] StepError),
    /// Corrections would leave no valid volume.
    #[error("{path} could not be corrected ({by}): {why}; choose other values of `volume.…`")]
    InvalidCorrection {
        /// Path of the volume.
        path: String,
        /// Corrections that were to be applied.
        by: String,
        /// Reason why they are impossible.
        why: String,
    },
    /// A reproduced picture differs from the original.
    #[error("{0}")]
    ReplayDiffers(String),
    /// A finer resolution level is called for than fits into memory.
    #[error("{0}")]
    LevelSubstituted(String),
    /// The result could not be written.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// A file could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// Standard output could not be written.
    #[error("could not write to standard output: {0}; check that its destination is open and has free space")]
    Output(std::io::Error),
    /// The system refused to start threads.
    #[error(
        "threads could not be started ({0}); raise the limits of processes and memory (`ulimit -u`, `ulimit -v`)"
    )]
    ThreadStart(String),
    /// The window could not be opened.
    #[error("{0}; `chiaroscuro render FILE -o OUT.png` needs no window")]
    Window(String),
}

impl From<BandError> for CliError {
    fn from(err: BandError) -> Self {
        match err {
            BandError::Gpu(err) => err.into(),
            BandError::Pages(err) => err.into(),
            BandError::PoolTooSmall { .. } => Self::PoolTooSmall(err),
        }
    }
}

impl CliError {
    /// Exit code of the process: 1 failed comparison, 2 usage, 3 bad input, 4 no adapter or window, 5 out of memory
    /// or over a limit, 6 input or output error.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::ReplayDiffers(_) | Self::LevelSubstituted(_) => 1,
            Self::Usage(_) => 2,
            Self::Preset { .. }
            | Self::Replay { .. }
            | Self::UntrustedVolumePath { .. }
            | Self::InvalidCorrection { .. }
            | Self::Step(_)
            | Self::Layer { .. } => 3,
            Self::TimeStep { source, .. } => source.exit_code(),
            // Regions are only ever given on the command line.
            Self::Load(err) if err.is_about("--region") => 2,
            Self::Load(err) => match err.kind() {
                LoadErrorKind::BadInput => 3,
                LoadErrorKind::Limit => 5,
                LoadErrorKind::Io | LoadErrorKind::Cancelled => 6,
            },
            Self::Gpu(
                GpuError::OutOfMemory { .. }
                | GpuError::AddressSpaceTooSmall { .. }
                | GpuError::OverLimit { .. },
            )
            | Self::PoolTooSmall(_)
            | Self::ThreadStart(_) => 5,
            Self::Surroundings(err) => match err {
                EnvironmentMapError::Io { .. } => 6,
                EnvironmentMapError::TooLarge { .. } => 5,
                EnvironmentMapError::Broken { .. }
                | EnvironmentMapError::Shape { .. }
                | EnvironmentMapError::Black { .. } => 3,
            },
            Self::Gpu(_) | Self::Window(_) => 4,
            Self::Read { .. } | Self::Export(_) | Self::Write(_) | Self::Picture(_) | Self::Output(_) => 6,
        }
    }
}
