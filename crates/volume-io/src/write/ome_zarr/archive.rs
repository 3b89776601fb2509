//! Archive of a hierarchy: a ZIP file with uncompressed entries, metadata first.
//!
//! After PKWARE's APPNOTE 6.3, <https://pkware.cachefly.net/webdocs/casestudies/APPNOTE.TXT>; its sections are named
//! below.

use std::fs::File;
use std::io::{BufWriter, Error, Read as _, Result, Seek as _, Write};

use flate2::Crc;

use super::hierarchy_sink::FolderSink;
use super::metadata::OME_VERSION;

/// Version of the format that is needed to read the archive: that with sizes of 64 bits.
const ZIP64_VERSION: u16 = 45;

/// System and version of the writer: Unix, whose permissions the entries have.
const MADE_BY: u16 = 3 << 8 | ZIP64_VERSION;

/// Flag of names in UTF-8.
const UTF8_NAMES: u16 = 1 << 11;

/// Date of all entries, 1 January 1980, so that equal volumes make equal archives.
const FIRST_DATE: u16 = 1 << 5 | 1;

/// Permissions of the entries: those of ordinary files.
const FILE_MODE: u32 = 0o100_644;

/// Number in place of one that needs 64 bits, and the id of the extra field that has them (4.5.3).
const IN_ZIP64_FIELD: u32 = u32::MAX;
const ZIP64_FIELD: u16 = 1;

/// Size of the ZIP64 end of central directory record without its first two fields (4.3.14.1).
const ZIP64_END_REST: u64 = 44;

/// Bytes that are copied at a time.
const COPY_BYTES: usize = 1 << 20;

/// Entry of the archive.
struct ArchiveEntry<'a> {
    name: &'a str,
    bytes: u64,
    checksum: u32,
    /// Offset of its local header.
    at: u64,
}

/// Packs the files of a folder into an archive, in the order in which they were begun.
///
/// # Errors
/// When a file cannot be read, or the archive not be written.
pub(super) fn pack(files: &FolderSink, out: &mut dyn Write) -> Result<()> {
    let mut out = BufWriter::with_capacity(COPY_BYTES, out);
    let mut entries = Vec::new();
    let mut at = 0;
    for name in files.keys() {
        let mut file = File::open(files.path(name))?;
        let checksum = checksum(&mut file)?;
        let bytes = file.stream_position()?;
        let entry = ArchiveEntry { name, bytes, checksum, at };
        let header = entry.local_header();
        out.write_all(&header)?;
        file.rewind()?;
        let copied = std::io::copy(&mut file, &mut out)?;
        if copied != bytes {
            return Err(Error::other("a temporary file has changed"));
        }
        at += header.len() as u64 + bytes;
        entries.push(entry);
    }
    let directory: Vec<u8> = entries.iter().flat_map(ArchiveEntry::directory_header).collect();
    out.write_all(&directory)?;
    out.write_all(&directory_end(entries.len() as u64, at, directory.len() as u64))?;
    out.flush()
}

/// Computes the CRC-32 of a file, which is read to its end.
fn checksum(file: &mut File) -> Result<u32> {
    let (mut sum, mut block) = (Crc::new(), vec![0; COPY_BYTES]);
    loop {
        match file.read(&mut block)? {
            0 => return Ok(sum.sum()),
            count => sum.update(&block[..count]),
        }
    }
}

/// Number in 32 bits, or its place holder.
fn short(number: u64) -> u32 {
    u32::try_from(number).unwrap_or(IN_ZIP64_FIELD)
}

impl ArchiveEntry<'_> {
    /// Encodes the fields that both headers share, from the version that is needed to the length of the name.
    fn shared_fields(&self) -> Vec<u8> {
        let mut fields = Vec::new();
        // Stored without compression, at midnight.
        for number in [ZIP64_VERSION, UTF8_NAMES, 0, 0, FIRST_DATE] {
            fields.extend(number.to_le_bytes());
        }
        fields.extend(self.checksum.to_le_bytes());
        fields.extend([short(self.bytes).to_le_bytes(), short(self.bytes).to_le_bytes()].concat());
        fields.extend((self.name.len() as u16).to_le_bytes());
        fields
    }

    /// Encodes the extra field with those numbers that do not fit into 32 bits; empty if all fit.
    fn large_numbers(&self, has_offset: bool) -> Vec<u8> {
        let all = [(self.bytes, true), (self.bytes, true), (self.at, has_offset)];
        let large = all.into_iter().filter(|&(number, is_there)| is_there && short(number) == IN_ZIP64_FIELD);
        let numbers: Vec<u8> = large.flat_map(|(number, _)| number.to_le_bytes()).collect();
        if numbers.is_empty() {
            return numbers;
        }
        [&ZIP64_FIELD.to_le_bytes()[..], &(numbers.len() as u16).to_le_bytes(), &numbers].concat()
    }

    /// Encodes the header before the content (4.3.7).
    fn local_header(&self) -> Vec<u8> {
        let large = self.large_numbers(false);
        let mut header = b"PK\x03\x04".to_vec();
        header.extend(self.shared_fields());
        header.extend((large.len() as u16).to_le_bytes());
        header.extend(self.name.as_bytes());
        header.extend(large);
        header
    }

    /// Encodes the header in the central directory (4.3.12).
    fn directory_header(&self) -> Vec<u8> {
        let large = self.large_numbers(true);
        let mut header = b"PK\x01\x02".to_vec();
        header.extend(MADE_BY.to_le_bytes());
        header.extend(self.shared_fields());
        header.extend((large.len() as u16).to_le_bytes());
        // No comment, the first disk, no internal attributes.
        header.extend([0; 6]);
        header.extend((FILE_MODE << 16).to_le_bytes());
        header.extend(short(self.at).to_le_bytes());
        header.extend(self.name.as_bytes());
        header.extend(large);
        header
    }
}

/// Encodes the records at the end: those of 64 bits (4.3.14, 4.3.15), and that of all archives (4.3.16), whose comment
/// says that metadata come first.
fn directory_end(count: u64, at: u64, bytes: u64) -> Vec<u8> {
    let comment = format!(
        r#"{{"ome":{{"version":"{OME_VERSION}","zipFile":{{"centralDirectory":{{"jsonFirst":true}}}}}}}}"#
    );
    let mut end = b"PK\x06\x06".to_vec();
    end.extend(ZIP64_END_REST.to_le_bytes());
    end.extend([MADE_BY.to_le_bytes(), ZIP64_VERSION.to_le_bytes()].concat());
    // Disks.
    end.extend([0; 8]);
    for number in [count, count, bytes, at] {
        end.extend(number.to_le_bytes());
    }
    end.extend(b"PK\x06\x07\0\0\0\0");
    end.extend((at + bytes).to_le_bytes());
    end.extend(1u32.to_le_bytes());
    end.extend(b"PK\x05\x06\0\0\0\0");
    let entries = u16::try_from(count).unwrap_or(u16::MAX);
    end.extend([entries.to_le_bytes(), entries.to_le_bytes()].concat());
    end.extend([short(bytes).to_le_bytes(), short(at).to_le_bytes()].concat());
    // The comment ends with a zero byte.
    end.extend((comment.len() as u16 + 1).to_le_bytes());
    end.extend(comment.as_bytes());
    end.push(0);
    end
}
