//! `ImageJ` metadata: lines of `name=value` in the description of the first page.
//!
//! After the files that `ImageJ` itself writes (its class `FileSaver`). Stacks over 4 GiB have only one page, whose
//! data are followed by those of the other slices. Channels vary fastest over the pages, then slices, then time
//! steps.

use super::super::file::TiffFile;
use super::super::messages::HELP;
use super::super::stack::{TiffSlice, TiffStack};
use super::super::undescribed::UsablePages;
use super::contiguous::contiguous_pages;
use super::imagej_channels::ImagejMetadata;
use super::spacing::placement_from_resolution;
use crate::formats::pictures::channels_and_times::ChannelsAndTimes;
use crate::reading::input::stem;
use chiaroscuro_volume::{LoadContext, LoadError, ValueMetadata, VolumeChoice};

/// Maximum number of channels that `ImageJ` shows together.
const MAX_CHANNELS: usize = 7;

/// Lines of an `ImageJ` description.
struct ImagejDescription<'a>(&'a str);

impl<'a> ImagejDescription<'a> {
    fn text(&self, name: &str) -> Option<&'a str> {
        self.0.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix('=')).map(str::trim)
    }

    fn number(&self, name: &str) -> Option<f64> {
        self.text(name)?.parse().ok().filter(|number: &f64| number.is_finite())
    }

    fn count(&self, name: &str) -> Option<usize> {
        self.text(name)?.parse().ok().filter(|&count| count > 0)
    }
}

/// Returns true if a description was written by `ImageJ`.
pub(crate) fn is_imagej(description: &str) -> bool {
    description.starts_with("ImageJ=")
}

/// Builds the stack of a file with such a description.
pub(crate) fn stack(
    context: LoadContext<'_>,
    tiff: &mut TiffFile,
    description: &str,
    choice: &VolumeChoice,
) -> Result<TiffStack, LoadError> {
    let said = ImagejDescription(description);
    let images = said.count("images");
    if let (Some(images), &[page]) = (images, tiff.pages.as_slice())
        && images > 1
        && page.is_plain_rows()
    {
        tiff.pages = contiguous_pages(context, tiff, &page, images, "images")?;
    }
    let mut remarks = Vec::new();
    let pages = UsablePages::new(tiff).with_remarks(&mut remarks);
    let Some(first) = pages.first().map(|&page| tiff.pages[page]) else {
        return Err(context.bad_input_error("pages", "it has no usable page", HELP));
    };
    let (channels, frames) = (said.count("channels").unwrap_or(1), said.count("frames").unwrap_or(1));
    let slices = said.count("slices");
    let others = channels.checked_mul(frames);
    // Old versions give only the total number of images.
    let slices = slices.or_else(|| others.map(|others| (pages.len() / others).max(1))).unwrap_or(1);
    let is_whole = others.and_then(|others| others.checked_mul(slices)).is_some_and(|all| all <= pages.len());
    let (channels, slices, frames) = if is_whole {
        // Programs that write such files without naming the axes make slices channels.
        let is_depth = channels > MAX_CHANNELS && [slices, frames] == [1, 1] && choice.channel.is_none();
        if is_depth {
            remarks.push(format!("{channels} channels of one slice each are taken as slices"));
        }
        if is_depth { (1, channels, 1) } else { (channels, slices, frames) }
    } else {
        remarks.push(format!(
            "{channels} channels of {slices} slices at {frames} time steps are announced, and there are {} pages: all \
             are taken as slices",
            pages.len()
        ));
        (1, pages.len(), 1)
    };
    let dims = [first.width, first.height, slices as u64];
    let metadata = ImagejMetadata::read(tiff);
    let steps = ChannelsAndTimes {
        dims,
        channels,
        channel_names: metadata.channel_names(channels, pages.len()),
        channel_colors: metadata.channel_colors(channels),
        frames,
        frame_names: Vec::new(),
    };
    let chosen = steps.choose(context, choice)?;
    let mut placement = placement_from_resolution(tiff, said.text("unit"), said.number("spacing"));
    placement.remarks.splice(0..0, remarks);
    chosen.add_time_remark(&mut placement);
    let page_of = |[frame, slice]: [usize; 2]| pages[(frame * slices + slice) * channels + chosen.channel];
    Ok(TiffStack {
        name: stem(context.path),
        slices: chosen
            .slices(slices, frames)
            .into_iter()
            .map(|place| Some(TiffSlice { file: 0, page: page_of(place) }))
            .collect(),
        other_files: Vec::new(),
        sample: None,
        placement,
        hints: hints(&said, channels),
        scale: slope_and_intercept(&said),
    })
}

/// Slope and intercept of the values. `ImageJ` stores signed 16-bit numbers in this way.
fn slope_and_intercept(said: &ImagejDescription<'_>) -> [f64; 2] {
    // Function 0 is linear; others are calibration curves for film densities.
    match (said.text("cf"), said.number("c0"), said.number("c1")) {
        (Some("0"), Some(intercept), Some(slope)) => [slope, intercept],
        _ => [1.0, 0.0],
    }
}

fn hints(said: &ImagejDescription<'_>, channels: usize) -> ValueMetadata {
    let mut hints = ValueMetadata::default();
    // With several channels, the window is that of the first.
    if let (1, Some(low), Some(high)) = (channels, said.number("min"), said.number("max")) {
        hints.set_window(low, high);
    }
    // "Gray value" is the default unit, without meaning.
    if let Some(unit) = said.text("vunit").filter(|unit| !unit.eq_ignore_ascii_case("gray value")) {
        hints.set_unit(unit);
    }
    hints
}
