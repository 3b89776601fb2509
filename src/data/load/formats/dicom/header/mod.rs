//! Header of a DICOM file: all data elements before the pixels.

pub(super) mod bytes;
pub(super) mod csa;
pub(super) mod found;
pub(super) mod place;
pub(super) mod plane;
mod plane_elements;
pub(super) mod segments;
pub(super) mod syntax;
pub(super) mod tags;
pub(super) mod taken;
mod value;
pub(super) mod walk;

use std::io;
use std::path::{Path, PathBuf};

use super::object_class::ObjectClass;
use crate::data::attempt::{Attempt, quoted};
use crate::data::load::reading::input::Input;
use crate::data::load::reading::reader::Start;
use crate::data::load::{Endian, LoadControl, LoadError};
use bytes::{Bytes, LONGEST_VALUE};
use found::Found;
use syntax::{Form, Syntax};
use tags::{ITEM, TRANSFER_SYNTAX};
use value::Value;
use walk::{Broken, PixelElement, head, walk};

/// Offset of the magic bytes `DICM` (PS3.10 section 7.1), behind a preamble of 128 bytes.
const MARK_AT: usize = 128;

/// Maximum number of elements of the file meta group: the standard has twelve.
const MOST_META_ELEMENTS: usize = 1000;

/// Header of a DICOM file, parsed up to its pixels.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) path: PathBuf,
    /// Size of the file in bytes.
    pub(super) len: u64,
    pub(super) syntax: Syntax,
    pub(super) found: Found,
    pub(super) pixels: Option<PixelElement>,
}

/// True if these bytes begin a DICOM file: by the magic bytes, or by the first two elements in files without them.
pub(super) fn is_dicom(start: &[u8]) -> bool {
    has_mark(start) || begins_with_elements(start)
}

fn has_mark(start: &[u8]) -> bool {
    start.get(MARK_AT..MARK_AT + 4) == Some(b"DICM")
}

/// True if a file begins with two elements of the lowest groups, in ascending order.
fn begins_with_elements(start: &[u8]) -> bool {
    let form = Form::of_start(start, Form::EXPLICIT);
    let u16_at =
        |at: usize| Value { bytes: start.get(at..).unwrap_or_default(), endian: form.endian }.short();
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

impl Header {
    /// Reads the header of a file.
    pub(super) fn read(path: &Path, control: &LoadControl) -> Result<(Self, Bytes), LoadError> {
        let attempt = Attempt { what: super::WHAT, path };
        let mut input = Input::open(attempt)?;
        let start = Start::of(&mut input).map_err(|error| attempt.io(error))?;
        Self::of(attempt, input, start.stored(), control)
    }

    /// Reads the header of a file that is already open and begins with the bytes `start`.
    pub(super) fn of(
        attempt: Attempt<'_>,
        input: Input,
        start: &[u8],
        control: &LoadControl,
    ) -> Result<(Self, Bytes), LoadError> {
        let len = input.len;
        let mut bytes = Bytes::of(input);
        let broken = |broken: Broken| broken.into_error(attempt);
        if has_mark(start) {
            bytes.skip(MARK_AT as u64 + 4).map_err(|error| attempt.io(error))?;
        }
        let said = meta(&mut bytes).map_err(broken)?;
        let mut syntax = said.as_deref().map_or(Syntax::unsaid(Form::EXPLICIT), Syntax::of);
        if syntax.is_deflated {
            bytes = bytes.inflated();
        } else {
            // The data themselves decide: programs convert a file and leave its transfer syntax unchanged.
            let start = bytes.peek::<6>().map_err(|error| attempt.io(error))?;
            syntax.form = Form::of_start(&start, syntax.form);
        }
        let mut found = Found::default();
        let pixels = walk(&mut bytes, syntax.form, &mut found, control).map_err(broken)?;
        if let Some(pixels) = pixels
            && !syntax.is_deflated
        {
            let start = if syntax.is_private() { first_fragment(&mut bytes, pixels) } else { Ok(Vec::new()) };
            let start = start.map_err(|error| attempt.io(error))?;
            syntax = syntax.looked_at(pixels.length, native_bytes(&found), &start);
        }
        Ok((Self { path: attempt.path.to_owned(), len, syntax, found, pixels }, bytes))
    }

    /// Describes a file without pixels: the name of its class, or what its header states.
    pub(super) fn kind(&self) -> String {
        let found = &self.found;
        let class = ObjectClass::from_uid(&found.sop_class);
        match (class, found.modality.as_str(), found.sop_class.as_str()) {
            _ if found.is_directory => "a list of files (DICOMDIR)".to_owned(),
            (Some(class), ..) => class.name.to_owned(),
            (None, "", "") => "it says nothing of what it is".to_owned(),
            (None, "", class) => format!("of class {}", quoted(class)),
            (None, modality, _) => format!("of modality {}", quoted(modality)),
        }
    }

    /// Returns the stated number of frames, at least 1.
    pub(super) fn frame_count(&self) -> u64 {
        self.found.frame_count.map_or(1, |count| count.max(1.0) as u64)
    }
}

/// Number of bytes of a compressed image that identify its codec: more than precede the size in a JPEG.
const FRAGMENT_START: usize = 4096;

/// Returns the beginning of the first compressed image; empty if the pixels are not in fragments.
fn first_fragment(bytes: &mut Bytes, pixels: PixelElement) -> io::Result<Vec<u8>> {
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
    bytes.peek::<FRAGMENT_START>()
}

/// Returns the size of the pixels without compression, in bytes; `None` if the header lacks a factor.
fn native_bytes(found: &Found) -> Option<u64> {
    let factors = [found.rows?, found.columns?, found.samples.unwrap_or(1), found.bits_allocated?];
    let bits = factors.into_iter().map(u64::from).product::<u64>();
    Some((bits.checked_mul(found.frame_count.map_or(1, |count| count.max(1.0) as u64))?).div_ceil(8))
}

/// Reads the file meta group; returns the identifier of the transfer syntax.
fn meta(bytes: &mut Bytes) -> Result<Option<String>, Broken> {
    let mut said = None;
    for _ in 0..MOST_META_ELEMENTS {
        if bytes.peek::<2>()? != [2, 0] {
            return Ok(said);
        }
        let Some(tag) = bytes.tag(Endian::Little)? else { return Ok(said) };
        let length = u64::from(head(bytes, true, Endian::Little)?.length);
        if tag == TRANSFER_SYNTAX && length <= LONGEST_VALUE {
            said = Some(Value { bytes: &bytes.value(length)?, endian: Endian::Little }.text());
        } else {
            bytes.skip(length)?;
        }
    }
    Err(Broken::Wrong(format!("its first group has more than {MOST_META_ELEMENTS} elements")))
}
