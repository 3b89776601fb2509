//! The looks of earlier runs: a file for each, with a small picture; and a lock for as long as the run lasts.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{SystemTime, UNIX_EPOCH};

use eframe::egui::ColorImage;

use super::{damaged, thumbnail};
use crate::data::read_small;
use crate::export;
use crate::model::Record;

/// Looks of earlier runs that are kept.
pub(crate) const MOST: usize = 10;

/// Names that are looked at in the folder: a hundred runs at once, each with three files.
const MOST_NAMES: usize = 300;

/// The last look of an earlier run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct EarlierRun {
    /// A session file.
    pub look: PathBuf,
    /// What it is of: a path or the name of a built-in volume.
    pub source: String,
    /// When it was kept.
    pub when: SystemTime,
    /// The run ended without having been told to: it crashed, or was killed.
    pub crashed: bool,
}

impl EarlierRun {
    /// What the look shows, if that was kept.
    pub(crate) fn picture(&self) -> Option<ColorImage> {
        thumbnail::read(&self.look.with_extension("png"))
    }

    /// The user has been told that the run crashed.
    pub(super) fn settle(&mut self) {
        end(&self.look);
        self.crashed = false;
    }
}

/// The run of a look has ended as it should, or nobody needs to know otherwise.
pub(super) fn end(look: &Path) {
    export::remove(&lock_of(look));
}

fn lock_of(look: &Path) -> PathBuf {
    look.with_extension("lock")
}

/// Runs of this process, which may have several windows.
static RUNS: AtomicU32 = AtomicU32::new(0);

/// The files of a run that goes on.
#[derive(Debug)]
pub(super) struct ThisRun {
    /// Where its look is kept.
    pub look: PathBuf,
    /// Held until the process ends, however it does.
    lock: Option<File>,
}

impl ThisRun {
    /// Begins a run in a folder.
    pub(super) fn begin(folder: &Path) -> std::io::Result<Self> {
        export::make_folder(folder)?;
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        // Names in the order of time, and of no other process.
        let number = RUNS.fetch_add(1, Ordering::Relaxed);
        let name = format!("{:013}-{}-{number}.json", now.as_millis(), std::process::id());
        let look = folder.join(name);
        // On a file system without locks, a run that goes on looks as if it had crashed.
        let lock = export::hold_lock(&lock_of(&look))?;
        Ok(Self { look, lock: Some(lock) })
    }
}

impl Drop for ThisRun {
    fn drop(&mut self) {
        // Some systems do not remove what is open.
        self.lock = None;
        // A run that panics is one that was cut off.
        if std::thread::panicking() {
            return;
        }
        end(&self.look);
    }
}

/// Whether the run of a look goes on; and if not, whether it was cut off.
enum Ended {
    NotYet,
    AsItShould,
    Crashed,
}

fn how_ended(look: &Path) -> Ended {
    match File::open(lock_of(look)) {
        Err(_) => Ended::AsItShould,
        Ok(lock) => match lock.try_lock() {
            Err(std::fs::TryLockError::WouldBlock) => Ended::NotYet,
            _ => Ended::Crashed,
        },
    }
}

/// Takes over the look of a version that kept one for all runs.
pub(super) fn adopt(folder: &Path, runs: &Path) {
    for name in ["before.json", "now.json"] {
        let look = folder.join(name);
        let Ok(when) = std::fs::metadata(&look).and_then(|found| found.modified()) else { continue };
        let millis = when.duration_since(UNIX_EPOCH).unwrap_or_default().as_millis();
        export::make_folder(runs).ok();
        export::rename(&look, &runs.join(format!("{millis:013}-0.json"))).ok();
    }
}

/// How often the program was cut off before it had a look, since it had one.
pub(super) fn failed_starts(folder: &Path) -> usize {
    failed(&files_of(folder)).0.len()
}

/// The files of a folder, in the order of their names.
fn files_of(folder: &Path) -> Vec<PathBuf> {
    let names = std::fs::read_dir(folder).into_iter().flatten().take(MOST_NAMES);
    let mut files: Vec<PathBuf> = names.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.sort();
    files
}

/// The locks of runs that were cut off before they had a look: after the latest run that had one, and before.
fn failed(files: &[PathBuf]) -> (Vec<&PathBuf>, Vec<&PathBuf>) {
    let has_ending = |file: &&PathBuf, wanted: &str| file.extension().is_some_and(|ending| ending == wanted);
    let latest = files.iter().rfind(|file| has_ending(file, "json"));
    let locks = files.iter().filter(|file| has_ending(file, "lock"));
    let cut_off = locks.filter(|lock| {
        let look = lock.with_extension("json");
        !look.exists() && matches!(how_ended(&look), Ended::Crashed)
    });
    cut_off.partition(|lock| latest.is_none_or(|latest| *lock > latest))
}

/// The runs of a folder that have ended, the latest first, with notices of what was damaged. More than [`MOST`] are
/// not kept.
pub(super) fn read(folder: &Path) -> (Vec<EarlierRun>, Vec<String>) {
    let files = files_of(folder);
    // Starts that failed matter until one has not.
    let (_, over) = failed(&files);
    for lock in over {
        export::remove(lock);
    }
    let (mut runs, mut notices) = (Vec::new(), Vec::new());
    for look in files.into_iter().rev().filter(|file| file.extension().is_some_and(|ending| ending == "json"))
    {
        let ended = how_ended(&look);
        if matches!(ended, Ended::NotYet) {
            continue;
        }
        if runs.len() == MOST {
            remove(&look);
            continue;
        }
        let crashed = matches!(ended, Ended::Crashed);
        if let Some(run) = describe(&look, crashed) {
            runs.push(run);
        } else {
            notices.push(damaged::put_aside(&look));
            remove(&look);
        }
    }
    (runs, notices)
}

/// What the list says of a look; none if it is none.
fn describe(look: &Path, crashed: bool) -> Option<EarlierRun> {
    let text = String::from_utf8(read_small(look).ok()?).ok()?;
    let record = Record::read(&text).ok()?;
    let when = std::fs::metadata(look).and_then(|found| found.modified()).unwrap_or(UNIX_EPOCH);
    Some(EarlierRun { look: look.to_owned(), source: record.volume?.source, when, crashed })
}

/// Removes a look, and what belongs to it.
fn remove(look: &Path) {
    for file in [look.to_owned(), look.with_extension("png"), lock_of(look)] {
        export::remove(&file);
    }
}
