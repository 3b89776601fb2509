//! The data elements of a data set, one after the other (PS3.5 chapter 7): those that are wanted are read, all others are
//! skipped. What is nested is kept on a list, not on the stack, and every length is checked against what surrounds it.

use std::io;

use super::bytes::{Bytes, LONGEST_VALUE};
use super::found::Found;
use super::place::Place;
use super::syntax::Form;
use super::tags::{DOUBLES, FLOATS, ITEM, ITEM_END, PIXELS, SEQUENCE_END, Tag, written};
use crate::data::attempt::Attempt;
use crate::data::load::{Endian, LoadControl, LoadError};

/// How deep sequences are followed: real files nest some ten of them.
const DEEPEST: usize = 64;

/// Most elements that are looked at: those of a hundred thousand frames.
const MOST_ELEMENTS: usize = 1 << 24;

/// Most bytes that a deflated header may have after inflating.
const MOST_INFLATED: u64 = 1 << 30;

/// Elements between two looks at `cancel`.
const AT_ONCE: usize = 1 << 12;

/// The length of what ends with a mark.
const UNDEFINED: u32 = u32::MAX;

/// Where the pixels are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::data::load::formats::dicom) struct PixelElement {
    pub(in crate::data::load::formats::dicom) tag: Tag,
    /// Bytes are pairs, and swapped where the order is big endian.
    pub(in crate::data::load::formats::dicom) is_words: bool,
    /// Where the value begins.
    pub(in crate::data::load::formats::dicom) offset: u64,
    /// Its length; `None` where it is in fragments.
    pub(in crate::data::load::formats::dicom) length: Option<u64>,
}

/// Why a data set cannot be read.
#[derive(Debug)]
pub(in crate::data::load::formats::dicom) enum Broken {
    Io(io::Error),
    /// What is wrong.
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

/// A sequence, or an item of one, that has been entered.
struct Level {
    /// The sequence; `None` for an item.
    sequence: Option<Tag>,
    /// Items that have begun.
    items: usize,
    place: Place,
    is_explicit: bool,
    /// Where it ends, if its length says so.
    end: Option<u64>,
    /// What nothing in it may pass: its own end or that of what surrounds it.
    limit: u64,
}

/// An element up to its value.
pub(in crate::data::load::formats::dicom) struct Head {
    /// Two letters; `None` where the form does not say them.
    vr: Option<[u8; 2]>,
    pub(in crate::data::load::formats::dicom) length: u32,
}

/// Reads a data set up to its pixels.
///
/// # Errors
/// What contradicts itself, ends too early, or nests too deeply.
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
            // Zeros that fill up a file.
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
                // Marks where nothing is open are written by some after lengths, and harmless.
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
                            // What nobody could name was written as it was received: without representations.
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

/// The representation and the length of an element.
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
        // An element without one among others that have one: some programs paste private data so.
        _ => Ok(Head { vr: None, length: of([a, b, c, d]) }),
    }
}

/// Where something ends that begins at `at`; `None` where a mark says so.
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

/// As [`end_of`]; pixels that are cut off are found out later, with better words.
fn end_of_value(at: u64, head: &Head, limit: u64, tag: Tag, is_top: bool) -> Result<Option<u64>, Broken> {
    if is_top && is_pixels(tag) && head.length != UNDEFINED {
        return Ok(Some(at.saturating_add(u64::from(head.length)).min(limit).max(at)));
    }
    end_of(at, head.length, limit, tag)
}

/// Skips pixels in fragments that are not the picture's own: those of a small picture in a header.
fn skip_fragments(bytes: &mut Bytes, endian: Endian, limit: u64) -> Result<(), Broken> {
    // Each takes 8 bytes: there are no more than the file has room for.
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
