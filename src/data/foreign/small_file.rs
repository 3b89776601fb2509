//! Files that are read whole because they are small: settings, presets, lists.

use std::io::Read as _;
use std::path::Path;

/// Largest file that is read this way: a thousand times the size of a real one.
const MOST_BYTES: u64 = 4 << 20;

/// The bytes of a small file.
///
/// # Errors
/// When it cannot be read, is no file (a folder, a device) or is too large.
pub fn read_small(path: &Path) -> std::io::Result<Vec<u8>> {
    let too_large = || std::io::Error::other("larger than 4 MiB, which settings never are");
    read_bounded(path, MOST_BYTES)?.ok_or_else(too_large)
}

/// The bytes of a regular file; none where it has more than `most_bytes`.
///
/// # Errors
/// When it cannot be read, or is no file (a folder, a pipe, a device).
pub(crate) fn read_bounded(path: &Path, most_bytes: u64) -> std::io::Result<Option<Vec<u8>>> {
    let metadata = std::fs::metadata(path)?;
    if !metadata.is_file() {
        return Err(std::io::Error::other("not a regular file"));
    }
    let mut bytes = Vec::new();
    // What is said of a file's length need not be true.
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
        assert_eq!(read_small(&path).unwrap(), b"some text");
        std::fs::File::create(&path).unwrap().set_len(MOST_BYTES + 1).unwrap();
        assert!(read_small(&path).unwrap_err().to_string().contains("4 MiB"));
        assert!(read_small(folder.path()).unwrap_err().to_string().contains("regular"));
        assert!(read_small(&folder.path().join("none")).is_err());
    }
}
