//! Files of others that are read on a thread: looks, sessions, transfer functions, pictures of surroundings.
//!
//! The window goes on meanwhile. What is done with the content happens on the window's thread once it is there, or once the
//! user has cancelled the task; a task that is cancelled runs to its end, and its result is dropped.

mod surroundings;
mod transfer;

use std::io;
use std::path::{Path, PathBuf};

use eframe::egui;

use crate::app::common::frame;
use crate::app::worker::task::Work;
use crate::app::{App, text};

/// Purposes for which a file is read; for each one file at a time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::app) enum Reason {
    /// To open it: a look, or a volume.
    Open,
    /// To lay the session over a volume that is loaded.
    Session,
    /// To lay its look over the open volume.
    Look,
    /// To compare its look with that of the window.
    Comparison,
    /// To import its transfer function.
    Transfer,
    /// To light the scene by it.
    Surroundings,
}

/// The reason why a file has no content.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::app) enum NotRead {
    /// The user has cancelled the task.
    Cancelled,
    /// It failed, with details for a message.
    Failed(String),
}

/// Work for the window's thread when a task has ended.
type Finish = Box<dyn FnOnce(&mut App, &egui::Context)>;

/// Use that is made of a file's content.
type Then<T> = Box<dyn FnOnce(&mut App, Result<T, NotRead>, &egui::Context)>;

/// File that is being read on a thread.
struct FileTask<T> {
    work: Work<Result<T, String>>,
    then: Then<T>,
}

/// Task whose content may be of any type.
trait Task {
    /// Whether it has ended; then with the work that is left.
    fn end(self: Box<Self>) -> Result<Finish, Box<dyn Task>>;

    /// Gives it up.
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

/// Task with the file that it reads.
struct Running {
    reason: Reason,
    path: PathBuf,
    task: Box<dyn Task>,
}

/// Files that are being read.
#[derive(Default)]
pub(in crate::app) struct FileTasks {
    running: Vec<Running>,
}

impl FileTasks {
    /// The file that was asked for last, of those that are being read.
    pub(in crate::app) fn path(&self) -> Option<&Path> {
        self.running.last().map(|running| running.path.as_path())
    }

    /// Whether a file is read for a reason.
    pub(in crate::app) fn is_reading(&self, reason: Reason) -> bool {
        self.running.iter().any(|running| running.reason == reason)
    }

    /// Forgets what is read for a reason: something else has taken its place.
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

    /// What is left to do of tasks that have ended.
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
    /// Reads a file on a thread, and does something with its content when it is there or was given up.
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

    /// Says that nothing came of a file.
    pub(in crate::app) fn say_not_read(&mut self, short: &str, why: NotRead) {
        match why {
            NotRead::Cancelled => self.messages.note(text::files::READING_CANCELLED),
            NotRead::Failed(details) => self.messages.error(short, details),
        }
    }

    /// Takes in what was read.
    pub(in crate::app) fn take_files(&mut self, ctx: &egui::Context) {
        for (reason, finish) in self.file_tasks.take() {
            finish(self, ctx);
            self.open_something(reason, ctx);
        }
    }

    /// Cancels what is being read and opened.
    pub(in crate::app) fn cancel_files(&mut self, ctx: &egui::Context) {
        self.loader.cancel();
        for Running { reason, path: _, task } in std::mem::take(&mut self.file_tasks.running) {
            task.cancel()(self, ctx);
            self.open_something(reason, ctx);
        }
    }

    /// Cancels them when Escape was pressed, and nothing over the picture has taken that.
    pub(in crate::app) fn cancel_files_by_key(&mut self, ctx: &egui::Context) {
        let is_reading = self.file_tasks.path().is_some() || self.loader.progress().is_some();
        if is_reading && frame::is_for_picture(ctx) {
            self.cancel_files(ctx);
        }
    }
}

/// A way to keep files from being read, for tests that look at the window meanwhile.
#[cfg(feature = "testing")]
mod hold {
    use std::sync::{Mutex, MutexGuard, PoisonError};

    static HELD: Mutex<()> = Mutex::new(());

    /// Waits until nobody holds files back.
    pub(super) fn wait() -> MutexGuard<'static, ()> {
        HELD.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(feature = "testing")]
impl App {
    /// Keeps files from being read while the result is there.
    pub fn hold_files() -> impl Sized {
        hold::wait()
    }

    /// The file that is being read.
    pub fn file_being_read(&self) -> Option<&Path> {
        self.file_tasks.path()
    }
}
