//! The mark in pictures: a text of PNG, a comment of GIF, an attribute of EXR. All stand before the pixels.

use std::fs::File;
use std::io::{BufRead as _, BufReader, Read as _, Result};

use super::{LONGEST_MARK, MOST_PARTS, is_mark};

/// Keyword of the text that says which program made a PNG.
const SOFTWARE: &[u8] = b"Software\0";

/// Keyword of the look that PNG pictures carry, those of versions without the mark too.
const LOOK_IN_PNG: &[u8] = b"chiaroscuro\0";

/// Name of the first piece of the look that EXR pictures carry, those of versions without the mark too.
const LOOK_IN_EXR: &[u8] = b"chiaroscuro.000\0";

/// Bytes of the longest name of an EXR attribute, and of its kind.
const LONGEST_NAME: u64 = 256;

fn array<const N: usize>(file: &mut BufReader<File>) -> Result<[u8; N]> {
    let mut bytes = [0; N];
    file.read_exact(&mut bytes)?;
    Ok(bytes)
}

/// As many bytes of a part as a mark can have, of which so many have been read when this returns.
fn beginning(file: &mut BufReader<File>, length: u64) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.take(length.min(LONGEST_MARK)).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn skip(file: &mut BufReader<File>, bytes: u64) -> Result<()> {
    file.seek_relative(i64::try_from(bytes).map_err(std::io::Error::other)?)
}

/// Chunks: length, kind, contents, check sum.
pub(super) fn png(mut file: BufReader<File>) -> Result<bool> {
    skip(&mut file, 8)?;
    for _ in 0..MOST_PARTS {
        let length = u64::from(u32::from_be_bytes(array(&mut file)?));
        let kind = array::<4>(&mut file)?;
        if matches!(&kind, b"IDAT" | b"IEND") {
            break;
        }
        let text = beginning(&mut file, length)?;
        let is_told = match &kind {
            b"tEXt" => text.strip_prefix(SOFTWARE).is_some_and(is_mark),
            b"iTXt" => text.starts_with(LOOK_IN_PNG),
            _ => false,
        };
        if is_told {
            return Ok(true);
        }
        skip(&mut file, length - text.len() as u64 + 4)?;
    }
    Ok(false)
}

/// Blocks before the first picture: extensions, each of which has runs of up to 255 bytes.
pub(super) fn gif(mut file: BufReader<File>) -> Result<bool> {
    skip(&mut file, 10)?;
    let [flags, _, _] = array(&mut file)?;
    if flags & 0x80 != 0 {
        // Three bytes for each of 2 to 256 colours.
        skip(&mut file, 3 << ((flags & 7) + 1))?;
    }
    for _ in 0..MOST_PARTS {
        let [block] = array(&mut file)?;
        if block != 0x21 {
            break;
        }
        let [kind] = array(&mut file)?;
        let mut text = Vec::new();
        for _ in 0..MOST_PARTS {
            let [length] = array(&mut file)?;
            if length == 0 {
                break;
            }
            let run = beginning(&mut file, length.into())?;
            if (text.len() as u64) < LONGEST_MARK {
                text.extend(run);
            }
        }
        if kind == 0xFE && is_mark(&text) {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Attributes: name, kind, length, and as many bytes; an empty name ends them.
pub(super) fn exr(mut file: BufReader<File>) -> Result<bool> {
    skip(&mut file, 8)?;
    for _ in 0..MOST_PARTS {
        let (mut name, mut kind) = (Vec::new(), Vec::new());
        for word in [&mut name, &mut kind] {
            file.by_ref().take(LONGEST_NAME).read_until(0, word)?;
            if word.len() < 2 {
                return Ok(false);
            }
        }
        let length = u64::from(u32::from_le_bytes(array(&mut file)?));
        let text = beginning(&mut file, length)?;
        let is_text = kind == b"string\0";
        if is_text && (name == LOOK_IN_EXR || name == b"software\0" && is_mark(&text)) {
            return Ok(true);
        }
        skip(&mut file, length - text.len() as u64)?;
    }
    Ok(false)
}
