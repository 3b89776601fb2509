//! TIFF files without further metadata: all pages that match the first one are slices, in file order.

use super::file::TiffFile;
use super::file::page::SampleMeaning;
use super::stack::{TiffSlice, TiffStack};
use crate::formats::pictures::channels_and_times::ChannelsAndTimes;
use crate::reading::input::stem;
use crate::reading::placement::GridPlacement;
use chiaroscuro_volume::{LoadContext, LoadError, ValueMetadata, VolumeChoice};

/// Pages that are slices: those that match the first page that is not a thumbnail or mask.
pub(super) struct UsablePages {
    /// Indices of the slices among the pages of the file.
    pub(super) pages: Vec<usize>,
    /// Remark on masks and smaller versions that are left out.
    pub(super) auxiliary_remark: Option<String>,
    /// Remark on pages of another kind that are left out.
    pub(super) mismatch_remark: Option<String>,
}

impl UsablePages {
    /// Selects the pages of a file.
    pub(super) fn new(tiff: &TiffFile) -> Self {
        let pages = &tiff.pages;
        let all_aside = pages.iter().all(|page| page.is_auxiliary);
        let is_meant = |page: usize| all_aside || !pages[page].is_auxiliary;
        let (meant, aside): (Vec<usize>, Vec<usize>) = (0..pages.len()).partition(|&page| is_meant(page));
        let is_like_first = |&page: &usize| pages[page].matches(&pages[meant[0]]);
        let (like, unlike): (Vec<usize>, Vec<usize>) = meant.iter().copied().partition(is_like_first);
        let remark = |left_out: &[usize], why: &str| {
            (!left_out.is_empty())
                .then(|| format!("{} of {} pages are left out: {why}", left_out.len(), pages.len()))
        };
        Self {
            auxiliary_remark: remark(&aside, "they are masks or smaller versions of others"),
            mismatch_remark: remark(&unlike, "their size or sample type differs from the first"),
            pages: like,
        }
    }

    /// Takes the indices, and adds the remarks on the pages that are left out.
    pub(super) fn with_remarks(self, remarks: &mut Vec<String>) -> Vec<usize> {
        remarks.extend(self.auxiliary_remark.into_iter().chain(self.mismatch_remark));
        self.pages
    }
}

/// Builds the stack of a file without further metadata.
pub(super) fn stack_of_pages(
    context: LoadContext<'_>,
    tiff: &TiffFile,
    choice: &VolumeChoice,
) -> Result<TiffStack, LoadError> {
    let mut placement = GridPlacement::unknown();
    let pages = UsablePages::new(tiff).with_remarks(&mut placement.remarks);
    let Some(first) = pages.first().map(|&page| tiff.pages[page]) else {
        return Err(context.bad_input_error("pages", "it has no usable page", super::messages::HELP));
    };
    let is_channels = first.meaning == SampleMeaning::Channels;
    let steps = ChannelsAndTimes {
        dims: [first.width, first.height, pages.len() as u64],
        channels: if is_channels { first.samples } else { 1 },
        channel_names: Vec::new(),
        channel_colors: Vec::new(),
        frames: 1,
        frame_names: Vec::new(),
    };
    let chosen = steps.choose(context, choice)?;
    Ok(TiffStack {
        name: stem(context.path),
        slices: pages.into_iter().map(|page| Some(TiffSlice { file: 0, page })).collect(),
        other_files: Vec::new(),
        sample: is_channels.then_some(chosen.channel),
        placement,
        hints: ValueMetadata::default(),
        scale: [1.0, 0.0],
    })
}
