//! Kinds of jobs, and the names of their threads.

/// Kind of a job, by what it makes or does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum JobKind {
    Balance,
    ContactSheet,
    Corrections,
    Export,
    FileDialog,
    Framing,
    Histogram,
    KindLook,
    LightSearch,
    LightSlice,
    Load,
    NextFile,
    Outline,
    PartSilhouette,
    RawProposals,
    RawSlices,
    ReadFile,
    SavedThumbnails,
    SceneCard,
    SeriesRange,
    TimeStep,
    VolumeThumbnail,
    WarmUp,
}

impl JobKind {
    /// Name of the job's thread, for debuggers and in messages of panics.
    pub(super) fn thread_name(self) -> &'static str {
        match self {
            Self::Balance => "balance",
            Self::ContactSheet => "contact-sheet",
            Self::Corrections => "corrections",
            Self::Export => "export",
            Self::FileDialog => "file-dialog",
            Self::Framing => "framing",
            Self::Histogram => "histogram",
            Self::KindLook => "first-look",
            Self::LightSearch => "light-search",
            Self::LightSlice => "light-slice",
            Self::Load => "loader",
            Self::NextFile => "next-file",
            Self::Outline => "outline",
            Self::PartSilhouette => "part",
            Self::RawProposals => "raw-proposals",
            Self::RawSlices => "raw-slices",
            Self::ReadFile => "file",
            Self::SavedThumbnails => "kept",
            Self::SceneCard => "scene-card",
            Self::SeriesRange => "series-range",
            Self::TimeStep => "time-step",
            Self::VolumeThumbnail => "preview",
            Self::WarmUp => "warm-up",
        }
    }
}
