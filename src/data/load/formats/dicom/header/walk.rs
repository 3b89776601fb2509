//! Parser of a data set's elements, in order (PS3.5 chapter 7): those in use are read, all others are skipped.
//! Nesting is kept on an explicit stack instead of recursion, and every length is checked against the enclosing one.

use std::io;

use super::bytes::{Bytes, LONGEST_VALUE};
use super::found::Found;
use super::place::Place;
use super::syntax::Form;
use super::tags::{DOUBLES, FLOATS, ITEM, ITEM_END, PIXELS, SEQUENCE_END, Tag, written};
use crate::data::attempt::Attempt;
use crate::data::load::{Endian, LoadControl, LoadError};

/// Maximum nesting depth of sequences: real files nest some ten.
const DEEPEST: usize = 64;

/// Maximum number of elements parsed: those of a hundred thousand frames.
const MOST_ELEMENTS: usize = 1 << 24;

/// Maximum size of a deflated header after inflating, in bytes.
const MOST_INFLATED: u64 = 1 << 30;

/// Number of elements between two checks for cancellation.
const AT_ONCE: usize = 1 << 12;

/// Undefined length: a delimiter ends the value.
const UNDEFINED: u32 = u32::MAX;

/// Location of the pixels in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::data::load::formats::dicom) struct PixelElement {
    pub(in crate::data::load::formats::dicom) tag: Tag,
    /// True if bytes are stored in 16-bit words, and so swapped in big-endian order.
    pub(in crate::data::load::formats::dicom) is_words: bool,
    /// Byte offset of the value.
    pub(in crate::data::load::formats::dicom) offset: u64,
    /// Length of the value in bytes; `None` if it is in fragments.
    pub(in crate::data::load::formats::dicom) length: Option<u64>,
}

/// Reason why a data set cannot be parsed.
#[derive(Debug)]
pub(in crate::data::load::formats::dicom) enum Broken {
    Io(io::Error),
    /// Malformed data, described for the user.
    Wrong(String),
    Stopped(LoadError),
}

impl From<io::Error> for Broken {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::UnexpectedEof => {
                Self::Wrong("it is cut off: it ends within an element".to_owned())
            }
            io::ErrorKind::InvalidData | io::ErrorKind::InvalidInput => {
                Self::Wrong(format!("its deflated data are broken: {error}"))
            }
            _ => Self::Io(error),
        }
    }
}

impl Broken {
    pub(in crate::data::load::formats::dicom) fn into_error(self, attempt: Attempt<'_>) -> LoadError {
        match self {
            Self::Io(error) => attempt.io(error),
            Self::Wrong(why) => attempt.bad_input("data set", why, "copy or export the file again"),
            Self::Stopped(error) => error,
        }
    }
}

/// Sequence or item that is currently open.
struct Level {
    /// Tag of the sequence; `None` for an item.
    sequence: Option<Tag>,
    /// Number of items begun so far.
    items: usize,
    place: Place,
    is_explicit: bool,
    /// End offset, if the length is defined.
    end: Option<u64>,
    /// Offset that no element within may pass: its own end, or that of the enclosing level.
    limit: u64,
}

/// Head of a data element: everything before its value.
pub(in crate::data::load::formats::dicom) struct Head {
    /// Value representation, two letters; `None` in implicit encoding.
    vr: Option<[u8; 2]>,
    pub(in crate::data::load::formats::dicom) length: u32,
}

/// Parses a data set up to its pixels.
///
/// # Errors
/// Data that contradict themselves, end too early, or nest too deeply.
pub(in crate::data::load::formats::dicom) fn walk(
    bytes: &mut Bytes,
    form: Form,
    found: &mut Found,
    control: &LoadControl,
) -> Result<Option<PixelElement>, Broken> {
    let endian = form.endian;
    let mut open: Vec<Level> = Vec::new();
    for count in 0..MOST_ELEMENTS {
        if count % AT_ONCE == 0 {
            control.check().map_err(Broken::Stopped)?;
        }
        if bytes.is_deflated() && bytes.at > MOST_INFLATED {
            return Err(Broken::Wrong(format!("its header has more than {MOST_INFLATED} bytes")));
        }
        while open.last().is_some_and(|level| level.end == Some(bytes.at)) {
            open.pop();
        }
        let Some(tag) = bytes.tag(endian)? else { return Ok(None) };
        let (place, is_explicit, limit) =
            open.last().map_or((Place::Top, form.is_explicit, bytes.len), |level| {
                (level.place, level.is_explicit, level.limit)
            });
        match tag {
            // Zeros that pad a file.
            0 if open.is_empty() => return Ok(None),
            ITEM => {
                let length = bytes.u32(endian)?;
                let end = end_of(bytes.at, length, limit, tag)?;
                let item = open.last_mut().and_then(|level| {
                    let sequence = level.sequence?;
                    level.items += 1;
                    Some(place.item(sequence, level.items - 1))
                });
                let place =
                    item.ok_or_else(|| Broken::Wrong("an item lies outside of a sequence".to_owned()))?;
                open.push(Level {
                    sequence: None,
                    items: 0,
                    place,
                    is_explicit,
                    end,
                    limit: end.unwrap_or(limit),
                });
            }
            ITEM_END | SEQUENCE_END => {
                bytes.u32(endian)?;
                // Some programs write delimiters after defined lengths as well; they are harmless.
                if open.last().is_some_and(|level| level.sequence.is_some() == (tag == SEQUENCE_END)) {
                    open.pop();
                }
            }
            _ => {
                if open.last().is_some_and(|level| level.sequence.is_some()) {
                    return Err(Broken::Wrong(format!(
                        "{} lies between the items of a sequence",
                        written(tag)
                    )));
                }
                let head = head(bytes, is_explicit, endian)?;
                let end = end_of_value(bytes.at, &head, limit, tag, open.is_empty())?;
                if open.is_empty() && matches!(tag, PIXELS | FLOATS | DOUBLES) {
                    let is_words = head.vr != Some(*b"OB");
                    let length = end.map(|end| end - bytes.at);
                    return Ok(Some(PixelElement { tag, is_words, offset: bytes.at, length }));
                }
                let inside = place.inside(tag);
                let is_unnamed = head.vr.is_none() || head.vr == Some(*b"UN");
                let is_sequence =
                    head.vr == Some(*b"SQ") || is_unnamed && (end.is_none() || inside.is_some());
                match end {
                    None if is_pixels(tag) || !is_sequence => skip_fragments(bytes, endian, limit)?,
                    Some(end) if !is_sequence => {
                        let length = end - bytes.at;
                        if length <= LONGEST_VALUE && Found::wants(place, tag) {
                            let value = bytes.value(length)?;
                            found.take(place, tag, &value, endian);
                        } else {
                            bytes.skip(length)?;
                        }
                    }
                    Some(end) if inside.is_none() => {
                        found.pass(place, tag);
                        bytes.skip(end - bytes.at)?;
                    }
                    _ => {
                        found.pass(place, tag);
                        if open.len() >= 2 * DEEPEST {
                            return Err(Broken::Wrong(format!("more than {DEEPEST} sequences are nested")));
                        }
                        open.push(Level {
                            sequence: Some(tag),
                            items: 0,
                            place: inside.unwrap_or(Place::Elsewhere),
                            // Content of unknown representation (UN) is copied as received, in implicit encoding.
                            is_explicit: is_explicit && head.vr == Some(*b"SQ"),
                            end,
                            limit: end.unwrap_or(limit),
                        });
                    }
                }
            }
        }
    }
    Err(Broken::Wrong(format!("it has more than {MOST_ELEMENTS} elements")))
}

fn is_pixels(tag: Tag) -> bool {
    matches!(tag, PIXELS | FLOATS | DOUBLES)
}

/// Reads the value representation and length of an element.
pub(in crate::data::load::formats::dicom) fn head(
    bytes: &mut Bytes,
    is_explicit: bool,
    endian: Endian,
) -> io::Result<Head> {
    if !is_explicit {
        return Ok(Head { vr: None, length: bytes.u32(endian)? });
    }
    let [a, b, c, d]: [u8; 4] = bytes.next()?;
    let of = |four: [u8; 4]| match endian {
        Endian::Little => u32::from_le_bytes(four),
        Endian::Big => u32::from_be_bytes(four),
    };
    let vr = [a, b];
    match &vr {
        b"OB" | b"OD" | b"OF" | b"OL" | b"OV" | b"OW" | b"SQ" | b"SV" | b"UC" | b"UN" | b"UR" | b"UT"
        | b"UV" => Ok(Head { vr: Some(vr), length: bytes.u32(endian)? }),
        _ if vr.iter().all(u8::is_ascii_uppercase) => {
            let length = match endian {
                Endian::Little => u16::from_le_bytes([c, d]),
                Endian::Big => u16::from_be_bytes([c, d]),
            };
            Ok(Head { vr: Some(vr), length: u32::from(length) })
        }
        // An element without representation among explicit ones: some programs insert private data like that.
        _ => Ok(Head { vr: None, length: of([a, b, c, d]) }),
    }
}

/// Returns the end offset of a value that begins at `at`; `None` if its length is undefined.
fn end_of(at: u64, length: u32, limit: u64, tag: Tag) -> Result<Option<u64>, Broken> {
    if length == UNDEFINED {
        return Ok(None);
    }
    let end = at.saturating_add(u64::from(length));
    if end > limit {
        let left = limit.saturating_sub(at);
        return Err(Broken::Wrong(format!(
            "{} at byte {at} says that it has {length} bytes, where {left} are left",
            written(tag)
        )));
    }
    Ok(Some(end))
}

/// Returns the end offset of an element's value; truncated pixels are detected later, with a clearer message.
fn end_of_value(at: u64, head: &Head, limit: u64, tag: Tag, is_top: bool) -> Result<Option<u64>, Broken> {
    if is_top && is_pixels(tag) && head.length != UNDEFINED {
        return Ok(Some(at.saturating_add(u64::from(head.length)).min(limit).max(at)));
    }
    end_of(at, head.length, limit, tag)
}

/// Skips fragments that are not those of the image itself, such as an icon's.
fn skip_fragments(bytes: &mut Bytes, endian: Endian, limit: u64) -> Result<(), Broken> {
    // Each fragment takes at least 8 bytes, so the file size bounds their number.
    while let Some(tag) = bytes.tag(endian)? {
        let length = bytes.u32(endian)?;
        match tag {
            SEQUENCE_END => return Ok(()),
            ITEM => match end_of(bytes.at, length, limit, tag)? {
                Some(end) => bytes.skip(end - bytes.at)?,
                None => return Err(Broken::Wrong("a fragment has no length".to_owned())),
            },
            _ => return Err(Broken::Wrong(format!("{} lies among fragments", written(tag)))),
        }
    }
    Err(Broken::Wrong("its fragments have no end".to_owned()))
}
