//! LSM metadata of Zeiss laser scanning microscopes, in a directory entry of their own: numbers of slices and time
//! steps, and the voxel size. Slices vary fastest over the pages; channels are the samples of a page.

use super::super::fault::HELP;
use super::super::file::Tiff;
use super::super::file::bytes::whole;
use super::super::file::page::{Meaning, tag};
use super::super::plain::usable;
use super::super::stack::{Slice, Stack, Steps};
use crate::data::attempt::Attempt;
use crate::data::load::Endian;
use crate::data::load::reading::input::stem;
use crate::data::load::reading::placement::Placement;
use crate::data::load::{Choice, LoadError};
use crate::data::{Hints, Modality};

/// Magic numbers of the entry, versions 1.3 and later.
const MAGIC: [u64; 2] = [0x0030_0494, 0x0040_0494];

/// Number of bytes of the entry that are read, to the end of the voxel sizes.
const INFO_BYTES: u64 = 64;

/// Contents of the LSM entry.
pub(in super::super) struct Info {
    slices: usize,
    frames: usize,
    /// Voxel size, in metres.
    spacing: [f64; 3],
}

impl Info {
    /// Reads the entry; `None` where a file has none.
    pub(in super::super) fn of(tiff: &mut Tiff) -> Option<Self> {
        let bytes = tiff.first.get(tag::LSM_INFO)?.raw(&mut tiff.bytes, INFO_BYTES).ok()?;
        let number = |at: usize, size: usize| Some(whole(bytes.get(at..at + size)?, Endian::Little));
        let is_one = number(0, 4).is_some_and(|magic| MAGIC.contains(&magic));
        let length = |at| number(at, 8).map(f64::from_bits);
        is_one.then_some(Self {
            slices: number(16, 4)?.max(1) as usize,
            frames: number(24, 4)?.max(1) as usize,
            spacing: [length(40)?, length(48)?, length(56)?],
        })
    }

    /// Builds the stack of an LSM file.
    pub(in super::super) fn stack(
        &self,
        attempt: Attempt<'_>,
        tiff: &Tiff,
        choice: &Choice,
    ) -> Result<Stack, LoadError> {
        let is_length = |length: &f64| length.is_finite() && *length > 0.0;
        let mut placement = if self.spacing.iter().all(is_length) {
            Placement::spaced(self.spacing.map(|length| length * 1e3)).said_in(1e-3)
        } else {
            Placement::unknown()
        };
        let mut remarks = Vec::new();
        let pages = usable(tiff, &mut remarks);
        // Without a remark on thumbnails: LSM files always have them.
        placement.remarks.extend(remarks.into_iter().filter(|remark| !remark.contains("smaller versions")));
        let Some(first) = pages.first().map(|&page| tiff.pages[page]) else {
            return Err(attempt.bad_input("pages", "there is none", HELP));
        };
        let is_whole = self.slices.checked_mul(self.frames) == Some(pages.len());
        let (slices, frames) = if is_whole { (self.slices, self.frames) } else { (pages.len(), 1) };
        let is_channels = first.meaning != Meaning::Grey;
        let steps = Steps {
            dims: [first.width, first.height, slices as u64],
            channels: if is_channels { first.samples } else { 1 },
            channel_names: Vec::new(),
            frames,
        };
        let chosen = steps.chosen(attempt, choice)?;
        chosen.remark(&mut placement);
        let mut hints = Hints::default();
        hints.modality = Modality::LightMicroscopy;
        let page_of =
            |[frame, slice]: [usize; 2]| Some(Slice { file: 0, page: pages[frame * slices + slice] });
        Ok(Stack {
            name: stem(attempt.path),
            slices: chosen.slices(slices, frames).into_iter().map(page_of).collect(),
            beside: Vec::new(),
            sample: is_channels.then_some(chosen.channel),
            placement,
            hints,
            scale: [1.0, 0.0],
        })
    }
}
