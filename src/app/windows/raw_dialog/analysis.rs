//! Background analysis of a raw file: its length, and proposals for its layout.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui;

use crate::app::text;
use crate::app::text::raw::RawLengthText;
use crate::app::worker::background_task::BackgroundTask;
use chiaroscuro_volume::CancelOnDrop;
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
    task: Option<BackgroundTask<io::Result<RawAnalysisResult>>>,
    result: Option<RawAnalysisResult>,
    failure: Option<String>,
    _stopper: CancelOnDrop,
}

impl RawAnalysis {
    pub(super) fn start(path: &Path, file_hints: RawNameHints, ctx: &egui::Context) -> Self {
        let bytes = SharedBytes { path: path.to_owned(), bytes: Arc::default() };
        let stopper = CancelOnDrop::default();
        let task = {
            let (bytes, cancel) = (bytes.clone(), stopper.token().clone());
            move || {
                bytes.with_bytes(|bytes| {
                    let length = RawLengthText { bytes: bytes.length(), is_exact: bytes.is_exact() };
                    Ok(RawAnalysisResult { length, proposals: propose_layouts(bytes, file_hints, &cancel)? })
                })
            }
        };
        let work = BackgroundTask::start("raw-proposals", ctx, task);
        let failure = work.as_ref().err().map(text::raw::not_read);
        Self { bytes, task: work.ok(), result: None, failure, _stopper: stopper }
    }

    /// Takes the result of the analysis; returns true if it is new.
    pub(super) fn collect(&mut self) -> bool {
        let Some(result) = self.task.as_ref().and_then(BackgroundTask::take_result) else { return false };
        self.task = None;
        match result {
            Ok(Ok(found)) => self.result = Some(found),
            Ok(Err(error)) => self.failure = Some(text::raw::not_read(&error)),
            Err(panic) => self.failure = Some(panic),
        }
        self.result.is_some()
    }

    pub(super) fn is_busy(&self) -> bool {
        self.task.is_some()
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

    pub(super) fn bytes(&self) -> &SharedBytes {
        &self.bytes
    }
}
