//! Background reading of files other than volumes: looks, sessions, transfer functions and environment maps.
//!
//! The window stays responsive meanwhile. The content is used on the window's thread when the task has ended, or when
//! the user has cancelled it; a cancelled task runs to its end, and its result is dropped.

mod environment_map;
mod transfer;

use std::io;
use std::path::{Path, PathBuf};

use eframe::egui;

use crate::app::common::overlay_windows;
use crate::app::worker::background_task::BackgroundTask;
use crate::app::{App, text};

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

/// Continuation on the window's thread after a task has ended.
type TaskContinuation = Box<dyn FnOnce(&mut App, &egui::Context)>;

/// Continuation that uses the content of a file.
type ContentHandler<T> = Box<dyn FnOnce(&mut App, Result<T, FileReadFailure>, &egui::Context)>;

/// File that is being read on a thread, with its continuation.
struct FileTask<T> {
    work: BackgroundTask<Result<T, String>>,
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
        Ok(Box::new(move |app, ctx| then(app, content, ctx)))
    }

    fn cancel(self: Box<Self>) -> TaskContinuation {
        Box::new(move |app, ctx| (self.handler)(app, Err(FileReadFailure::Cancelled), ctx))
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

    /// Returns true while a file is read for this purpose.
    pub(crate) fn is_reading(&self, reason: ReadPurpose) -> bool {
        self.running.iter().any(|running| running.reason == reason)
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
        let task = move || {
            #[cfg(feature = "testing")]
            drop(test_lock::wait());
            read(&file)
        };
        match BackgroundTask::start("file", ctx, task) {
            Ok(work) => {
                let task = Box::new(FileTask { work, handler: then });
                self.running.push(RunningFileTask { reason, path: path.to_owned(), task });
                Ok(())
            }
            Err(err) => Err((err, then)),
        }
    }

    /// Removes the tasks that have ended, and returns their continuations.
    fn take_finished(&mut self) -> Vec<(ReadPurpose, TaskContinuation)> {
        let mut ended = Vec::new();
        for RunningFileTask { reason, path, task } in std::mem::take(&mut self.running) {
            match task.end() {
                Ok(finish) => ended.push((reason, finish)),
                Err(task) => self.running.push(RunningFileTask { reason, path, task }),
            }
        }
        ended
    }
}

impl App {
    /// Reads a file on a thread; `then` gets the content, or the reason why it is missing.
    pub(crate) fn read_file<T: Send + 'static>(
        &mut self,
        reason: ReadPurpose,
        path: &Path,
        ctx: &egui::Context,
        read: impl FnOnce(&Path) -> Result<T, String> + Send + 'static,
        then: impl FnOnce(&mut Self, Result<T, FileReadFailure>, &egui::Context) + 'static,
    ) {
        if let Err((err, then)) = self.opening.file_tasks.start(reason, path, ctx, read, Box::new(then)) {
            then(self, Err(FileReadFailure::Failed(text::files::no_thread(err))), ctx);
        }
    }

    /// Reports that a file was not read.
    pub(crate) fn report_read_failure(&mut self, short: &str, why: FileReadFailure) {
        match why {
            FileReadFailure::Cancelled => self.editor.messages.note(text::files::READING_CANCELLED),
            FileReadFailure::Failed(details) => self.editor.messages.error(short, details),
        }
    }

    /// Runs the continuations of the tasks that have ended.
    pub(crate) fn finish_file_tasks(&mut self, ctx: &egui::Context) {
        for (reason, finish) in self.opening.file_tasks.take_finished() {
            finish(self, ctx);
            self.open_default_if_empty(reason, ctx);
        }
    }

    /// Cancels opening a volume and reading other files.
    pub(crate) fn cancel_files(&mut self, ctx: &egui::Context) {
        self.loader.cancel();
        for RunningFileTask { reason, path: _, task } in std::mem::take(&mut self.opening.file_tasks.running)
        {
            task.cancel()(self, ctx);
            self.open_default_if_empty(reason, ctx);
        }
    }

    /// Cancels opening and reading when Escape was pressed and no window or widget takes the key.
    pub(crate) fn cancel_files_by_key(&mut self, ctx: &egui::Context) {
        let is_reading = self.opening.file_tasks.path().is_some() || self.loader.progress().is_some();
        if is_reading && overlay_windows::escape_for_picture(ctx) {
            self.cancel_files(ctx);
        }
    }
}

/// Lock that blocks the reading of files, for tests that inspect the window meanwhile.
#[cfg(feature = "testing")]
mod test_lock {
    use std::sync::{Mutex, MutexGuard, PoisonError};

    static HELD: Mutex<()> = Mutex::new(());

    /// Waits until no test holds the lock.
    pub(super) fn wait() -> MutexGuard<'static, ()> {
        HELD.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(feature = "testing")]
impl App {
    /// Blocks the reading of files while the returned guard lives.
    pub fn block_file_tasks() -> impl Sized {
        test_lock::wait()
    }

    /// Path of the file that is being read.
    pub fn file_being_read(&self) -> Option<&Path> {
        self.opening.file_tasks.path()
    }
}
