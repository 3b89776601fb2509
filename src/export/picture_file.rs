//! Pictures of any size as files, from bands of rows.

use std::path::Path;

use super::animation::carried;
use super::{ExportError, ReadPictureError, Rows, check_ending, exr_file, png_file};
use crate::model::{Depth, ImageSpec};

/// Kinds of picture files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureFormat {
    /// Display colours, 8 or 16 bits, straight alpha.
    Png,
    /// Linear light, 16-bit floats, premultiplied.
    Exr,
}

impl PictureFormat {
    /// What a name stands for: EXR where it ends so, else PNG.
    pub fn of_path(path: &Path) -> Self {
        let is_exr = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("exr"));
        if is_exr { Self::Exr } else { Self::Png }
    }

    /// The depth in which a file of this kind is written when its display colours would have `wanted`.
    pub fn depth(self, wanted: Depth) -> Depth {
        match (self, wanted) {
            (Self::Exr, _) => Depth::Linear,
            (Self::Png, Depth::Sixteen) => Depth::Sixteen,
            (Self::Png, _) => Depth::Eight,
        }
    }
}

/// Writes a picture whose rows come band by band from the top, whole or not at all.
///
/// It carries a record ([`crate::model::Record`]) as text. How its numbers are written follows from the name
/// and from [`ImageSpec::depth`], which must fit ([`PictureFormat::depth`]).
///
/// # Errors
/// What `rows` says; when the kind of file does not fit the depth, or the disk refuses.
pub fn write_picture<E: From<ExportError>>(
    path: &Path,
    shot: &ImageSpec,
    record: Option<&str>,
    rows: &mut dyn FnMut() -> Result<Option<Rows>, E>,
) -> Result<(), E> {
    check_picture(path, shot)?;
    match PictureFormat::of_path(path) {
        PictureFormat::Png => png_file::write(path, shot, record, rows),
        PictureFormat::Exr => exr_file::write(path, shot, record, rows),
    }
}

/// Says before anything is drawn whether a picture cannot be written under a name.
///
/// # Errors
/// When the name stands for another kind of file, or that kind does not fit the depth.
pub fn check_picture(path: &Path, shot: &ImageSpec) -> Result<(), ExportError> {
    check_ending(path, &["png", "exr"], "pictures are written as .png or .exr, and the name says as which")?;
    let format = PictureFormat::of_path(path);
    if format.depth(shot.depth) != shot.depth {
        let what = match format {
            PictureFormat::Png => "PNG files hold 8 or 16 bits; EXR files hold linear light",
            PictureFormat::Exr => "EXR files hold linear light; PNG files hold 8 or 16 bits",
        };
        return Err(ExportError::Unfit { what, path: path.to_owned() });
    }
    Ok(())
}

/// A picture's columns and rows: what its header says, and nothing is decoded.
///
/// # Errors
/// When the file cannot be read, is no picture, or claims more pixels than any that this program makes.
pub fn picture_size(path: &Path) -> Result<[u32; 2], ReadPictureError> {
    match PictureFormat::of_path(path) {
        PictureFormat::Png => png_file::size(path),
        PictureFormat::Exr => exr_file::size(path),
    }
}

/// A picture's columns and rows, and all its rows: bytes of 8-bit PNG, else floats.
///
/// # Errors
/// When the file cannot be read or is no picture.
pub fn read_picture(path: &Path) -> Result<([u32; 2], Rows), ReadPictureError> {
    match PictureFormat::of_path(path) {
        PictureFormat::Png => png_file::read(path),
        PictureFormat::Exr => exr_file::read(path),
    }
}

/// Whether a file may carry a record, by its name: a picture, or one that moves.
pub fn may_carry_record(path: &Path) -> bool {
    let is_one = |ending: &str| path.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending));
    ["png", "exr", "gif", "mp4"].into_iter().any(is_one)
}

/// The record that a picture file carries, or one that moves, if it does.
///
/// # Errors
/// When the file cannot be read or is no picture.
pub fn read_record(path: &Path) -> Result<Option<String>, ReadPictureError> {
    if let Some(found) = carried::read_record(path) {
        return found;
    }
    match PictureFormat::of_path(path) {
        PictureFormat::Png => png_file::read_record(path),
        PictureFormat::Exr => exr_file::read_record(path),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_say_what_files_hold() {
        let folder = tempfile::tempdir().unwrap();
        let mut shot = ImageSpec::new([1, 1]);
        for (name, depth, fits) in [
            ("a.png", Depth::Eight, true),
            ("a.PNG", Depth::Sixteen, true),
            ("a.png", Depth::Linear, false),
            ("a.exr", Depth::Eight, false),
            ("a.EXR", Depth::Linear, true),
            ("a.gif", Depth::Eight, false),
            ("a.JPG", Depth::Eight, false),
            ("v1.5", Depth::Eight, false),
            ("a.nrrd", Depth::Eight, false),
            ("a", Depth::Eight, false),
        ] {
            shot.depth = depth;
            let mut rows = match depth {
                Depth::Eight => Some(Rows::Bytes(vec![0; 4])),
                _ => Some(Rows::Floats(vec![0.0; 4])),
            };
            let mut next = || Ok::<_, ExportError>(rows.take());
            let written = write_picture(&folder.path().join(name), &shot, None, &mut next);
            assert_eq!(written.is_ok(), fits, "{name} {depth:?}: {written:?}");
        }
        for (name, may) in [
            ("a.PNG", true),
            ("b.Exr", true),
            ("c.json", false),
            ("png", false),
            ("d.gif", true),
            ("e.MP4", true),
        ] {
            assert_eq!(may_carry_record(Path::new(name)), may, "{name}");
        }
        assert_eq!(PictureFormat::of_path(Path::new("a.exr")).depth(Depth::Sixteen), Depth::Linear);
    }

    #[test]
    fn nothing_is_left_of_a_picture_that_fails() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["a.png", "a.exr"] {
            let path = folder.path().join(name);
            let depth = PictureFormat::of_path(&path).depth(Depth::Eight);
            let shot = ImageSpec { depth, ..ImageSpec::new([2, 40]) };
            let mut bands = 0;
            let mut next = || {
                bands += 1;
                match (bands, depth) {
                    (1, Depth::Eight) => Ok(Some(Rows::Bytes(vec![0; 8 * 20]))),
                    (1, _) => Ok(Some(Rows::Floats(vec![0.0; 8 * 20]))),
                    _ => Err(ExportError::Unfit { what: "stop", path: "x".into() }),
                }
            };
            let err = write_picture(&path, &shot, None, &mut next).unwrap_err();
            assert!(err.to_string().starts_with("stop"), "{name}: {err}");
            // Rows that end too early are no picture, either.
            let mut next = || Ok::<_, ExportError>(None);
            assert!(write_picture(&path, &shot, None, &mut next).is_err(), "{name}");
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
