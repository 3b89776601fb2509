//! Background analysis of a raw file: its length, and proposals for its layout.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui;

use crate::app::text;
use crate::app::text::raw::RawLengthText;
use crate::app::worker::jobs::{JobControl, JobKind, JobSlot};
use chiaroscuro_volume_io::raw::{LayoutProposal, RawBytes, RawNameHints, propose_layouts};

/// Bytes of the file, shared by tasks that read in turn; the first one opens it.
#[derive(Debug, Clone)]
pub(super) struct SharedBytes {
    path: PathBuf,
    bytes: Arc<Mutex<Option<RawBytes>>>,
}

impl SharedBytes {
    /// Runs a function on the bytes. Called by tasks only: it waits for other tasks and for the disk.
    pub(super) fn with_bytes<T>(&self, task: impl FnOnce(&mut RawBytes) -> io::Result<T>) -> io::Result<T> {
        // After a panic the bytes are still consistent: they are only read.
        let mut guard = self.bytes.lock().unwrap_or_else(PoisonError::into_inner);
        let bytes = match guard.take() {
            Some(bytes) => bytes,
            None => RawBytes::open(&self.path)?,
        };
        task(guard.insert(bytes))
    }
}

/// Result of the analysis: length and layout proposals.
#[derive(Debug)]
struct RawAnalysisResult {
    length: RawLengthText,
    proposals: Vec<LayoutProposal>,
}

/// Analysis of a file in progress, and its result.
#[derive(Debug)]
pub(super) struct RawAnalysis {
    bytes: SharedBytes,
    task: JobSlot<io::Result<RawAnalysisResult>>,
    result: Option<RawAnalysisResult>,
    failure: Option<String>,
}

impl RawAnalysis {
    pub(super) fn start(path: &Path, file_hints: RawNameHints, ctx: &egui::Context) -> Self {
        let bytes = SharedBytes { path: path.to_owned(), bytes: Arc::default() };
        let shared = bytes.clone();
        let analyse = move |job: &JobControl| {
            shared.with_bytes(|bytes| {
                let length = RawLengthText { bytes: bytes.length(), is_exact: bytes.is_exact() };
                Ok(RawAnalysisResult { length, proposals: propose_layouts(bytes, file_hints, job.token())? })
            })
        };
        let mut task = JobSlot::default();
        let started = task.start(JobKind::RawProposals, ctx, (), analyse);
        let failure = started.err().map(|err| text::raw::not_read(&err));
        Self { bytes, task, result: None, failure }
    }

    /// Takes the result of the analysis; returns true if it is new.
    pub(super) fn collect(&mut self) -> bool {
        let Some(result) = self.task.take_result() else { return false };
        match result {
            Ok(Ok(found)) => self.result = Some(found),
            Ok(Err(error)) => self.failure = Some(text::raw::not_read(&error)),
            Err(panic) => self.failure = Some(panic),
        }
        self.result.is_some()
    }

    pub(super) fn is_busy(&self) -> bool {
        self.task.is_running()
    }

    pub(super) fn failure(&self) -> Option<&str> {
        self.failure.as_deref()
    }

    pub(super) fn proposals(&self) -> &[LayoutProposal] {
        // Users do not read more than these.
        self.result.as_ref().map_or(&[], |found| &found.proposals[..found.proposals.len().min(5)])
    }

    pub(super) fn length(&self) -> Option<RawLengthText> {
        self.result.as_ref().map(|found| found.length)
    }

    /// Returns the bytes of the file, which the preview of slices shares.
    pub(super) fn bytes(&self) -> &SharedBytes {
        &self.bytes
    }
}
