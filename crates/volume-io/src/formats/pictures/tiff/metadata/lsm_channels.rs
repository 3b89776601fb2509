//! Names and colours of the channels of LSM files, in a block outside of the metadata entry.

use super::super::file::bytes::{TiffBytes, decode_integer};
use crate::Endian;

/// Maximum length of the block that is read, in bytes: a thousand channels with names of 60 letters.
const MAX_BYTES: u64 = 64 << 10;

/// Length of the block's head: six numbers of 32 bits.
const HEAD_BYTES: usize = 24;

/// Channels of an LSM file.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct LsmChannels {
    /// Names in the order of the channels; empty where the file has none.
    pub(super) names: Vec<String>,
    /// Colours in sRGB, likewise.
    pub(super) colors: Vec<Option<[u8; 3]>>,
}

impl LsmChannels {
    /// Reads the block at offset `at`; empty where there is none, or it is broken.
    pub(super) fn read(bytes: &mut TiffBytes, at: u64) -> Self {
        let left = bytes.len().saturating_sub(at);
        let mut head = [0; HEAD_BYTES];
        if at == 0 || bytes.read(at, &mut head).is_err() {
            return Self::default();
        }
        let size = number(&head, 0).unwrap_or(0).min(left).min(MAX_BYTES);
        let mut block = vec![0; size as usize];
        if bytes.read(at, &mut block).is_err() {
            return Self::default();
        }
        Self {
            names: parse_names(&block).unwrap_or_default(),
            colors: parse_colors(&block).unwrap_or_default(),
        }
    }
}

/// Parses the colours of the block: red, green, blue and a zero byte each.
fn parse_colors(block: &[u8]) -> Option<Vec<Option<[u8; 3]>>> {
    let (count, at) = (number(block, 4)?, usize::try_from(number(block, 12)?).ok()?);
    let colors = block.get(at.max(HEAD_BYTES)..)?.as_chunks::<4>().0;
    let count = usize::try_from(count).ok()?;
    Some(colors.iter().take(count).map(|&[red, green, blue, _]| Some([red, green, blue])).collect())
}

/// Parses the block: its length, the number of colours, the number of names, and the offsets of both in it. Each name
/// follows its length, which includes a zero byte.
fn parse_names(block: &[u8]) -> Option<Vec<String>> {
    let (count, at) = (number(block, 8)?, usize::try_from(number(block, 16)?).ok()?);
    let mut rest = block.get(at.max(HEAD_BYTES)..)?;
    let mut names = Vec::new();
    while (names.len() as u64) < count {
        let Some(length) = number(rest, 0) else { break };
        let Some(text) = rest.get(4..).and_then(|text| text.get(..usize::try_from(length).ok()?)) else {
            break;
        };
        rest = &rest[4 + text.len()..];
        let text = &text[..text.iter().position(|&byte| byte == 0).unwrap_or(text.len())];
        let latin = || text.iter().map(|&byte| char::from(byte)).collect();
        names.push(std::str::from_utf8(text).map_or_else(|_| latin(), str::to_owned));
    }
    Some(names)
}

/// Number of 32 bits at an offset.
fn number(bytes: &[u8], at: usize) -> Option<u64> {
    Some(decode_integer(bytes.get(at..)?.get(..4)?, Endian::Little))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Encodes a block with a colour and a name for each channel.
    pub(crate) fn block(names: &[&[u8]]) -> Vec<u8> {
        let colors: Vec<u8> = (0..names.len() as u8).flat_map(|at| [at, 2 * at, 3 * at, 0]).collect();
        let texts: Vec<u8> = names
            .iter()
            .flat_map(|name| [&(name.len() as u32 + 1).to_le_bytes()[..], name, &[0]].concat())
            .collect();
        let (count, at) = (names.len(), HEAD_BYTES + colors.len());
        let head = [at + texts.len(), count, count, HEAD_BYTES, at, 0];
        let head: Vec<u8> = head.iter().flat_map(|&number| (number as u32).to_le_bytes()).collect();
        [head, colors, texts].concat()
    }

    #[test]
    fn each_name_follows_its_length() {
        let names = parse_names(&block(&[b"DAPI", b"", b"Ch2-T1", b"\xb5m"]));
        assert_eq!(names.unwrap(), ["DAPI", "", "Ch2-T1", "µm"]);
    }

    #[test]
    fn colors_lie_before_the_names() {
        let colors = parse_colors(&block(&[b"DAPI", b"GFP"])).unwrap();
        assert_eq!(colors, [Some([0, 0, 0]), Some([1, 2, 3])]);
        for end in 0..40 {
            let some = parse_colors(&block(&[b"DAPI", b"GFP"])[..end]).unwrap_or_default();
            assert!(some.len() <= 2 && some.iter().zip(&colors).all(|(a, b)| a == b));
        }
    }

    #[test]
    fn broken_blocks_have_the_names_before_the_break() {
        let whole = block(&[b"DAPI", b"GFP"]);
        for end in 0..whole.len() {
            let names = parse_names(&whole[..end]).unwrap_or_default();
            assert!(names.len() < 2 && names.iter().all(|name| name == "DAPI"), "{end}: {names:?}");
        }
        let with = |at: usize, number: u32| {
            let mut block = whole.clone();
            block[at..at + 4].copy_from_slice(&number.to_le_bytes());
            parse_names(&block).unwrap_or_default().len()
        };
        for number in [0, 1, u32::MAX] {
            assert!([8, 16, 32, 40].into_iter().all(|at| with(at, number) <= 2), "{number}");
        }
    }
}
