//! Which page of which file an OME-TIFF has for a slice: its elements `TiffData`.

use std::collections::HashMap;
use std::path::PathBuf;

use roxmltree::Node;

use super::super::super::fault::HELP;
use super::super::super::file::directory::MOST_PAGES;
use super::super::super::stack::Slice;
use super::{Sizes, beside_of, children, number};
use crate::data::attempt::Attempt;
use crate::data::load::LoadError;

/// The page of every slice, channel and time that there is one for.
pub(super) struct Pages<'a> {
    /// By the place in `DimensionOrder`.
    places: HashMap<usize, (&'a str, usize)>,
    /// Slices, channels and times, and how far one goes on in the order.
    strides: [usize; 3],
    sizes: [usize; 3],
    /// What the file that is opened is called in the XML.
    own: Option<&'a str>,
}

impl<'a> Pages<'a> {
    /// Goes through what is said of pages. `own_pages` are those of the file that is opened.
    pub(super) fn of(
        attempt: Attempt<'_>,
        root: Node<'a, '_>,
        pixels: Node<'a, '_>,
        sizes: &Sizes,
        own_pages: usize,
    ) -> Result<Self, LoadError> {
        let counts = [sizes.dims[2] as usize, sizes.channels, sizes.frames];
        let mut strides = [1; 3];
        let mut stride = 1usize;
        for letter in sizes.order {
            let axis = axis_of(letter);
            strides[axis] = stride;
            stride = stride.saturating_mul(counts[axis]);
        }
        let all = stride;
        let elements: Vec<Node<'_, '_>> = children(pixels, "TiffData").collect();
        let mut pages = HashMap::new();
        let mut said = 0usize;
        for &element in &elements {
            let first =
                ["FirstZ", "FirstC", "FirstT"].map(|name| number::<usize>(element, name).unwrap_or(0));
            if (0..3).any(|axis| first[axis] >= counts[axis]) {
                let why = format!("{first:?} is beyond its {counts:?} slices, channels and times");
                return Err(attempt.bad_input("TiffData", why, HELP));
            }
            let page = number::<usize>(element, "IFD");
            let count = number::<usize>(element, "PlaneCount");
            // All pages where nothing is said, one where the first is.
            let count = count.unwrap_or(if page.is_some() { 1 } else { own_pages.max(1) });
            let start = (0..3).map(|axis| first[axis] * strides[axis]).sum::<usize>();
            let file = children(element, "UUID").find_map(|uuid| uuid.attribute("FileName")).unwrap_or("");
            let count = count.min(all.saturating_sub(start));
            // Also where the same pages are said again and again.
            said = said.saturating_add(count);
            if said > MOST_PAGES {
                let why = format!("there are more than {MOST_PAGES} pages");
                return Err(attempt.limit("TiffData", why, "split the file into several"));
            }
            for step in 0..count {
                pages.insert(start + step, (file, page.unwrap_or(0).saturating_add(step)));
            }
        }
        if elements.is_empty() {
            pages.extend((0..own_pages.min(all)).map(|page| (page, ("", page))));
        }
        let own = own_name(attempt, root, &elements);
        Ok(Self { places: pages, strides, sizes: counts, own })
    }

    /// The pages for some slices, channels and times, and the files that they lie in beside the one that is opened.
    ///
    /// # Errors
    /// `BadInput` where there is no page for one, `Io` where its file is not there.
    pub(super) fn find(
        &self,
        attempt: Attempt<'_>,
        wanted: &[[usize; 3]],
    ) -> Result<(Vec<Slice>, Vec<PathBuf>), LoadError> {
        let mut beside = Vec::new();
        let mut known: HashMap<&str, usize> = HashMap::new();
        let mut slices = Vec::with_capacity(wanted.len());
        for place in wanted {
            let at = (0..3).map(|axis| place[axis] * self.strides[axis]).sum::<usize>();
            let Some(&(name, page)) = self.places.get(&at) else {
                let [slice, channel, frame] = place;
                let [slices, channels, frames] = self.sizes;
                return Err(attempt.bad_input(
                    "TiffData",
                    format!(
                        "there is no page for slice {slice} of {slices}, channel {channel} of {channels}, time {frame} of \
                         {frames}"
                    ),
                    "the recording may have been stopped: choose another channel or time, or export it anew",
                ));
            };
            let file = match known.get(name) {
                _ if name.is_empty() || Some(name) == self.own => 0,
                Some(&file) => file,
                None => {
                    beside.push(beside_of(attempt, name)?);
                    known.insert(name, beside.len());
                    beside.len()
                }
            };
            slices.push(Slice { file, page });
        }
        Ok((slices, beside))
    }
}

fn axis_of(letter: char) -> usize {
    match letter {
        'Z' => 0,
        'C' => 1,
        _ => 2,
    }
}

/// What the file that is opened is called in the XML: its own name, or the only one there is where it was renamed since,
/// or the one whose mark is that of the file.
fn own_name<'a>(attempt: Attempt<'_>, root: Node<'a, '_>, elements: &[Node<'a, '_>]) -> Option<&'a str> {
    let marks: Vec<(&str, Option<&str>)> = elements
        .iter()
        .flat_map(|&element| children(element, "UUID"))
        .filter_map(|uuid| Some((uuid.attribute("FileName")?, uuid.text())))
        .collect();
    let file = attempt.path.file_name()?.to_string_lossy();
    let by_name = marks.iter().find(|(name, _)| *name == file).map(|(name, _)| *name);
    let mark = root.attribute("UUID").map(str::trim);
    let by_mark = || {
        let is_own = |text: Option<&str>| text.map(str::trim).is_some_and(|text| Some(text) == mark);
        marks.iter().find(|(_, text)| is_own(*text)).map(|(name, _)| *name)
    };
    let only = || {
        let (first, _) = marks.first()?;
        marks.iter().all(|(name, _)| name == first).then_some(*first)
    };
    by_name.or_else(by_mark).or_else(only)
}
