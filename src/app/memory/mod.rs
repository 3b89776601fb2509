//! State that outlives a run: recent files, up axes, corrections, and autosaved looks for crash recovery.
//!
//! Each run has files of its own, so that two windows never overwrite each other's looks.

mod corrected;
mod damaged;
mod earlier;
mod keeper;
mod kept_list;
mod recent;
mod recent_pictures;
mod standing;
mod thumbnail;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui::{self, ColorImage};

pub(crate) use self::corrected::{FileStamp, Remembered};
pub(crate) use self::damaged::check_window_state;
pub(crate) use self::earlier::EarlierRun;
use self::earlier::ThisRun;
use self::keeper::Keeper;
#[cfg(feature = "cli")]
pub(crate) use self::keeper::end_in_a_hurry;
pub(crate) use self::keeper::{LastWords, write_last_words};
pub(crate) use self::recent::RecentFile;
pub(crate) use self::recent_pictures::RecentPictures;
use self::standing::Standing;
use crate::app::text;
use crate::data::Corrections;
use crate::data::load::Choice;
use crate::export;
use crate::model::{SceneAxis, Settings};

/// Number of successive failed starts after which the next one is a safe start.
const FAILED_STARTS: usize = 3;

/// Returns true if the last starts of the program with this storage folder have failed in succession.
pub(crate) fn starts_have_failed(folder: &Path) -> bool {
    earlier::failed_starts(&folder.join("runs")) >= FAILED_STARTS
}

fn is_builtin(source: &Path) -> bool {
    source.to_str().is_some_and(|name| name.starts_with("builtin:"))
}

/// Absolute path of a file; `None` for built-in volumes.
fn whole_path(source: &Path) -> Option<PathBuf> {
    (!is_builtin(source)).then(|| std::path::absolute(source).ok()).flatten()
}

/// Absolute path of a file's folder; `None` for built-in volumes.
fn folder_of(source: &Path) -> Option<PathBuf> {
    whole_path(source).and_then(|file| file.parent().map(Path::to_owned))
}

/// Look that was scheduled last, with its volume.
#[derive(Debug)]
struct Kept {
    settings: Settings,
    source: PathBuf,
    content_id: u64,
    choice: Choice,
}

/// State in the storage folder of the program; without a folder, nothing is remembered.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    recent: Vec<RecentFile>,
    /// Up axes of folders, the latest first.
    standing: Vec<Standing>,
    /// Corrections of files, the latest first.
    corrected: Vec<Remembered>,
    /// Runs that have ended, the latest first.
    earlier: Vec<EarlierRun>,
    /// True if there was no earlier run.
    is_first: bool,
    /// True if the last starts have failed in succession.
    is_troubled: bool,
    /// Notices that are still to be shown to the user.
    notices: Vec<String>,
    kept: Option<Kept>,
    /// True while writes fail, which was reported.
    is_failing: bool,
    folder: Option<PathBuf>,
    // Drop order: everything is written before the run ends.
    keeper: Option<Keeper>,
    run: Option<ThisRun>,
}

impl Memory {
    /// Reads the state in a folder and starts the autosave there. `wake` is repainted when a write fails.
    pub(crate) fn new(folder: Option<&Path>, wake: &egui::Context) -> Self {
        let mut memory = Self::default();
        let Some(folder) = folder else { return memory };
        memory.folder = Some(folder.to_owned());
        let runs = folder.join("runs");
        earlier::adopt(folder, &runs);
        for folder in [folder, &runs] {
            export::remove_abandoned(folder);
        }
        memory.is_first = !runs.exists();
        let (recent, notice) = recent::read(folder);
        (memory.recent, memory.notices) = (recent, notice.into_iter().collect());
        memory.recent.truncate(recent::MOST);
        let (standing, notice) = standing::read(folder);
        memory.standing = standing;
        memory.notices.extend(notice);
        let (corrected, notice) = corrected::read(folder);
        memory.corrected = corrected;
        memory.notices.extend(notice);
        memory.is_troubled = starts_have_failed(folder);
        let (earlier, notices) = earlier::read(&runs);
        memory.earlier = earlier;
        memory.notices.extend(notices);
        let begun = ThisRun::begin(&runs)
            .and_then(|run| Ok((Keeper::new(folder, &run.look, wake)?, run)))
            .map_err(|err| text::memory::not_remembered(folder, err));
        match begun {
            Ok((keeper, run)) => (memory.keeper, memory.run) = (Some(keeper), Some(run)),
            Err(notice) => memory.notices.push(notice),
        }
        memory
    }

    /// Returns true if the program has never been used with this storage folder.
    pub(crate) fn is_first(&self) -> bool {
        self.is_first
    }

    /// Returns true if the last starts have failed, so that this one has to be a safe start.
    pub(crate) fn is_troubled(&self) -> bool {
        self.is_troubled
    }

    /// Recently opened files, the latest first.
    pub(crate) fn recent(&self) -> &[RecentFile] {
        &self.recent
    }

    /// Creates the cache of the recent files' thumbnails.
    pub(crate) fn recent_pictures(&self) -> RecentPictures {
        self.folder.as_deref().map_or_else(RecentPictures::default, RecentPictures::of)
    }

    /// Adds a file and the choice of its volume to the recent files. Built-in volumes have a menu of their own.
    pub(crate) fn opened(&mut self, source: &Path, choice: &Choice) {
        if is_builtin(source) {
            return;
        }
        let path = std::path::absolute(source).unwrap_or_else(|_| source.to_owned());
        let latest = RecentFile { path, choice: choice.clone() };
        recent::put_first(&mut self.recent, latest.clone());
        if let Some(keeper) = &self.keeper {
            keeper.opened(latest);
        }
    }

    /// Returns the up axis for a file: the last one that the user has chosen in its folder.
    pub(crate) fn up_of(&self, source: &Path) -> SceneAxis {
        let folder = folder_of(source);
        let known = folder.and_then(|folder| self.standing.iter().find(|known| known.folder == folder));
        known.map_or_else(SceneAxis::default, |known| known.up)
    }

    /// Remembers the up axis for the folder of a file. Built-in volumes have no folder.
    pub(crate) fn stood(&mut self, source: &Path, up: SceneAxis) {
        let Some(folder) = folder_of(source) else { return };
        let latest = Standing { folder, up };
        standing::put_first(&mut self.standing, latest.clone());
        if let Some(keeper) = &self.keeper {
            keeper.stood(latest);
        }
    }

    /// Returns the last corrections of a file, if it has any.
    pub(crate) fn corrections_of(&self, source: &Path) -> Option<Remembered> {
        let whole = whole_path(source)?;
        self.corrected.iter().find(|known| known.is_at(&whole)).cloned()
    }

    /// Remembers the corrections of a file. Built-in volumes are not remembered.
    pub(crate) fn corrected(&mut self, source: &Path, stamp: FileStamp, opened_id: u64, by: Corrections) {
        let Some(file) = whole_path(source) else { return };
        let latest = Remembered::new(file, stamp, opened_id, by);
        corrected::put_first(&mut self.corrected, latest.clone());
        if let Some(keeper) = &self.keeper {
            keeper.corrected(latest);
        }
    }

    /// Runs that have ended, the latest first.
    pub(crate) fn earlier(&self) -> &[EarlierRun] {
        &self.earlier
    }

    /// Returns true if a record is the look of an earlier run, which may open the volume that was open then.
    pub(crate) fn is_own(&self, record: &Path) -> bool {
        self.earlier.iter().any(|run| run.look == record)
    }

    /// Path of the look of the previous run, if there is one.
    pub(crate) fn before(&self) -> Option<PathBuf> {
        self.earlier.first().map(|run| run.look.clone())
    }

    /// Marks crashed runs as acknowledged: their looks stay in the list, and are not offered again.
    pub(crate) fn settle(&mut self) {
        self.earlier.iter_mut().filter(|run| run.crashed).for_each(EarlierRun::settle);
    }

    /// Autosaves the look of a volume, unless it is unchanged.
    pub(crate) fn keep(&mut self, settings: &Settings, source: &Path, content_id: u64, choice: &Choice) {
        let is_known = self.kept.as_ref().is_some_and(|kept| {
            kept.content_id == content_id && kept.choice == *choice && kept.settings == *settings
        });
        if let Some(keeper) = self.keeper.as_ref().filter(|_| !is_known) {
            keeper.keep(settings, source, content_id, choice);
            let (settings, source, choice) = (settings.clone(), source.to_owned(), choice.clone());
            self.kept = Some(Kept { settings, source, content_id, choice });
        }
    }

    /// Autosaves a picture of the look as its thumbnail.
    pub(crate) fn show(&self, picture: Arc<ColorImage>) {
        if let Some((keeper, kept)) = self.keeper.as_ref().zip(self.kept.as_ref()) {
            keeper.show(picture, &kept.source);
        }
    }

    /// Adds a notice for the user from before there was a window.
    pub(crate) fn add_notice(&mut self, notice: String) {
        self.notices.push(notice);
    }

    /// Takes the notices that the user has not seen yet.
    pub(crate) fn take_notices(&mut self) -> Vec<String> {
        let failure = self.keeper.as_ref().and_then(Keeper::failure);
        let was_failing = std::mem::replace(&mut self.is_failing, failure.is_some());
        self.notices.extend(failure.filter(|_| !was_failing).map(|why| text::memory::not_kept(&why)));
        std::mem::take(&mut self.notices)
    }

    /// Returns a handle that writes pending changes before the process terminates.
    pub(crate) fn last_words(&self) -> Option<LastWords> {
        self.keeper.as_ref().map(Keeper::last_words)
    }
}

#[cfg(test)]
mod tests;
