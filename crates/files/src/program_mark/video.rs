//! Program mark in videos: the comment of an MP4.

use std::fs::File;
use std::io::{BufReader, Error, Read as _, Result, Seek as _, SeekFrom};

use super::{MAX_MARK_BYTES, MAX_PARTS, is_mark};

/// Path of nested boxes to the comment, with the bytes of each before its inner boxes: `meta` has a version, and the
/// comment's data a type and a language.
const COMMENT_BOX_PATH: [([u8; 4], u64); 6] =
    [(*b"moov", 0), (*b"udta", 0), (*b"meta", 4), (*b"ilst", 0), (*b"\xa9cmt", 0), (*b"data", 8)];

/// Follows the nested boxes to the comment, at any position in the file.
pub(super) fn mp4(mut file: BufReader<File>) -> Result<bool> {
    let mut inside = 0..file.get_ref().metadata()?.len();
    for (kind, before) in COMMENT_BOX_PATH {
        let Some(found) = find_box(&mut file, inside, kind)? else { return Ok(false) };
        inside = found.start.saturating_add(before)..found.end;
    }
    file.seek(SeekFrom::Start(inside.start))?;
    let mut text = Vec::new();
    file.take(inside.end.saturating_sub(inside.start).min(MAX_MARK_BYTES)).read_to_end(&mut text)?;
    Ok(is_mark(&text))
}

/// Finds the first box of a kind among siblings, and returns the range of its contents.
fn find_box(
    file: &mut BufReader<File>,
    inside: std::ops::Range<u64>,
    kind: [u8; 4],
) -> Result<Option<std::ops::Range<u64>>> {
    let mut at = inside.start;
    for _ in 0..MAX_PARTS {
        // A length and a type; there may be padding after the last box.
        if inside.end.saturating_sub(at) < 8 {
            break;
        }
        file.seek(SeekFrom::Start(at))?;
        let (mut length, mut found) = ([0; 4], [0; 4]);
        file.read_exact(&mut length)?;
        file.read_exact(&mut found)?;
        let (head, length) = match u32::from_be_bytes(length) {
            // Extends to the end of the enclosing box.
            0 => (8, inside.end - at),
            1 => {
                let mut long = [0; 8];
                file.read_exact(&mut long)?;
                (16, u64::from_be_bytes(long))
            }
            length => (8, u64::from(length)),
        };
        let end = at.checked_add(length).filter(|end| length >= head && *end <= inside.end);
        let end = end.ok_or_else(|| Error::other("a box is longer than the box around it"))?;
        if found == kind {
            return Ok(Some(at + head..end));
        }
        at = end;
    }
    Ok(None)
}
