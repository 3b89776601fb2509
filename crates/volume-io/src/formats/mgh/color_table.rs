//! Colour table of an MGH file: names and colours of labels, which `FreeSurfer` stores behind the voxels.
//!
//! After `fio.cpp`, `tags.cpp` and `colortab.cpp` of `FreeSurfer` (`TAGreadStart`, `znzCTABreadFromBinary`): five
//! real numbers on the acquisition, then tags. All numbers are big-endian.

use chiaroscuro_volume::FileLabelTable;

/// Maximum number of bytes read behind the voxels: a table of the two thousand labels of the finest atlases takes 100
/// KiB, and the command lines that made the file precede it.
pub(super) const MAX_FOOTER_BYTES: u64 = 4 << 20;

/// Size of the acquisition parameters: repetition time, flip angle, echo time, inversion time, field of view.
const ACQUISITION_BYTES: usize = 20;

/// Tags (`tags.h`) whose length is absent or encoded differently from that of other tags.
const OLD_COLOR_TABLE: i32 = 1;
const OLD_REAL_RAS: i32 = 2;
const OLD_SURFACE_GEOMETRY: i32 = 20;
const OLD_TRANSFORM: i32 = 30;

/// Version of tables in which each entry stores its label number.
const NUMBERED_VERSION: i32 = -2;

/// Parses the labels from the bytes behind the voxels; empty if there is no table, or an invalid one.
pub(super) fn parse_labels(footer: &[u8]) -> FileLabelTable {
    find_table(&mut BigEndianCursor { remaining: footer }).unwrap_or_default()
}

fn find_table(bytes: &mut BigEndianCursor<'_>) -> Option<FileLabelTable> {
    bytes.take(ACQUISITION_BYTES)?;
    loop {
        let skip = match bytes.int()? {
            OLD_COLOR_TABLE => return parse_table(bytes),
            OLD_REAL_RAS | OLD_SURFACE_GEOMETRY => 0,
            // The stored length includes a terminating zero that is not written.
            OLD_TRANSFORM => i64::from(bytes.int()?) - 1,
            // Tag 0 ends the list.
            0 => return None,
            _ => bytes.long()?,
        };
        bytes.take(usize::try_from(skip).ok()?)?;
    }
}

fn parse_table(bytes: &mut BigEndianCursor<'_>) -> Option<FileLabelTable> {
    let first = bytes.int()?;
    let has_numbers = first == NUMBERED_VERSION;
    // Highest label number in version 2, number of entries in the older version.
    let count = if has_numbers { bytes.int()? } else { first };
    bytes.text()?;
    let count = if has_numbers { bytes.int()? } else { count };
    let mut labels = FileLabelTable::default();
    for at in 0..count {
        let number = if has_numbers { bytes.int()? } else { at };
        let name = bytes.text()?;
        let parts = [bytes.int()?, bytes.int()?, bytes.int()?];
        let _transparency = bytes.int()?;
        labels.insert(i64::from(number), &name, Some(parts.map(|part| part as f32 / 255.0)));
    }
    Some(labels)
}

/// Cursor over the bytes that are still to be parsed.
struct BigEndianCursor<'a> {
    remaining: &'a [u8],
}

impl<'a> BigEndianCursor<'a> {
    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, left) = self.remaining.split_at_checked(count)?;
        self.remaining = left;
        Some(taken)
    }

    fn int(&mut self) -> Option<i32> {
        self.take(4)?.try_into().ok().map(i32::from_be_bytes)
    }

    fn long(&mut self) -> Option<i64> {
        self.take(8)?.try_into().ok().map(i64::from_be_bytes)
    }

    /// Reads text that follows its length, up to its terminating zero.
    fn text(&mut self) -> Option<String> {
        let length = usize::try_from(self.int()?).ok()?;
        let bytes = self.take(length)?;
        let text = bytes.split(|&byte| byte == 0).next().unwrap_or_default();
        Some(String::from_utf8_lossy(text).into_owned())
    }
}
