//! `ImageJ` metadata: lines of `name=value` in the description of the first page.
//!
//! After the files that `ImageJ` itself writes (its class `FileSaver`). Stacks over 4 GiB have only one page, whose
//! data are followed by those of the other slices. Channels vary fastest over the pages, then slices, then time
//! steps.

use super::super::fault::HELP;
use super::super::file::Tiff;
use super::super::plain::usable;
use super::super::stack::{Slice, Stack, Steps};
use super::contiguous::contiguous;
use super::names::ImagejMetadata;
use super::place::place;
use crate::data::Hints;
use crate::data::attempt::Attempt;
use crate::data::load::reading::input::stem;
use crate::data::load::{Choice, LoadError};

/// Maximum number of channels that `ImageJ` shows together.
const MOST_CHANNELS: usize = 7;

/// Lines of an `ImageJ` description.
struct Said<'a>(&'a str);

impl<'a> Said<'a> {
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
pub(in super::super) fn is_imagej(description: &str) -> bool {
    description.starts_with("ImageJ=")
}

/// Builds the stack of a file with such a description.
pub(in super::super) fn stack(
    attempt: Attempt<'_>,
    tiff: &mut Tiff,
    description: &str,
    choice: &Choice,
) -> Result<Stack, LoadError> {
    let said = Said(description);
    let images = said.count("images");
    if let (Some(images), &[page]) = (images, tiff.pages.as_slice())
        && images > 1
        && page.is_bare()
    {
        tiff.pages = contiguous(attempt, tiff, &page, images, "images")?;
    }
    let mut remarks = Vec::new();
    let pages = usable(tiff, &mut remarks);
    let Some(first) = pages.first().map(|&page| tiff.pages[page]) else {
        return Err(attempt.bad_input("pages", "there is none", HELP));
    };
    let (channels, frames) = (said.count("channels").unwrap_or(1), said.count("frames").unwrap_or(1));
    let slices = said.count("slices");
    let others = channels.checked_mul(frames);
    // Old versions give only the total number of images.
    let slices = slices.or_else(|| others.map(|others| (pages.len() / others).max(1))).unwrap_or(1);
    let is_whole = others.and_then(|others| others.checked_mul(slices)).is_some_and(|all| all <= pages.len());
    let (channels, slices, frames) = if is_whole {
        // Programs that write such files without naming the axes make slices channels.
        let is_depth = channels > MOST_CHANNELS && [slices, frames] == [1, 1] && choice.channel.is_none();
        if is_depth {
            remarks.push(format!("{channels} channels of one slice each are taken as slices"));
        }
        if is_depth { (1, channels, 1) } else { (channels, slices, frames) }
    } else {
        remarks.push(format!(
            "{channels} channels of {slices} slices at {frames} times are said, and there are {} pages: all are taken as \
             slices",
            pages.len()
        ));
        (1, pages.len(), 1)
    };
    let dims = [first.width, first.height, slices as u64];
    let channel_names = ImagejMetadata::read(tiff).channel_names(channels, pages.len());
    let chosen = Steps { dims, channels, channel_names, frames }.chosen(attempt, choice)?;
    let mut placement = place(tiff, said.text("unit"), said.number("spacing"));
    placement.remarks.splice(0..0, remarks);
    chosen.remark(&mut placement);
    let page_of = |[frame, slice]: [usize; 2]| pages[(frame * slices + slice) * channels + chosen.channel];
    Ok(Stack {
        name: stem(attempt.path),
        slices: chosen
            .slices(slices, frames)
            .into_iter()
            .map(|place| Some(Slice { file: 0, page: page_of(place) }))
            .collect(),
        beside: Vec::new(),
        sample: None,
        placement,
        hints: hints(&said, channels),
        scale: scale(&said),
    })
}

/// Slope and intercept of the values. `ImageJ` stores signed 16-bit numbers in this way.
fn scale(said: &Said<'_>) -> [f64; 2] {
    // Function 0 is linear; others are calibration curves for film densities.
    match (said.text("cf"), said.number("c0"), said.number("c1")) {
        (Some("0"), Some(intercept), Some(slope)) => [slope, intercept],
        _ => [1.0, 0.0],
    }
}

fn hints(said: &Said<'_>, channels: usize) -> Hints {
    let mut hints = Hints::default();
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
