//! Colour palettes (TIFF 6.0, section 5): values are measurements or labels, and the colours serve display only;
//! labels keep them.

use crate::formats::pictures::tiff::file::TiffFile;
use crate::formats::pictures::tiff::file::page::tag;
use chiaroscuro_volume::{DataKind, Volume};

/// Photometric interpretation of palette colours.
const PALETTE: f64 = 3.0;

/// Number of entries of a 16-bit palette, the longest possible.
const MAX_NUMBERS: u64 = 3 << 16;

/// Remark on palettes for the user.
const REMARK: &str = "values are indices into its colour table";

/// Palette: red of all entries, then green, then blue, each up to 65535.
pub(crate) struct TiffPalette(Vec<u64>);

impl TiffPalette {
    /// Reads the palette of the first page, if it has one.
    pub(crate) fn read(tiff: &mut TiffFile) -> Option<Self> {
        let is_palette = tiff.number_entry(tag::PHOTOMETRIC) == Some(PALETTE);
        let entry = tiff.first.get(tag::COLOR_MAP).filter(|_| is_palette)?;
        entry.numbers(&mut tiff.bytes, MAX_NUMBERS).ok().map(Self)
    }

    /// Adds the remark to a volume and, if it is a label map, the colours of its labels.
    pub(crate) fn apply(&self, volume: Volume) -> Volume {
        let remarks = volume.remarks().iter().cloned().chain([REMARK.to_owned()]).collect();
        let volume = volume.with_remarks(remarks);
        if !matches!(volume.kind().kind, DataKind::LabelMap { .. }) {
            return volume;
        }
        let mut hints = volume.metadata().clone();
        for label in volume.labels().map_or(&[][..], |labels| labels.labels()) {
            hints.labels.insert(label.number, "", self.color(label.number));
        }
        volume.with_metadata(hints)
    }

    fn color(&self, number: i64) -> Option<[f32; 3]> {
        let count = self.0.len() / 3;
        let at = usize::try_from(number).ok().filter(|&at| at < count)?;
        // Some programs write values up to 255.
        let most = if self.0.iter().all(|&part| part < 256) { 255.0 } else { 65535.0 };
        Some([0, 1, 2].map(|part| self.0[part * count + at] as f32 / most))
    }
}
