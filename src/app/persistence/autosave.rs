//! Autosave of the current look and of the lists of files, on a thread of its own.
//!
//! It works even when no frame is drawn.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, TryLockError, Weak};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use eframe::egui::{self, ColorImage};

use super::corrected_files::{self, CorrectedFile};
#[cfg(feature = "cli")]
use super::earlier_runs;
use super::folder_orientation::{self, FolderOrientation};
use super::recent_files::RecentFile;
use super::{recent_files, recent_thumbnails, thumbnail};
use chiaroscuro_files::write_atomically;
use chiaroscuro_scene::{LookRecord, Settings, VolumeRecord};
use chiaroscuro_volume::FieldOrigin;

/// Time for which changes are collected before they are written: together with the time for writing, the maximum
/// loss, and half of the two seconds that users are promised.
const COLLECT_TIME: Duration = Duration::from_secs(1);

/// Time for which a terminating process waits for a write in progress: three quarters of the two seconds that users
/// are promised, since it has a look of its own to write then.
const TERMINATION_TIMEOUT: Duration = Duration::from_millis(1500);

/// Look with the volumes that it belongs to.
#[derive(Debug, Clone)]
struct AutosavedLook {
    settings: Settings,
    /// Volume that is open, and those that are shown with it.
    volumes: Vec<FieldOrigin>,
}

impl AutosavedLook {
    fn text(&self) -> String {
        let volume = VolumeRecord::from_volumes(&self.volumes, None);
        LookRecord::to_json(&self.settings, volume.as_ref(), None)
    }
}

/// Picture of a look, with the file that it shows.
#[derive(Debug)]
struct LookPicture {
    picture: Arc<ColorImage>,
    source: PathBuf,
}

/// Changes that wait to be written.
#[derive(Debug, Default)]
struct PendingWrites {
    look: Option<AutosavedLook>,
    picture: Option<LookPicture>,
    /// Files that were opened, the latest last.
    opened: Vec<RecentFile>,
    /// Up axes that the user has chosen for folders, the latest last.
    up_axes: Vec<FolderOrientation>,
    /// Corrections that the user has chosen for files, the latest last.
    corrected: Vec<CorrectedFile>,
    closed: bool,
}

impl PendingWrites {
    fn is_empty(&self) -> bool {
        let has_lists = !(self.opened.is_empty() && self.up_axes.is_empty() && self.corrected.is_empty());
        self.look.is_none() && self.picture.is_none() && !has_lists
    }
}

/// State shared by the window and the autosave thread.
#[derive(Debug)]
struct AutosaveShared {
    due: Mutex<PendingWrites>,
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

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Locks a mutex, unless that takes longer than a terminating process can wait.
fn lock_with_timeout<T>(mutex: &Mutex<T>) -> Option<MutexGuard<'_, T>> {
    let begin = Instant::now();
    loop {
        match mutex.try_lock() {
            Ok(guard) => return Some(guard),
            Err(TryLockError::Poisoned(poisoned)) => return Some(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) if begin.elapsed() > TERMINATION_TIMEOUT => return None,
            Err(TryLockError::WouldBlock) => std::thread::sleep(Duration::from_millis(5)),
        }
    }
}

impl AutosaveShared {
    /// Writes pending changes. A look that could not be written stays pending, unless there is a newer one; other
    /// changes that fail are dropped.
    fn write(&self, due: PendingWrites) {
        let PendingWrites { look, picture, opened, up_axes: stood, corrected, closed: _ } = due;
        if let Some(look) = look {
            let failed =
                write_atomically(&self.look, look.text().as_bytes()).err().map(|err| err.to_string());
            if failed.is_some() {
                lock(&self.due).look.get_or_insert(look);
            }
            let before = std::mem::replace(&mut *lock(&self.failure), failed.clone());
            if let Some(why) = failed.filter(|_| before.is_none()) {
                log::warn!("the look was not autosaved: {why}");
                self.wake.request_repaint();
            }
        }
        // The look matters most; the lists do without thumbnails and the latest file.
        if let Some(LookPicture { picture, source }) = picture {
            let kept = thumbnail::write(&picture, &self.look.with_extension("png"));
            if let Err(err) = kept.and_then(|()| recent_thumbnails::write(&self.folder, &source, &picture)) {
                log::warn!("the thumbnail of the look was not saved: {err}");
            }
        }
        if !opened.is_empty() {
            match recent_files::add(&self.folder, &opened) {
                Ok(listed) => recent_thumbnails::remove_unlisted(&self.folder, &listed),
                Err(err) => log::warn!("the list of recent files was not saved: {err}"),
            }
        }
        if !stood.is_empty()
            && let Err(err) = folder_orientation::add(&self.folder, stood)
        {
            log::warn!("the up axis of the object was not saved: {err}");
        }
        if !corrected.is_empty()
            && let Err(err) = corrected_files::add(&self.folder, corrected)
        {
            log::warn!("the corrections of the file were not saved: {err}");
        }
    }

    /// Collects changes and writes them until the window closes.
    fn run(&self) {
        loop {
            let due = lock(&self.due);
            let idle = |due: &mut PendingWrites| due.is_empty() && !due.closed;
            let due = self.changed.wait_while(due, idle).unwrap_or_else(PoisonError::into_inner);
            let open = |due: &mut PendingWrites| !due.closed;
            let (due, _) = self
                .changed
                .wait_timeout_while(due, COLLECT_TIME, open)
                .unwrap_or_else(PoisonError::into_inner);
            let is_last = due.closed;
            drop(due);
            let _writing = lock(&self.writing);
            let due = {
                let mut due = lock(&self.due);
                let closed = due.closed;
                std::mem::replace(&mut *due, PendingWrites { closed, ..PendingWrites::default() })
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
pub(super) struct AutosaveThread {
    shared: Arc<AutosaveShared>,
    thread: Option<JoinHandle<()>>,
}

/// Handle that writes pending changes at once, for a process that is terminated or panics.
#[derive(Debug, Clone)]
pub(crate) struct EmergencySave(Weak<AutosaveShared>);

/// Handles of all windows of this process. They stay static: the panic hook and the handler of termination write by
/// them, and have no window at hand.
static EMERGENCY_SAVES: Mutex<Vec<EmergencySave>> = Mutex::new(Vec::new());

/// Writes the pending changes of all windows of this process.
pub(crate) fn write_all_pending() {
    let all = lock_with_timeout(&EMERGENCY_SAVES).map(|all| all.clone());
    all.into_iter().flatten().for_each(|words| words.write());
}

/// Writes the pending changes of all windows of a process that was told to terminate, and marks their runs as ended
/// normally.
#[cfg(feature = "cli")]
pub(crate) fn save_before_termination() {
    write_all_pending();
    for words in lock_with_timeout(&EMERGENCY_SAVES).iter().flat_map(|all| all.iter()) {
        if let Some(shared) = words.0.upgrade() {
            earlier_runs::mark_ended(&shared.look);
        }
    }
}

impl EmergencySave {
    /// Writes pending changes, unless a stopped thread holds a lock.
    pub(crate) fn write(&self) {
        let Some(shared) = self.0.upgrade() else { return };
        let Some(_writing) = lock_with_timeout(&shared.writing) else { return };
        let Some(due) = lock_with_timeout(&shared.due).map(|mut due| std::mem::take(&mut *due)) else {
            return;
        };
        shared.write(due);
    }
}

impl AutosaveThread {
    /// Starts the autosave to a file of the look, and to the lists in a folder.
    pub(super) fn new(folder: &Path, look: &Path, wake: &egui::Context) -> std::io::Result<Self> {
        let shared = Arc::new(AutosaveShared {
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
        let mut all = lock(&EMERGENCY_SAVES);
        all.retain(|words| words.0.strong_count() > 0);
        all.push(keeper.last_words());
        drop(all);
        Ok(keeper)
    }

    fn change(&self, change: impl FnOnce(&mut PendingWrites)) {
        change(&mut lock(&self.shared.due));
        self.shared.changed.notify_one();
    }

    /// Schedules the current look for writing.
    pub(super) fn schedule_look(&self, settings: &Settings, volumes: &[FieldOrigin]) {
        let look = AutosavedLook { settings: settings.clone(), volumes: volumes.to_vec() };
        self.change(|due| due.look = Some(look));
    }

    /// Schedules a picture of the look for writing, as a thumbnail.
    pub(super) fn schedule_thumbnail(&self, picture: Arc<ColorImage>, source: &Path) {
        let source = source.to_owned();
        self.change(|due| due.picture = Some(LookPicture { picture, source }));
    }

    /// Schedules an opened file for the list of recent files.
    pub(super) fn schedule_recent_file(&self, file: RecentFile) {
        self.change(|due| due.opened.push(file));
    }

    /// Schedules the up axis of a folder.
    pub(super) fn schedule_up_axis(&self, standing: FolderOrientation) {
        self.change(|due| due.up_axes.push(standing));
    }

    /// Schedules the corrections of a file.
    pub(super) fn schedule_corrections(&self, remembered: CorrectedFile) {
        self.change(|due| due.corrected.push(remembered));
    }

    /// Returns the reason why the look could not be written, if the last write failed.
    pub(super) fn failure(&self) -> Option<String> {
        lock(&self.shared.failure).clone()
    }

    /// Returns a handle that writes pending changes before the process terminates.
    pub(super) fn last_words(&self) -> EmergencySave {
        EmergencySave(Arc::downgrade(&self.shared))
    }
}

impl Drop for AutosaveThread {
    fn drop(&mut self) {
        self.change(|due| due.closed = true);
        // A panic of the thread was logged there.
        self.thread.take().map(JoinHandle::join);
    }
}
