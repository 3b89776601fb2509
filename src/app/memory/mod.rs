//! What is remembered from one run to the next: files that were opened, and the looks of this run and the last ones.
//!
//! Each run has files of its own, so that two windows never take anything from each other.

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

/// Starts in succession that have to fail before one leaves out what may be to blame.
const FAILED_STARTS: usize = 3;

/// Whether the last starts of the program have failed, one after the other, of those that remember in a folder.
pub(crate) fn starts_have_failed(folder: &Path) -> bool {
    earlier::failed_starts(&folder.join("runs")) >= FAILED_STARTS
}

fn is_builtin(source: &Path) -> bool {
    source.to_str().is_some_and(|name| name.starts_with("builtin:"))
}

/// The path of a file from the root; built-in volumes have none.
fn whole_path(source: &Path) -> Option<PathBuf> {
    (!is_builtin(source)).then(|| std::path::absolute(source).ok()).flatten()
}

/// The folder of a file from the root; built-in volumes have none.
fn folder_of(source: &Path) -> Option<PathBuf> {
    whole_path(source).and_then(|file| file.parent().map(Path::to_owned))
}

/// The look that was handed over last, and what it is of.
#[derive(Debug)]
struct Kept {
    settings: Settings,
    source: PathBuf,
    content_id: u64,
    choice: Choice,
}

/// Files in the folder that the system gives us; without one, nothing is remembered.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    recent: Vec<RecentFile>,
    /// Which way up things stood in folders, the latest first.
    standing: Vec<Standing>,
    /// How files were corrected, the latest first.
    corrected: Vec<Remembered>,
    /// Runs that have ended, the latest first.
    earlier: Vec<EarlierRun>,
    /// There was no run before.
    is_first: bool,
    /// The last starts have failed, one after the other.
    is_troubled: bool,
    /// What the user should know, once.
    notices: Vec<String>,
    kept: Option<Kept>,
    /// The last write has failed, and that has been said.
    is_failing: bool,
    folder: Option<PathBuf>,
    // In this order: all is written before the run ends.
    keeper: Option<Keeper>,
    run: Option<ThisRun>,
}

impl Memory {
    /// Remembers what was written to a folder, and keeps the look of this run there. Wakes the window when something
    /// could not be kept.
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

    /// Whether nobody has used the program here before.
    pub(crate) fn is_first(&self) -> bool {
        self.is_first
    }

    /// Whether the last starts have failed: the next one leaves out what may be to blame.
    pub(crate) fn is_troubled(&self) -> bool {
        self.is_troubled
    }

    /// What was opened, the latest first.
    pub(crate) fn recent(&self) -> &[RecentFile] {
        &self.recent
    }

    /// Their pictures.
    pub(crate) fn recent_pictures(&self) -> RecentPictures {
        self.folder.as_deref().map_or_else(RecentPictures::default, RecentPictures::of)
    }

    /// Takes note of a file that was opened, and of which of its volumes. Built-in volumes have a menu of their own.
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

    /// Which way up a file is to stand that is opened from where others were.
    pub(crate) fn up_of(&self, source: &Path) -> SceneAxis {
        let folder = folder_of(source);
        let known = folder.and_then(|folder| self.standing.iter().find(|known| known.folder == folder));
        known.map_or_else(SceneAxis::default, |known| known.up)
    }

    /// Takes note of which way up the user has stood a file. Built-in volumes are in no folder.
    pub(crate) fn stood(&mut self, source: &Path, up: SceneAxis) {
        let Some(folder) = folder_of(source) else { return };
        let latest = Standing { folder, up };
        standing::put_first(&mut self.standing, latest.clone());
        if let Some(keeper) = &self.keeper {
            keeper.stood(latest);
        }
    }

    /// How a file was corrected when it was open last, if it was.
    pub(crate) fn corrections_of(&self, source: &Path) -> Option<Remembered> {
        let whole = whole_path(source)?;
        self.corrected.iter().find(|known| known.is_at(&whole)).cloned()
    }

    /// Takes note of how the user has corrected a file. Built-in volumes are what they are.
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

    /// Whether a record is the look of an earlier run: it may open what the user had open then.
    pub(crate) fn is_own(&self, record: &Path) -> bool {
        self.earlier.iter().any(|run| run.look == record)
    }

    /// The look of the run before, if there is one.
    pub(crate) fn before(&self) -> Option<PathBuf> {
        self.earlier.first().map(|run| run.look.clone())
    }

    /// The user has been told of the runs that crashed: they are among the earlier ones, and not offered again.
    pub(crate) fn settle(&mut self) {
        self.earlier.iter_mut().filter(|run| run.crashed).for_each(EarlierRun::settle);
    }

    /// Keeps a look of a volume, unless it is as it was.
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

    /// Keeps what the look shows.
    pub(crate) fn show(&self, picture: Arc<ColorImage>) {
        if let Some((keeper, kept)) = self.keeper.as_ref().zip(self.kept.as_ref()) {
            keeper.show(picture, &kept.source);
        }
    }

    /// Something that the user should know, and that was found before there was a window.
    pub(crate) fn add_notice(&mut self, notice: String) {
        self.notices.push(notice);
    }

    /// What the user should know, once.
    pub(crate) fn take_notices(&mut self) -> Vec<String> {
        let failure = self.keeper.as_ref().and_then(Keeper::failure);
        let was_failing = std::mem::replace(&mut self.is_failing, failure.is_some());
        self.notices.extend(failure.filter(|_| !was_failing).map(|why| text::memory::not_kept(&why)));
        std::mem::take(&mut self.notices)
    }

    /// What a process does before it ends in a hurry.
    pub(crate) fn last_words(&self) -> Option<LastWords> {
        self.keeper.as_ref().map(Keeper::last_words)
    }
}

#[cfg(test)]
mod tests;
