//! Pictures that move, as PNG (APNG): written frame by frame, so that a long turn takes no more memory than a
//! short one.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use super::export::{ExportError, place, rgb, temporary_beside};

/// A file of pictures of one size that is being written. It takes its name when it is complete; programs that
/// do not know of such files show the first picture.
pub struct Animation {
    writer: png::Writer<BufWriter<File>>,
    file: tempfile::NamedTempFile,
    path: PathBuf,
    transparent: bool,
}

impl std::fmt::Debug for Animation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Animation").field("path", &self.path).finish_non_exhaustive()
    }
}

impl Animation {
    /// Begins a file for so many pictures, `rate` of them a second, again and again.
    ///
    /// # Errors
    /// When the folder cannot be written to.
    pub fn create(
        path: &Path,
        [width, height]: [u32; 2],
        frames: u32,
        transparent: bool,
        rate: u16,
    ) -> Result<Self, ExportError> {
        let failed = |source| ExportError::Write { path: path.to_owned(), source };
        let file = temporary_beside(path)?;
        let mut encoder = png::Encoder::new(BufWriter::new(file.reopen().map_err(failed)?), width, height);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_color(if transparent { png::ColorType::Rgba } else { png::ColorType::Rgb });
        encoder.set_animated(frames, 0)?;
        encoder.set_frame_delay(1, rate)?;
        encoder.validate_sequence(true);
        Ok(Self { writer: encoder.write_header()?, file, path: path.to_owned(), transparent })
    }

    /// Adds a picture: sRGB bytes, RGBA, row by row from the top left.
    ///
    /// # Errors
    /// When the disk refuses, or the picture is one too many.
    pub fn add(&mut self, shown: &[u8]) -> Result<(), ExportError> {
        if self.transparent {
            self.writer.write_image_data(shown)?;
        } else {
            self.writer.write_image_data(&rgb(shown))?;
        }
        Ok(())
    }

    /// Completes the file.
    ///
    /// # Errors
    /// When the disk refuses, or pictures are missing; an older file of that name stays.
    pub fn finish(self) -> Result<(), ExportError> {
        self.writer.finish()?;
        place(self.file, &self.path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_have_all_their_pictures_or_do_not_exist() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let picture = |at: u8| vec![at; 4 * 6];
        let mut short = Animation::create(&path, [3, 2], 3, false, 10).unwrap();
        short.add(&picture(1)).unwrap();
        assert!(short.finish().is_err(), "two are missing");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is left");
        let mut whole = Animation::create(&path, [3, 2], 3, true, 10).unwrap();
        for at in 1..=3 {
            whole.add(&picture(at)).unwrap();
        }
        assert!(!path.exists(), "not yet");
        whole.finish().unwrap();
        let decoder = png::Decoder::new(std::io::BufReader::new(File::open(&path).unwrap()));
        let info = decoder.read_info().unwrap();
        assert_eq!(info.info().animation_control().unwrap().num_frames, 3);
        assert!(Animation::create(&folder.path().join("no/b.png"), [3, 2], 3, true, 10).is_err());
    }
}
