//! A TIFF file: its pages, and the numbers of each.

pub(super) mod bytes;
mod codec;
pub(super) mod directory;
pub(super) mod page;
mod unpack;

use std::io;

use rayon::prelude::*;

use super::fault::{HELP, compression_name, unreadable};
use crate::data::attempt::Attempt;
use crate::data::load::reading::input::Input;
use crate::data::load::reading::number::Number;
use crate::data::load::reading::samples::{self, Fault};
use crate::data::load::{Endian, LoadControl, LoadError};
use bytes::Bytes;
use codec::Codec;
use directory::{Directory, walk};
use page::{Offsets, Page};
use unpack::{invert, restore, widen};

/// A tile may be larger than its page by so much: pages are rounded up to whole tiles, of 256 x 256 pixels mostly.
const MOST_TILE_EXCESS: u64 = 64 << 20;

/// A file whose pages are known.
pub(super) struct Tiff {
    pub(super) bytes: Bytes,
    /// All of them, in the order of the file.
    pub(super) pages: Vec<Page>,
    /// What is said of the first.
    pub(super) first: Directory,
}

/// The parts of a page as they lie in the file.
pub(super) struct Packed {
    page: Page,
    endian: Endian,
    /// By sample, where each has its own; then by row and column of parts. An empty one was never written.
    parts: Vec<Vec<u8>>,
    samples: usize,
}

impl Tiff {
    /// Goes through the pages of a file.
    ///
    /// # Errors
    /// `BadInput` for what is no TIFF file, or a broken one.
    pub(super) fn open(attempt: Attempt<'_>, input: Input, control: &LoadControl) -> Result<Self, LoadError> {
        let len = input.len;
        let mut bytes = Bytes::of(input.reader.into_inner(), len);
        let (mut pages, mut first) = (Vec::new(), None);
        walk(attempt, &mut bytes, control, |bytes, directory| {
            let field = format!("page {}", pages.len());
            pages.push(Page::of(bytes, &directory).map_err(|error| unreadable(attempt, &field, error))?);
            first.get_or_insert(directory);
            Ok(())
        })?;
        Ok(Self { bytes, pages, first: first.unwrap_or_default() })
    }

    /// A number of the first page's directory.
    pub(super) fn said(&mut self, tag: u16) -> Option<f64> {
        self.first.get(tag)?.first(&mut self.bytes)
    }

    /// The text of an entry of the first page's directory, at most so many bytes of it.
    pub(super) fn text(&mut self, tag: u16, most: u64) -> Option<String> {
        self.first.get(tag)?.text(&mut self.bytes, most).ok()
    }

    /// Fetches the parts of a page: all, or those of one sample where each sample has its own.
    ///
    /// # Errors
    /// `BadInput` where they are not in the file, or not of a kind that is read.
    pub(super) fn fetch(
        &mut self,
        attempt: Attempt<'_>,
        number: usize,
        sample: Option<usize>,
        control: &LoadControl,
    ) -> Result<Packed, LoadError> {
        let field = format!("page {number}");
        let fault = |error| unreadable(attempt, &field, error);
        let page = *self.pages.get(number).ok_or_else(|| {
            attempt.bad_input(&field, format!("the file has only {} pages", self.pages.len()), HELP)
        })?;
        page.check(attempt, &field)?;
        let endian = self.bytes.endian;
        let [across, down] = page.grid();
        let per_sample = across.checked_mul(down).ok_or_else(|| fault(io::ErrorKind::InvalidData.into()))?;
        let offsets = match page.offsets {
            Offsets::At(at) => vec![at],
            Offsets::Listed(entry) => entry.numbers(&mut self.bytes).map_err(fault)?,
        };
        let counts = match page.counts {
            Some(entry) => entry.numbers(&mut self.bytes).map_err(fault)?,
            None => Vec::new(),
        };
        let samples = if page.is_planar { 1 } else { page.samples };
        let wanted = match (page.is_planar, sample) {
            (true, Some(sample)) => sample..sample + 1,
            (true, None) => 0..page.samples,
            (false, _) => 0..1,
        };
        // Each part that is listed takes some bytes of the file, so that this is no more than the file is long.
        let listed = offsets.len() as u64;
        if per_sample.saturating_mul(wanted.end as u64) > listed {
            let why = format!("{per_sample} strips or tiles are needed and {listed} are listed");
            return Err(attempt.bad_input(&field, why, HELP));
        }
        let mut parts = Vec::new();
        let [start, end] = [wanted.start, wanted.end].map(|sample| sample * per_sample as usize);
        for (at, &offset) in offsets.iter().enumerate().take(end).skip(start) {
            control.check()?;
            let row = at as u64 % per_sample / across;
            let whole = page.part_bytes(samples, row);
            let count = match counts.get(at).copied() {
                // Programs that write more than 4 GiB as one part cannot say so.
                _ if page.compression == 1 => whole,
                // No compression makes things longer than this.
                Some(count) => count.min(whole.saturating_mul(2).saturating_add(1 << 16)),
                None => return Err(fault(io::ErrorKind::InvalidData.into())),
            };
            if offset == 0 {
                parts.push(Vec::new());
                continue;
            }
            if offset.checked_add(count).is_none_or(|end| end > self.bytes.len()) {
                return Err(fault(io::ErrorKind::UnexpectedEof.into()));
            }
            let mut part = zeroed(attempt, &field, count)?;
            self.bytes.read(offset, &mut part).map_err(fault)?;
            parts.push(part);
        }
        Ok(Packed { page, endian, parts, samples })
    }
}

/// So many bytes of zero.
fn zeroed(attempt: Attempt<'_>, field: &str, count: u64) -> Result<Vec<u8>, LoadError> {
    let room = usize::try_from(count).ok().and_then(|count| samples::zeroed(count).ok());
    room.ok_or_else(|| {
        let why = format!("the memory for {count} bytes is not there");
        attempt.limit(field, why, "close other programs or load a smaller volume")
    })
}

impl Page {
    /// Parts across and down.
    fn grid(&self) -> [u64; 2] {
        [self.width.div_ceil(self.part[0]), self.height.div_ceil(self.part[1])]
    }

    /// Bytes of a row of a part, as it is before it is compressed.
    fn row_bytes(&self, samples: usize) -> u64 {
        (u128::from(self.part[0]) * samples as u128 * u128::from(self.bits)).div_ceil(8) as u64
    }

    /// Bytes of a part in a row of parts; the last strip may be shorter.
    fn part_bytes(&self, samples: usize, row: u64) -> u64 {
        let left = self.height - row * self.part[1];
        let rows = if self.is_tiled { self.part[1] } else { self.part[1].min(left) };
        self.row_bytes(samples).saturating_mul(rows)
    }

    /// Whether it is of a kind that is read, and its sizes can be.
    pub(super) fn check(&self, attempt: Attempt<'_>, field: &str) -> Result<(), LoadError> {
        let refuse = |why: String, help: &str| Err(attempt.bad_input(field, why, help));
        let bits = self.bits;
        if let page::Meaning::Foreign(photometric) = self.meaning {
            let kind = match photometric {
                4 => "a mask",
                5 => "CMYK",
                6 => "YCbCr",
                8..=10 => "CIE L*a*b*",
                32803 | 34892 => "the raw data of a camera",
                _ => "not known",
            };
            return refuse(
                format!("its colours are of a kind that is not read: {kind}"),
                "save it as grey or RGB",
            );
        }
        if self.number().is_none() {
            let format = match self.format {
                2 => "signed",
                3 => "floating point",
                5 | 6 => "complex",
                _ => "unsigned",
            };
            return refuse(
                format!("its numbers are of a kind that is not read: {format}, of {bits} bits"),
                "save it with unsigned or signed numbers of 8, 16 or 32 bits, or floating point of 32",
            );
        }
        if Codec::of(self.compression).is_none() {
            let name = compression_name(self.compression);
            return refuse(
                format!("it is compressed {name} (number {}), which is not read", self.compression),
                "save it uncompressed, or with LZW, Deflate, PackBits or Zstandard",
            );
        }
        let suits = match self.predictor {
            1 => true,
            2 => bits.is_multiple_of(8),
            3 => self.format == 3,
            _ => false,
        };
        if !suits {
            return refuse(
                format!("predictor {} does not go with its numbers of {bits} bits", self.predictor),
                "save it without a predictor",
            );
        }
        let samples = if self.is_planar { 1 } else { self.samples };
        let part = self.part_bytes(samples, 0);
        // Unpacked numbers are at least as long as packed ones.
        match self.bytes() {
            Some(whole) if part <= whole.saturating_add(MOST_TILE_EXCESS) => Ok(()),
            _ => refuse(format!("tiles of {} x {} pixels cannot be meant", self.part[0], self.part[1]), HELP),
        }
    }
}

impl Packed {
    /// The numbers of the page, little-endian, those of a pixel beside each other.
    ///
    /// # Errors
    /// `BadInput` where a part is broken or too short.
    pub(super) fn unpack(
        &self,
        attempt: Attempt<'_>,
        number: usize,
        control: &LoadControl,
    ) -> Result<Vec<u8>, LoadError> {
        let field = format!("page {number}");
        let page = &self.page;
        let [across, down] = page.grid().map(|count| count as usize);
        let size = page.number().map_or(1, Number::bytes);
        let planes = (self.parts.len() / (across * down).max(1)).max(1);
        let row_bytes = page.width as usize * self.samples * size;
        let bytes = (row_bytes as u64).saturating_mul(page.height).saturating_mul(planes as u64);
        self.check_room(attempt, &field)?;
        let mut all = zeroed(attempt, &field, bytes)?;
        let plane_bytes = all.len() / planes;
        for (plane, parts) in all.chunks_exact_mut(plane_bytes).zip(self.parts.chunks(across * down)) {
            // Rows of parts on all cores.
            let rows = plane
                .par_chunks_mut(row_bytes.saturating_mul(page.part[1] as usize))
                .zip(parts.par_chunks(across));
            let rows = rows.enumerate().map(|(row, (band, parts))| {
                parts.iter().enumerate().try_for_each(|(column, part)| {
                    self.unpack_part(attempt, &field, [column, row], part, band, control)
                })
            });
            // Of several that are broken the first is told.
            if let Some(error) = rows.find_map_first(Result::err) {
                return Err(error);
            }
        }
        if page.is_inverted && matches!(page.format, 1 | 4) {
            invert(&mut all, page.bits);
        }
        Ok(if planes > 1 { woven(&all, planes, size) } else { all })
    }

    /// Refuses parts that cannot hold as much as they should, before memory is taken for that.
    fn check_room(&self, attempt: Attempt<'_>, field: &str) -> Result<(), LoadError> {
        let [across, down] = self.page.grid().map(|count| (count as usize).max(1));
        let Some(codec) = Codec::of(self.page.compression) else { return Ok(()) };
        for (at, packed) in self.parts.iter().enumerate().filter(|(_, packed)| !packed.is_empty()) {
            let wanted = self.page.part_bytes(self.samples, (at / across % down) as u64);
            let room = codec.most(packed.len());
            if room < wanted {
                return Err(attempt.bad_input(
                    field,
                    format!("a strip or tile ends too early: {wanted} bytes expected, room for {room} found"),
                    HELP,
                ));
            }
        }
        Ok(())
    }

    /// Puts what a part holds where it belongs among some rows.
    fn unpack_part(
        &self,
        attempt: Attempt<'_>,
        field: &str,
        [column, row]: [usize; 2],
        packed: &[u8],
        band: &mut [u8],
        control: &LoadControl,
    ) -> Result<(), LoadError> {
        // Never written: all 0, as other readers have it.
        if packed.is_empty() {
            return Ok(());
        }
        let page = &self.page;
        let packed_row = page.row_bytes(self.samples) as usize;
        let whole = page.part_bytes(self.samples, row as u64);
        let size = page.number().map_or(1, Number::bytes);
        let pixel = self.samples * size;
        let row_bytes = page.width as usize * pixel;
        let is_direct = !page.is_tiled && page.bits.is_multiple_of(8);
        if is_direct {
            self.expand(attempt, field, packed, band, control)?;
            restore(page, self.endian, self.samples, packed_row, band);
            return Ok(());
        }
        let mut part = zeroed(attempt, field, whole)?;
        self.expand(attempt, field, packed, &mut part, control)?;
        restore(page, self.endian, self.samples, packed_row, &mut part);
        // What of a row lies within the page.
        let first = column * page.part[0] as usize;
        let pixels = (page.part[0] as usize).min(page.width as usize - first);
        let mut wide = Vec::new();
        for (target, packed) in band.chunks_exact_mut(row_bytes).zip(part.chunks_exact(packed_row)) {
            let target = &mut target[first * pixel..(first + pixels) * pixel];
            if page.bits.is_multiple_of(8) {
                target.copy_from_slice(&packed[..pixels * pixel]);
            } else {
                wide.clear();
                widen(packed, page.bits, pixels * self.samples, &mut wide);
                target.copy_from_slice(&wide);
            }
        }
        Ok(())
    }

    fn expand(
        &self,
        attempt: Attempt<'_>,
        field: &str,
        packed: &[u8],
        out: &mut [u8],
        control: &LoadControl,
    ) -> Result<(), LoadError> {
        let Some(codec) = Codec::of(self.page.compression) else { return Ok(()) };
        let reversed: Vec<u8>;
        let packed = if self.page.is_reversed {
            reversed = packed.iter().copied().map(u8::reverse_bits).collect();
            &reversed
        } else {
            packed
        };
        let wanted = out.len();
        match codec.expand(packed, out, control) {
            Ok(found) if found == wanted => Ok(()),
            Ok(found) => Err(attempt.bad_input(
                field,
                format!("a strip or tile ends too early: {wanted} bytes expected, {found} found"),
                HELP,
            )),
            Err(Fault::Stopped(error)) => Err(error),
            Err(Fault::Io(error)) => {
                let why = format!("a compressed strip or tile is broken: {error}");
                Err(attempt.bad_input(field, crate::data::plain(&why, 200), HELP))
            }
            Err(_) => Err(attempt.bad_input(field, "a compressed strip or tile is broken", HELP)),
        }
    }
}

/// Numbers of several planes beside each other.
fn woven(planes: &[u8], count: usize, size: usize) -> Vec<u8> {
    let plane = planes.len() / count;
    let mut woven = Vec::with_capacity(planes.len());
    for at in (0..plane).step_by(size) {
        for sample in 0..count {
            woven.extend_from_slice(&planes[sample * plane + at..][..size]);
        }
    }
    woven
}
