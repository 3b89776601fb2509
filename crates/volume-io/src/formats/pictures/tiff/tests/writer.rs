//! Writer of TIFF files of a few pixels, for tests.

use crate::Endian;
use crate::formats::pictures::tiff::file::page::tag;

/// Types of directory values.
pub(super) const ASCII: u16 = 2;
const BYTE: u16 = 1;
pub(super) const SHORT: u16 = 3;
pub(super) const LONG: u16 = 4;
const RATIONAL: u16 = 5;
const LONG8: u16 = 16;

/// Directory entry: type, count, and the bytes of its values.
#[derive(Clone)]
struct TiffField {
    kind: u16,
    count: u64,
    bytes: Vec<u8>,
}

/// Page to write: its directory entries and its data.
#[derive(Clone)]
pub(super) struct TiffLeaf {
    fields: Vec<(u16, TiffField)>,
    parts: Vec<Vec<u8>>,
    is_tiled: bool,
    endian: Endian,
    is_big: bool,
}

/// Byte order and flavour (classic or `BigTIFF`) of a file to write.
#[derive(Clone, Copy)]
pub(super) struct TiffWriter {
    pub(super) endian: Endian,
    pub(super) is_big: bool,
}

pub(super) const LITTLE: TiffWriter = TiffWriter { endian: Endian::Little, is_big: false };

impl TiffWriter {
    /// Creates a page of one strip.
    pub(super) fn leaf(self, [width, height]: [u64; 2], bits: u64, pixels: &[u8]) -> TiffLeaf {
        let leaf = TiffLeaf {
            fields: Vec::new(),
            parts: vec![pixels.to_vec()],
            is_tiled: false,
            endian: self.endian,
            is_big: self.is_big,
        };
        leaf.with(tag::WIDTH, LONG, &[width])
            .with(tag::HEIGHT, SHORT, &[height])
            .with(tag::BITS, SHORT, &[bits])
            .with(tag::PHOTOMETRIC, SHORT, &[1])
    }

    fn number(self, value: u64, bytes: usize) -> Vec<u8> {
        match self.endian {
            Endian::Little => value.to_le_bytes()[..bytes].to_vec(),
            Endian::Big => value.to_be_bytes()[8 - bytes..].to_vec(),
        }
    }

    /// Writes a file of these pages.
    pub(super) fn file(self, leaves: &[TiffLeaf]) -> Vec<u8> {
        let place = if self.is_big { 8 } else { 4 };
        let mut file = match self.endian {
            Endian::Little => b"II".to_vec(),
            Endian::Big => b"MM".to_vec(),
        };
        if self.is_big {
            file.extend([self.number(43, 2), self.number(8, 2), self.number(0, 2)].concat());
        } else {
            file.extend(self.number(42, 2));
        }
        // Where the offset of the next directory is to be written.
        let mut link = file.len();
        file.extend(vec![0; place]);
        for leaf in leaves {
            let mut offsets = Vec::new();
            for part in &leaf.parts {
                offsets.push(if part.is_empty() { 0 } else { file.len() as u64 });
                file.extend(part);
            }
            let counts: Vec<u64> = leaf.parts.iter().map(|part| part.len() as u64).collect();
            let kind = if self.is_big { LONG8 } else { LONG };
            let (at, of) = if leaf.is_tiled {
                (tag::TILE_OFFSETS, tag::TILE_COUNTS)
            } else {
                (tag::STRIP_OFFSETS, tag::STRIP_COUNTS)
            };
            let mut leaf = leaf.clone();
            for (tag, numbers) in [(at, offsets), (of, counts)] {
                // An entry that the test has set itself is kept.
                if leaf.fields.iter().all(|(found, _)| *found != tag) {
                    leaf = leaf.with(tag, kind, &numbers);
                }
            }
            leaf.fields.sort_by_key(|(tag, _)| *tag);
            let mut directory = self.number(leaf.fields.len() as u64, if self.is_big { 8 } else { 2 });
            for (tag, field) in &leaf.fields {
                directory.extend([self.number((*tag).into(), 2), self.number(field.kind.into(), 2)].concat());
                directory.extend(self.number(field.count, place));
                if field.bytes.len() <= place {
                    let mut inside = field.bytes.clone();
                    inside.resize(place, 0);
                    directory.extend(inside);
                } else {
                    directory.extend(self.number(file.len() as u64, place));
                    file.extend(&field.bytes);
                }
            }
            let here = self.number(file.len() as u64, place);
            file[link..link + place].copy_from_slice(&here);
            file.extend(&directory);
            link = file.len();
            file.extend(vec![0; place]);
        }
        file
    }
}

impl TiffLeaf {
    fn writer(&self) -> TiffWriter {
        TiffWriter { endian: self.endian, is_big: self.is_big }
    }

    fn put(mut self, tag: u16, field: TiffField) -> Self {
        self.fields.retain(|(found, _)| *found != tag);
        self.fields.push((tag, field));
        self
    }

    /// Sets an entry of integers.
    pub(super) fn with(self, tag: u16, kind: u16, values: &[u64]) -> Self {
        let size = match kind {
            BYTE => 1,
            SHORT => 2,
            LONG => 4,
            _ => 8,
        };
        let writer = self.writer();
        let bytes = values.iter().flat_map(|&value| writer.number(value, size)).collect();
        self.put(tag, TiffField { kind, count: values.len() as u64, bytes })
    }

    pub(super) fn with_rational(self, tag: u16, over: u64, under: u64) -> Self {
        let writer = self.writer();
        let bytes = [writer.number(over, 4), writer.number(under, 4)].concat();
        self.put(tag, TiffField { kind: RATIONAL, count: 1, bytes })
    }

    pub(super) fn with_text(self, tag: u16, text: &str) -> Self {
        let bytes = [text.as_bytes(), &[0]].concat();
        self.put(tag, TiffField { kind: ASCII, count: bytes.len() as u64, bytes })
    }

    /// Inserts another text of a tag before the one that the page has.
    pub(super) fn with_second_text(mut self, tag: u16, text: &str) -> Self {
        let bytes = [text.as_bytes(), &[0]].concat();
        let field = TiffField { kind: ASCII, count: bytes.len() as u64, bytes };
        self.fields.insert(0, (tag, field));
        self
    }

    pub(super) fn with_bytes(self, tag: u16, bytes: &[u8]) -> Self {
        self.put(tag, TiffField { kind: BYTE, count: bytes.len() as u64, bytes: bytes.to_vec() })
    }

    pub(super) fn with_parts(self, parts: Vec<Vec<u8>>) -> Self {
        Self { parts, ..self }
    }

    pub(super) fn with_rows_per_strip(self, rows: u64, parts: Vec<Vec<u8>>) -> Self {
        self.with(tag::ROWS_PER_STRIP, SHORT, &[rows]).with_parts(parts)
    }

    pub(super) fn with_tiles(self, [width, height]: [u64; 2], parts: Vec<Vec<u8>>) -> Self {
        let tiled = self.with(tag::TILE_WIDTH, SHORT, &[width]).with(tag::TILE_HEIGHT, SHORT, &[height]);
        Self { is_tiled: true, ..tiled.with_parts(parts) }
    }
}
