//! Bounded reading of small files: settings, presets, lists.

use std::io::Read as _;
use std::path::Path;

/// Maximum size of a small file: a thousand times that of a real one.
const MAX_SMALL_FILE_BYTES: u64 = 4 << 20;

/// Reads a small file completely.
///
/// # Errors
/// Fails if the file cannot be read, is not a regular file (but a folder or device), or is too large.
pub fn read_small_file(path: &Path) -> std::io::Result<Vec<u8>> {
    let too_large = || std::io::Error::other("larger than 4 MiB, the maximum for a settings file");
    read_bounded(path, MAX_SMALL_FILE_BYTES)?.ok_or_else(too_large)
}

/// Reads a regular file completely; `None` if it has more than `most_bytes` bytes.
///
/// # Errors
/// Fails if the file cannot be read, or is not a regular file (but a folder, pipe or device).
pub fn read_bounded(path: &Path, most_bytes: u64) -> std::io::Result<Option<Vec<u8>>> {
    let metadata = std::fs::metadata(path)?;
    if !metadata.is_file() {
        return Err(std::io::Error::other("not a regular file"));
    }
    let mut bytes = Vec::new();
    // The length in the metadata is not trusted: it may change, and is 0 for some special files.
    std::fs::File::open(path)?.take(most_bytes.saturating_add(1)).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= most_bytes).then_some(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_small_files_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        std::fs::write(&path, "some text").unwrap();
        assert_eq!(read_small_file(&path).unwrap(), b"some text");
        std::fs::File::create(&path).unwrap().set_len(MAX_SMALL_FILE_BYTES + 1).unwrap();
        assert!(read_small_file(&path).unwrap_err().to_string().contains("4 MiB"));
        assert!(read_small_file(folder.path()).unwrap_err().to_string().contains("regular"));
        assert!(read_small_file(&folder.path().join("none")).is_err());
    }
}
