//! JPEG-LS (ITU-T T.87), lossless or near-lossless, of one to four components.
//!
//! Hostile images: a line takes at least one bit per component (or one for all of them if pixels are interleaved), so
//! a scan with fewer bits than lines is refused before it gets memory. A run may encode a line of any width in that
//! one bit, so no better bound exists: callers compare [`header`] with the expected size before they decode. Rows are
//! appended as their bits are found, so a short image that claims a large size takes neither the memory nor the time
//! of that size.

mod scan_decoder;

use std::mem::take;

use scan_decoder::JpegLsScanDecoder;

/// Frame header of an image: size, components, and bit depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JpegLsHeader {
    /// Width of the image in pixels, 1 to 65535.
    pub width: usize,
    /// Height of the image in pixels, 1 to 65535.
    pub height: usize,
    /// Number of components per pixel, 1 to 4.
    pub components: usize,
    /// Number of bits per component, 2 to 16.
    pub(super) bits: u32,
}

/// Decoded image of the size in its [`JpegLsHeader`]: samples row by row, the components of a pixel adjacent, colours
/// not converted.
#[derive(Debug)]
pub struct JpegLsImage {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) components: usize,
    /// Numbers from 0 to at most 2^bits − 1, as many as width × height × components.
    pub samples: Vec<u16>,
}

/// Parses an image up to its frame header (SOF55), and no further.
///
/// # Errors
/// Reason why `packed` is no JPEG-LS image, is broken, or uses an unsupported extension: a clause without a full stop,
/// such as `its markers are broken`, to be put behind the name of the image. It quotes no text of the image.
pub fn header(packed: &[u8]) -> Result<JpegLsHeader, String> {
    packed.starts_with(&[0xff, 0xd8]).then_some(()).ok_or("it is not JPEG-LS")?;
    let mut stream = JpegLsStream { packed, at: 2, ..JpegLsStream::default() };
    while stream.frame.is_none() {
        stream.segment()?;
    }
    Ok(stream.frame.ok_or(BAD_MARKERS)?)
}

/// Decodes an image: all of it, or nothing.
///
/// # Errors
/// Reason why the image cannot be decoded, worded like that of [`header`]; images that are truncated, or too large for
/// the memory, are errors too.
pub fn decode(packed: &[u8]) -> Result<JpegLsImage, String> {
    let JpegLsHeader { width, height, components, bits: _ } = header(packed)?;
    let mut picture = JpegLsImage { width, height, components, samples: Vec::new() };
    let mut pending = vec![true; components];
    let mut stream = JpegLsStream { packed, at: 2, ..JpegLsStream::default() };
    while pending.contains(&true) {
        let Some(segment) = stream.segment()? else { continue };
        let (coder, places, is_sample_interleaved) = stream.scan(segment)?;
        // A component that occurs twice could take time again and again.
        if !places.iter().all(|&at| pending.get_mut(at).is_some_and(take)) {
            return Err(BAD_MARKERS.to_owned());
        }
        stream.at = match (is_sample_interleaved, &places[..]) {
            (true, &[a, b]) => coder.scan(&stream, &[[a, b]], &mut picture)?,
            (true, &[a, b, c]) => coder.scan(&stream, &[[a, b, c]], &mut picture)?,
            (true, &[a, b, c, d]) => coder.scan(&stream, &[[a, b, c, d]], &mut picture)?,
            _ => coder.scan(&stream, places.as_chunks::<1>().0, &mut picture)?,
        };
    }
    Ok(picture)
}

/// Error message for missing bits, or bits that no encoder writes.
const TRUNCATED: &str = "it is broken, or ends before its last pixel";
/// Error message for a segment of wrong length or in a wrong place.
const BAD_MARKERS: &str = "its markers are broken";

/// Marker parser of an image, with the parameters read so far (T.87 C.1).
#[derive(Default)]
struct JpegLsStream<'a> {
    packed: &'a [u8],
    at: usize,
    frame: Option<JpegLsHeader>,
    /// Component identifiers that scans refer to.
    component_ids: Vec<u8>,
    /// Preset parameters MAXVAL, T1, T2, T3 and RESET (T.87 C.2.4.1.1); 0 stands for the default.
    presets: [u16; 5],
    /// Restart interval in lines (T.87 C.2.5), or 0.
    restart_interval: usize,
}

impl<'a> JpegLsStream<'a> {
    /// Reads one segment with its marker (T.81 B.1.1); returns its data if it starts a scan.
    fn segment(&mut self) -> Result<Option<&'a [u8]>, &'static str> {
        let rest = self.packed.get(self.at..).unwrap_or_default();
        let fill = rest.iter().take_while(|&&byte| byte == 0xff).count();
        let (marker, after) = match rest.get(fill..) {
            Some([0xd9, ..] | []) | None => return Err(TRUNCATED),
            Some([marker, after @ ..]) => (*marker, after),
        };
        let length = after.first_chunk().map_or(0, |&two| usize::from(u16::from_be_bytes(two)));
        let data = after.get(2..length).ok_or(BAD_MARKERS)?;
        self.at += fill + 1 + length;
        match (marker, data) {
            _ if fill == 0 => return Err(BAD_MARKERS),
            (0xda, _) if self.frame.is_some() => return Ok(Some(data)),
            (0xf7, _) if self.frame.is_none() => self.read_frame(data)?,
            (0xf8, [1, presets @ ..]) if presets.len() == 10 => {
                let presets = presets.as_chunks().0.first_chunk().ok_or(BAD_MARKERS)?;
                self.presets = presets.map(u16::from_be_bytes);
            }
            (0xf8, [2 | 3, ..]) => return Err("mapping tables are not supported"),
            (0xf8, [4..=255, ..]) => return Err("extensions of JPEG-LS are not supported"),
            (0xdd, _) if matches!(data.len(), 2..=4) => {
                self.restart_interval = data.iter().fold(0, |all, &byte| all << 8 | usize::from(byte));
            }
            // HP's colour transform, an encoder extension that improves compression; 0 means none.
            (0xe8, [b'm', b'r', b'f', b'x', 1..=255, ..]) => {
                return Err("its colour transform is not supported");
            }
            // Application segments, and comments.
            (0xe0..=0xef | 0xfe, _) => {}
            (0xc0..=0xcf, _) => return Err("it is another kind of JPEG"),
            _ => return Err(BAD_MARKERS),
        }
        Ok(None)
    }

    /// Parses the frame header (T.87 C.2.2).
    fn read_frame(&mut self, data: &[u8]) -> Result<(), &'static str> {
        let &[bits, y1, y0, x1, x0, count, ref each @ ..] = data else { return Err(BAD_MARKERS) };
        let [width, height] = [[x1, x0], [y1, y0]].map(|two| u16::from_be_bytes(two).into());
        let parts = each.as_chunks::<3>().0;
        self.component_ids = parts.iter().map(|part| part[0]).collect();
        self.frame = Some(JpegLsHeader { width, height, components: parts.len(), bits: bits.into() });
        match count {
            _ if each.len() != 3 * usize::from(count) => Err(BAD_MARKERS),
            0 | 5.. => Err("only 1 to 4 components are supported"),
            _ if !(2..=16).contains(&bits) => Err("only 2 to 16 bits are supported"),
            _ if parts.iter().any(|part| part[1] != 0x11) => Err("subsampling is not supported"),
            _ if width == 0 || height == 0 => Err("a size outside the frame header is not supported"),
            _ => Ok(()),
        }
    }

    /// Parses the header of a scan (T.87 C.2.3): a decoder, the offsets of its components within a pixel, and true if
    /// pixels are interleaved by sample.
    fn scan(&self, data: &[u8]) -> Result<(JpegLsScanDecoder, Vec<usize>, bool), &'static str> {
        let (&count, rest) = data.split_first().ok_or(BAD_MARKERS)?;
        let (pairs, rest) = rest.split_at_checked(2 * usize::from(count)).ok_or(BAD_MARKERS)?;
        let &[near, mode @ 0..=2, transform] = rest else { return Err(BAD_MARKERS) };
        let pairs = pairs.as_chunks::<2>().0;
        if transform != 0 || pairs.iter().any(|pair| pair[1] != 0) {
            return Err("point transforms and mapping tables are not supported");
        }
        let place = |pair: &[u8; 2]| self.component_ids.iter().position(|&name| name == pair[0]);
        let places: Vec<_> = pairs.iter().map(place).collect::<Option<_>>().ok_or(BAD_MARKERS)?;
        let frame = self.frame.as_ref().ok_or(BAD_MARKERS)?;
        match (mode, places.len()) {
            (_, 0) | (0, 2..) => Err(BAD_MARKERS),
            (_, n) => Ok((JpegLsScanDecoder::new(frame, self.presets, near)?, places, mode == 2 && n > 1)),
        }
    }
}
