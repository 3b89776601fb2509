//! Program mark in pictures: a PNG text, a GIF comment, an EXR attribute. All of them precede the pixels.

use std::fs::File;
use std::io::{BufRead as _, BufReader, Read as _, Result};

use super::{MAX_MARK_BYTES, MAX_PARTS, is_mark};

/// Keyword of the PNG text that names the writing program.
const SOFTWARE: &[u8] = b"Software\0";

/// Keyword of the record in PNG pictures, including those of versions without the mark.
const PNG_RECORD_KEYWORD: &[u8] = b"chiaroscuro\0";

/// Name of the first piece of the record in EXR pictures, including those of versions without the mark.
const EXR_RECORD_NAME: &[u8] = b"chiaroscuro.000\0";

/// Length of the longest name or type of an EXR attribute, in bytes.
const MAX_NAME_BYTES: u64 = 256;

fn array<const N: usize>(file: &mut BufReader<File>) -> Result<[u8; N]> {
    let mut bytes = [0; N];
    file.read_exact(&mut bytes)?;
    Ok(bytes)
}

/// Reads the beginning of a part of the given length: as many bytes as a mark can have. The result's length is the
/// number of bytes consumed.
fn read_beginning(file: &mut BufReader<File>, length: u64) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.take(length.min(MAX_MARK_BYTES)).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn skip(file: &mut BufReader<File>, bytes: u64) -> Result<()> {
    file.seek_relative(i64::try_from(bytes).map_err(std::io::Error::other)?)
}

/// Searches the chunks of a PNG: length, type, contents, checksum.
pub(super) fn png(mut file: BufReader<File>) -> Result<bool> {
    skip(&mut file, 8)?;
    for _ in 0..MAX_PARTS {
        let length = u64::from(u32::from_be_bytes(array(&mut file)?));
        let kind = array::<4>(&mut file)?;
        if matches!(&kind, b"IDAT" | b"IEND") {
            break;
        }
        let text = read_beginning(&mut file, length)?;
        let is_told = match &kind {
            b"tEXt" => text.strip_prefix(SOFTWARE).is_some_and(is_mark),
            b"iTXt" => text.starts_with(PNG_RECORD_KEYWORD),
            _ => false,
        };
        if is_told {
            return Ok(true);
        }
        skip(&mut file, length - text.len() as u64 + 4)?;
    }
    Ok(false)
}

/// Searches the blocks before the first picture of a GIF: extensions, each with sub-blocks of up to 255 bytes.
pub(super) fn gif(mut file: BufReader<File>) -> Result<bool> {
    skip(&mut file, 10)?;
    let [flags, _, _] = array(&mut file)?;
    if flags & 0x80 != 0 {
        // Colour table: three bytes for each of 2 to 256 colours.
        skip(&mut file, 3 << ((flags & 7) + 1))?;
    }
    for _ in 0..MAX_PARTS {
        let [block] = array(&mut file)?;
        if block != 0x21 {
            break;
        }
        let [kind] = array(&mut file)?;
        let mut text = Vec::new();
        for _ in 0..MAX_PARTS {
            let [length] = array(&mut file)?;
            if length == 0 {
                break;
            }
            let run = read_beginning(&mut file, length.into())?;
            if (text.len() as u64) < MAX_MARK_BYTES {
                text.extend(run);
            }
        }
        if kind == 0xFE && is_mark(&text) {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Searches the attributes of an EXR: name, type, length, and the value; an empty name ends the header.
pub(super) fn exr(mut file: BufReader<File>) -> Result<bool> {
    skip(&mut file, 8)?;
    for _ in 0..MAX_PARTS {
        let (mut name, mut kind) = (Vec::new(), Vec::new());
        for word in [&mut name, &mut kind] {
            file.by_ref().take(MAX_NAME_BYTES).read_until(0, word)?;
            if word.len() < 2 {
                return Ok(false);
            }
        }
        let length = u64::from(u32::from_le_bytes(array(&mut file)?));
        let text = read_beginning(&mut file, length)?;
        let is_text = kind == b"string\0";
        if is_text && (name == EXR_RECORD_NAME || name == b"software\0" && is_mark(&text)) {
            return Ok(true);
        }
        skip(&mut file, length - text.len() as u64)?;
    }
    Ok(false)
}
