//! Header of a DICOM file: all data elements before the pixels.

pub(super) mod acquisition_attributes;
pub(super) mod csa;
pub(super) mod element_context;
mod element_value;
pub(super) mod image_plane;
pub(super) mod parser;
mod plane_elements;
mod private_elements;
pub(super) mod reader;
pub(super) mod segments;
pub(super) mod tags;
pub(super) mod transfer_syntax;
pub(super) mod values;

use std::io;
use std::path::{Path, PathBuf};

use super::object_class::ObjectClass;
use crate::Endian;
use crate::reading::input::InputFile;
use crate::reading::reader::FileStart;
use chiaroscuro_volume::{LoadContext, LoadControl, LoadError, quoted};
use element_value::ElementValue;
use parser::{DataSetError, PixelElement, parse_data_set, read_element_head};
use reader::{DicomReader, MAX_VALUE_BYTES};
use tags::{ITEM, TRANSFER_SYNTAX};
use transfer_syntax::{ElementEncoding, TransferSyntax};
use values::DicomValues;

/// Offset of the magic bytes `DICM` (PS3.10 section 7.1), behind a preamble of 128 bytes.
const MAGIC_OFFSET: usize = 128;

/// Maximum number of elements of the file meta group: the standard has twelve.
const MAX_META_ELEMENTS: usize = 1000;

/// Header of a DICOM file, parsed up to its pixels.
#[derive(Debug)]
pub(super) struct DicomHeader {
    pub(super) path: PathBuf,
    /// Size of the file in bytes.
    pub(super) file_bytes: u64,
    pub(super) syntax: TransferSyntax,
    pub(super) values: DicomValues,
    pub(super) pixels: Option<PixelElement>,
}

/// True if these bytes begin a DICOM file: by the magic bytes, or by the first two elements in files without them.
pub(super) fn is_dicom(start: &[u8]) -> bool {
    has_magic(start) || begins_with_elements(start)
}

fn has_magic(start: &[u8]) -> bool {
    start.get(MAGIC_OFFSET..MAGIC_OFFSET + 4) == Some(b"DICM")
}

/// True if a file begins with two elements of the lowest groups, in ascending order.
fn begins_with_elements(start: &[u8]) -> bool {
    let form = ElementEncoding::detect(start, ElementEncoding::EXPLICIT);
    let u16_at =
        |at: usize| ElementValue { bytes: start.get(at..).unwrap_or_default(), endian: form.endian }.u16();
    let tag_at = |at: usize| Some((u16_at(at)?, u16_at(at.checked_add(2)?)?));
    let Some((first, _)) = tag_at(0) else { return false };
    if first != 2 && first != 8 {
        return false;
    }
    let length = match (form.is_explicit, start.get(4..6)) {
        (true, Some(b"UL" | b"CS" | b"UI" | b"DA" | b"TM" | b"SH" | b"LO")) => u16_at(6),
        (true, _) => None,
        // Lengths of 32 bits: those of the first elements are small.
        (false, _) => u16_at(4).filter(|_| u16_at(6) == Some(0)),
    };
    let Some(length) = length.filter(|&length| length % 2 == 0 && length <= 256) else { return false };
    let second = tag_at(8 + usize::from(length));
    let is_next = |second: (u16, u16)| matches!(second.0, 2 | 8) && Some(second) > tag_at(0);
    second.is_some_and(is_next)
}

impl DicomHeader {
    /// Reads the header of a file.
    pub(super) fn read(path: &Path, control: &LoadControl) -> Result<(Self, DicomReader), LoadError> {
        let context = LoadContext { operation: super::READ_FILE, path };
        let mut input = InputFile::open(context)?;
        let start = FileStart::read(&mut input).map_err(|error| context.io_error(error))?;
        Self::parse(context, input, start.stored(), control)
    }

    /// Reads the header of a file that is already open and begins with the bytes `start`.
    pub(super) fn parse(
        context: LoadContext<'_>,
        input: InputFile,
        start: &[u8],
        control: &LoadControl,
    ) -> Result<(Self, DicomReader), LoadError> {
        let len = input.len;
        let mut bytes = DicomReader::new(input);
        let broken = |broken: DataSetError| broken.into_error(context);
        if has_magic(start) {
            bytes.skip(MAGIC_OFFSET as u64 + 4).map_err(|error| context.io_error(error))?;
        }
        let syntax_uid = read_file_meta(&mut bytes).map_err(broken)?;
        let mut syntax = syntax_uid
            .as_deref()
            .map_or(TransferSyntax::native(ElementEncoding::EXPLICIT), TransferSyntax::from_uid);
        if syntax.is_deflated {
            bytes = bytes.into_inflated();
        } else {
            // The data themselves decide: programs convert a file and leave its transfer syntax unchanged.
            let start = bytes.peek::<6>().map_err(|error| context.io_error(error))?;
            syntax.encoding = ElementEncoding::detect(&start, syntax.encoding);
        }
        let mut found = DicomValues::default();
        let pixels = parse_data_set(&mut bytes, syntax.encoding, &mut found, control).map_err(broken)?;
        if let Some(pixels) = pixels
            && !syntax.is_deflated
        {
            let start =
                if syntax.is_private() { read_fragment_start(&mut bytes, pixels) } else { Ok(Vec::new()) };
            let start = start.map_err(|error| context.io_error(error))?;
            syntax = syntax.corrected_by_pixels(pixels.length, native_bytes(&found), &start);
        }
        Ok((Self { path: context.path.to_owned(), file_bytes: len, syntax, values: found, pixels }, bytes))
    }

    /// Describes a file without pixels: the name of its class, or what its header states.
    pub(super) fn object_kind(&self) -> String {
        let found = &self.values;
        let class = ObjectClass::from_uid(&found.sop_class);
        match (class, found.modality.as_str(), found.sop_class.as_str()) {
            _ if found.is_directory => "list of files (DICOMDIR)".to_owned(),
            (Some(class), ..) => class.name.to_owned(),
            (None, "", "") => "of unstated class and modality".to_owned(),
            (None, "", class) => format!("of class {}", quoted(class)),
            (None, modality, _) => format!("of modality {}", quoted(modality)),
        }
    }

    /// Returns the stated number of frames, at least 1.
    pub(super) fn frame_count(&self) -> u64 {
        self.values.frame_count.map_or(1, |count| count.max(1.0) as u64)
    }
}

/// Number of bytes of a compressed image that identify its codec: more than precede the size in a JPEG.
const FRAGMENT_START_BYTES: usize = 4096;

/// Returns the beginning of the first compressed image; empty if the pixels are not in fragments.
fn read_fragment_start(bytes: &mut DicomReader, pixels: PixelElement) -> io::Result<Vec<u8>> {
    if pixels.length.is_some() {
        return Ok(Vec::new());
    }
    // The first item is the offset table. Truncation here is reported later, in a clearer message.
    let (Some(ITEM), Ok(length)) = (bytes.tag(Endian::Little)?, bytes.u32(Endian::Little)) else {
        return Ok(Vec::new());
    };
    if bytes.skip(u64::from(length)).is_err() || bytes.skip(8).is_err() {
        return Ok(Vec::new());
    }
    bytes.peek::<FRAGMENT_START_BYTES>()
}

/// Returns the size of the pixels without compression, in bytes; `None` if the header lacks a factor.
fn native_bytes(found: &DicomValues) -> Option<u64> {
    let factors = [found.rows?, found.columns?, found.samples.unwrap_or(1), found.bits_allocated?];
    let bits = factors.into_iter().map(u64::from).product::<u64>();
    Some((bits.checked_mul(found.frame_count.map_or(1, |count| count.max(1.0) as u64))?).div_ceil(8))
}

/// Reads the file meta group; returns the identifier of the transfer syntax.
fn read_file_meta(bytes: &mut DicomReader) -> Result<Option<String>, DataSetError> {
    let mut said = None;
    for _ in 0..MAX_META_ELEMENTS {
        if bytes.peek::<2>()? != [2, 0] {
            return Ok(said);
        }
        let Some(tag) = bytes.tag(Endian::Little)? else { return Ok(said) };
        let length = u64::from(read_element_head(bytes, true, Endian::Little)?.length);
        if tag == TRANSFER_SYNTAX && length <= MAX_VALUE_BYTES {
            said = Some(ElementValue { bytes: &bytes.value(length)?, endian: Endian::Little }.text());
        } else {
            bytes.skip(length)?;
        }
    }
    Err(DataSetError::Malformed(format!(
        "its file meta information has more than {MAX_META_ELEMENTS} elements"
    )))
}
