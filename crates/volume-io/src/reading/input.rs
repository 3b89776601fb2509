//! Opening of regular files; the file type is checked first.

use std::fs::{self, File, FileType};
use std::io::{self, BufRead as _, BufReader, Seek as _, SeekFrom};
use std::path::Path;
use std::time::SystemTime;

use super::companion_path::{DANGLING_LINK, DANGLING_LINK_HELP};
use super::{LoadControl, LoadError};
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::LoadContext;

/// Regular file open for reading, positioned at its beginning.
#[derive(Debug)]
pub(crate) struct InputFile {
    /// Buffered reader of the file's content.
    pub(crate) reader: BufReader<File>,
    /// Length of the file in bytes when it was opened.
    pub(crate) len: u64,
}

impl InputFile {
    /// Opens a regular file; symbolic links are followed.
    ///
    /// # Errors
    /// `Io` when it does not exist, is not readable, or is a directory, pipe, socket or device. Pipes and devices are
    /// never opened: opening a pipe blocks, and a device may have no end.
    pub(crate) fn open(context: LoadContext<'_>) -> Result<Self, LoadError> {
        let io = |error| context.io_error(error);
        let refuse = |file_type: FileType| {
            if file_type.is_dir() {
                context.not_a_file_error("it is a directory", "name one file")
            } else {
                context.not_a_file_error(
                    "it is a pipe, socket or device, not a regular file",
                    "copy it to a file first",
                )
            }
        };
        let file_type = match fs::metadata(context.path) {
            Ok(metadata) => metadata.file_type(),
            Err(error)
                if error.kind() == io::ErrorKind::NotFound && fs::symlink_metadata(context.path).is_ok() =>
            {
                return Err(context.not_a_file_error(DANGLING_LINK, DANGLING_LINK_HELP));
            }
            Err(error) => return Err(io(error)),
        };
        if !file_type.is_file() {
            return Err(refuse(file_type));
        }
        let file = File::open(context.path).map_err(io)?;
        // The path may name another file by now; the open handle cannot.
        let metadata = file.metadata().map_err(io)?;
        if !metadata.is_file() {
            return Err(refuse(metadata.file_type()));
        }
        Ok(Self { reader: BufReader::with_capacity(256 << 10, file), len: metadata.len() })
    }

    /// Seeks to byte `position` of the file.
    pub(crate) fn seek(&mut self, position: u64) -> io::Result<()> {
        self.reader.seek(SeekFrom::Start(position)).map(drop)
    }

    /// Skips `lines` lines and returns their length in bytes, or `None` when the file ends before that.
    pub(crate) fn skip_lines(
        &mut self,
        context: LoadContext<'_>,
        lines: u64,
        control: &LoadControl,
    ) -> Result<Option<u64>, LoadError> {
        let mut left = lines;
        let mut skipped = 0;
        while left > 0 {
            control.check()?;
            let block = self.reader.fill_buf().map_err(|error| context.io_error(error))?;
            if block.is_empty() {
                return Ok(None);
            }
            let used = match block.iter().position(|&byte| byte == b'\n') {
                Some(end) => {
                    left -= 1;
                    end + 1
                }
                None => block.len(),
            };
            self.reader.consume(used);
            skipped += used as u64;
        }
        Ok(Some(skipped))
    }
}

/// Length and modification time of a file when it was opened, to detect writes by other programs while it is read:
/// such content would be a mixture of two versions.
#[derive(Debug)]
pub(crate) struct FileChangeGuard {
    file: File,
    initial_state: (u64, Option<SystemTime>),
}

/// Length, and modification time where the system provides it.
fn file_state(file: &File) -> io::Result<(u64, Option<SystemTime>)> {
    file.metadata().map(|metadata| (metadata.len(), metadata.modified().ok()))
}

impl FileChangeGuard {
    /// Records the state of an input before anything is read from it.
    pub(crate) fn new(
        context: LoadContext<'_>,
        input: &InputFile,
        control: &LoadControl,
    ) -> Result<Self, LoadError> {
        control.record_read(context.path);
        let seen = input.reader.get_ref().try_clone().and_then(|file| Ok((file_state(&file)?, file)));
        seen.map(|(before, file)| Self { file, initial_state: before })
            .map_err(|error| context.io_error(error))
    }

    /// Returns the result of reading, unless the file has changed since it was opened.
    ///
    /// # Errors
    /// `Io` when it has changed, even if reading failed for another reason, except for `Cancelled`, which is passed
    /// on.
    pub(crate) fn check_unchanged<T>(
        &self,
        context: LoadContext<'_>,
        read: Result<T, LoadError>,
    ) -> Result<T, LoadError> {
        if matches!(read, Err(LoadError::Cancelled)) {
            return read;
        }
        if file_state(&self.file).map_err(|error| context.io_error(error))? == self.initial_state {
            return read;
        }
        Err(context.not_a_file_error(
            "the file has changed while it was being read",
            "open it again when the program that writes it has finished",
        ))
    }
}

/// Returns true if a file with these first bytes is a gzip file (RFC 1952: magic, then method 8).
pub(crate) fn is_gzip(magic: &[u8]) -> bool {
    magic.starts_with(&[0x1f, 0x8b, 8])
}

/// Upper bound of the inflated size of `bytes` compressed bytes: deflate expands a byte to at most 1032
/// (<https://zlib.net/zlib_tech.html>).
pub(crate) fn max_inflated_bytes(bytes: u64) -> u64 {
    bytes.saturating_mul(1032)
}

/// File name without its extension, if that is one of `endings` (lower case, longest first); the comparison ignores
/// case.
pub(crate) fn name_without_extension(path: &Path, endings: &[&str]) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let lower = name.to_lowercase();
    let ending = endings.iter().find(|ending| lower.ends_with(**ending) && lower.len() > ending.len());
    // Lower-casing can change the length in bytes: then the name stays whole.
    let kept = ending.and_then(|ending| name.get(..name.len().saturating_sub(ending.len())));
    kept.unwrap_or(&name).to_owned()
}

/// File name without its last extension and without `.gz` after that: the default name of a volume.
pub(crate) fn stem(path: &Path) -> String {
    let is_zipped = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("gz"));
    let unzipped = path.file_stem().filter(|_| is_zipped).map_or(path, Path::new);
    let stem = unzipped.file_stem().unwrap_or(path.as_os_str());
    sanitised(&stem.to_string_lossy(), 120)
}
