//! Background analysis of a raw file: its length, and proposals for its layout.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui;

use crate::app::text;
use crate::app::text::raw::Length;
use crate::app::worker::task::Work;
use crate::data::load::raw::{Proposal, RawBytes, Said, proposals};

/// Bytes of the file, shared by tasks that read in turn; the first one opens it.
#[derive(Debug, Clone)]
pub(super) struct SharedBytes {
    path: PathBuf,
    bytes: Arc<Mutex<Option<RawBytes>>>,
}

impl SharedBytes {
    /// Runs a function on the bytes. Called by tasks only: it waits for other tasks and for the disk.
    pub(super) fn read<T>(&self, task: impl FnOnce(&mut RawBytes) -> io::Result<T>) -> io::Result<T> {
        // After a panic the bytes are still consistent: they are only read.
        let mut held = self.bytes.lock().unwrap_or_else(PoisonError::into_inner);
        let bytes = match held.take() {
            Some(bytes) => bytes,
            None => RawBytes::open(&self.path)?,
        };
        task(held.insert(bytes))
    }
}

/// Cancel flag that is set when this is dropped.
#[derive(Debug, Default)]
pub(super) struct Stopper(pub(super) Arc<AtomicBool>);

impl Drop for Stopper {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Result of the analysis: length and layout proposals.
#[derive(Debug)]
struct Found {
    length: Length,
    proposals: Vec<Proposal>,
}

/// Analysis of a file in progress, and its result.
#[derive(Debug)]
pub(super) struct Looking {
    bytes: SharedBytes,
    work: Option<Work<io::Result<Found>>>,
    found: Option<Found>,
    failure: Option<String>,
    _stopper: Stopper,
}

impl Looking {
    pub(super) fn start(path: &Path, said: Said, ctx: &egui::Context) -> Self {
        let bytes = SharedBytes { path: path.to_owned(), bytes: Arc::default() };
        let stopper = Stopper::default();
        let task = {
            let (bytes, stop) = (bytes.clone(), Arc::clone(&stopper.0));
            move || {
                bytes.read(|bytes| {
                    let length = Length { bytes: bytes.length(), is_exact: bytes.is_exact() };
                    Ok(Found { length, proposals: proposals(bytes, said, &stop)? })
                })
            }
        };
        let work = Work::start("raw-proposals", ctx, task);
        let failure = work.as_ref().err().map(text::raw::not_read);
        Self { bytes, work: work.ok(), found: None, failure, _stopper: stopper }
    }

    /// Takes the result of the analysis; returns true if it is new.
    pub(super) fn take(&mut self) -> bool {
        let Some(result) = self.work.as_ref().and_then(Work::take) else { return false };
        self.work = None;
        match result {
            Ok(Ok(found)) => self.found = Some(found),
            Ok(Err(error)) => self.failure = Some(text::raw::not_read(&error)),
            Err(panic) => self.failure = Some(panic),
        }
        self.found.is_some()
    }

    pub(super) fn is_busy(&self) -> bool {
        self.work.is_some()
    }

    pub(super) fn failure(&self) -> Option<&str> {
        self.failure.as_deref()
    }

    pub(super) fn proposals(&self) -> &[Proposal] {
        // Users do not read more than these.
        self.found.as_ref().map_or(&[], |found| &found.proposals[..found.proposals.len().min(5)])
    }

    pub(super) fn length(&self) -> Option<Length> {
        self.found.as_ref().map(|found| found.length)
    }

    pub(super) fn bytes(&self) -> &SharedBytes {
        &self.bytes
    }
}
