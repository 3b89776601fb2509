//! Thumbnails of recent files, with the last picture of each: one file each, in a folder of their own.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui::{self, ColorImage, TextureHandle, TextureOptions};

use super::recent_files::{RecentFile, encode_entry};
use super::{is_builtin, thumbnail};
use chiaroscuro_files::fingerprint;

/// Name of the folder, beside the list.
const FOLDER: &str = "recent";

/// Maximum number of directory entries that are read: far more than are kept.
const MOST_NAMES: usize = 300;

/// Path of a file's thumbnail, named by a hash of the file's path.
fn thumbnail_path(folder: &Path, file: &Path) -> PathBuf {
    folder.join(FOLDER).join(format!("{:016x}.png", fingerprint(&encode_entry(file))))
}

/// Writes the thumbnail of a file. Built-in volumes are not in the list.
pub(super) fn write(folder: &Path, file: &Path, picture: &ColorImage) -> Result<(), String> {
    if is_builtin(file) {
        return Ok(());
    }
    chiaroscuro_files::make_folder(&folder.join(FOLDER)).map_err(|err| err.to_string())?;
    let whole = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    thumbnail::write(picture, &thumbnail_path(folder, &whole))
}

/// Removes thumbnails of files that are no longer in the list.
pub(super) fn remove_unlisted(folder: &Path, listed: &[RecentFile]) {
    let kept: Vec<PathBuf> = listed.iter().map(|file| thumbnail_path(folder, &file.path)).collect();
    let names = std::fs::read_dir(folder.join(FOLDER)).into_iter().flatten().flatten();
    for path in names.take(MOST_NAMES).map(|entry| entry.path()) {
        let is_ours = path.extension().is_some_and(|ending| ending == "png");
        if is_ours && !kept.contains(&path) {
            chiaroscuro_files::remove_own_file(&path);
        }
    }
}

/// Cache of thumbnails for the menu, read when it is first opened after a file was opened.
#[derive(Default)]
pub(crate) struct RecentThumbnails {
    folder: Option<PathBuf>,
    read: Vec<(PathBuf, Option<TextureHandle>)>,
}

impl RecentThumbnails {
    /// Creates a cache for the thumbnails in a folder.
    pub(super) fn new(folder: &Path) -> Self {
        Self { folder: Some(folder.to_owned()), read: Vec::new() }
    }

    /// Drops all thumbnails, so that changed ones are read.
    pub(crate) fn clear(&mut self) {
        self.read.clear();
    }

    /// Returns the thumbnail of a file, if there is one.
    pub(crate) fn get(&mut self, file: &Path, ctx: &egui::Context) -> Option<TextureHandle> {
        let folder = self.folder.as_ref()?;
        if let Some((_, known)) = self.read.iter().find(|(known, _)| known == file) {
            return known.clone();
        }
        let picture = thumbnail::read(&thumbnail_path(folder, file))
            .map(|picture| ctx.load_texture("recent file", Arc::new(picture), TextureOptions::LINEAR));
        self.read.push((file.to_owned(), picture.clone()));
        picture
    }
}

#[cfg(test)]
mod tests {
    use egui::Color32;

    use super::*;
    use chiaroscuro_volume::VolumeChoice;

    #[test]
    fn pictures_belong_to_their_files_and_go_with_them() {
        let folder = tempfile::tempdir().unwrap();
        let (a, b) = (Path::new("/data/a.nrrd"), Path::new("/data/b.nrrd"));
        write(folder.path(), a, &ColorImage::filled([4, 3], Color32::RED)).unwrap();
        write(folder.path(), b, &ColorImage::filled([6, 3], Color32::BLUE)).unwrap();
        write(folder.path(), Path::new("builtin:chair"), &ColorImage::filled([9, 9], Color32::RED)).unwrap();
        let ctx = egui::Context::default();
        let mut pictures = RecentThumbnails::new(folder.path());
        assert_eq!(pictures.get(a, &ctx).unwrap().size(), [4, 3]);
        assert_eq!(pictures.get(b, &ctx).unwrap().size(), [6, 3]);
        assert!(pictures.get(Path::new("/data/c.nrrd"), &ctx).is_none());
        let listed = [RecentFile { path: b.to_owned(), choice: VolumeChoice::default() }];
        remove_unlisted(folder.path(), &listed);
        assert!(pictures.get(a, &ctx).is_some(), "what was read stays until it is forgotten");
        pictures.clear();
        assert!(pictures.get(a, &ctx).is_none() && pictures.get(b, &ctx).is_some());
        assert!(RecentThumbnails::default().get(b, &ctx).is_none(), "nothing is remembered");
    }
}
