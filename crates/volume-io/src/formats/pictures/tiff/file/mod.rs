//! TIFF file: its pages, and the decoding of their samples.

pub(super) mod bytes;
mod codec;
pub(super) mod directory;
mod jpeg;
pub(super) mod page;
mod parts;
mod predictor;
mod zstd;

use std::io;

use bytemuck::allocation::try_zeroed_vec;
use rayon::prelude::*;

use super::messages::{HELP, unreadable_error};
use crate::Endian;
use crate::reading::input::InputFile;
use crate::reading::number::FileNumberType;
use crate::reading::samples::ReadFault;
use bytes::TiffBytes;
use chiaroscuro_volume::{LoadContext, LoadControl, LoadError};
use codec::TiffCodec;
use directory::{TiffDirectory, TiffDirectoryEntry, for_each_directory};
use page::{PartOffsets, TiffPage};
use predictor::{undo_predictor, unpack_bits};

/// Maximum number of strips or tiles of a page: tiles of 256 x 256 pixels reach it in a page of 262144 x 262144.
const MAX_PARTS: u64 = 1 << 20;

/// Maximum number of bytes that are read more than once: blank tiles may share the same bytes.
const MAX_SHARED_BYTES: u64 = 32 << 20;

/// Maximum size of JPEG tables: four quantisation and eight Huffman tables have 2.7 KiB.
const MAX_TABLES_BYTES: u64 = 64 << 10;

/// TIFF file whose pages have been listed.
pub(super) struct TiffFile {
    pub(super) bytes: TiffBytes,
    /// All pages in file order.
    pub(super) pages: Vec<TiffPage>,
    /// Directory of the first page.
    pub(super) first: TiffDirectory,
}

/// Strips or tiles of a page, compressed as in the file.
pub(super) struct CompressedPage {
    page: TiffPage,
    endian: Endian,
    /// Compressed data by sample, where each sample has its own, then by row and column. Empty where a strip or tile
    /// was never written.
    parts: Vec<Vec<u8>>,
    samples: usize,
    /// JPEG tables that the strips or tiles share.
    tables: Vec<u8>,
}

impl TiffFile {
    /// Reads the directories of all pages.
    ///
    /// # Errors
    /// `BadInput` for a file that is not TIFF, or is broken.
    pub(super) fn open(
        context: LoadContext<'_>,
        input: InputFile,
        control: &LoadControl,
    ) -> Result<Self, LoadError> {
        let len = input.len;
        let mut bytes = TiffBytes::new(input.reader.into_inner(), len);
        let (mut pages, mut first) = (Vec::new(), None);
        for_each_directory(context, &mut bytes, control, |bytes, directory| {
            let field = format!("page {}", pages.len());
            pages.push(
                TiffPage::parse(bytes, &directory)
                    .map_err(|error| unreadable_error(context, &field, error))?,
            );
            first.get_or_insert(directory);
            Ok(())
        })?;
        Ok(Self { bytes, pages, first: first.unwrap_or_default() })
    }

    /// Number in an entry of the first page's directory.
    pub(super) fn number_entry(&mut self, tag: u16) -> Option<f64> {
        self.first.get(tag)?.first_number(&mut self.bytes)
    }

    /// Text in an entry of the first page's directory, at most `most` bytes of it.
    pub(super) fn text_entry(&mut self, tag: u16, most: u64) -> Option<String> {
        self.first.get(tag)?.text(&mut self.bytes, most).ok()
    }

    /// Text in an entry of any page, at most `most` bytes of it.
    pub(super) fn text_of(&mut self, entry: TiffDirectoryEntry, most: u64) -> Option<String> {
        entry.text(&mut self.bytes, most).ok()
    }

    /// Reads the strips or tiles of a page: all, or those of one sample where samples are separate.
    ///
    /// # Errors
    /// As [`Self::check_parts`]; `Limit` where memory is exhausted.
    pub(super) fn fetch(
        &mut self,
        context: LoadContext<'_>,
        number: usize,
        sample: Option<usize>,
        control: &LoadControl,
    ) -> Result<CompressedPage, LoadError> {
        let field = format!("page {number}");
        let fault = |error| unreadable_error(context, &field, error);
        let (page, places) = self.part_locations(context, number, sample, control)?;
        let mut parts = Vec::new();
        for PartLocation { offset, count } in places {
            control.check()?;
            let mut part = alloc_zeroed_bytes(context, &field, count)?;
            self.bytes.read(offset, &mut part).map_err(fault)?;
            parts.push(part);
        }
        let tables = page.jpeg_tables.map(|entry| entry.raw(&mut self.bytes, MAX_TABLES_BYTES));
        let tables = tables.transpose().map_err(fault)?.unwrap_or_default();
        let samples = if page.is_planar { 1 } else { page.samples };
        Ok(CompressedPage { page, endian: self.bytes.endian, parts, samples, tables })
    }

    /// Checks that the strips or tiles of a page lie within the file, and that they can hold its pixels.
    ///
    /// # Errors
    /// `BadInput` where they do not, or where their encoding is not supported.
    pub(super) fn check_parts(
        &mut self,
        context: LoadContext<'_>,
        number: usize,
        sample: Option<usize>,
        control: &LoadControl,
    ) -> Result<(), LoadError> {
        self.part_locations(context, number, sample, control).map(drop)
    }

    /// Returns a page, and the locations of the strips or tiles that [`Self::fetch`] reads.
    fn part_locations(
        &mut self,
        context: LoadContext<'_>,
        number: usize,
        sample: Option<usize>,
        control: &LoadControl,
    ) -> Result<(TiffPage, Vec<PartLocation>), LoadError> {
        let field = format!("page {number}");
        let fault = |error| unreadable_error(context, &field, error);
        let page = *self.pages.get(number).ok_or_else(|| {
            context.bad_input_error(&field, format!("the file has only {} pages", self.pages.len()), HELP)
        })?;
        page.check_supported(context, &field)?;
        let [across, down] = page.grid();
        let per_sample = across.checked_mul(down).ok_or_else(|| fault(io::ErrorKind::InvalidData.into()))?;
        let samples = if page.is_planar { 1 } else { page.samples };
        let wanted = match (page.is_planar, sample) {
            (true, Some(sample)) => sample..sample + 1,
            (true, None) => 0..page.samples,
            (false, _) => 0..1,
        };
        // Each listed strip or tile takes some bytes of the file, so that the count is bounded by the file's length.
        let listed = match page.offsets {
            PartOffsets::At(_) => 1,
            PartOffsets::Listed(entry) => entry.count,
        };
        let needed = per_sample.saturating_mul(wanted.end as u64);
        if needed > listed {
            let why =
                format!("{per_sample} strips or tiles are needed per plane and {listed} are listed in all");
            return Err(context.bad_input_error(&field, why, HELP));
        }
        if needed > MAX_PARTS {
            let why = format!("it has {needed} strips or tiles, {MAX_PARTS} are allowed");
            return Err(context.limit_error(&field, why, "save it with larger tiles"));
        }
        let offsets = match page.offsets {
            PartOffsets::At(at) => vec![at],
            PartOffsets::Listed(entry) => entry.numbers(&mut self.bytes, needed).map_err(fault)?,
        };
        let counts = match page.counts {
            Some(entry) => entry.numbers(&mut self.bytes, needed).map_err(fault)?,
            None => Vec::new(),
        };
        let (mut places, mut sum) = (Vec::new(), 0u64);
        let [start, end] = [wanted.start, wanted.end].map(|sample| sample * per_sample as usize);
        for (at, &offset) in offsets.iter().enumerate().take(end).skip(start) {
            control.check()?;
            // Never written: all 0, as other readers have it.
            if offset == 0 {
                places.push(PartLocation { offset, count: 0 });
                continue;
            }
            let row = at as u64 % per_sample / across;
            let whole = page.part_bytes(samples, row);
            let count = match counts.get(at).copied() {
                // Uncompressed strips over 4 GiB have a wrong count, since it is a 32-bit number.
                _ if page.compression == 1 => whole,
                // No compression scheme expands data beyond this.
                Some(count) => count.min(whole.saturating_mul(2).saturating_add(1 << 16)),
                None => return Err(fault(io::ErrorKind::InvalidData.into())),
            };
            if offset.checked_add(count).is_none_or(|end| end > self.bytes.len()) {
                return Err(fault(io::ErrorKind::UnexpectedEof.into()));
            }
            sum += count;
            if sum > self.bytes.len().saturating_add(MAX_SHARED_BYTES) {
                let why = "its strips or tiles overlap: they share the same bytes";
                return Err(context.bad_input_error(&field, why, HELP));
            }
            let room = TiffCodec::from_tag(page.compression).map_or(0, |codec| codec.max_expanded(count));
            if room < whole && count > 0 {
                let why =
                    format!("a strip or tile ends too early: {whole} bytes expected, at most {room} found");
                return Err(context.bad_input_error(&field, why, HELP));
            }
            places.push(PartLocation { offset, count });
        }
        Ok((page, places))
    }
}

/// Location of a strip or tile in the file; of no bytes where it was never written.
struct PartLocation {
    offset: u64,
    count: u64,
}

/// Allocates `count` zero bytes, whose pages are committed only as they are written: a page with less data than it
/// announces takes only the memory for those.
pub(super) fn alloc_zeroed_bytes(
    context: LoadContext<'_>,
    field: &str,
    count: u64,
) -> Result<Vec<u8>, LoadError> {
    let room = usize::try_from(count).ok().and_then(|count| try_zeroed_vec(count).ok());
    room.ok_or_else(|| {
        let why = format!("there is not enough memory for {count} bytes");
        context.limit_error(field, why, "close other programs or load a smaller volume")
    })
}

impl CompressedPage {
    /// Compressed bytes of all strips or tiles.
    pub(super) fn len(&self) -> u64 {
        self.parts.iter().map(|part| part.len() as u64).sum()
    }

    /// Decodes the page to little-endian samples, interleaved by pixel.
    ///
    /// # Errors
    /// `BadInput` where a strip or tile is broken or too short.
    pub(super) fn unpack(
        &self,
        context: LoadContext<'_>,
        number: usize,
        control: &LoadControl,
    ) -> Result<Vec<u8>, LoadError> {
        let field = format!("page {number}");
        let page = &self.page;
        let [across, down] = page.grid().map(|count| count as usize);
        let size = page.number().map_or(1, FileNumberType::bytes);
        let planes = (self.parts.len() / (across * down).max(1)).max(1);
        let row_bytes = page.width as usize * self.samples * size;
        let bytes = (row_bytes as u64).saturating_mul(page.height).saturating_mul(planes as u64);
        let mut all = alloc_zeroed_bytes(context, &field, bytes)?;
        let plane_bytes = all.len() / planes;
        for (plane, parts) in all.chunks_exact_mut(plane_bytes).zip(self.parts.chunks(across * down)) {
            // Rows of strips or tiles in parallel.
            let rows = plane
                .par_chunks_mut(row_bytes.saturating_mul(page.part_size[1] as usize))
                .zip(parts.par_chunks(across));
            rows.enumerate().try_for_each(|(row, (band, parts))| {
                parts.iter().enumerate().try_for_each(|(column, part)| {
                    self.unpack_part(context, &field, [column, row], part, band, control)
                })
            })?;
        }
        Ok(if planes > 1 { interleave_planes(&all, planes, size) } else { all })
    }

    /// Decodes a strip or tile into a band of rows of the page.
    fn unpack_part(
        &self,
        context: LoadContext<'_>,
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
        let size = page.number().map_or(1, FileNumberType::bytes);
        let pixel = self.samples * size;
        let row_bytes = page.width as usize * pixel;
        let is_direct = !page.is_tiled && page.bits.is_multiple_of(8);
        if is_direct {
            self.expand(context, field, packed, band, control)?;
            undo_predictor(page, self.endian, self.samples, packed_row, band);
            return Ok(());
        }
        let mut part = alloc_zeroed_bytes(context, field, whole)?;
        self.expand(context, field, packed, &mut part, control)?;
        undo_predictor(page, self.endian, self.samples, packed_row, &mut part);
        // Part of a row that lies within the page.
        let first = column * page.part_size[0] as usize;
        let pixels = (page.part_size[0] as usize).min(page.width as usize - first);
        let mut wide = Vec::new();
        for (target, packed) in band.chunks_exact_mut(row_bytes).zip(part.chunks_exact(packed_row)) {
            let target = &mut target[first * pixel..(first + pixels) * pixel];
            if page.bits.is_multiple_of(8) {
                target.copy_from_slice(&packed[..pixels * pixel]);
            } else {
                wide.clear();
                unpack_bits(packed, page.bits, pixels * self.samples, &mut wide);
                target.copy_from_slice(&wide);
            }
        }
        Ok(())
    }

    fn expand(
        &self,
        context: LoadContext<'_>,
        field: &str,
        packed: &[u8],
        out: &mut [u8],
        control: &LoadControl,
    ) -> Result<(), LoadError> {
        let Some(codec) = TiffCodec::from_tag(self.page.compression) else { return Ok(()) };
        let reversed: Vec<u8>;
        let packed = if self.page.is_lsb_first {
            reversed = packed.iter().copied().map(u8::reverse_bits).collect();
            &reversed
        } else {
            packed
        };
        let wanted = out.len();
        let picture = jpeg::JpegPart {
            tables: &self.tables,
            size: self.page.part_size,
            full_bytes: self.page.row_bytes(self.samples).saturating_mul(self.page.part_size[1]) as usize,
            samples: self.samples,
            is_ycbcr: self.page.is_ycbcr && self.samples == 3,
        };
        match codec.expand(packed, picture, out, control) {
            Ok(found) if found == wanted => Ok(()),
            Ok(found) => Err(context.bad_input_error(
                field,
                format!("a strip or tile ends too early: {wanted} bytes expected, {found} found"),
                HELP,
            )),
            Err(ReadFault::Stopped(error)) => Err(error),
            Err(ReadFault::Long) => {
                let why =
                    format!("a compressed strip or tile goes on beyond the {wanted} bytes of its pixels");
                Err(context.bad_input_error(field, why, HELP))
            }
            Err(ReadFault::Io(error)) => {
                let why = format!("a compressed strip or tile is broken: {error}");
                Err(context.bad_input_error(field, chiaroscuro_files::sanitised(&why, 200), HELP))
            }
            Err(_) => Err(context.bad_input_error(field, "a compressed strip or tile is broken", HELP)),
        }
    }
}

/// Interleaves the samples of several planes.
fn interleave_planes(planes: &[u8], count: usize, size: usize) -> Vec<u8> {
    let plane = planes.len() / count;
    let mut woven = Vec::with_capacity(planes.len());
    for at in (0..plane).step_by(size) {
        for sample in 0..count {
            woven.extend_from_slice(&planes[sample * plane + at..][..size]);
        }
    }
    woven
}
