//! Animations: written frame by frame, so that a long turn takes no more memory than a short one.

mod apng;
pub(super) mod embedded_record;
mod gif;
mod image_sequence;
mod mp4;

pub use image_sequence::{FrameFolder, frame_names};

use std::path::{Path, PathBuf};

use super::ExportError;

/// File format of an animation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AnimationFormat {
    /// Animated PNG: full colour; supported by browsers.
    Apng,
    /// GIF: 256 colours; supported everywhere.
    Gif,
    /// MP4 video, encoded by ffmpeg.
    Mp4,
    /// Folder with a PNG file for each frame.
    Folder,
}

impl AnimationFormat {
    /// Returns the format of a path by its extension; unknown extensions mean a folder.
    pub fn from_path(path: &Path) -> Self {
        let ending = path.extension().map(std::ffi::OsStr::to_ascii_lowercase);
        match ending.as_ref().and_then(|ending| ending.to_str()) {
            Some("png" | "apng") => Self::Apng,
            Some("gif") => Self::Gif,
            Some("mp4") => Self::Mp4,
            _ => Self::Folder,
        }
    }

    /// Returns the folder that paths of volumes in records are relative to: the file's, or the folder of frames.
    pub fn record_folder(path: &Path) -> Option<&Path> {
        if Self::from_path(path) == Self::Folder { Some(path) } else { path.parent() }
    }
}

/// Parameters of an animation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AnimationSpec {
    /// Columns and rows of each frame.
    pub size: [u32; 2],
    /// Number of frames.
    pub frames: u32,
    /// Frames per second.
    pub rate: u16,
    /// True if the background is transparent.
    pub transparent: bool,
}

/// Extensions of other picture and video formats, which are not accepted as folder names.
const UNSUPPORTED_EXTENSIONS: [&str; 10] =
    ["avi", "avif", "bmp", "exr", "jpeg", "jpg", "mkv", "mov", "webm", "webp"];

/// Encoder of one animation format.
trait AnimationEncoder: Send {
    /// Adds a frame: sRGB bytes, RGBA, with its record.
    fn add(&mut self, shown: &[u8], record: &str) -> Result<(), ExportError>;

    /// Completes the file and gives it its name.
    fn finish(self: Box<Self>) -> Result<(), ExportError>;
}

/// Animation that is being written, with frames of equal size. The file gets its name when it is complete, and leaves
/// nothing behind otherwise; in a folder, each frame is complete by itself.
pub struct Animation {
    encoder: Box<dyn AnimationEncoder>,
    path: PathBuf,
}

impl std::fmt::Debug for Animation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Animation").finish_non_exhaustive()
    }
}

impl Animation {
    /// Starts an animation in the format of its extension, looping endlessly if the format supports that.
    ///
    /// # Errors
    /// When the folder cannot be written to, the format does not support the parameters, or ffmpeg is needed and
    /// missing.
    pub fn create(path: &Path, animation_spec: &AnimationSpec) -> Result<Self, ExportError> {
        let ending = path.extension().map(std::ffi::OsStr::to_ascii_lowercase).unwrap_or_default();
        if UNSUPPORTED_EXTENSIONS.iter().any(|other| ending == *other) {
            let what = "animations are written as .png, .gif, .mp4 or into a folder";
            return Err(ExportError::UnsupportedByFormat { what, path: path.to_owned() });
        }
        let encoder = Self::encoder(path, animation_spec).map_err(ExportError::with_path(path))?;
        Ok(Self { encoder, path: path.to_owned() })
    }

    /// Adds a frame: sRGB bytes, RGBA, row by row from the top left; and its record.
    ///
    /// # Errors
    /// When the file cannot be written, or there are too many frames.
    pub fn add(&mut self, shown: &[u8], record: &str) -> Result<(), ExportError> {
        self.encoder.add(shown, record).map_err(ExportError::with_path(&self.path))
    }

    /// Completes the file.
    ///
    /// # Errors
    /// When the file cannot be written, or frames are missing; an older file of that name stays.
    pub fn finish(self) -> Result<(), ExportError> {
        self.encoder.finish().map_err(ExportError::with_path(&self.path))
    }

    /// Returns the encoder for the format of a path.
    fn encoder(
        path: &Path,
        animation_spec: &AnimationSpec,
    ) -> Result<Box<dyn AnimationEncoder>, ExportError> {
        Ok(match AnimationFormat::from_path(path) {
            AnimationFormat::Apng => Box::new(apng::ApngWriter::create(path, animation_spec)?),
            AnimationFormat::Gif => Box::new(gif::GifWriter::create(path, animation_spec)?),
            AnimationFormat::Mp4 => {
                Box::new(mp4::Mp4Writer::create(path, animation_spec, "ffmpeg".as_ref())?)
            }
            AnimationFormat::Folder => {
                Box::new(image_sequence::ImageSequenceWriter::create(path, animation_spec)?)
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Parameters of the animations in these tests.
    const TEST_ANIMATION: AnimationSpec =
        AnimationSpec { size: [6, 4], frames: 3, rate: 24, transparent: false };

    fn picture(at: u8) -> Vec<u8> {
        (0..24).flat_map(|i| [at * 60, i * 10, 30, if i == 0 { 0 } else { 255 }]).collect()
    }

    #[test]
    fn names_say_what_is_meant() {
        for (name, format) in [
            ("a.PNG", AnimationFormat::Apng),
            ("a.apng", AnimationFormat::Apng),
            ("a.gif", AnimationFormat::Gif),
            ("a.Mp4", AnimationFormat::Mp4),
            ("frames", AnimationFormat::Folder),
            ("v1.5", AnimationFormat::Folder),
        ] {
            assert_eq!(AnimationFormat::from_path(Path::new(name)), format, "{name}");
        }
        for (path, folder) in [("a/turn.gif", "a"), ("a/frames", "a/frames")] {
            assert_eq!(AnimationFormat::record_folder(Path::new(path)), Some(Path::new(folder)));
        }
    }

    #[test]
    fn files_have_all_their_pictures_or_do_not_exist() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["a.png", "a.gif"] {
            let path = folder.path().join(name);
            let mut short = Animation::create(&path, &TEST_ANIMATION).unwrap();
            short.add(&picture(1), "{}").unwrap();
            assert!(short.finish().is_err(), "two are missing");
            assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is left");
            for transparent in [false, true] {
                let mut whole =
                    Animation::create(&path, &AnimationSpec { transparent, ..TEST_ANIMATION }).unwrap();
                for at in 1..=3 {
                    whole.add(&picture(at), "{}").unwrap();
                }
                assert_eq!(path.exists(), transparent, "not yet, or that of before");
                whole.finish().unwrap();
            }
            std::fs::remove_file(&path).unwrap();
            assert!(Animation::create(&folder.path().join("no").join(name), &TEST_ANIMATION).is_err());
        }
    }

    #[test]
    fn folders_have_a_file_for_each_picture() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("turn");
        let mut file = Animation::create(&path, &TEST_ANIMATION).unwrap();
        for at in 0..3 {
            file.add(&picture(at), &format!("{{\"at\": {at}}}")).unwrap();
        }
        file.finish().unwrap();
        let last = path.join("0002.png");
        assert_eq!(crate::read_record(&last).unwrap().as_deref(), Some("{\"at\": 2}"));
        assert_eq!(image::open(&last).unwrap().to_rgba8().get_pixel(1, 0).0, [120, 10, 30, 255]);
        assert_eq!(std::fs::read_dir(&path).unwrap().count(), 3);
        // Frames may be written in any order.
        let frames = FrameFolder::create(&path, &TEST_ANIMATION).unwrap();
        let bytes = std::fs::read(&last).unwrap();
        std::fs::remove_file(&last).unwrap();
        frames.write(2, &picture(2), "{\"at\": 2}").unwrap();
        assert!(std::fs::read(&last).unwrap() == bytes);
        // A shorter turn would be mixed with the remaining frames of this one.
        assert!(Animation::create(&path, &AnimationSpec { frames: 2, ..TEST_ANIMATION }).is_err());
        assert!(Animation::create(&path, &TEST_ANIMATION).is_ok());
        for name in ["turn.webm", "turn.exr"] {
            assert!(Animation::create(&folder.path().join(name), &TEST_ANIMATION).is_err(), "{name}");
        }
    }
}
