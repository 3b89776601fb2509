//! Pictures as files.

use std::io::Write as _;
use std::path::{Path, PathBuf};

/// Why a file could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The encoder refused.
    #[error("the picture could not be encoded: {0}")]
    Encode(#[from] png::EncodingError),
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
    let mut file = temporary_beside(path)?;
    file.write_all(contents).map_err(|source| ExportError::Write { path: path.to_owned(), source })?;
    place(file, path)
}

/// A file for what will take a name when it is complete.
pub(super) fn temporary_beside(path: &Path) -> Result<tempfile::NamedTempFile, ExportError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // The temporary file's own name means nothing to the user: keep the kind of error alone.
    tempfile::Builder::new()
        .prefix(".chiaroscuro-")
        .suffix(".part")
        .tempfile_in(folder)
        .map_err(|err| ExportError::Write { path: path.to_owned(), source: err.kind().into() })
}

/// Gives a complete file its name.
pub(super) fn place(file: tempfile::NamedTempFile, path: &Path) -> Result<(), ExportError> {
    let failed = |source| ExportError::Write { path: path.to_owned(), source };
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

/// Under which name a picture carries its record.
const RECORD: &str = "chiaroscuro";

/// Most bytes that are read of a picture's texts: a thousand times a real record.
const MOST_TEXT: usize = 16 << 20;

/// Writes a picture, as [`super::Renderer::read_shown`] gives it, as PNG: RGB, or RGBA with straight alpha when
/// it is transparent. It carries a record ([`crate::model::Record`]) as text.
///
/// # Errors
/// As [`write_atomically`].
pub fn export_png(
    size: [u32; 2],
    shown: &[u8],
    transparent: bool,
    record: Option<&str>,
    path: &Path,
) -> Result<(), ExportError> {
    let bytes = if transparent {
        encode(size, png::ColorType::Rgba, shown, record)?
    } else {
        encode(size, png::ColorType::Rgb, &rgb(shown), record)?
    };
    write_atomically(path, &bytes)
}

/// Bytes of colours as PNG, with a text if there is one.
pub(super) fn encode(
    [width, height]: [u32; 2],
    color: png::ColorType,
    bytes: &[u8],
    record: Option<&str>,
) -> Result<Vec<u8>, png::EncodingError> {
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, width, height);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_color(color);
    if let Some(record) = record {
        encoder.add_itxt_chunk(RECORD.to_owned(), record.to_owned())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(bytes)?;
    writer.finish()?;
    Ok(png)
}

/// The colours of a picture without its alpha.
pub(super) fn rgb(shown: &[u8]) -> Vec<u8> {
    shown.chunks_exact(4).flat_map(|texel| [texel[0], texel[1], texel[2]]).collect()
}

/// The record that a PNG file carries, if it does.
///
/// # Errors
/// When the file cannot be read or is no PNG.
pub fn read_record(path: &Path) -> Result<Option<String>, ReadPictureError> {
    let failed =
        |why: &dyn std::fmt::Display| ReadPictureError { path: path.to_owned(), why: why.to_string() };
    let file = std::fs::File::open(path).map_err(|err| failed(&err))?;
    let limits = png::Limits { bytes: MOST_TEXT };
    let decoder = png::Decoder::new_with_limits(std::io::BufReader::new(file), limits);
    let reader = decoder.read_info().map_err(|err| failed(&err))?;
    let found = reader.info().utf8_text.iter().find(|text| text.keyword == RECORD);
    found.map(|text| text.get_text().map_err(|err| failed(&err))).transpose()
}

/// Why a picture could not be read.
#[derive(Debug, thiserror::Error)]
#[error("could not read the picture: {why} ({path}); a PNG file that this program has exported helps")]
pub struct ReadPictureError {
    /// Which.
    path: PathBuf,
    /// What is wrong with it.
    why: String,
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
        export_png([3, 2], &shown, true, None, &path).unwrap();
        assert_eq!(read_record(&path).unwrap(), None);
        assert_eq!(image::open(&path).unwrap().to_rgba8().into_raw(), shown);
        let record = "{\"name\": \"Größe, 体積\"}";
        export_png([3, 2], &shown, true, Some(record), &path).unwrap();
        assert_eq!(image::open(&path).unwrap().to_rgba8().into_raw(), shown);
        assert_eq!(read_record(&path).unwrap().as_deref(), Some(record));
        std::fs::write(&path, b"no picture").unwrap();
        assert!(read_record(&path).is_err() && read_record(Path::new("/no/such.png")).is_err());
    }
}
