//! Parser of a data set's elements, in order (PS3.5 chapter 7): those in use are read, all others are skipped.
//! Nesting is kept on an explicit stack instead of recursion, and every length is checked against the enclosing one.

use std::io;

use super::element_context::ElementContext;
use super::reader::{DicomReader, MAX_VALUE_BYTES};
use super::tags::{DOUBLES, DicomTag, FLOATS, ITEM, ITEM_END, PIXELS, SEQUENCE_END, format_tag};
use super::transfer_syntax::ElementEncoding;
use super::values::DicomValues;
use crate::Endian;
use chiaroscuro_volume::{LoadContext, LoadControl, LoadError};

/// Maximum nesting depth of sequences: real files nest some ten.
const MAX_NESTING: usize = 64;

/// Maximum number of elements parsed: those of a hundred thousand frames.
const MAX_ELEMENTS: usize = 1 << 24;

/// Maximum size of a deflated header after inflating, in bytes.
const MAX_INFLATED_BYTES: u64 = 1 << 30;

/// Number of elements between two checks for cancellation.
const ELEMENTS_PER_CHECK: usize = 1 << 12;

/// Undefined length: a delimiter ends the value.
const UNDEFINED_LENGTH: u32 = u32::MAX;

/// Location of the pixels in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PixelElement {
    pub(crate) tag: DicomTag,
    /// True if bytes are stored in 16-bit words, and so swapped in big-endian order.
    pub(crate) is_words: bool,
    /// Byte offset of the value.
    pub(crate) offset: u64,
    /// Length of the value in bytes; `None` if it is in fragments.
    pub(crate) length: Option<u64>,
}

/// Reason why a data set cannot be parsed.
#[derive(Debug)]
pub(crate) enum DataSetError {
    Io(io::Error),
    /// Malformed data, described for the user.
    Malformed(String),
    Cancelled(LoadError),
}

impl From<io::Error> for DataSetError {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::UnexpectedEof => {
                Self::Malformed("the file is truncated: it ends within a data element".to_owned())
            }
            io::ErrorKind::InvalidData | io::ErrorKind::InvalidInput => {
                Self::Malformed(format!("its deflated data are broken: {error}"))
            }
            _ => Self::Io(error),
        }
    }
}

impl DataSetError {
    pub(crate) fn into_error(self, load: LoadContext<'_>) -> LoadError {
        match self {
            Self::Io(error) => load.io_error(error),
            Self::Malformed(why) => load.bad_input_error("data set", why, "copy or export the file again"),
            Self::Cancelled(error) => error,
        }
    }
}

/// Sequence or item that is currently open.
struct OpenSequence {
    /// Tag of the sequence; `None` for an item.
    sequence: Option<DicomTag>,
    /// Number of items begun so far.
    items: usize,
    context: ElementContext,
    is_explicit: bool,
    /// End offset, if the length is defined.
    end: Option<u64>,
    /// Offset that no element within may pass: its own end, or that of the enclosing level.
    limit: u64,
}

/// Head of a data element: everything before its value.
pub(crate) struct ElementHead {
    /// Value representation, two letters; `None` in implicit encoding.
    vr: Option<[u8; 2]>,
    pub(crate) length: u32,
}

/// Parses a data set up to its pixels.
///
/// # Errors
/// Data that contradict themselves, end too early, or nest too deeply.
pub(crate) fn parse_data_set(
    bytes: &mut DicomReader,
    form: ElementEncoding,
    found: &mut DicomValues,
    control: &LoadControl,
) -> Result<Option<PixelElement>, DataSetError> {
    let mut parser = DataSetParser { bytes, endian: form.endian, found, levels: Vec::new() };
    for count in 0..MAX_ELEMENTS {
        if count % ELEMENTS_PER_CHECK == 0 {
            control.check().map_err(DataSetError::Cancelled)?;
        }
        if parser.bytes.is_deflated() && parser.bytes.position > MAX_INFLATED_BYTES {
            return Err(DataSetError::Malformed(format!(
                "its header has more than {MAX_INFLATED_BYTES} bytes"
            )));
        }
        parser.close_ended_levels();
        let Some(tag) = parser.bytes.tag(form.endian)? else { return Ok(None) };
        let level = parser.current_level(form.is_explicit);
        match tag {
            // Zeros that pad a file.
            0 if parser.levels.is_empty() => return Ok(None),
            ITEM => parser.open_item(level)?,
            ITEM_END | SEQUENCE_END => parser.close_delimited(tag)?,
            _ => {
                if let Some(pixels) = parser.parse_element(tag, level)? {
                    return Ok(Some(pixels));
                }
            }
        }
    }
    Err(DataSetError::Malformed(format!("it has more than {MAX_ELEMENTS} elements")))
}

/// Properties of the level in which an element lies.
#[derive(Debug, Clone, Copy)]
struct CurrentLevel {
    context: ElementContext,
    is_explicit: bool,
    /// Offset that no element within may pass.
    limit: u64,
}

/// State of parsing a data set.
struct DataSetParser<'a> {
    bytes: &'a mut DicomReader,
    endian: Endian,
    found: &'a mut DicomValues,
    /// Open sequences and items, innermost last.
    levels: Vec<OpenSequence>,
}

impl DataSetParser<'_> {
    /// Closes the levels of defined length that end here.
    fn close_ended_levels(&mut self) {
        while self.levels.last().is_some_and(|level| level.end == Some(self.bytes.position)) {
            self.levels.pop();
        }
    }

    /// Returns the innermost level; `is_explicit` is the encoding of the top level.
    fn current_level(&self, is_explicit: bool) -> CurrentLevel {
        let top = CurrentLevel { context: ElementContext::TopLevel, is_explicit, limit: self.bytes.len };
        self.levels.last().map_or(top, |level| CurrentLevel {
            context: level.context,
            is_explicit: level.is_explicit,
            limit: level.limit,
        })
    }

    /// Opens an item, whose tag has been read.
    fn open_item(&mut self, level: CurrentLevel) -> Result<(), DataSetError> {
        let length = self.bytes.u32(self.endian)?;
        let end = end_offset(self.bytes.position, length, level.limit, ITEM)?;
        let item = self.levels.last_mut().and_then(|sequence| {
            let tag = sequence.sequence?;
            sequence.items += 1;
            Some(level.context.in_item(tag, sequence.items - 1))
        });
        let context =
            item.ok_or_else(|| DataSetError::Malformed("an item lies outside of a sequence".to_owned()))?;
        self.levels.push(OpenSequence {
            sequence: None,
            items: 0,
            context,
            is_explicit: level.is_explicit,
            end,
            limit: end.unwrap_or(level.limit),
        });
        Ok(())
    }

    /// Closes the level that a delimiter ends.
    fn close_delimited(&mut self, tag: DicomTag) -> Result<(), DataSetError> {
        self.bytes.u32(self.endian)?;
        // Some programs write delimiters after defined lengths as well; they are harmless.
        if self.levels.last().is_some_and(|level| level.sequence.is_some() == (tag == SEQUENCE_END)) {
            self.levels.pop();
        }
        Ok(())
    }

    /// Parses an element whose tag has been read: stores or skips its value, or opens its sequence. Returns the
    /// location of the pixels where it holds them.
    fn parse_element(
        &mut self,
        tag: DicomTag,
        level: CurrentLevel,
    ) -> Result<Option<PixelElement>, DataSetError> {
        let CurrentLevel { context, is_explicit, limit } = level;
        let is_top = self.levels.is_empty();
        if self.levels.last().is_some_and(|level| level.sequence.is_some()) {
            return Err(DataSetError::Malformed(format!(
                "{} lies between the items of a sequence",
                format_tag(tag)
            )));
        }
        let head = read_element_head(self.bytes, is_explicit, self.endian)?;
        let start = self.bytes.position;
        let end = value_end_offset(start, &head, limit, tag, is_top)?;
        if is_top && is_pixels(tag) {
            let (is_words, length) = (head.vr != Some(*b"OB"), end.map(|end| end - start));
            return Ok(Some(PixelElement { tag, is_words, offset: start, length }));
        }
        let inner_context = context.in_sequence(tag);
        let has_unknown_vr = head.vr.is_none() || head.vr == Some(*b"UN");
        let is_sequence =
            head.vr == Some(*b"SQ") || has_unknown_vr && (end.is_none() || inner_context.is_some());
        match end {
            None if is_pixels(tag) || !is_sequence => skip_fragments(self.bytes, self.endian, limit)?,
            Some(end) if !is_sequence => {
                let length = end - start;
                if length <= MAX_VALUE_BYTES && DicomValues::uses(context, tag) {
                    let value = self.bytes.value(length)?;
                    self.found.store(context, tag, &value, self.endian);
                } else {
                    self.bytes.skip(length)?;
                }
            }
            Some(end) if inner_context.is_none() => {
                self.found.note_sequence(context, tag);
                self.bytes.skip(end - start)?;
            }
            _ => {
                self.found.note_sequence(context, tag);
                if self.levels.len() >= 2 * MAX_NESTING {
                    return Err(DataSetError::Malformed(format!(
                        "more than {MAX_NESTING} sequences are nested"
                    )));
                }
                self.levels.push(OpenSequence {
                    sequence: Some(tag),
                    items: 0,
                    context: inner_context.unwrap_or(ElementContext::Unused),
                    // Content of unknown representation (UN) is copied as received, in implicit encoding.
                    is_explicit: is_explicit && head.vr == Some(*b"SQ"),
                    end,
                    limit: end.unwrap_or(limit),
                });
            }
        }
        Ok(None)
    }
}

fn is_pixels(tag: DicomTag) -> bool {
    matches!(tag, PIXELS | FLOATS | DOUBLES)
}

/// Reads the value representation and length of an element.
pub(crate) fn read_element_head(
    bytes: &mut DicomReader,
    is_explicit: bool,
    endian: Endian,
) -> io::Result<ElementHead> {
    if !is_explicit {
        return Ok(ElementHead { vr: None, length: bytes.u32(endian)? });
    }
    let [a, b, c, d]: [u8; 4] = bytes.read_array()?;
    let of = |four: [u8; 4]| match endian {
        Endian::Little => u32::from_le_bytes(four),
        Endian::Big => u32::from_be_bytes(four),
    };
    let vr = [a, b];
    match &vr {
        b"OB" | b"OD" | b"OF" | b"OL" | b"OV" | b"OW" | b"SQ" | b"SV" | b"UC" | b"UN" | b"UR" | b"UT"
        | b"UV" => Ok(ElementHead { vr: Some(vr), length: bytes.u32(endian)? }),
        _ if vr.iter().all(u8::is_ascii_uppercase) => {
            let length = match endian {
                Endian::Little => u16::from_le_bytes([c, d]),
                Endian::Big => u16::from_be_bytes([c, d]),
            };
            Ok(ElementHead { vr: Some(vr), length: u32::from(length) })
        }
        // An element without representation among explicit ones: some programs insert private data like that.
        _ => Ok(ElementHead { vr: None, length: of([a, b, c, d]) }),
    }
}

/// Returns the end offset of a value that begins at `at`; `None` if its length is undefined.
fn end_offset(at: u64, length: u32, limit: u64, tag: DicomTag) -> Result<Option<u64>, DataSetError> {
    if length == UNDEFINED_LENGTH {
        return Ok(None);
    }
    let end = at.saturating_add(u64::from(length));
    if end > limit {
        let left = limit.saturating_sub(at);
        return Err(DataSetError::Malformed(format!(
            "{} at byte {at} states a length of {length} bytes, only {left} are left",
            format_tag(tag)
        )));
    }
    Ok(Some(end))
}

/// Returns the end offset of an element's value; truncated pixels are detected later, with a clearer message.
fn value_end_offset(
    at: u64,
    head: &ElementHead,
    limit: u64,
    tag: DicomTag,
    is_top: bool,
) -> Result<Option<u64>, DataSetError> {
    if is_top && is_pixels(tag) && head.length != UNDEFINED_LENGTH {
        return Ok(Some(at.saturating_add(u64::from(head.length)).min(limit).max(at)));
    }
    end_offset(at, head.length, limit, tag)
}

/// Skips fragments that are not those of the image itself, such as an icon's.
fn skip_fragments(bytes: &mut DicomReader, endian: Endian, limit: u64) -> Result<(), DataSetError> {
    // Each fragment takes at least 8 bytes, so the file size bounds their number.
    while let Some(tag) = bytes.tag(endian)? {
        let length = bytes.u32(endian)?;
        match tag {
            SEQUENCE_END => return Ok(()),
            ITEM => match end_offset(bytes.position, length, limit, tag)? {
                Some(end) => bytes.skip(end - bytes.position)?,
                None => return Err(DataSetError::Malformed("a fragment has no length".to_owned())),
            },
            _ => return Err(DataSetError::Malformed(format!("{} lies among fragments", format_tag(tag)))),
        }
    }
    Err(DataSetError::Malformed("the end of its fragments is missing".to_owned()))
}
