//! The header of a file: everything before its pixels.

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

/// Where files have their mark (PS3.10 section 7.1): after 128 bytes that mean nothing.
const MARK_AT: usize = 128;

/// Elements of the group that says how the rest is written: the standard has twelve.
const MOST_META_ELEMENTS: usize = 1000;

/// A file, read up to its pixels.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) path: PathBuf,
    /// Bytes of the file.
    pub(super) len: u64,
    pub(super) syntax: Syntax,
    pub(super) found: Found,
    pub(super) pixels: Option<PixelElement>,
}

/// Whether a file that begins like this is one: by its mark, or by its first two elements where it has none.
pub(super) fn is_dicom(start: &[u8]) -> bool {
    has_mark(start) || begins_with_elements(start)
}

fn has_mark(start: &[u8]) -> bool {
    start.get(MARK_AT..MARK_AT + 4) == Some(b"DICM")
}

/// Whether two elements of the groups that come first begin a file, in order.
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
        // Of 32 bits: the first that come are short.
        (false, _) => u16_at(4).filter(|_| u16_at(6) == Some(0)),
    };
    let Some(length) = length.filter(|&length| length % 2 == 0 && length <= 256) else { return false };
    let second = tag_at(8 + usize::from(length));
    let is_next = |second: (u16, u16)| matches!(second.0, 2 | 8) && Some(second) > tag_at(0);
    second.is_some_and(is_next)
}

impl Header {
    /// Reads a file's header.
    pub(super) fn read(path: &Path, control: &LoadControl) -> Result<(Self, Bytes), LoadError> {
        let attempt = Attempt { what: super::WHAT, path };
        let mut input = Input::open(attempt)?;
        let start = Start::of(&mut input).map_err(|error| attempt.io(error))?;
        Self::of(attempt, input, start.stored(), control)
    }

    /// As [`Self::read`], of a file that is open and begins so.
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
            // What is there counts: programs convert a file and forget to say so.
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

    /// What it is, where it has no pixels: the name of its class, or what it says of itself.
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

    /// How many frames it says that it has; at least one.
    pub(super) fn frame_count(&self) -> u64 {
        self.found.frame_count.map_or(1, |count| count.max(1.0) as u64)
    }
}

/// Bytes of a picture whose beginning says how it is compressed: more than what stands before the size of a JPEG.
const FRAGMENT_START: usize = 4096;

/// The beginning of the first compressed picture; nothing where pixels are not in fragments.
fn first_fragment(bytes: &mut Bytes, pixels: PixelElement) -> io::Result<Vec<u8>> {
    if pixels.length.is_some() {
        return Ok(Vec::new());
    }
    // The first item is a table. What is cut off there is told later, with better words.
    let (Some(ITEM), Ok(length)) = (bytes.tag(Endian::Little)?, bytes.u32(Endian::Little)) else {
        return Ok(Vec::new());
    };
    if bytes.skip(u64::from(length)).is_err() || bytes.skip(8).is_err() {
        return Ok(Vec::new());
    }
    bytes.peek::<FRAGMENT_START>()
}

/// Bytes that the pixels have without compression; `None` where the header does not say it.
fn native_bytes(found: &Found) -> Option<u64> {
    let factors = [found.rows?, found.columns?, found.samples.unwrap_or(1), found.bits_allocated?];
    let bits = factors.into_iter().map(u64::from).product::<u64>();
    Some((bits.checked_mul(found.frame_count.map_or(1, |count| count.max(1.0) as u64))?).div_ceil(8))
}

/// Reads the group that says how the rest is written; the identifier of the transfer syntax.
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
