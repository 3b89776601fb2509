//! State that outlives a run: recent files, up axes, corrections, and autosaved looks for crash recovery.
//!
//! Each run has files of its own, so that two windows never overwrite each other's looks.

mod autosave;
mod corrected_files;
mod earlier_runs;
mod folder_orientation;
mod quarantine;
mod recent_files;
mod recent_thumbnails;
mod shared_list;
mod thumbnail;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui::{self, ColorImage};

use self::autosave::AutosaveThread;
#[cfg(feature = "cli")]
pub(crate) use self::autosave::save_before_termination;
pub(crate) use self::autosave::{EmergencySave, write_all_pending};
pub(crate) use self::corrected_files::{CorrectedFile, FileStamp};
use self::earlier_runs::CurrentRun;
pub(crate) use self::earlier_runs::EarlierRun;
use self::folder_orientation::FolderOrientation;
pub(crate) use self::quarantine::check_window_state;
pub(crate) use self::recent_files::RecentFile;
pub(crate) use self::recent_thumbnails::RecentThumbnails;
use crate::app::text;
use chiaroscuro_scene::{SceneAxis, Settings};
use chiaroscuro_volume::{Corrections, FieldOrigin, VolumeChoice};

/// Number of successive failed starts after which the next one is a safe start.
const FAILED_STARTS: usize = 3;

/// Returns true if the last starts of the program with this storage folder have failed in succession.
pub(crate) fn starts_have_failed(folder: &Path) -> bool {
    earlier_runs::failed_starts(&folder.join("runs")) >= FAILED_STARTS
}

fn is_builtin(source: &Path) -> bool {
    source.to_str().is_some_and(|name| name.starts_with("builtin:"))
}

/// Absolute path of a file; `None` for built-in volumes.
fn absolute_path(source: &Path) -> Option<PathBuf> {
    (!is_builtin(source)).then(|| std::path::absolute(source).ok()).flatten()
}

/// Absolute path of a file's folder; `None` for built-in volumes.
fn folder_of(source: &Path) -> Option<PathBuf> {
    absolute_path(source).and_then(|file| file.parent().map(Path::to_owned))
}

/// Look that was scheduled last, with its volume.
#[derive(Debug)]
struct LastAutosave {
    settings: Settings,
    /// Volume that is open, and those that are shown with it.
    volumes: Vec<FieldOrigin>,
}

/// State in the storage folder of the program; without a folder, nothing is remembered.
#[derive(Debug, Default)]
pub(crate) struct PersistentState {
    recent: Vec<RecentFile>,
    /// Up axes of folders, the latest first.
    standing: Vec<FolderOrientation>,
    /// Corrections of files, the latest first.
    corrected: Vec<CorrectedFile>,
    /// Runs that have ended, the latest first.
    earlier: Vec<EarlierRun>,
    /// True if there was no earlier run.
    is_first: bool,
    /// True if the last starts have failed in succession.
    is_troubled: bool,
    /// Notices that are still to be shown to the user.
    notices: Vec<String>,
    kept: Option<LastAutosave>,
    /// True while writes fail, which was reported.
    is_failing: bool,
    folder: Option<PathBuf>,
    /// Absolute path of a file that is deleted when the window is closed. It is in no list; only the autosaved look, with
    /// which a crash is recovered from, names it.
    temporary: Option<PathBuf>,
    // Drop order: everything is written before the run ends.
    keeper: Option<AutosaveThread>,
    run: Option<CurrentRun>,
}

impl PersistentState {
    /// Reads the state in a folder and starts the autosave there. `wake` is repainted when a write fails.
    pub(crate) fn new(folder: Option<&Path>, wake: &egui::Context) -> Self {
        let mut memory = Self::default();
        let Some(folder) = folder else { return memory };
        memory.folder = Some(folder.to_owned());
        let runs = folder.join("runs");
        earlier_runs::import_old_look(folder, &runs);
        for folder in [folder, &runs] {
            chiaroscuro_files::remove_abandoned_temporary_files(folder);
        }
        memory.is_first = !runs.exists();
        let (recent, notice) = recent_files::read(folder);
        (memory.recent, memory.notices) = (recent, notice.into_iter().collect());
        memory.recent.truncate(recent_files::MAX_RECENT_FILES);
        let (standing, notice) = folder_orientation::read(folder);
        memory.standing = standing;
        memory.notices.extend(notice);
        let (corrected, notice) = corrected_files::read(folder);
        memory.corrected = corrected;
        memory.notices.extend(notice);
        memory.is_troubled = starts_have_failed(folder);
        let (earlier, notices) = earlier_runs::read(&runs);
        memory.earlier = earlier;
        memory.notices.extend(notices);
        let begun = CurrentRun::begin(&runs)
            .and_then(|run| Ok((AutosaveThread::new(folder, &run.look, wake)?, run)))
            .map_err(|err| text::persistence::storage_failed(folder, err));
        match begun {
            Ok((keeper, run)) => (memory.keeper, memory.run) = (Some(keeper), Some(run)),
            Err(notice) => memory.notices.push(notice),
        }
        memory
    }

    /// Returns true if the program has never been used with this storage folder.
    pub(crate) fn is_first_use(&self) -> bool {
        self.is_first
    }

    /// Returns true if the last starts have failed, so that this one has to be a safe start.
    pub(crate) fn needs_safe_start(&self) -> bool {
        self.is_troubled
    }

    /// Recently opened files, the latest first.
    pub(crate) fn recent(&self) -> &[RecentFile] {
        &self.recent
    }

    /// Creates the cache of the recent files' thumbnails.
    pub(crate) fn recent_pictures(&self) -> RecentThumbnails {
        self.folder.as_deref().map_or_else(RecentThumbnails::default, RecentThumbnails::new)
    }

    /// Keeps a file that is deleted when the window is closed out of the lists of recent files, up axes and corrections.
    pub(crate) fn set_temporary_file(&mut self, source: &Path) {
        self.temporary = absolute_path(source);
    }

    fn is_temporary(&self, source: &Path) -> bool {
        self.temporary.is_some() && self.temporary == absolute_path(source)
    }

    /// Adds a file and the choice of its volume to the recent files. Built-in volumes have a menu of their own.
    pub(crate) fn add_recent(&mut self, source: &Path, choice: &VolumeChoice) {
        if is_builtin(source) || self.is_temporary(source) {
            return;
        }
        let path = std::path::absolute(source).unwrap_or_else(|_| source.to_owned());
        let latest = RecentFile { path, choice: choice.clone() };
        recent_files::put_first(&mut self.recent, latest.clone());
        if let Some(keeper) = &self.keeper {
            keeper.schedule_recent_file(latest);
        }
    }

    /// Returns the up axis for a file: the last one that the user has chosen in its folder; `None` without a choice.
    pub(crate) fn up_of(&self, source: &Path) -> Option<SceneAxis> {
        let folder = folder_of(source)?;
        self.standing.iter().find(|known| known.folder == folder).map(|known| known.up)
    }

    /// Remembers the up axis for the folder of a file. Built-in volumes have no folder.
    pub(crate) fn remember_up(&mut self, source: &Path, up: SceneAxis) {
        let Some(folder) = folder_of(source).filter(|_| !self.is_temporary(source)) else { return };
        let latest = FolderOrientation { folder, up };
        folder_orientation::put_first(&mut self.standing, latest.clone());
        if let Some(keeper) = &self.keeper {
            keeper.schedule_up_axis(latest);
        }
    }

    /// Returns the last corrections of a file, if it has any.
    pub(crate) fn corrections_of(&self, source: &Path) -> Option<CorrectedFile> {
        let whole = absolute_path(source)?;
        self.corrected.iter().find(|known| known.is_of_file(&whole)).cloned()
    }

    /// Remembers the corrections of a file. Built-in volumes are not remembered.
    pub(crate) fn remember_corrections(
        &mut self,
        source: &Path,
        stamp: FileStamp,
        opened_id: u64,
        by: Corrections,
    ) {
        let Some(file) = absolute_path(source).filter(|_| !self.is_temporary(source)) else { return };
        let latest = CorrectedFile::new(file, stamp, opened_id, by);
        corrected_files::put_first(&mut self.corrected, latest.clone());
        if let Some(keeper) = &self.keeper {
            keeper.schedule_corrections(latest);
        }
    }

    /// Runs that have ended, the latest first.
    pub(crate) fn earlier_runs(&self) -> &[EarlierRun] {
        &self.earlier
    }

    /// Returns true if a record is the look of an earlier run, which may open the volume that was open then.
    pub(crate) fn is_autosaved_look(&self, record: &Path) -> bool {
        self.earlier.iter().any(|run| run.look == record)
    }

    /// Path of the look of the previous run, if there is one.
    pub(crate) fn previous_look(&self) -> Option<PathBuf> {
        self.earlier.first().map(|run| run.look.clone())
    }

    /// Marks crashed runs as acknowledged: their looks stay in the list, and are not offered again.
    pub(crate) fn acknowledge_crashes(&mut self) {
        self.earlier.iter_mut().filter(|run| run.crashed).for_each(EarlierRun::acknowledge_crash);
    }

    /// Autosaves the look of a volume and of those that are shown with it, unless it is unchanged.
    pub(crate) fn autosave(&mut self, settings: &Settings, volumes: Vec<FieldOrigin>) {
        let is_known =
            self.kept.as_ref().is_some_and(|kept| kept.volumes == volumes && kept.settings == *settings);
        if let Some(keeper) = self.keeper.as_ref().filter(|_| !is_known) {
            keeper.schedule_look(settings, &volumes);
            self.kept = Some(LastAutosave { settings: settings.clone(), volumes });
        }
    }

    /// Autosaves a picture of the look as its thumbnail.
    pub(crate) fn autosave_thumbnail(&self, picture: Arc<ColorImage>) {
        let volume = self.kept.as_ref().and_then(|kept| kept.volumes.first());
        if let Some((keeper, volume)) = self.keeper.as_ref().zip(volume) {
            keeper.schedule_thumbnail(picture, &volume.source);
        }
    }

    /// Adds a notice for the user from before there was a window.
    pub(crate) fn add_notice(&mut self, notice: String) {
        self.notices.push(notice);
    }

    /// Takes the notices that the user has not seen yet.
    pub(crate) fn take_notices(&mut self) -> Vec<String> {
        let failure = self.keeper.as_ref().and_then(AutosaveThread::failure);
        let was_failing = std::mem::replace(&mut self.is_failing, failure.is_some());
        self.notices
            .extend(failure.filter(|_| !was_failing).map(|why| text::persistence::autosave_failed(&why)));
        std::mem::take(&mut self.notices)
    }

    /// Returns a handle that writes pending changes before the process terminates.
    pub(crate) fn emergency_save(&self) -> Option<EmergencySave> {
        self.keeper.as_ref().map(AutosaveThread::last_words)
    }
}

#[cfg(test)]
mod tests;
