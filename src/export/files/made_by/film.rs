//! The mark in films: the comment of an MP4.

use std::fs::File;
use std::io::{BufReader, Error, Read as _, Result, Seek as _, SeekFrom};

use super::{LONGEST_MARK, MOST_PARTS, is_mark};

/// The boxes, one in the other, in which the comment is, and bytes of each that stand before the boxes in it: `meta`
/// has a version, and the comment's own data a type and a language.
const WAY: [([u8; 4], u64); 6] =
    [(*b"moov", 0), (*b"udta", 0), (*b"meta", 4), (*b"ilst", 0), (*b"\xa9cmt", 0), (*b"data", 8)];

/// Follows the boxes to the comment, wherever they are.
pub(super) fn mp4(mut file: BufReader<File>) -> Result<bool> {
    let mut inside = 0..file.get_ref().metadata()?.len();
    for (kind, before) in WAY {
        let Some(found) = find(&mut file, inside, kind)? else { return Ok(false) };
        inside = found.start.saturating_add(before)..found.end;
    }
    file.seek(SeekFrom::Start(inside.start))?;
    let mut text = Vec::new();
    file.take(inside.end.saturating_sub(inside.start).min(LONGEST_MARK)).read_to_end(&mut text)?;
    Ok(is_mark(&text))
}

/// Where the contents of the first box of a kind are, of those that lie side by side.
fn find(
    file: &mut BufReader<File>,
    inside: std::ops::Range<u64>,
    kind: [u8; 4],
) -> Result<Option<std::ops::Range<u64>>> {
    let mut at = inside.start;
    for _ in 0..MOST_PARTS {
        // A length and a kind; there may be bytes behind the last box.
        if inside.end.saturating_sub(at) < 8 {
            break;
        }
        file.seek(SeekFrom::Start(at))?;
        let (mut length, mut found) = ([0; 4], [0; 4]);
        file.read_exact(&mut length)?;
        file.read_exact(&mut found)?;
        let (head, length) = match u32::from_be_bytes(length) {
            // To the end of all.
            0 => (8, inside.end - at),
            1 => {
                let mut long = [0; 8];
                file.read_exact(&mut long)?;
                (16, u64::from_be_bytes(long))
            }
            length => (8, u64::from(length)),
        };
        let end = at.checked_add(length).filter(|end| length >= head && *end <= inside.end);
        let end = end.ok_or_else(|| Error::other("a box is longer than what it is in"))?;
        if found == kind {
            return Ok(Some(at + head..end));
        }
        at = end;
    }
    Ok(None)
}
