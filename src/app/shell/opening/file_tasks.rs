//! Background reading of files other than volumes: looks, sessions, transfer functions and environment maps.
//!
//! The window stays responsive meanwhile. The content is used on the window's thread when the task has ended, or when
//! the user has cancelled it; a cancelled task runs to its end, and its result is dropped.

use std::io;
use std::path::{Path, PathBuf};

use eframe::egui;

use super::VolumeOpener;
use crate::app::common::overlay_windows;
use crate::app::shell::messages::MessageLog;
use crate::app::text;
use crate::app::worker::jobs::{JobControl, JobHandle, JobKind};
use chiaroscuro_files::fault;

/// Purpose for which a file is read; at most one file per purpose at a time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ReadPurpose {
    /// Opens the file, which is a look or a volume.
    Open,
    /// Applies the session to a volume that has been loaded.
    Session,
    /// Applies the look to the open volume.
    Look,
    /// Compares the look with that of the window.
    Comparison,
    /// Adds the volume of the file as a layer.
    Layer,
    /// Imports the transfer function of the file.
    Transfer,
    /// Lights the scene by the environment map.
    Surroundings,
}

/// Reason why the content of a file is missing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum FileReadFailure {
    /// Cancellation of the task by the user.
    Cancelled,
    /// Failure of the task, with details for a message.
    Failed(String),
}

impl FileReadFailure {
    /// Reports that a file was not read.
    pub(super) fn report(self, short: &str, messages: &mut MessageLog) {
        match self {
            Self::Cancelled => messages.note(text::files::READING_CANCELLED),
            Self::Failed(details) => messages.error(short, details),
        }
    }
}

/// Continuation on the window's thread after a task has ended.
type TaskContinuation = Box<dyn FnOnce(&mut VolumeOpener<'_>)>;

/// Continuation that uses the content of a file.
type ContentHandler<T> = Box<dyn FnOnce(&mut VolumeOpener<'_>, Result<T, FileReadFailure>)>;

/// File that is being read on a thread, with its continuation.
struct FileTask<T> {
    work: JobHandle<Result<T, String>>,
    handler: ContentHandler<T>,
}

/// File task with the type of its content erased.
trait ErasedFileTask {
    /// Returns the continuation if the task has ended, and the task itself otherwise.
    fn end(self: Box<Self>) -> Result<TaskContinuation, Box<dyn ErasedFileTask>>;

    /// Cancels the task and returns its continuation.
    fn cancel(self: Box<Self>) -> TaskContinuation;
}

impl<T: Send + 'static> ErasedFileTask for FileTask<T> {
    fn end(self: Box<Self>) -> Result<TaskContinuation, Box<dyn ErasedFileTask>> {
        let Some(result) = self.work.take_result() else { return Err(self) };
        let (content, then) = (result.and_then(|read| read).map_err(FileReadFailure::Failed), self.handler);
        Ok(Box::new(move |opener| then(opener, content)))
    }

    fn cancel(self: Box<Self>) -> TaskContinuation {
        Box::new(move |opener| (self.handler)(opener, Err(FileReadFailure::Cancelled)))
    }
}

/// Running task with its file and purpose.
struct RunningFileTask {
    reason: ReadPurpose,
    path: PathBuf,
    task: Box<dyn ErasedFileTask>,
}

/// Set of the files that are being read.
#[derive(Default)]
pub(crate) struct FileTasks {
    running: Vec<RunningFileTask>,
}

impl FileTasks {
    /// Path of the file that was requested last, among those being read.
    pub(crate) fn path(&self) -> Option<&Path> {
        self.running.last().map(|running| running.path.as_path())
    }

    /// Drops the task of a purpose, because something else has superseded it.
    pub(crate) fn drop_purpose(&mut self, reason: ReadPurpose) {
        self.running.retain(|running| running.reason != reason);
    }

    fn start<T: Send + 'static>(
        &mut self,
        reason: ReadPurpose,
        path: &Path,
        ctx: &egui::Context,
        read: impl FnOnce(&Path) -> Result<T, String> + Send + 'static,
        then: ContentHandler<T>,
    ) -> Result<(), (io::Error, ContentHandler<T>)> {
        self.drop_purpose(reason);
        let file = path.to_owned();
        let task = move |_: &JobControl| {
            fault::wait_while_files_are_held();
            read(&file)
        };
        match JobHandle::start(JobKind::ReadFile, ctx, task) {
            Ok(work) => {
                let task = Box::new(FileTask { work, handler: then });
                self.running.push(RunningFileTask { reason, path: path.to_owned(), task });
                Ok(())
            }
            Err(err) => Err((err, then)),
        }
    }

    /// Removes the tasks that have ended, and returns their continuations.
    fn take_finished(&mut self) -> Vec<TaskContinuation> {
        let mut ended = Vec::new();
        for RunningFileTask { reason, path, task } in std::mem::take(&mut self.running) {
            match task.end() {
                Ok(finish) => ended.push(finish),
                Err(task) => self.running.push(RunningFileTask { reason, path, task }),
            }
        }
        ended
    }
}

impl VolumeOpener<'_> {
    /// Reads a file on a thread; `then` gets the content, or the reason why it is missing.
    pub(crate) fn read_file<T: Send + 'static>(
        &mut self,
        reason: ReadPurpose,
        path: &Path,
        read: impl FnOnce(&Path) -> Result<T, String> + Send + 'static,
        then: impl FnOnce(&mut VolumeOpener<'_>, Result<T, FileReadFailure>) + 'static,
    ) {
        if let Err((err, then)) = self.state.file_tasks.start(reason, path, self.ctx, read, Box::new(then)) {
            then(self, Err(FileReadFailure::Failed(text::files::no_thread(err))));
        }
    }

    /// Runs the continuations of the tasks that have ended.
    pub(crate) fn finish_file_tasks(&mut self) {
        for finish in self.state.file_tasks.take_finished() {
            finish(self);
        }
    }

    /// Cancels opening a volume and reading other files.
    pub(crate) fn cancel_files(&mut self) {
        self.state.loader.cancel();
        for RunningFileTask { reason: _, path: _, task } in std::mem::take(&mut self.state.file_tasks.running)
        {
            task.cancel()(self);
        }
    }

    /// Cancels opening and reading when Escape was pressed and no window or widget takes the key.
    pub(crate) fn cancel_files_by_key(&mut self) {
        if self.state.is_opening() && overlay_windows::escape_for_picture(self.ctx) {
            self.cancel_files();
        }
    }
}
