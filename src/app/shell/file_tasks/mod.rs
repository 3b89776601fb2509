//! Background reading of files other than volumes: looks, sessions, transfer functions and environment maps.
//!
//! The window stays responsive meanwhile. The content is used on the window's thread when the task has ended, or when
//! the user has cancelled it; a cancelled task runs to its end, and its result is dropped.

mod surroundings;
mod transfer;

use std::io;
use std::path::{Path, PathBuf};

use eframe::egui;

use crate::app::common::frame;
use crate::app::worker::task::Work;
use crate::app::{App, text};

/// Purpose for which a file is read; at most one file per purpose at a time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::app) enum Reason {
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
pub(in crate::app) enum NotRead {
    /// Cancellation of the task by the user.
    Cancelled,
    /// Failure of the task, with details for a message.
    Failed(String),
}

/// Continuation on the window's thread after a task has ended.
type Finish = Box<dyn FnOnce(&mut App, &egui::Context)>;

/// Continuation that uses the content of a file.
type Then<T> = Box<dyn FnOnce(&mut App, Result<T, NotRead>, &egui::Context)>;

/// File that is being read on a thread, with its continuation.
struct FileTask<T> {
    work: Work<Result<T, String>>,
    then: Then<T>,
}

/// File task with the type of its content erased.
trait Task {
    /// Returns the continuation if the task has ended, and the task itself otherwise.
    fn end(self: Box<Self>) -> Result<Finish, Box<dyn Task>>;

    /// Cancels the task and returns its continuation.
    fn cancel(self: Box<Self>) -> Finish;
}

impl<T: Send + 'static> Task for FileTask<T> {
    fn end(self: Box<Self>) -> Result<Finish, Box<dyn Task>> {
        let Some(result) = self.work.take() else { return Err(self) };
        let (content, then) = (result.and_then(|read| read).map_err(NotRead::Failed), self.then);
        Ok(Box::new(move |app, ctx| then(app, content, ctx)))
    }

    fn cancel(self: Box<Self>) -> Finish {
        Box::new(move |app, ctx| (self.then)(app, Err(NotRead::Cancelled), ctx))
    }
}

/// Running task with its file and purpose.
struct Running {
    reason: Reason,
    path: PathBuf,
    task: Box<dyn Task>,
}

/// Set of the files that are being read.
#[derive(Default)]
pub(in crate::app) struct FileTasks {
    running: Vec<Running>,
}

impl FileTasks {
    /// Path of the file that was requested last, among those being read.
    pub(in crate::app) fn path(&self) -> Option<&Path> {
        self.running.last().map(|running| running.path.as_path())
    }

    /// Returns true while a file is read for this purpose.
    pub(in crate::app) fn is_reading(&self, reason: Reason) -> bool {
        self.running.iter().any(|running| running.reason == reason)
    }

    /// Drops the task of a purpose, because something else has superseded it.
    pub(in crate::app) fn forget(&mut self, reason: Reason) {
        self.running.retain(|running| running.reason != reason);
    }

    fn start<T: Send + 'static>(
        &mut self,
        reason: Reason,
        path: &Path,
        ctx: &egui::Context,
        read: impl FnOnce(&Path) -> Result<T, String> + Send + 'static,
        then: Then<T>,
    ) -> Result<(), (io::Error, Then<T>)> {
        self.forget(reason);
        let file = path.to_owned();
        let task = move || {
            #[cfg(feature = "testing")]
            drop(hold::wait());
            read(&file)
        };
        match Work::start("file", ctx, task) {
            Ok(work) => {
                let task = Box::new(FileTask { work, then });
                self.running.push(Running { reason, path: path.to_owned(), task });
                Ok(())
            }
            Err(err) => Err((err, then)),
        }
    }

    /// Removes the tasks that have ended, and returns their continuations.
    fn take(&mut self) -> Vec<(Reason, Finish)> {
        let mut ended = Vec::new();
        for Running { reason, path, task } in std::mem::take(&mut self.running) {
            match task.end() {
                Ok(finish) => ended.push((reason, finish)),
                Err(task) => self.running.push(Running { reason, path, task }),
            }
        }
        ended
    }
}

impl App {
    /// Reads a file on a thread; `then` gets the content, or the reason why it is missing.
    pub(in crate::app) fn read_file<T: Send + 'static>(
        &mut self,
        reason: Reason,
        path: &Path,
        ctx: &egui::Context,
        read: impl FnOnce(&Path) -> Result<T, String> + Send + 'static,
        then: impl FnOnce(&mut Self, Result<T, NotRead>, &egui::Context) + 'static,
    ) {
        if let Err((err, then)) = self.file_tasks.start(reason, path, ctx, read, Box::new(then)) {
            then(self, Err(NotRead::Failed(text::files::no_thread(err))), ctx);
        }
    }

    /// Reports that a file was not read.
    pub(in crate::app) fn say_not_read(&mut self, short: &str, why: NotRead) {
        match why {
            NotRead::Cancelled => self.messages.note(text::files::READING_CANCELLED),
            NotRead::Failed(details) => self.messages.error(short, details),
        }
    }

    /// Runs the continuations of the tasks that have ended.
    pub(in crate::app) fn take_files(&mut self, ctx: &egui::Context) {
        for (reason, finish) in self.file_tasks.take() {
            finish(self, ctx);
            self.open_something(reason, ctx);
        }
    }

    /// Cancels opening a volume and reading other files.
    pub(in crate::app) fn cancel_files(&mut self, ctx: &egui::Context) {
        self.loader.cancel();
        for Running { reason, path: _, task } in std::mem::take(&mut self.file_tasks.running) {
            task.cancel()(self, ctx);
            self.open_something(reason, ctx);
        }
    }

    /// Cancels opening and reading when Escape was pressed and no window or widget takes the key.
    pub(in crate::app) fn cancel_files_by_key(&mut self, ctx: &egui::Context) {
        let is_reading = self.file_tasks.path().is_some() || self.loader.progress().is_some();
        if is_reading && frame::is_for_picture(ctx) {
            self.cancel_files(ctx);
        }
    }
}

/// Lock that blocks the reading of files, for tests that inspect the window meanwhile.
#[cfg(feature = "testing")]
mod hold {
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
    pub fn hold_files() -> impl Sized {
        hold::wait()
    }

    /// Path of the file that is being read.
    pub fn file_being_read(&self) -> Option<&Path> {
        self.file_tasks.path()
    }
}
