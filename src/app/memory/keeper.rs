//! Autosave of the current look and of the lists of files, on a thread of its own.
//!
//! It works even when no frame is drawn.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, TryLockError, Weak};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use eframe::egui::{self, ColorImage};

use super::corrected::{self, Remembered};
#[cfg(feature = "cli")]
use super::earlier;
use super::recent::RecentFile;
use super::standing::{self, Standing};
use super::{recent, recent_pictures, thumbnail};
use crate::data::load::Choice;
use crate::export::write_atomically;
use crate::model::{Record, Settings, VolumeRecord};

/// Time for which changes are collected before they are written: together with the time for writing, the maximum
/// loss, and half of the two seconds that users are promised.
const COLLECT: Duration = Duration::from_secs(1);

/// Time for which a terminating process waits for a write in progress: three quarters of the two seconds that users
/// are promised, since it has a look of its own to write then.
const LAST_WAIT: Duration = Duration::from_millis(1500);

/// Look with the volume that it belongs to.
#[derive(Debug, Clone)]
struct Look {
    settings: Settings,
    source: PathBuf,
    content_id: u64,
    choice: Choice,
}

impl Look {
    fn text(&self) -> String {
        let volume = VolumeRecord::new(&self.source, self.content_id, None).choosing(self.choice.clone());
        Record::text(&self.settings, Some(&volume), None)
    }
}

/// Picture of a look, with the file that it shows.
#[derive(Debug)]
struct Shown {
    picture: Arc<ColorImage>,
    source: PathBuf,
}

/// Changes that wait to be written.
#[derive(Debug, Default)]
struct Due {
    look: Option<Look>,
    picture: Option<Shown>,
    /// Files that were opened, the latest last.
    opened: Vec<RecentFile>,
    /// Up axes that the user has chosen for folders, the latest last.
    stood: Vec<Standing>,
    /// Corrections that the user has chosen for files, the latest last.
    corrected: Vec<Remembered>,
    closed: bool,
}

impl Due {
    fn is_empty(&self) -> bool {
        let has_lists = !(self.opened.is_empty() && self.stood.is_empty() && self.corrected.is_empty());
        self.look.is_none() && self.picture.is_none() && !has_lists
    }
}

/// State shared by the window and the autosave thread.
#[derive(Debug)]
struct Shared {
    due: Mutex<Due>,
    changed: Condvar,
    /// Held during a write, so that an older state is never written last.
    writing: Mutex<()>,
    /// Reason why the last write of the look failed, if it did.
    failure: Mutex<Option<String>>,
    /// Storage folder of the program.
    folder: PathBuf,
    /// Path of this run's look; its thumbnail lies beside it.
    look: PathBuf,
    wake: egui::Context,
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Locks a mutex, unless that takes longer than a terminating process can wait.
fn locked_soon<T>(mutex: &Mutex<T>) -> Option<MutexGuard<'_, T>> {
    let begin = Instant::now();
    loop {
        match mutex.try_lock() {
            Ok(guard) => return Some(guard),
            Err(TryLockError::Poisoned(poisoned)) => return Some(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) if begin.elapsed() > LAST_WAIT => return None,
            Err(TryLockError::WouldBlock) => std::thread::sleep(Duration::from_millis(5)),
        }
    }
}

impl Shared {
    /// Writes pending changes. A look that could not be written stays pending, unless there is a newer one; other
    /// changes that fail are dropped.
    fn write(&self, due: Due) {
        let Due { look, picture, opened, stood, corrected, closed: _ } = due;
        if let Some(look) = look {
            let failed =
                write_atomically(&self.look, look.text().as_bytes()).err().map(|err| err.to_string());
            if failed.is_some() {
                locked(&self.due).look.get_or_insert(look);
            }
            let before = std::mem::replace(&mut *locked(&self.failure), failed.clone());
            if let Some(why) = failed.filter(|_| before.is_none()) {
                log::warn!("the look was not kept: {why}");
                self.wake.request_repaint();
            }
        }
        // The look matters most; the lists do without thumbnails and the latest file.
        if let Some(Shown { picture, source }) = picture {
            let kept = thumbnail::write(&picture, &self.look.with_extension("png"));
            if let Err(err) = kept.and_then(|()| recent_pictures::write(&self.folder, &source, &picture)) {
                log::warn!("the small picture of the look was not kept: {err}");
            }
        }
        if !opened.is_empty() {
            match recent::add(&self.folder, &opened) {
                Ok(listed) => recent_pictures::tidy(&self.folder, &listed),
                Err(err) => log::warn!("files that were opened were not noted: {err}"),
            }
        }
        if !stood.is_empty()
            && let Err(err) = standing::add(&self.folder, stood)
        {
            log::warn!("which way up the object stood was not noted: {err}");
        }
        if !corrected.is_empty()
            && let Err(err) = corrected::add(&self.folder, corrected)
        {
            log::warn!("how the file was corrected was not noted: {err}");
        }
    }

    /// Collects changes and writes them until the window closes.
    fn run(&self) {
        loop {
            let due = locked(&self.due);
            let idle = |due: &mut Due| due.is_empty() && !due.closed;
            let due = self.changed.wait_while(due, idle).unwrap_or_else(PoisonError::into_inner);
            let open = |due: &mut Due| !due.closed;
            let (due, _) =
                self.changed.wait_timeout_while(due, COLLECT, open).unwrap_or_else(PoisonError::into_inner);
            let is_last = due.closed;
            drop(due);
            let _writing = locked(&self.writing);
            let due = {
                let mut due = locked(&self.due);
                let closed = due.closed;
                std::mem::replace(&mut *due, Due { closed, ..Due::default() })
            };
            self.write(due);
            if is_last {
                return;
            }
        }
    }
}

/// Autosave of this run. Dropping it waits until everything is written.
#[derive(Debug)]
pub(super) struct Keeper {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

/// Handle that writes pending changes at once, for a process that is terminated or panics.
#[derive(Debug, Clone)]
pub(crate) struct LastWords(Weak<Shared>);

/// Handles of all windows of this process.
static LAST_WORDS: Mutex<Vec<LastWords>> = Mutex::new(Vec::new());

/// Writes the pending changes of all windows of this process.
pub(crate) fn write_last_words() {
    let all = locked_soon(&LAST_WORDS).map(|all| all.clone());
    all.into_iter().flatten().for_each(|words| words.write());
}

/// Writes the pending changes of all windows of a process that was told to terminate, and marks their runs as ended
/// normally.
#[cfg(feature = "cli")]
pub(crate) fn end_in_a_hurry() {
    write_last_words();
    for words in locked_soon(&LAST_WORDS).iter().flat_map(|all| all.iter()) {
        if let Some(shared) = words.0.upgrade() {
            earlier::end(&shared.look);
        }
    }
}

impl LastWords {
    /// Writes pending changes, unless a stopped thread holds a lock.
    pub(crate) fn write(&self) {
        let Some(shared) = self.0.upgrade() else { return };
        let Some(_writing) = locked_soon(&shared.writing) else { return };
        let Some(due) = locked_soon(&shared.due).map(|mut due| std::mem::take(&mut *due)) else { return };
        shared.write(due);
    }
}

impl Keeper {
    /// Starts the autosave to a file of the look, and to the lists in a folder.
    pub(super) fn new(folder: &Path, look: &Path, wake: &egui::Context) -> std::io::Result<Self> {
        let shared = Arc::new(Shared {
            due: Mutex::default(),
            changed: Condvar::new(),
            writing: Mutex::default(),
            failure: Mutex::default(),
            folder: folder.to_owned(),
            look: look.to_owned(),
            wake: wake.clone(),
        });
        let thread = {
            let shared = Arc::clone(&shared);
            std::thread::Builder::new().name("memory".to_owned()).spawn(move || shared.run())?
        };
        let keeper = Self { shared, thread: Some(thread) };
        let mut all = locked(&LAST_WORDS);
        all.retain(|words| words.0.strong_count() > 0);
        all.push(keeper.last_words());
        drop(all);
        Ok(keeper)
    }

    fn change(&self, change: impl FnOnce(&mut Due)) {
        change(&mut locked(&self.shared.due));
        self.shared.changed.notify_one();
    }

    /// Schedules the current look for writing.
    pub(super) fn keep(&self, settings: &Settings, source: &Path, content_id: u64, choice: &Choice) {
        let (settings, source, choice) = (settings.clone(), source.to_owned(), choice.clone());
        let look = Look { settings, source, content_id, choice };
        self.change(|due| due.look = Some(look));
    }

    /// Schedules a picture of the look for writing, as a thumbnail.
    pub(super) fn show(&self, picture: Arc<ColorImage>, source: &Path) {
        let source = source.to_owned();
        self.change(|due| due.picture = Some(Shown { picture, source }));
    }

    /// Schedules an opened file for the list of recent files.
    pub(super) fn opened(&self, file: RecentFile) {
        self.change(|due| due.opened.push(file));
    }

    /// Schedules the up axis of a folder.
    pub(super) fn stood(&self, standing: Standing) {
        self.change(|due| due.stood.push(standing));
    }

    /// Schedules the corrections of a file.
    pub(super) fn corrected(&self, remembered: Remembered) {
        self.change(|due| due.corrected.push(remembered));
    }

    /// Returns the reason why the look could not be written, if the last write failed.
    pub(super) fn failure(&self) -> Option<String> {
        locked(&self.shared.failure).clone()
    }

    /// Returns a handle that writes pending changes before the process terminates.
    pub(super) fn last_words(&self) -> LastWords {
        LastWords(Arc::downgrade(&self.shared))
    }
}

impl Drop for Keeper {
    fn drop(&mut self) {
        self.change(|due| due.closed = true);
        // A panic of the thread was logged there.
        self.thread.take().map(JoinHandle::join);
    }
}
