//! Image sequence: a folder with one PNG file per frame, each with its record.

use std::path::{Path, PathBuf};

use super::{AnimationEncoder, AnimationSpec};
use crate::{ExportError, export_png};
use chiaroscuro_files::make_folder;

/// Returns the file name of a frame.
fn frame_name(at: u32) -> String {
    format!("{at:04}.png")
}

/// Returns the paths of all frames in a folder.
pub fn frame_names(folder: &Path, frames: u32) -> Vec<PathBuf> {
    (0..frames).map(|at| folder.join(frame_name(at))).collect()
}

/// Folder of the frames of an animation, which may be written in any order and by several programs.
#[derive(Debug)]
pub struct FrameFolder {
    path: PathBuf,
    animation_spec: AnimationSpec,
}

impl FrameFolder {
    /// Opens the folder of an animation, and makes it if it does not exist.
    ///
    /// # Errors
    /// When the folder cannot be made, or contains the frames of a longer animation.
    pub fn create(path: &Path, animation_spec: &AnimationSpec) -> Result<Self, ExportError> {
        if path.join(frame_name(animation_spec.frames)).exists() {
            let what = "the folder contains the frames of a longer animation; choose another folder";
            return Err(ExportError::UnsupportedByFormat { what, path: path.to_owned() });
        }
        make_folder(path).map_err(ExportError::io_error_for(path))?;
        Ok(Self { path: path.to_owned(), animation_spec: *animation_spec })
    }

    /// Writes a frame, whose file gets its name when it is complete: sRGB bytes, RGBA, row by row from the top left; and
    /// its record.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self, at: u32, shown: &[u8], record: &str) -> Result<(), ExportError> {
        let AnimationSpec { size, transparent, .. } = self.animation_spec;
        export_png(size, shown, transparent, Some(record), &self.path.join(frame_name(at)))
    }
}

/// Writer of an image sequence in a folder.
pub(super) struct ImageSequenceWriter {
    folder: FrameFolder,
    written: u32,
}

impl ImageSequenceWriter {
    pub(super) fn create(path: &Path, animation_spec: &AnimationSpec) -> Result<Self, ExportError> {
        Ok(Self { folder: FrameFolder::create(path, animation_spec)?, written: 0 })
    }
}

impl AnimationEncoder for ImageSequenceWriter {
    fn add(&mut self, shown: &[u8], record: &str) -> Result<(), ExportError> {
        self.folder.write(self.written, shown, record)?;
        self.written += 1;
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), ExportError> {
        Ok(())
    }
}
