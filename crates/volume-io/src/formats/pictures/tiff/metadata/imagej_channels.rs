//! Names and colours of channels in the `ImageJ` metadata block: slice labels, info lines about the image, and lookup
//! tables.
//!
//! `ImageJ` has two entries of its own: 50838 with the lengths of the parts of 50839 (its classes `TiffEncoder` and
//! `TiffDecoder`). Text is UTF-16 in the byte order of the file.

use super::super::file::TiffFile;
use super::super::file::page::tag;
use crate::Endian;

/// Maximum length of the metadata, in bytes: labels of a hundred thousand slices.
const MAX_BYTES: u64 = 16 << 20;

/// Types of parts, as numbers of four letters.
const INFO: u32 = u32::from_be_bytes(*b"info");
const LABELS: u32 = u32::from_be_bytes(*b"labl");
const LOOKUP_TABLES: u32 = u32::from_be_bytes(*b"luts");
/// Magic number at the beginning of the list of types.
const MAGIC: u32 = u32::from_be_bytes(*b"IJIJ");

/// Texts and colours of the `ImageJ` metadata block.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct ImagejMetadata {
    /// Label of each page, or, from other programs, of each channel.
    labels: Vec<String>,
    /// Info lines of the form `key = value`.
    info: String,
    /// Colour in sRGB of the largest values of each channel.
    colors: Vec<Option<[u8; 3]>>,
}

impl ImagejMetadata {
    /// Reads the metadata of a file; empty where it has no such entries, or broken ones.
    pub(super) fn read(tiff: &mut TiffFile) -> Self {
        let counts = tiff.first.get(tag::IMAGEJ_COUNTS);
        let counts = counts.and_then(|entry| entry.numbers(&mut tiff.bytes, MAX_BYTES / 4).ok());
        let content = tiff.first.get(tag::IMAGEJ_CONTENT);
        let content = content.and_then(|entry| entry.raw(&mut tiff.bytes, MAX_BYTES).ok());
        let (Some(counts), Some(content)) = (counts, content) else { return Self::default() };
        Self::parse(&counts, &content, tiff.bytes.endian).unwrap_or_default()
    }

    /// Parses the entries; the first length is that of the list of types.
    fn parse(counts: &[u64], content: &[u8], endian: Endian) -> Option<Self> {
        let (&header, lengths) = counts.split_first()?;
        let number = |bytes: &[u8]| {
            let bytes = [bytes[0], bytes[1], bytes[2], bytes[3]];
            if endian == Endian::Big { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) }
        };
        let header_bytes = content.get(..usize::try_from(header).ok()?)?;
        let mut words = header_bytes.chunks_exact(4).map(number);
        if words.next()? != MAGIC {
            return None;
        }
        let mut kept = Self::default();
        let mut rest = content.get(header_bytes.len()..)?;
        let mut lengths = lengths.iter();
        while let (Some(kind), Some(count)) = (words.next(), words.next()) {
            for _ in 0..count {
                let length = usize::try_from(*lengths.next()?).ok()?;
                let (part, after) = rest.split_at_checked(length)?;
                rest = after;
                match kind {
                    LABELS => kept.labels.push(text(part, endian)),
                    INFO => kept.info = text(part, endian),
                    LOOKUP_TABLES => kept.colors.push(last_color(part)),
                    _ => {}
                }
            }
        }
        Some(kept)
    }

    /// Names of the channels, which vary fastest over the pages; empty where the metadata have none.
    pub(super) fn channel_names(&self, channels: usize, pages: usize) -> Vec<String> {
        if channels < 2 {
            return Vec::new();
        }
        let names = if self.labels.len() == channels {
            self.labels.iter().map(|label| strip_indices(label)).collect()
        } else if self.labels.len() >= pages.max(channels) {
            self.labels_of_channels(channels)
        } else {
            Vec::new()
        };
        let says_something =
            |names: &[String]| names.len() == channels && names.iter().any(|name| *name != names[0]);
        let lists = [names, self.names_in_info(channels)];
        lists.into_iter().find(|names| says_something(names)).unwrap_or_default()
    }

    /// Colours of the channels, one for each; empty where the metadata have another number of them.
    pub(super) fn channel_colors(&self, channels: usize) -> Vec<Option<[u8; 3]>> {
        if self.colors.len() == channels { self.colors.clone() } else { Vec::new() }
    }

    /// Label of the first page of each channel, where all its pages have the same.
    fn labels_of_channels(&self, channels: usize) -> Vec<String> {
        let labels: Vec<String> = self.labels.iter().map(|label| strip_indices(label)).collect();
        let is_same = |channel: usize| {
            labels.iter().skip(channel).step_by(channels).all(|label| *label == labels[channel])
        };
        if (0..channels).all(is_same) { labels[..channels].to_vec() } else { Vec::new() }
    }

    /// Names in lines that Bio-Formats and others write: `… Channel … Name #1 = DAPI`.
    fn names_in_info(&self, channels: usize) -> Vec<String> {
        let mut names: Vec<(u64, String)> = Vec::new();
        for line in self.info.lines() {
            let Some((key, value)) = line.split_once('=') else { continue };
            let key = key.trim().to_lowercase();
            let bare = key.trim_end_matches(|c: char| c.is_ascii_digit() || matches!(c, ' ' | '#'));
            let number = key[bare.len()..].trim_start_matches([' ', '#']).parse().ok();
            let is_name = bare.contains("channel") && bare.ends_with("name");
            if let (Some(number), true) = (number, is_name) {
                names.push((number, value.trim().to_owned()));
            }
        }
        names.sort_by_key(|&(number, _)| number);
        names.dedup_by_key(|&mut (number, _)| number);
        if names.len() == channels { names.into_iter().map(|(_, name)| name).collect() } else { Vec::new() }
    }
}

/// Colour of the largest values in a lookup table: 256 bytes of red, then green, then blue.
fn last_color(table: &[u8]) -> Option<[u8; 3]> {
    let (colors, rest) = table.as_chunks::<256>();
    match colors {
        [red, green, blue] if rest.is_empty() => Some([red[255], green[255], blue[255]]),
        _ => None,
    }
}

/// Decodes UTF-16 in the given byte order.
fn text(bytes: &[u8], endian: Endian) -> String {
    let unit = |pair: &[u8; 2]| match endian {
        Endian::Big => u16::from_be_bytes(*pair),
        Endian::Little => u16::from_le_bytes(*pair),
    };
    String::from_utf16_lossy(&bytes.as_chunks::<2>().0.iter().map(unit).collect::<Vec<_>>())
}

/// First line of a label, without the indices of channel, slice and time, as in `c:1/2 z:3/8 - DAPI`.
fn strip_indices(label: &str) -> String {
    let is_count = |word: &str| {
        let count = word.trim_end_matches(';').split_once(':').and_then(|(axis, count)| {
            let (at, of) = count.split_once('/')?;
            let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
            Some(matches!(axis, "c" | "z" | "t" | "ch" | "s") && is_number(at) && is_number(of))
        });
        count.unwrap_or(false)
    };
    let line = label.lines().next().unwrap_or_default();
    let words: Vec<&str> = line.split_whitespace().filter(|word| !is_count(word)).collect();
    words.join(" ").trim_matches(['-', ' ']).to_owned()
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    fn number(value: u32, endian: Endian) -> [u8; 4] {
        if endian == Endian::Big { value.to_be_bytes() } else { value.to_le_bytes() }
    }

    /// Encodes both entries as `ImageJ` does.
    pub(crate) fn entries(info: &str, labels: &[&str], endian: Endian) -> (Vec<u64>, Vec<u8>) {
        let text = |text: &str| -> Vec<u8> {
            let unit =
                |unit: u16| if endian == Endian::Big { unit.to_be_bytes() } else { unit.to_le_bytes() };
            text.encode_utf16().flat_map(unit).collect()
        };
        let mut header = number(MAGIC, endian).to_vec();
        let table: Vec<u8> = (0..768).map(|at| if at < 512 { (at % 256) as u8 } else { 7 }).collect();
        let mut parts = Vec::new();
        for (kind, texts) in [(INFO, &[info][..]), (LABELS, labels)] {
            header.extend([number(kind, endian), number(texts.len() as u32, endian)].concat());
            parts.extend(texts.iter().map(|part| text(part)));
        }
        header.extend([number(LOOKUP_TABLES, endian), number(1, endian)].concat());
        parts.push(table);
        let counts = [&header].into_iter().chain(&parts).map(|part| part.len() as u64).collect();
        (counts, [&header[..], &parts.concat()].concat())
    }

    fn names(info: &str, labels: &[&str], channels: usize, pages: usize) -> Vec<String> {
        let mut found = Vec::new();
        for endian in [Endian::Little, Endian::Big] {
            let (counts, content) = entries(info, labels, endian);
            found = ImagejMetadata::parse(&counts, &content, endian).unwrap().channel_names(channels, pages);
        }
        found
    }

    #[test]
    fn labels_name_channels_where_they_differ_by_them_alone() {
        assert_eq!(names("", &["DAPI", "GFP"], 2, 8), ["DAPI", "GFP"]);
        let of_pages = ["c:1/2 z:1/2 - DAPI", "c:2/2 z:1/2 - GFP", "c:1/2 z:2/2 - DAPI", "c:2/2 z:2/2 - GFP"];
        assert_eq!(names("", &of_pages, 2, 4), ["DAPI", "GFP"]);
        let of_slices = ["a_1.tif", "a_2.tif", "a_3.tif", "a_4.tif"];
        assert!(names("", &of_slices, 2, 4).is_empty(), "each page has a name of its own");
        assert!(names("", &["cells", "cells"], 2, 4).is_empty(), "all channels have the same");
        assert!(names("", &["DAPI"], 1, 4).is_empty(), "there is nothing to choose");
    }

    #[test]
    fn info_names_channels() {
        let info = "BitsPerPixel = 8\nInformation|Image|Channel|Name #2 = GFP\nInformation|Image|Channel|Name #1 = DAPI\n\
                    Channel Name = x\nnothing";
        assert_eq!(names(info, &[], 2, 4), ["DAPI", "GFP"]);
        assert!(names(info, &[], 3, 6).is_empty());
    }

    #[test]
    fn lookup_tables_end_with_the_color_of_a_channel() {
        let (counts, content) = entries("", &[], Endian::Big);
        let metadata = ImagejMetadata::parse(&counts, &content, Endian::Big).unwrap();
        assert_eq!(metadata.channel_colors(1), [Some([255, 255, 7])]);
        assert!(metadata.channel_colors(2).is_empty());
        assert_eq!(last_color(&[0; 767]), None);
    }

    #[test]
    fn broken_entries_say_nothing() {
        let (counts, content) = entries("a", &["b", "c"], Endian::Little);
        for end in 0..content.len() {
            let _nothing_or_less = ImagejMetadata::parse(&counts, &content[..end], Endian::Little);
        }
        assert_eq!(ImagejMetadata::parse(&counts, &content, Endian::Big), None);
        assert_eq!(ImagejMetadata::parse(&[], &content, Endian::Little), None);
        assert_eq!(ImagejMetadata::parse(&[u64::MAX, 4], &content, Endian::Little), None);
        let mut endless = content.clone();
        endless[8..12].copy_from_slice(&u32::MAX.to_le_bytes());
        assert_eq!(ImagejMetadata::parse(&counts, &endless, Endian::Little), None);
    }
}
