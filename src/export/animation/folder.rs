//! Image sequence: a folder with one PNG file per frame, each with its record.

use std::path::{Path, PathBuf};

use super::{AnimationEncoder, AnimationSpec};
use crate::export::{ExportError, export_png, make_folder};

/// Returns the file name of a frame.
fn name(at: u32) -> String {
    format!("{at:04}.png")
}

/// Returns the paths of all frames in a folder.
pub fn frame_names(folder: &Path, frames: u32) -> Vec<PathBuf> {
    (0..frames).map(|at| folder.join(name(at))).collect()
}

/// Writer of an image sequence in a folder.
pub(super) struct Folder {
    path: PathBuf,
    reel: AnimationSpec,
    written: u32,
}

impl Folder {
    pub(super) fn create(path: &Path, reel: &AnimationSpec) -> Result<Self, ExportError> {
        if path.join(name(reel.frames)).exists() {
            let what = "the folder holds the pictures of a longer turn; another folder keeps them apart";
            return Err(ExportError::Unfit { what, path: path.to_owned() });
        }
        make_folder(path).map_err(ExportError::writing(path))?;
        Ok(Self { path: path.to_owned(), reel: *reel, written: 0 })
    }
}

impl AnimationEncoder for Folder {
    fn add(&mut self, shown: &[u8], record: &str) -> Result<(), ExportError> {
        let path = self.path.join(name(self.written));
        export_png(self.reel.size, shown, self.reel.transparent, Some(record), &path)?;
        self.written += 1;
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), ExportError> {
        Ok(())
    }
}
