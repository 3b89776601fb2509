//! Files of this program, told from files of others by the mark that they carry.

use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom};
use std::path::Path;

use crate::model::MADE_BY;

/// What pictures of versions without the mark carry: the record of a PNG, and that of an EXR.
const EARLIER: [&[u8]; 2] = [b"iTXtchiaroscuro\0", b"chiaroscuro.000\0"];

/// Sessions and presets of versions without the mark hold all of these.
const EARLIER_SESSION: [&[u8]; 3] = [b"\"schema\"", b"\"camera\"", b"\"shadows\""];

/// Bytes that are read from the beginning: the mark stands before pixels and voxels.
const HEAD: u64 = 1 << 18;

/// And from the end: where a film keeps its texts, unless they come first.
const TAIL: u64 = 1 << 16;

/// Whether this program has made a file, or nobody: an empty one holds nothing that could be lost. A file that cannot
/// be read counts as somebody else's.
pub fn is_ours(path: &Path) -> bool {
    read_ends(path).is_ok_and(|(length, bytes)| {
        let has = |mark: &[u8]| bytes.windows(mark.len()).any(|window| window == mark);
        length == 0
            || has(MADE_BY.as_bytes())
            || EARLIER.into_iter().any(has)
            || EARLIER_SESSION.into_iter().all(has)
    })
}

/// The length of a file, its beginning and its end.
fn read_ends(path: &Path) -> std::io::Result<(u64, Vec<u8>)> {
    let metadata = std::fs::metadata(path)?;
    if !metadata.is_file() {
        return Err(std::io::Error::other("no regular file"));
    }
    let mut file = File::open(path)?;
    let mut bytes = Vec::new();
    file.by_ref().take(HEAD).read_to_end(&mut bytes)?;
    let length = metadata.len();
    if length > HEAD {
        file.seek(SeekFrom::Start(length.saturating_sub(TAIL).max(HEAD)))?;
        file.take(TAIL).read_to_end(&mut bytes)?;
    }
    Ok((length, bytes))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::made_by;

    #[test]
    fn files_of_ours_are_told_from_others() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        let is_ours_with = |contents: &[u8]| {
            std::fs::write(&path, contents).unwrap();
            is_ours(&path)
        };
        assert!(is_ours_with(b"") && is_ours_with(made_by().as_bytes()));
        assert!(is_ours_with(b"\x89PNG....IHDR....iTXtchiaroscuro\0{}"));
        assert!(is_ours_with(br#"{"schema": 1, "camera": {}, "shadows": {}}"#));
        assert!(!is_ours_with(b"\x89PNG....IHDR....tEXtTitle\0Chiaroscuro"), "a picture of that name");
        assert!(!is_ours_with(br#"{"camera": {}, "shadows": {}}"#));
        let far = |before: usize, after: usize| [vec![0; before], MADE_BY.into(), vec![0; after]].concat();
        assert!(is_ours_with(&far(1 << 20, 100)), "at the end");
        assert!(!is_ours_with(&far(1 << 20, 1 << 20)), "in the middle of what others wrote");
        assert!(!is_ours(folder.path()) && !is_ours(&folder.path().join("none")));
    }
}
