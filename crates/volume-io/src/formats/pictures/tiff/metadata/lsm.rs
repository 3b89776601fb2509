//! LSM metadata of Zeiss laser scanning microscopes, in a directory entry of their own: numbers of slices and time
//! steps, the voxel size, and the names of channels. Slices vary fastest over the pages; channels are the samples of a
//! page.

use super::super::file::TiffFile;
use super::super::file::bytes::decode_integer;
use super::super::file::page::{SampleMeaning, tag};
use super::super::messages::HELP;
use super::super::stack::{TiffSlice, TiffStack};
use super::super::undescribed::UsablePages;
use super::lsm_channels::LsmChannels;
use crate::Endian;
use crate::formats::pictures::channels_and_times::ChannelsAndTimes;
use crate::reading::input::stem;
use crate::reading::placement::GridPlacement;
use chiaroscuro_volume::{LoadContext, LoadError, Modality, ValueMetadata, VolumeChoice};

/// Magic numbers of the entry, versions 1.3 and later.
const MAGIC: [u64; 2] = [0x0030_0494, 0x0040_0494];

/// Number of bytes of the entry that are read, to the end of the offset of the channels' block.
const INFO_BYTES: u64 = 112;

/// Contents of the LSM entry.
pub(crate) struct LsmInfo {
    slices: usize,
    frames: usize,
    /// Voxel size, in metres.
    spacing: [f64; 3],
    channels: LsmChannels,
}

impl LsmInfo {
    /// Reads the entry; `None` where a file has none.
    pub(crate) fn read(tiff: &mut TiffFile) -> Option<Self> {
        let bytes = tiff.first.get(tag::LSM_INFO)?.raw(&mut tiff.bytes, INFO_BYTES).ok()?;
        let number = |at: usize, size: usize| Some(decode_integer(bytes.get(at..at + size)?, Endian::Little));
        if !number(0, 4).is_some_and(|magic| MAGIC.contains(&magic)) {
            return None;
        }
        let length = |at| number(at, 8).map(f64::from_bits);
        Some(Self {
            slices: number(16, 4)?.max(1) as usize,
            frames: number(24, 4)?.max(1) as usize,
            spacing: [length(40)?, length(48)?, length(56)?],
            channels: LsmChannels::read(&mut tiff.bytes, number(108, 4).unwrap_or(0)),
        })
    }

    /// Builds the stack of an LSM file.
    pub(crate) fn stack(
        &self,
        context: LoadContext<'_>,
        tiff: &TiffFile,
        choice: &VolumeChoice,
    ) -> Result<TiffStack, LoadError> {
        let is_length = |length: &f64| length.is_finite() && *length > 0.0;
        let mut placement = if self.spacing.iter().all(is_length) {
            GridPlacement::from_spacing(self.spacing.map(|length| length * 1e3)).with_length_unit(1e-3)
        } else {
            GridPlacement::unknown()
        };
        let UsablePages { pages, mismatch_remark, .. } = UsablePages::new(tiff);
        // Without a remark on thumbnails: LSM files always have them.
        placement.remarks.extend(mismatch_remark);
        let Some(first) = pages.first().map(|&page| tiff.pages[page]) else {
            return Err(context.bad_input_error("pages", "it has no usable page", HELP));
        };
        let is_whole = self.slices.checked_mul(self.frames) == Some(pages.len());
        let (slices, frames) = if is_whole { (self.slices, self.frames) } else { (pages.len(), 1) };
        let is_channels = first.meaning != SampleMeaning::Grey;
        let steps = ChannelsAndTimes {
            dims: [first.width, first.height, slices as u64],
            channels: if is_channels { first.samples } else { 1 },
            channel_names: self.channels.names.clone(),
            channel_colors: self.channels.colors.clone(),
            frames,
            frame_names: Vec::new(),
        };
        let chosen = steps.choose(context, choice)?;
        chosen.add_time_remark(&mut placement);
        let mut hints = ValueMetadata::default();
        hints.modality = Modality::LightMicroscopy;
        let page_of =
            |[frame, slice]: [usize; 2]| Some(TiffSlice { file: 0, page: pages[frame * slices + slice] });
        Ok(TiffStack {
            name: stem(context.path),
            slices: chosen.slices(slices, frames).into_iter().map(page_of).collect(),
            other_files: Vec::new(),
            sample: is_channels.then_some(chosen.channel),
            placement,
            hints,
            scale: [1.0, 0.0],
        })
    }
}
