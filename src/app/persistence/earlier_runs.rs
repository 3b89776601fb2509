//! Looks of earlier runs for crash recovery.
//!
//! Each run has a session file and a thumbnail, and a lock file while it lasts.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use eframe::egui::ColorImage;

use super::{quarantine, thumbnail};
use chiaroscuro_files::read_small_file;
use chiaroscuro_scene::LookRecord;

/// Maximum number of earlier looks that are kept.
pub(crate) const MAX_EARLIER_RUNS: usize = 10;

/// Maximum number of directory entries that are read: a hundred simultaneous runs with three files each.
const MOST_NAMES: usize = 300;

/// Last look of an earlier run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct EarlierRun {
    /// Path of the session file.
    pub look: PathBuf,
    /// Path of the volume's file, or name of a built-in volume.
    pub source: String,
    /// Time of the last autosave.
    pub when: SystemTime,
    /// True if the run crashed or was killed.
    pub crashed: bool,
}

impl EarlierRun {
    /// Reads the thumbnail of the look, if there is one.
    pub(crate) fn picture(&self) -> Option<ColorImage> {
        thumbnail::read(&self.look.with_extension("png"))
    }

    /// Marks the crash as acknowledged by the user.
    pub(super) fn acknowledge_crash(&mut self) {
        mark_ended(&self.look);
        self.crashed = false;
    }
}

/// Marks the run of a look as ended normally, by removing its lock file.
pub(super) fn mark_ended(look: &Path) {
    chiaroscuro_files::remove_own_file(&lock_path(look));
}

fn lock_path(look: &Path) -> PathBuf {
    look.with_extension("lock")
}

/// Files of the current run.
#[derive(Debug)]
pub(super) struct CurrentRun {
    /// Path of the autosaved look.
    pub look: PathBuf,
    /// Lock that is held until the process ends, normally or not.
    lock: Option<File>,
}

impl CurrentRun {
    /// Starts a run in a folder, with a lock file.
    pub(super) fn begin(folder: &Path) -> std::io::Result<Self> {
        chiaroscuro_files::make_folder(folder)?;
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        // Names sort by time, and are unique among processes.
        let name = format!("{:013}-{}", now.as_millis(), std::process::id());
        let mut number = 0;
        loop {
            let look = folder.join(format!("{name}-{number}.json"));
            number += 1;
            // Another window of this process may have begun within the millisecond, and have left its look.
            if look.exists() {
                continue;
            }
            // On a file system without locks, a running window looks like a crashed one.
            match chiaroscuro_files::create_lock(&lock_path(&look)) {
                Err(err) if err.kind() == std::io::ErrorKind::AlreadyExists => {}
                lock => return Ok(Self { look, lock: Some(lock?) }),
            }
        }
    }
}

impl Drop for CurrentRun {
    fn drop(&mut self) {
        // Some systems do not remove open files.
        self.lock = None;
        // A run that panics counts as crashed.
        if std::thread::panicking() {
            return;
        }
        mark_ended(&self.look);
    }
}

/// State of the run of a look: running, ended normally, or crashed.
enum RunState {
    Running,
    EndedNormally,
    Crashed,
}

fn run_state(look: &Path) -> RunState {
    match File::open(lock_path(look)) {
        Err(_) => RunState::EndedNormally,
        Ok(lock) => match lock.try_lock() {
            Err(std::fs::TryLockError::WouldBlock) => RunState::Running,
            _ => RunState::Crashed,
        },
    }
}

/// Takes over the look of an older version, which kept a single one for all runs.
pub(super) fn import_old_look(folder: &Path, runs: &Path) {
    for name in ["before.json", "now.json"] {
        let look = folder.join(name);
        let Ok(when) = std::fs::metadata(&look).and_then(|found| found.modified()) else { continue };
        let millis = when.duration_since(UNIX_EPOCH).unwrap_or_default().as_millis();
        chiaroscuro_files::make_folder(runs).ok();
        chiaroscuro_files::rename_own_file(&look, &runs.join(format!("{millis:013}-0.json"))).ok();
    }
}

/// Counts the crashed runs without a look, since the last run with a look.
pub(super) fn failed_starts(folder: &Path) -> usize {
    crashed_without_look(&files_of(folder)).0.len()
}

/// Lists the files of a folder, sorted by name.
fn files_of(folder: &Path) -> Vec<PathBuf> {
    let names = std::fs::read_dir(folder).into_iter().flatten().take(MOST_NAMES);
    let mut files: Vec<PathBuf> = names.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.sort();
    files
}

/// Finds the locks of runs that crashed before they had a look: those after the latest run with a look, and those
/// before.
fn crashed_without_look(files: &[PathBuf]) -> (Vec<&PathBuf>, Vec<&PathBuf>) {
    let has_ending = |file: &&PathBuf, wanted: &str| file.extension().is_some_and(|ending| ending == wanted);
    let latest = files.iter().rfind(|file| has_ending(file, "json"));
    let locks = files.iter().filter(|file| has_ending(file, "lock"));
    let cut_off = locks.filter(|lock| {
        let look = lock.with_extension("json");
        !look.exists() && matches!(run_state(&look), RunState::Crashed)
    });
    cut_off.partition(|lock| latest.is_none_or(|latest| *lock > latest))
}

/// Reads the runs of a folder that have ended, the latest first, with notices of corrupt files. Removes all but
/// [`MAX_EARLIER_RUNS`].
pub(super) fn read(folder: &Path) -> (Vec<EarlierRun>, Vec<String>) {
    let files = files_of(folder);
    // Failed starts matter until one has succeeded.
    let (_, over) = crashed_without_look(&files);
    for lock in over {
        chiaroscuro_files::remove_own_file(lock);
    }
    let (mut runs, mut notices) = (Vec::new(), Vec::new());
    for look in files.into_iter().rev().filter(|file| file.extension().is_some_and(|ending| ending == "json"))
    {
        let ended = run_state(&look);
        if matches!(ended, RunState::Running) {
            continue;
        }
        if runs.len() == MAX_EARLIER_RUNS {
            remove(&look);
            continue;
        }
        let crashed = matches!(ended, RunState::Crashed);
        if let Some(run) = describe(&look, crashed) {
            runs.push(run);
        } else {
            notices.push(quarantine::quarantine(&look));
            // A look that could not be moved stays, so that nothing is lost.
            if !look.exists() {
                remove(&look);
            }
        }
    }
    (runs, notices)
}

/// Reads the description of a look for the list; `None` if the file is invalid.
fn describe(look: &Path, crashed: bool) -> Option<EarlierRun> {
    let text = String::from_utf8(read_small_file(look).ok()?).ok()?;
    let record = LookRecord::parse(&text).ok()?;
    let when = std::fs::metadata(look).and_then(|found| found.modified()).unwrap_or(UNIX_EPOCH);
    Some(EarlierRun { look: look.to_owned(), source: record.volume?.source, when, crashed })
}

/// Removes a look with its thumbnail and lock file.
fn remove(look: &Path) {
    for file in [look.to_owned(), look.with_extension("png"), lock_path(look)] {
        chiaroscuro_files::remove_own_file(&file);
    }
}
