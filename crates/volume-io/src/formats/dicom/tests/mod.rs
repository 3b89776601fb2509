//! Tests of DICOM files, end to end: accepted and refused files.

mod codecs;
mod frames;
mod gaps;
mod mosaics;
mod nested;
mod phases;
mod pixels;
mod refused;
mod segments;
mod series;
mod unplaced;
mod unreadable;

use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::PathBuf;

use flate2::Compression;
use flate2::write::DeflateEncoder;
use tempfile::TempDir;

use super::header::tags::{self, DicomTag};
use super::header::transfer_syntax::{ElementEncoding, TransferSyntax};
use crate::tests::helpers::{assert_refused, load_path};
use crate::{Endian, LoadOptions, load};
use chiaroscuro_volume::{LoadControl, LoadError, LoadErrorKind, Samples, Volume, VolumeChoice};

const IMPLICIT: &str = "1.2.840.10008.1.2";
const EXPLICIT: &str = "1.2.840.10008.1.2.1";
const DEFLATED: &str = "1.2.840.10008.1.2.1.99";
const BIG: &str = "1.2.840.10008.1.2.2";
const RLE: &str = "1.2.840.10008.1.2.5";

/// Content of a data element, for encoding.
#[derive(Debug, Clone)]
enum TestContent {
    /// Value with its representation (VR), encoded.
    Value([u8; 2], Vec<u8>),
    /// Items of a sequence; `true` for undefined lengths with delimiters.
    Items(Vec<DataSetBuilder>, bool),
    /// Fragments of compressed pixels, in order.
    Fragments(Vec<Vec<u8>>),
}

/// Builder of a data set.
#[derive(Debug, Clone, Default)]
struct DataSetBuilder(BTreeMap<DicomTag, TestContent>);

impl DataSetBuilder {
    fn value(mut self, tag: DicomTag, vr: [u8; 2], bytes: &[u8]) -> Self {
        self.0.insert(tag, TestContent::Value(vr, bytes.to_vec()));
        self
    }

    fn text(self, tag: DicomTag, vr: [u8; 2], text: &str) -> Self {
        let space = if text.len().is_multiple_of(2) { "" } else { " " };
        self.value(tag, vr, format!("{text}{space}").as_bytes())
    }

    fn decimal(self, tag: DicomTag, text: &str) -> Self {
        self.text(tag, *b"DS", text)
    }

    fn items(mut self, tag: DicomTag, items: Vec<Self>, is_marked: bool) -> Self {
        self.0.insert(tag, TestContent::Items(items, is_marked));
        self
    }

    fn without(mut self, tag: DicomTag) -> Self {
        self.0.remove(&tag);
        self
    }

    fn bytes(&self, form: ElementEncoding) -> Vec<u8> {
        let u16s = |n: u16| if form.endian == Endian::Little { n.to_le_bytes() } else { n.to_be_bytes() };
        let u32s = |n: u32| if form.endian == Endian::Little { n.to_le_bytes() } else { n.to_be_bytes() };
        let mark = |tag: DicomTag, length: u32| {
            [&u16s((tag >> 16) as u16)[..], &u16s(tag as u16), &u32s(length)].concat()
        };
        let mut bytes = Vec::new();
        for (&tag, content) in &self.0 {
            let (vr, length, body) = match content {
                TestContent::Value(vr, value) => (*vr, value.len() as u32, value.clone()),
                TestContent::Fragments(fragments) => {
                    let each = fragments.iter().flat_map(|f| [mark(tags::ITEM, f.len() as u32), f.clone()]);
                    (*b"OB", u32::MAX, each.chain([mark(tags::SEQUENCE_END, 0)]).collect::<Vec<_>>().concat())
                }
                TestContent::Items(items, is_marked) => {
                    let mut body = Vec::new();
                    for item in items {
                        let set = item.bytes(form);
                        let length = if *is_marked { u32::MAX } else { set.len() as u32 };
                        body.extend([mark(tags::ITEM, length), set].concat());
                        if *is_marked {
                            body.extend(mark(tags::ITEM_END, 0));
                        }
                    }
                    if *is_marked {
                        body.extend(mark(tags::SEQUENCE_END, 0));
                    }
                    (*b"SQ", if *is_marked { u32::MAX } else { body.len() as u32 }, body)
                }
            };
            bytes.extend([u16s((tag >> 16) as u16), u16s(tag as u16)].concat());
            if !form.is_explicit {
                bytes.extend(u32s(length));
            } else if matches!(&vr, b"OB" | b"OW" | b"OF" | b"OD" | b"OV" | b"SQ" | b"UN") {
                bytes.extend([&vr[..], &[0, 0], &u32s(length)].concat());
            } else {
                bytes.extend([&vr[..], &u16s(length as u16)].concat());
            }
            bytes.extend(body);
        }
        bytes
    }
}

/// Builder of a DICOM file.
#[derive(Debug, Clone)]
struct DicomFileBuilder {
    syntax: &'static str,
    set: DataSetBuilder,
}

impl DicomFileBuilder {
    /// A file of 3 x 2 pixels of 16 bits, 10 … 60, with a position.
    fn new(syntax: &'static str) -> Self {
        let set = DataSetBuilder::default()
            .text(tags::SOP_CLASS, *b"UI", "1.2.840.10008.5.1.4.1.1.2")
            .text(tags::MODALITY, *b"CS", "CT")
            .text(tags::SERIES_DESCRIPTION, *b"LO", "Head")
            .text(tags::SERIES_INSTANCE_UID, *b"UI", "1.2.3")
            .decimal(tags::SLICE_THICKNESS, "2.5")
            .decimal(tags::POSITION, "1\\2\\3")
            .decimal(tags::ORIENTATION, "1\\0\\0\\0\\1\\0")
            .decimal(tags::PIXEL_SPACING, "0.5\\0.25")
            .text(tags::PHOTOMETRIC, *b"CS", "MONOCHROME2");
        let file = Self { syntax, set };
        file.short(tags::SAMPLES, 1)
            .short(tags::ROWS, 2)
            .short(tags::COLUMNS, 3)
            .bits(16, 16, false)
            .words(&[10, 20, 30, 40, 50, 60])
    }

    fn form(&self) -> ElementEncoding {
        TransferSyntax::from_uid(self.syntax).encoding
    }

    fn with(self, change: impl FnOnce(DataSetBuilder) -> DataSetBuilder) -> Self {
        Self { set: change(self.set), ..self }
    }

    fn short(self, tag: DicomTag, number: u16) -> Self {
        let is_big = self.form().endian == Endian::Big;
        let bytes = if is_big { number.to_be_bytes() } else { number.to_le_bytes() };
        self.with(|set| set.value(tag, *b"US", &bytes))
    }

    fn bits(self, allocated: u16, stored: u16, is_signed: bool) -> Self {
        self.short(tags::BITS_ALLOCATED, allocated)
            .short(tags::BITS_STORED, stored)
            .short(tags::HIGH_BIT, stored - 1)
            .short(tags::IS_SIGNED, is_signed.into())
    }

    fn size(self, columns: u16, rows: u16) -> Self {
        self.short(tags::COLUMNS, columns).short(tags::ROWS, rows)
    }

    fn frames(self, count: &str) -> Self {
        self.with(|set| set.text(tags::FRAMES, *b"IS", count))
    }

    fn pixels(self, bytes: &[u8]) -> Self {
        self.with(|set| set.value(tags::PIXELS, *b"OW", bytes))
    }

    fn words(self, words: &[u16]) -> Self {
        let is_big = self.form().endian == Endian::Big;
        let bytes = |word: &u16| if is_big { word.to_be_bytes() } else { word.to_le_bytes() };
        let bytes: Vec<u8> = words.iter().flat_map(bytes).collect();
        self.pixels(&bytes)
    }

    fn fragments(mut self, fragments: &[&[u8]]) -> Self {
        let fragments = fragments.iter().map(|fragment| fragment.to_vec()).collect();
        self.set.0.insert(tags::PIXELS, TestContent::Fragments(fragments));
        self
    }

    fn bytes(&self) -> Vec<u8> {
        let meta = DataSetBuilder::default()
            .text(tags::TRANSFER_SYNTAX, *b"UI", self.syntax)
            .bytes(ElementEncoding::EXPLICIT);
        let set = self.set.bytes(self.form());
        let set = if self.syntax == DEFLATED {
            let mut encoder = DeflateEncoder::new(Vec::new(), Compression::fast());
            encoder.write_all(&set).unwrap();
            encoder.finish().unwrap()
        } else {
            set
        };
        [vec![0; 128], b"DICM".to_vec(), meta, set].concat()
    }

    fn write(&self, folder: &TempDir, name: &str) -> PathBuf {
        let path = folder.path().join(name);
        std::fs::write(&path, self.bytes()).unwrap();
        path
    }

    fn load(&self) -> Result<Volume, LoadError> {
        self.load_with(VolumeChoice::default())
    }

    fn load_with(&self, choice: VolumeChoice) -> Result<Volume, LoadError> {
        let folder = TempDir::new().unwrap();
        load_path(&self.write(&folder, "a.dcm"), choice)
    }
}

/// A file of 4 x 3 pixels v = x + 10 y + `base`, with a position.
fn ramp_file(base: u16) -> DicomFileBuilder {
    DicomFileBuilder::new(EXPLICIT).size(4, 3).words(&ramp_values(&[base]))
}

/// Returns the pixels of images as [`ramp_file`] makes them.
fn ramp_values(bases: &[u16]) -> Vec<u16> {
    let pixels = |&base: &u16| (0..12).map(move |at| at % 4 + at / 4 * 10 + base);
    bases.iter().flat_map(pixels).collect()
}

/// Makes a folder with these files, each named by its index.
fn folder(files: &[DicomFileBuilder]) -> TempDir {
    let folder = TempDir::new().unwrap();
    for (number, file) in files.iter().enumerate() {
        file.write(&folder, &format!("{number}"));
    }
    folder
}

#[track_caller]
fn assert_remark(volume: &Volume, words: &str) {
    let remarks = volume.remarks();
    assert!(remarks.iter().any(|remark| remark.contains(words)), "{words:?} is not in {remarks:?}");
}

/// Returns axes and origin of a volume, rounded.
fn affine_columns(volume: &Volume) -> [f64; 12] {
    volume.world_from_index().to_cols_array().map(|number| (number * 1e6).round() / 1e6)
}
