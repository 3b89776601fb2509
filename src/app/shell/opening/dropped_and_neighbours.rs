//! Dropped files and folders, and the next and previous file of a folder.

use std::path::{Path, PathBuf};

use super::VolumeOpener;
use super::plan::PendingLook;
use crate::app::text;
use crate::app::windows::file_dialogs;
use crate::app::worker::jobs::{JobControl, JobKind};
use crate::app::worker::loader::ReadChoices;
use chiaroscuro_volume::LoadControl;
use chiaroscuro_volume_io::neighbour_volume;

/// File extensions of possible slices of one volume; DICOM files often have none.
const SLICE_EXTENSIONS: [&str; 9] = ["dcm", "dicom", "ima", "png", "jpg", "jpeg", "bmp", "tif", "tiff"];

impl VolumeOpener<'_> {
    /// Opens files that were dropped on the window. Several files of one type in one folder are slices of a volume;
    /// of other files the first is opened.
    pub(crate) fn open_dropped(&mut self, paths: &[PathBuf]) {
        let Some(first) = paths.first() else { return };
        if let Some(folder) = slice_folder(paths) {
            if is_complete_folder(folder, paths) {
                self.open(folder);
                self.editor.messages.note(text::opening::folder_of_dropped(paths.len(), folder));
                return;
            }
            // The message was about another file.
            self.editor.messages.dismiss();
            let reading = ReadChoices { subset: Some(paths.into()), ..ReadChoices::default() };
            if self.start_loading(folder, reading) {
                self.state.requests.pending_look = None;
                self.editor.messages.note(text::opening::part_of_folder(paths.len(), folder));
            }
            return;
        }
        self.open(first);
        self.state.second_volume.note_dropped(first);
        if paths.len() > 1 {
            self.editor.messages.note(text::opening::first_of_dropped(paths.len(), first));
        }
    }

    /// Searches the folder for the file after or before the open one.
    pub(crate) fn seek_neighbour(&mut self, is_forward: bool) {
        // Pressing the key again goes on from the file that is being opened.
        let opening = self.state.loader.progress().map(|progress| progress.source.to_owned());
        let from =
            opening.or_else(|| self.editor.document.volume.as_ref().map(|volume| volume.source.clone()));
        let Some(from) = from.filter(|from| from.exists()) else {
            return self.editor.messages.note(text::opening::NO_FOLDER);
        };
        let task = move |job: &JobControl| {
            let control = LoadControl::with_token(job.token().clone());
            // Pictures with an embedded look are no volumes.
            neighbour_volume(&from, is_forward, |path| !file_dialogs::carries_look(path), &control)
        };
        let search = &mut self.state.next_file_search;
        if let Err(err) = search.start(JobKind::NextFile, self.ctx, is_forward, task) {
            self.editor.messages.error(text::opening::NOT_OPENED, text::opening::no_thread(err));
        }
    }

    /// Opens the file that the search has found.
    pub(crate) fn take_neighbour(&mut self) {
        let Some((is_forward, found)) = self.state.next_file_search.take_ended() else { return };
        match found {
            Ok(Some(path)) => {
                if self.start_loading(&path, ReadChoices::default()) {
                    self.state.requests.pending_look = Some(PendingLook::CurrentIfSimilar);
                }
            }
            Ok(None) => self.editor.messages.note(text::opening::no_neighbour(is_forward)),
            Err(panic) => self.editor.messages.error(text::opening::NOT_OPENED, panic),
        }
    }
}

/// File extension in lower case, without the dot.
fn lowercase_extension(path: &Path) -> Option<String> {
    path.extension().map(|ending| ending.to_string_lossy().to_lowercase())
}

/// Returns true if a folder has no further files of the same type, apart from hidden ones.
fn is_complete_folder(folder: &Path, paths: &[PathBuf]) -> bool {
    let Some(kind) = paths.first().map(|path| lowercase_extension(path)) else { return false };
    let is_other = |path: &Path| {
        let is_hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
        !is_hidden && lowercase_extension(path) == kind && path.is_file()
    };
    let found = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    // Large folders: one file more than these is enough.
    found.filter(|path| is_other(path)).take(paths.len() + 1).count() <= paths.len()
}

/// Returns the folder of files that may be slices of one volume: all of one type, in one folder.
fn slice_folder(paths: &[PathBuf]) -> Option<&Path> {
    let (first, others) = paths.split_first()?;
    let is_slice =
        lowercase_extension(first).is_none_or(|ending| SLICE_EXTENSIONS.contains(&ending.as_str()));
    let is_like = |other: &PathBuf| {
        lowercase_extension(other) == lowercase_extension(first) && other.parent() == first.parent()
    };
    let are_slices = !others.is_empty() && is_slice && others.iter().all(is_like);
    are_slices.then(|| first.parent()).flatten().filter(|_| paths.iter().all(|path| path.is_file()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slices_are_of_one_kind_and_in_one_folder() {
        let folder = tempfile::tempdir().unwrap();
        let files = |names: &[&str]| -> Vec<PathBuf> {
            names
                .iter()
                .map(|name| {
                    let path = folder.path().join(name);
                    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
                    std::fs::write(&path, "x").unwrap();
                    path
                })
                .collect()
        };
        assert_eq!(slice_folder(&files(&["1.dcm", "2.DCM"])), Some(folder.path()));
        assert_eq!(slice_folder(&files(&["IM1", "IM2"])), Some(folder.path()));
        let all = files(&["1.png", "2.png", "3.png"]);
        assert!(is_complete_folder(folder.path(), &all) && !is_complete_folder(folder.path(), &all[..2]));
        for others in [&["1.dcm"][..], &["1.dcm", "2.png"], &["a.nrrd", "b.nrrd"], &["1.dcm", "s/2.dcm"]] {
            assert_eq!(slice_folder(&files(others)), None, "{others:?}");
        }
    }
}
