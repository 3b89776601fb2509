//! Picture files of any size, written from bands of rows.

use std::path::Path;

use super::animation::carried;
use super::{ExportError, ReadPictureError, Rows, check_ending, exr_file, png_file};
use crate::model::{Depth, ImageSpec};

/// File format of a still picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureFormat {
    /// Display colours in 8 or 16 bits, with straight alpha.
    Png,
    /// Linear light in 16-bit floats, with premultiplied alpha.
    Exr,
}

impl PictureFormat {
    /// Returns the format of a file name: EXR for `.exr`, otherwise PNG.
    pub fn of_path(path: &Path) -> Self {
        let is_exr = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("exr"));
        if is_exr { Self::Exr } else { Self::Png }
    }

    /// Returns the depth in which this format stores a picture; PNG uses `wanted`, unless that is linear.
    pub fn depth(self, wanted: Depth) -> Depth {
        match (self, wanted) {
            (Self::Exr, _) => Depth::Linear,
            (Self::Png, Depth::Sixteen) => Depth::Sixteen,
            (Self::Png, _) => Depth::Eight,
        }
    }
}

/// Writes a picture atomically, from bands of rows from the top.
///
/// It embeds a record ([`crate::model::Record`]) as text. The encoding follows from the file name and from
/// [`ImageSpec::depth`], which must be supported by the format ([`PictureFormat::depth`]).
///
/// # Errors
/// Returns the errors of `rows`; also when the format does not support the depth, or the file cannot be written.
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

/// Checks before rendering that a picture can be written under a name.
///
/// # Errors
/// When the extension belongs to another format, or the format does not support the depth.
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

/// Returns the columns and rows from a picture's header, without decoding it.
///
/// # Errors
/// When the file cannot be read, is not a picture, or claims more pixels than this program ever writes.
pub fn picture_size(path: &Path) -> Result<[u32; 2], ReadPictureError> {
    match PictureFormat::of_path(path) {
        PictureFormat::Png => png_file::size(path),
        PictureFormat::Exr => exr_file::size(path),
    }
}

/// Reads a picture: its columns and rows, and all rows as bytes (8-bit PNG) or floats.
///
/// # Errors
/// When the file cannot be read or is not a picture.
pub fn read_picture(path: &Path) -> Result<([u32; 2], Rows), ReadPictureError> {
    match PictureFormat::of_path(path) {
        PictureFormat::Png => png_file::read(path),
        PictureFormat::Exr => exr_file::read(path),
    }
}

/// Returns true if a file may embed a record, by its extension: pictures and animations.
pub fn may_carry_record(path: &Path) -> bool {
    let is_one = |ending: &str| path.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending));
    ["png", "exr", "gif", "mp4"].into_iter().any(is_one)
}

/// Reads the record embedded in a picture or animation, if there is one.
///
/// # Errors
/// When the file cannot be read or is not a picture.
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
            // Too few rows are an error as well.
            let mut next = || Ok::<_, ExportError>(None);
            assert!(write_picture(&path, &shot, None, &mut next).is_err(), "{name}");
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
