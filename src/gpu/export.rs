//! Pictures as files.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use image::ImageEncoder as _;

use super::Picture;

/// Why a file could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The encoder refused.
    #[error("the picture could not be encoded: {0}")]
    Encode(#[from] image::ImageError),
    /// The disk refused.
    #[error("could not write: {source} ({path}); a folder that exists and can be written to helps")]
    Write {
        /// What was to be written.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
}

/// Writes a file whole or not at all: to a temporary file beside it, which then takes its name.
///
/// # Errors
/// When the folder cannot be written to or the disk is full; an older file of that name stays.
pub fn write_atomically(path: &Path, contents: &[u8]) -> Result<(), ExportError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let failed = |source| ExportError::Write { path: path.to_owned(), source };
    // The temporary file's own name means nothing to the user: keep the kind of error alone.
    let mut file = tempfile::Builder::new()
        .prefix(".chiaroscuro-")
        .suffix(".part")
        .tempfile_in(folder)
        .map_err(|err| failed(err.kind().into()))?;
    file.write_all(contents).map_err(failed)?;
    // Otherwise a crash just after the rename could leave an empty file under the old name.
    file.as_file().sync_all().map_err(failed)?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // Temporary files are private; an ordinary file is readable by everyone.
        let mode = std::fs::metadata(path).map_or(0o644, |old| old.permissions().mode());
        file.as_file().set_permissions(std::fs::Permissions::from_mode(mode)).map_err(failed)?;
    }
    file.persist(path).map_err(|err| failed(err.error))?;
    Ok(())
}

/// Writes a picture as PNG: RGB, or RGBA with straight alpha when it is transparent.
///
/// # Errors
/// As [`write_atomically`].
pub fn export_png(picture: &Picture, transparent: bool, path: &Path) -> Result<(), ExportError> {
    let mut png = Vec::new();
    let encoder = image::codecs::png::PngEncoder::new(&mut png);
    let [width, height] = picture.size;
    if transparent {
        encoder.write_image(&picture.shown, width, height, image::ExtendedColorType::Rgba8)?;
    } else {
        let rgb: Vec<u8> =
            picture.shown.chunks_exact(4).flat_map(|texel| [texel[0], texel[1], texel[2]]).collect();
        encoder.write_image(&rgb, width, height, image::ExtendedColorType::Rgb8)?;
    }
    write_atomically(path, &png)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write_atomically(&path, b"first").unwrap();
        write_atomically(&path, b"second").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"second");
        assert!(write_atomically(&folder.path().join("no/such/folder/a.txt"), b"x").is_err());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "no temporary file is left");
    }

    #[test]
    fn a_png_keeps_every_byte() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let shown = (0..4 * 6).map(|i| (i * 10) as u8).collect::<Vec<_>>();
        let picture = Picture { size: [3, 2], light: vec![[0.0; 4]; 6], shown: shown.clone() };
        export_png(&picture, true, &path).unwrap();
        assert_eq!(image::open(&path).unwrap().to_rgba8().into_raw(), shown);
    }
}
