//! TIFF writer: one uncompressed page per slice, with `ImageJ` metadata for distances and units.
//!
//! Format: TIFF 6.0 (Adobe, 1992), and `BigTIFF` (<https://www.awaresystems.be/imaging/tiff/bigtiff.html>) beyond 4
//! GiB. All directories precede all slices, so that every offset is known before anything is written.

use std::io::{Result, Write};

use super::export_volume::ExportVolume;
use chiaroscuro_files::{provenance_mark, sanitised_line};
use chiaroscuro_volume::VoxelType;

/// Tag of the text that names the writing program.
const SOFTWARE: u16 = 305;

/// Field type codes of TIFF.
const ASCII: u16 = 2;
const SHORT: u16 = 3;
const LONG: u16 = 4;
const RATIONAL: u16 = 5;
const LONG8: u16 = 16;

/// Spacing below which distances are written in micrometres, as is usual in microscopy; in mm.
const MICROMETRE_LIMIT_MM: f64 = 0.01;

/// Alignment of the slices in bytes: twice the size of the widest number.
const ALIGNMENT: u64 = 16;

/// Entry of a TIFF directory.
struct TiffEntry {
    tag: u16,
    kind: u16,
    count: u64,
    value: Vec<u8>,
}

impl TiffEntry {
    fn short(tag: u16, value: u16) -> Self {
        Self { tag, kind: SHORT, count: 1, value: value.to_le_bytes().to_vec() }
    }

    fn long(tag: u16, value: u32) -> Self {
        Self { tag, kind: LONG, count: 1, value: value.to_le_bytes().to_vec() }
    }

    /// Creates an entry for an offset or a length, in the width of the file's offsets.
    fn offset(tag: u16, value: u64, is_big: bool) -> Self {
        if is_big {
            return Self { tag, kind: LONG8, count: 1, value: value.to_le_bytes().to_vec() };
        }
        Self::long(tag, value as u32)
    }

    fn text(tag: u16, text: &str) -> Self {
        let value = [text.as_bytes(), b"\0"].concat();
        Self { tag, kind: ASCII, count: value.len() as u64, value }
    }

    fn rational(tag: u16, value: f64) -> Self {
        let [above, below] = best_fraction(value);
        let value = [above.to_le_bytes(), below.to_le_bytes()].concat();
        Self { tag, kind: RATIONAL, count: 1, value }
    }
}

/// Returns the best approximation of a value by a fraction of two 32-bit numbers, from its continued fraction.
fn best_fraction(value: f64) -> [u32; 2] {
    let (mut above, mut below) = ([1.0, 0.0], [0.0, 1.0]);
    let mut rest = value;
    // The expansion of a 64-bit number ends after about forty steps.
    for _ in 0..64 {
        let whole = rest.floor();
        let next = |last: [f64; 2]| whole * last[0] + last[1];
        let (up, down) = (next(above), next(below));
        if up.max(down) > f64::from(u32::MAX) {
            break;
        }
        (above, below) = ([up, above[0]], [down, below[0]]);
        let is_exact = (up / down - value).abs() <= 1e-15 * value;
        if is_exact || rest == whole {
            break;
        }
        rest = 1.0 / (rest - whole);
    }
    // Values beyond the range of fractions are clamped.
    match [above[0], below[0]] {
        [_, 0.0] => [u32::MAX, 1],
        [0.0, _] => [1, u32::MAX],
        [up, down] => [up as u32, down as u32],
    }
}

/// Offset width of a file: TIFF or `BigTIFF`.
#[derive(Clone, Copy)]
struct TiffVariant {
    is_big: bool,
}

impl TiffVariant {
    /// Size of the file header, in bytes.
    fn header_bytes(self) -> u64 {
        if self.is_big { 16 } else { 8 }
    }

    /// Maximum size of a value that is stored in the entry itself, in bytes.
    fn inline_bytes(self) -> usize {
        if self.is_big { 8 } else { 4 }
    }

    /// Encodes an offset in the file.
    fn offset_bytes(self, at: u64) -> Vec<u8> {
        if self.is_big { at.to_le_bytes().to_vec() } else { (at as u32).to_le_bytes().to_vec() }
    }

    /// Encodes a directory at an offset, followed by the values that do not fit into its entries; the next directory
    /// follows, unless it is the last.
    fn directory(self, entries: &[TiffEntry], at: u64, is_last: bool) -> Vec<u8> {
        let (count, entry) = if self.is_big { (8, 20) } else { (2, 12) };
        let mut behind = at + count + entry * entries.len() as u64 + self.inline_bytes() as u64;
        let mut bytes = (entries.len() as u64).to_le_bytes()[..count as usize].to_vec();
        let mut values = Vec::new();
        for TiffEntry { tag, kind, count, value } in entries {
            bytes.extend(tag.to_le_bytes());
            bytes.extend(kind.to_le_bytes());
            bytes.extend(self.offset_bytes(*count));
            if value.len() <= self.inline_bytes() {
                bytes.extend(value);
                bytes.extend(std::iter::repeat_n(0, self.inline_bytes() - value.len()));
                continue;
            }
            bytes.extend(self.offset_bytes(behind));
            let mut value = value.clone();
            // Padding keeps offsets of values even.
            value.resize(value.len().next_multiple_of(8), 0);
            behind += value.len() as u64;
            values.extend(value);
        }
        bytes.extend(self.offset_bytes(if is_last { 0 } else { behind }));
        bytes.extend(values);
        bytes
    }
}

/// Input for the directories of all pages.
struct TiffPages<'a> {
    volume: &'a ExportVolume<'a>,
    form: TiffVariant,
    page_bytes: u64,
}

impl<'a> TiffPages<'a> {
    fn new(volume: &'a ExportVolume<'a>, is_big: bool) -> Self {
        Self { volume, form: TiffVariant { is_big }, page_bytes: volume.bytes() / volume.dims()[2] as u64 }
    }

    /// Returns the offset of the first page's pixels.
    fn pixel_offset(&self) -> u64 {
        let of_page = |page: usize| self.form.directory(&self.entries(page, 0), 0, false).len() as u64;
        let others = self.volume.dims()[2] as u64 - 1;
        // All pages but the first have directories of equal size.
        let others = if others > 0 { others * of_page(1) } else { 0 };
        (self.form.header_bytes() + of_page(0) + others).next_multiple_of(ALIGNMENT)
    }

    /// Returns the entries of a page whose pixels are at an offset.
    fn entries(&self, page: usize, pixels: u64) -> Vec<TiffEntry> {
        let [width, height, _] = self.volume.dims();
        let voxel_type = self.volume.voxel_type();
        let is_first = page == 0;
        // Sample formats: 1 unsigned, 2 signed, 3 floating point.
        let format = match voxel_type {
            VoxelType::U8 | VoxelType::U16 | VoxelType::U32 => 1,
            VoxelType::I8 | VoxelType::I16 | VoxelType::I32 => 2,
            VoxelType::F32 | VoxelType::F64 => 3,
        };
        let mut entries = vec![
            TiffEntry::long(256, width as u32),
            TiffEntry::long(257, height as u32),
            TiffEntry::short(258, 8 * voxel_type.bytes() as u16),
            // Uncompressed; black is zero.
            TiffEntry::short(259, 1),
            TiffEntry::short(262, 1),
        ];
        if is_first {
            entries.push(TiffEntry::text(270, &description(self.volume)));
        }
        entries.extend([
            TiffEntry::offset(273, pixels, self.form.is_big),
            TiffEntry::short(277, 1),
            TiffEntry::long(278, height as u32),
            TiffEntry::offset(279, self.page_bytes, self.form.is_big),
        ]);
        if is_first {
            if !self.volume.has_unknown_geometry() {
                let [x, y, _] = spacing_in_unit(self.volume);
                entries.extend([TiffEntry::rational(282, 1.0 / x), TiffEntry::rational(283, 1.0 / y)]);
                // No absolute unit: the description names it.
                entries.push(TiffEntry::short(296, 1));
            }
            entries.push(TiffEntry::text(SOFTWARE, &provenance_mark()));
        }
        entries.push(TiffEntry::short(339, format));
        if let Some(padding) = self.volume.hints().padding.filter(|_| is_first) {
            // Tag of GDAL for the no-data value.
            entries.push(TiffEntry::text(42113, &padding.to_string()));
        }
        entries
    }
}

/// Writes a volume as TIFF, or as `BigTIFF` beyond 4 GiB.
pub(super) fn write(out: &mut dyn Write, volume: &ExportVolume<'_>) -> Result<()> {
    let pages = TiffPages::new(volume, false);
    let is_big = pages.pixel_offset() + volume.bytes() > u64::from(u32::MAX);
    write_pages(out, &if is_big { TiffPages::new(volume, true) } else { pages })
}

/// Writes a volume with the offset width of `pages`.
fn write_pages(out: &mut dyn Write, pages: &TiffPages<'_>) -> Result<()> {
    let TiffPages { volume, form, page_bytes } = *pages;
    if form.is_big {
        // Version 43, then the offset size of eight bytes.
        out.write_all(b"II\x2b\0\x08\0\0\0")?;
    } else {
        out.write_all(b"II\x2a\0")?;
    }
    out.write_all(&form.offset_bytes(form.header_bytes()))?;
    let (mut at, pixels) = (form.header_bytes(), pages.pixel_offset());
    let slices = volume.dims()[2];
    for page in 0..slices {
        let entries = pages.entries(page, pixels + page as u64 * page_bytes);
        let directory = form.directory(&entries, at, page + 1 == slices);
        out.write_all(&directory)?;
        at += directory.len() as u64;
    }
    out.write_all(&vec![0; (pixels - at) as usize])?;
    volume.write_voxels(out)
}

/// Returns the distances in the unit that the description names.
fn spacing_in_unit(volume: &ExportVolume<'_>) -> [f64; 3] {
    let spacing = volume.spacing_mm();
    if is_small(volume) { spacing.map(|length| length * 1e3) } else { spacing }
}

fn is_small(volume: &ExportVolume<'_>) -> bool {
    !volume.has_unknown_scale() && volume.spacing_mm().iter().any(|&length| length < MICROMETRE_LIMIT_MM)
}

/// Returns the metadata lines that `ImageJ` reads.
fn description(volume: &ExportVolume<'_>) -> String {
    let slices = volume.dims()[2];
    // Identifies the file as one of `ImageJ`'s.
    let mut text = format!("ImageJ=1.54f\nimages={slices}\nslices={slices}\n");
    let mut add = |name: &str, value: &str| text.extend([name, "=", &sanitised_line(value, 200), "\n"]);
    if !volume.has_unknown_scale() {
        add("unit", if is_small(volume) { "micron" } else { "mm" });
    }
    if !volume.has_unknown_geometry() {
        add("spacing", &spacing_in_unit(volume)[2].to_string());
    }
    if let Some([low, high]) = volume.hints().window {
        add("min", &low.to_string());
        add("max", &high.to_string());
    }
    if let Some(unit) = volume.unit() {
        add("vunit", unit);
    }
    add("loop", "false");
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LoadOptions, load};
    use chiaroscuro_volume::{LoadControl, Samples, Volume};

    #[test]
    fn large_files_are_read_as_small_ones_are() {
        let values = Samples::I16((0..60).map(|at| at * 500 - 9000).collect());
        let spacing = glam::DVec3::new(0.5, 1.5, 2.0);
        let volume =
            Volume::with_spacing("t", [5, 4, 3], spacing, values).unwrap().with_padding(-9000.0).unwrap();
        let outgoing = ExportVolume::new(&volume);
        let folder = tempfile::tempdir().unwrap();
        for is_big in [false, true] {
            let mut bytes = Vec::new();
            write_pages(&mut bytes, &TiffPages::new(&outgoing, is_big)).unwrap();
            assert_eq!(bytes[2], if is_big { 43 } else { 42 });
            let path = folder.path().join("t.tif");
            std::fs::write(&path, bytes).unwrap();
            let found = load(&path, &LoadOptions::default(), &LoadControl::new()).unwrap();
            assert_eq!((found.samples(), found.dims()), (volume.samples(), volume.dims()));
            assert_eq!((found.spacing_mm(), found.padding_value()), (spacing, Some(-9000.0)));
        }
    }

    #[test]
    fn fractions_are_as_near_as_they_can_be() {
        for (value, wanted) in [
            (2.0, [2, 1]),
            (1.0 / 1.5, [2, 3]),
            (0.1, [1, 10]),
            (1e12, [u32::MAX, 1]),
            (1e-12, [1, u32::MAX]),
        ] {
            assert_eq!(best_fraction(value), wanted, "{value}");
        }
        for at in 1..1000 {
            let value = f64::from(at).sqrt() * 0.37;
            let [above, below] = best_fraction(value);
            assert!((f64::from(above) / f64::from(below) / value - 1.0).abs() < 1e-9, "{value}");
        }
    }
}
