//! Picture files of any size, written from bands of rows.

use std::path::Path;

use super::animation::embedded_record;
use super::{ExportError, PicturePixels, PixelRows, ReadPictureError, exr_file, png_file};
use chiaroscuro_files::check_extension;
use chiaroscuro_scene::{ImageSpec, PixelFormat};

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
    pub fn from_path(path: &Path) -> Self {
        let is_exr = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("exr"));
        if is_exr { Self::Exr } else { Self::Png }
    }

    /// Returns the depth in which this format stores a picture; PNG uses `wanted`, unless that is linear.
    pub fn supported_depth(self, wanted: PixelFormat) -> PixelFormat {
        match (self, wanted) {
            (Self::Exr, _) => PixelFormat::Linear,
            (Self::Png, PixelFormat::Sixteen) => PixelFormat::Sixteen,
            (Self::Png, _) => PixelFormat::Eight,
        }
    }
}

/// Writes a picture atomically, from bands of rows from the top.
///
/// It embeds a record ([`chiaroscuro_scene::LookRecord`]) as text. The encoding follows from the file name and from
/// [`ImageSpec::depth`], which must be supported by the format ([`PictureFormat::supported_depth`]).
///
/// # Errors
/// Returns the errors of `rows`; also when the format does not support the depth, or the file cannot be written.
pub fn write_picture<E: From<ExportError>>(
    path: &Path,
    image_spec: &ImageSpec,
    record: Option<&str>,
    rows: &mut dyn FnMut() -> Result<Option<PixelRows>, E>,
) -> Result<(), E> {
    check_picture(path, image_spec)?;
    match PictureFormat::from_path(path) {
        PictureFormat::Png => png_file::write(path, image_spec, record, rows),
        PictureFormat::Exr => exr_file::write(path, image_spec, record, rows),
    }
}

/// Checks before rendering that a picture can be written under a name.
///
/// # Errors
/// When the extension belongs to another format, or the format does not support the depth.
pub fn check_picture(path: &Path, image_spec: &ImageSpec) -> Result<(), ExportError> {
    check_extension(
        path,
        &["png", "exr"],
        "pictures are written as .png or .exr; the extension selects the format",
    )?;
    let format = PictureFormat::from_path(path);
    if format.supported_depth(image_spec.depth) != image_spec.depth {
        let what = match format {
            PictureFormat::Png => "PNG files hold 8 or 16 bits; EXR files hold linear light",
            PictureFormat::Exr => "EXR files hold linear light; PNG files hold 8 or 16 bits",
        };
        return Err(ExportError::UnsupportedByFormat { what, path: path.to_owned() });
    }
    Ok(())
}

/// Returns the columns and rows from a picture's header, without decoding it.
///
/// # Errors
/// When the file cannot be read, is not a picture, or claims more pixels than this program ever writes.
pub fn picture_size(path: &Path) -> Result<[u32; 2], ReadPictureError> {
    match PictureFormat::from_path(path) {
        PictureFormat::Png => png_file::size(path),
        PictureFormat::Exr => exr_file::size(path),
    }
}

/// Reads the pixels of a picture.
///
/// # Errors
/// When the file cannot be read or is not a picture.
pub fn read_picture(path: &Path) -> Result<PicturePixels, ReadPictureError> {
    match PictureFormat::from_path(path) {
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
    if let Some(found) = embedded_record::read_record(path) {
        return found;
    }
    match PictureFormat::from_path(path) {
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
        let mut image_spec = ImageSpec::new([1, 1]);
        for (name, depth, fits) in [
            ("a.png", PixelFormat::Eight, true),
            ("a.PNG", PixelFormat::Sixteen, true),
            ("a.png", PixelFormat::Linear, false),
            ("a.exr", PixelFormat::Eight, false),
            ("a.EXR", PixelFormat::Linear, true),
            ("a.gif", PixelFormat::Eight, false),
            ("a.JPG", PixelFormat::Eight, false),
            ("v1.5", PixelFormat::Eight, false),
            ("a.nrrd", PixelFormat::Eight, false),
            ("a", PixelFormat::Eight, false),
        ] {
            image_spec.depth = depth;
            let mut rows = match depth {
                PixelFormat::Eight => Some(PixelRows::Bytes(vec![0; 4])),
                _ => Some(PixelRows::Floats(vec![0.0; 4])),
            };
            let mut next = || Ok::<_, ExportError>(rows.take());
            let written = write_picture(&folder.path().join(name), &image_spec, None, &mut next);
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
        assert_eq!(
            PictureFormat::from_path(Path::new("a.exr")).supported_depth(PixelFormat::Sixteen),
            PixelFormat::Linear
        );
    }

    #[test]
    fn nothing_is_left_of_a_picture_that_fails() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["a.png", "a.exr"] {
            let path = folder.path().join(name);
            let depth = PictureFormat::from_path(&path).supported_depth(PixelFormat::Eight);
            let image_spec = ImageSpec { depth, ..ImageSpec::new([2, 40]) };
            let mut bands = 0;
            let mut next = || {
                bands += 1;
                match (bands, depth) {
                    (1, PixelFormat::Eight) => Ok(Some(PixelRows::Bytes(vec![0; 8 * 20]))),
                    (1, _) => Ok(Some(PixelRows::Floats(vec![0.0; 8 * 20]))),
                    _ => Err(ExportError::UnsupportedByFormat { what: "stop", path: "x".into() }),
                }
            };
            let err = write_picture(&path, &image_spec, None, &mut next).unwrap_err();
            assert!(err.to_string().starts_with("stop"), "{name}: {err}");
            // Too few rows are an error as well.
            let mut next = || Ok::<_, ExportError>(None);
            assert!(write_picture(&path, &image_spec, None, &mut next).is_err(), "{name}");
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
