//! Pictures that move: written frame by frame, so that a long turn takes no more memory than a short one.

mod apng;
pub(super) mod carried;
mod folder;
mod gif;
mod mp4;

pub use folder::frame_names;

use std::path::{Path, PathBuf};

use super::ExportError;

/// Kinds of files that move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AnimationFormat {
    /// PNG that moves: every colour; browsers show it.
    Apng,
    /// GIF: 256 colours; everything shows it.
    Gif,
    /// A video, made by ffmpeg.
    Mp4,
    /// A folder with a PNG file for each picture.
    Folder,
}

impl AnimationFormat {
    /// What a name stands for; nothing that it does not end like means a folder.
    pub fn of_path(path: &Path) -> Self {
        let ending = path.extension().map(std::ffi::OsStr::to_ascii_lowercase);
        match ending.as_ref().and_then(|ending| ending.to_str()) {
            Some("png" | "apng") => Self::Apng,
            Some("gif") => Self::Gif,
            Some("mp4") => Self::Mp4,
            _ => Self::Folder,
        }
    }

    /// The folder from which the records of pictures see their volume: that of the file, or the one of pictures.
    pub fn record_folder(path: &Path) -> Option<&Path> {
        if Self::of_path(path) == Self::Folder { Some(path) } else { path.parent() }
    }
}

/// What all pictures of a file that moves have in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AnimationSpec {
    /// Columns and rows.
    pub size: [u32; 2],
    /// How many there will be.
    pub frames: u32,
    /// How many a second.
    pub rate: u16,
    /// Whether their background is left out.
    pub transparent: bool,
}

/// Endings of pictures and videos that are no name for a folder.
const OTHERS: [&str; 10] = ["avi", "avif", "bmp", "exr", "jpeg", "jpg", "mkv", "mov", "webm", "webp"];

/// A kind of file that is being written.
trait AnimationEncoder: Send {
    /// Adds a picture.
    fn add(&mut self, shown: &[u8], record: &str) -> Result<(), ExportError>;

    /// Completes it.
    fn finish(self: Box<Self>) -> Result<(), ExportError>;
}

/// A file of pictures of one size that is being written. It takes its name when it is complete, and leaves
/// nothing when it is not; but pictures in a folder are complete one by one.
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
    /// Begins a file, of the kind that its name says, which repeats for ever where the kind can.
    ///
    /// # Errors
    /// When the folder cannot be written to, the kind of file cannot hold what is asked for, or ffmpeg is
    /// needed and not there.
    pub fn create(path: &Path, reel: &AnimationSpec) -> Result<Self, ExportError> {
        let ending = path.extension().map(std::ffi::OsStr::to_ascii_lowercase).unwrap_or_default();
        if OTHERS.iter().any(|other| ending == *other) {
            let what = "turns are written as .png, .gif, .mp4 or into a folder";
            return Err(ExportError::Unfit { what, path: path.to_owned() });
        }
        let encoder = Self::encoder(path, reel).map_err(ExportError::about(path))?;
        Ok(Self { encoder, path: path.to_owned() })
    }

    /// Adds a picture: sRGB bytes, RGBA, row by row from the top left; and how it was made.
    ///
    /// # Errors
    /// When the disk refuses, or the picture is one too many.
    pub fn add(&mut self, shown: &[u8], record: &str) -> Result<(), ExportError> {
        self.encoder.add(shown, record).map_err(ExportError::about(&self.path))
    }

    /// Completes the file.
    ///
    /// # Errors
    /// When the disk refuses, or pictures are missing; an older file of that name stays.
    pub fn finish(self) -> Result<(), ExportError> {
        self.encoder.finish().map_err(ExportError::about(&self.path))
    }

    /// What writes the kind of file that a name says.
    fn encoder(path: &Path, reel: &AnimationSpec) -> Result<Box<dyn AnimationEncoder>, ExportError> {
        Ok(match AnimationFormat::of_path(path) {
            AnimationFormat::Apng => Box::new(apng::Apng::create(path, reel)?),
            AnimationFormat::Gif => Box::new(gif::Gif::create(path, reel)?),
            AnimationFormat::Mp4 => Box::new(mp4::Mp4::create(path, reel, "ffmpeg".as_ref())?),
            AnimationFormat::Folder => Box::new(folder::Folder::create(path, reel)?),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What tests write.
    const REEL: AnimationSpec = AnimationSpec { size: [6, 4], frames: 3, rate: 24, transparent: false };

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
            assert_eq!(AnimationFormat::of_path(Path::new(name)), format, "{name}");
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
            let mut short = Animation::create(&path, &REEL).unwrap();
            short.add(&picture(1), "{}").unwrap();
            assert!(short.finish().is_err(), "two are missing");
            assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is left");
            for transparent in [false, true] {
                let mut whole = Animation::create(&path, &AnimationSpec { transparent, ..REEL }).unwrap();
                for at in 1..=3 {
                    whole.add(&picture(at), "{}").unwrap();
                }
                assert_eq!(path.exists(), transparent, "not yet, or that of before");
                whole.finish().unwrap();
            }
            std::fs::remove_file(&path).unwrap();
            assert!(Animation::create(&folder.path().join("no").join(name), &REEL).is_err());
        }
    }

    #[test]
    fn folders_have_a_file_for_each_picture() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("turn");
        let mut file = Animation::create(&path, &REEL).unwrap();
        for at in 0..3 {
            file.add(&picture(at), &format!("{{\"at\": {at}}}")).unwrap();
        }
        file.finish().unwrap();
        let last = path.join("0002.png");
        assert_eq!(crate::export::read_record(&last).unwrap().as_deref(), Some("{\"at\": 2}"));
        assert_eq!(image::open(&last).unwrap().to_rgba8().get_pixel(1, 0).0, [120, 10, 30, 255]);
        assert_eq!(std::fs::read_dir(&path).unwrap().count(), 3);
        // A shorter turn would be mixed with what is left of this one.
        assert!(Animation::create(&path, &AnimationSpec { frames: 2, ..REEL }).is_err());
        assert!(Animation::create(&path, &REEL).is_ok());
        for name in ["turn.webm", "turn.exr"] {
            assert!(Animation::create(&folder.path().join(name), &REEL).is_err(), "{name}");
        }
    }
}
