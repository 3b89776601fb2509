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

/// Writer of an image sequence in a folder.
pub(super) struct ImageSequenceWriter {
    path: PathBuf,
    animation_spec: AnimationSpec,
    written: u32,
}

impl ImageSequenceWriter {
    pub(super) fn create(path: &Path, animation_spec: &AnimationSpec) -> Result<Self, ExportError> {
        if path.join(frame_name(animation_spec.frames)).exists() {
            let what = "the folder contains the frames of a longer turntable; choose another folder";
            return Err(ExportError::UnsupportedByFormat { what, path: path.to_owned() });
        }
        make_folder(path).map_err(ExportError::io_error_for(path))?;
        Ok(Self { path: path.to_owned(), animation_spec: *animation_spec, written: 0 })
    }
}

impl AnimationEncoder for ImageSequenceWriter {
    fn add(&mut self, shown: &[u8], record: &str) -> Result<(), ExportError> {
        let path = self.path.join(frame_name(self.written));
        export_png(self.animation_spec.size, shown, self.animation_spec.transparent, Some(record), &path)?;
        self.written += 1;
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), ExportError> {
        Ok(())
    }
}
