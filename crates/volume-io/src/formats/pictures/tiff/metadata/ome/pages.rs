//! Assignment of OME-TIFF planes to pages and files: the elements `TiffData`.

use std::collections::HashMap;
use std::path::PathBuf;

use roxmltree::Node;

use super::super::super::file::directory::MAX_PAGES;
use super::super::super::messages::HELP;
use super::super::super::stack::TiffSlice;
use super::{OmeSizes, children, number, resolve_set_file};
use chiaroscuro_volume::{LoadContext, LoadError, quoted};

/// Page of every combination of slice, channel and time that has one.
pub(super) struct OmePages<'a> {
    /// File name and page, by the plane's index in `DimensionOrder`.
    plane_pages: HashMap<usize, (&'a str, usize)>,
    /// Index step per slice, channel and time step.
    strides: [usize; 3],
    sizes: [usize; 3],
    /// Name of the opened file in the XML.
    own_name: Option<&'a str>,
    /// Number of pages of the opened file.
    own_count: usize,
}

/// Pages of a list of slices.
pub(super) struct SlicePages {
    /// Page of each slice; `None` for those without a page.
    pub(super) slices: Vec<Option<TiffSlice>>,
    /// Files that they lie in, apart from the opened one.
    pub(super) other_files: Vec<PathBuf>,
    /// Remark on missing files.
    pub(super) missing_files_remark: Option<String>,
}

impl<'a> OmePages<'a> {
    /// Reads the `TiffData` elements. `own_pages` is the number of pages of the opened file.
    pub(super) fn parse(
        context: LoadContext<'_>,
        root: Node<'a, '_>,
        pixels: Node<'a, '_>,
        sizes: &OmeSizes,
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
                let why = format!("{first:?} is beyond its {counts:?} slices, channels and time steps");
                return Err(context.bad_input_error("TiffData", why, HELP));
            }
            let page = number::<usize>(element, "IFD");
            let count = number::<usize>(element, "PlaneCount");
            // All pages where neither is given, one where only the first is.
            let count = count.unwrap_or(if page.is_some() { 1 } else { own_pages.max(1) });
            let start = (0..3).map(|axis| first[axis] * strides[axis]).sum::<usize>();
            let file = children(element, "UUID").find_map(|uuid| uuid.attribute("FileName")).unwrap_or("");
            let count = count.min(all.saturating_sub(start));
            // Counts repetitions of the same pages, too.
            said = said.saturating_add(count);
            if said > MAX_PAGES {
                let why = format!("there are more than {MAX_PAGES} pages");
                return Err(context.limit_error("TiffData", why, "split the file into several"));
            }
            for step in 0..count {
                pages.insert(start + step, (file, page.unwrap_or(0).saturating_add(step)));
            }
        }
        if elements.is_empty() {
            pages.extend((0..own_pages.min(all)).map(|page| (page, ("", page))));
        }
        let own = own_name(context, root, &elements);
        Ok(Self { plane_pages: pages, strides, sizes: counts, own_name: own, own_count: own_pages })
    }

    /// Finds the pages of some slices, given by slice, channel and time index.
    ///
    /// # Errors
    /// `BadInput` where the name of a file leads out of the folder.
    pub(super) fn find(
        &self,
        context: LoadContext<'_>,
        wanted: &[[usize; 3]],
    ) -> Result<SlicePages, LoadError> {
        let (mut beside, mut lost) = (Vec::new(), Vec::new());
        let mut known: HashMap<&str, Option<usize>> = HashMap::new();
        let mut slices = Vec::with_capacity(wanted.len());
        for place in wanted {
            let at = (0..3).map(|axis| place[axis] * self.strides[axis]).sum::<usize>();
            let Some(&(name, page)) = self.plane_pages.get(&at) else {
                slices.push(None);
                continue;
            };
            let file = match known.get(name) {
                _ if name.is_empty() || Some(name) == self.own_name => (page < self.own_count).then_some(0),
                Some(&file) => file,
                None => {
                    let file = match resolve_set_file(context, name) {
                        Ok(path) => {
                            beside.push(path);
                            Some(beside.len())
                        }
                        Err(LoadError::Io { .. }) => {
                            lost.push(name);
                            None
                        }
                        Err(error) => return Err(error),
                    };
                    known.insert(name, file);
                    file
                }
            };
            slices.push(file.map(|file| TiffSlice { file, page }));
        }
        let lost_files = lost.first().map(|first| match lost.len() - 1 {
            0 => format!("the file {} is missing", quoted(first)),
            more => format!("the file {} is missing, and {more} others", quoted(first)),
        });
        Ok(SlicePages { slices, other_files: beside, missing_files_remark: lost_files })
    }

    /// Number of time steps up to the last that has a page.
    pub(super) fn frames(&self) -> usize {
        self.count(2)
    }

    /// Number of channels up to the last that has a page.
    pub(super) fn channels(&self) -> usize {
        self.count(1)
    }

    fn count(&self, axis: usize) -> usize {
        let places = self.plane_pages.iter().filter(|(_, place)| self.may_exist(place));
        let along = |at: &usize| at / self.strides[axis] % self.sizes[axis];
        places.map(|(at, _)| along(at) + 1).max().unwrap_or(self.sizes[axis])
    }

    /// True if a page exists, judged without opening other files.
    fn may_exist(&self, &(name, page): &(&str, usize)) -> bool {
        let is_own = name.is_empty() || Some(name) == self.own_name;
        !is_own || page < self.own_count
    }

    /// Error for a combination of channel and time without any page.
    pub(super) fn missing_page_error(
        &self,
        context: LoadContext<'_>,
        channel: usize,
        frame: usize,
    ) -> LoadError {
        // As many as fit into a line.
        const MAX_LISTED: usize = 8;
        let mut there: Vec<[usize; 2]> = self
            .plane_pages
            .iter()
            .filter(|(_, place)| self.may_exist(place))
            .map(|(at, _)| [1, 2].map(|axis| at / self.strides[axis] % self.sizes[axis]))
            .collect();
        there.sort_unstable();
        there.dedup();
        let why = format!(
            "there is no page for channel {channel} at time step {frame}; the file has {} pages",
            self.own_count
        );
        let words = there.iter().take(MAX_LISTED).map(|[channel, frame]| format!("{channel} at {frame}"));
        let words = words.collect::<Vec<_>>().join(", ");
        let help = match there.len() {
            0 => "copy the file again, or export it anew".to_owned(),
            1..=MAX_LISTED => format!("choose a channel and a time step with pages: {words}"),
            more => {
                format!(
                    "choose a channel and a time step with pages: {words}, and {} more",
                    more - MAX_LISTED
                )
            }
        };
        context.bad_input_error("TiffData", why, help)
    }
}

fn axis_of(letter: char) -> usize {
    match letter {
        'Z' => 0,
        'C' => 1,
        _ => 2,
    }
}

/// Name of the opened file in the XML: its own name, or that with the UUID of the file, or the only name, since the
/// file may have been renamed.
fn own_name<'a>(context: LoadContext<'_>, root: Node<'a, '_>, elements: &[Node<'a, '_>]) -> Option<&'a str> {
    let marks: Vec<(&str, Option<&str>)> = elements
        .iter()
        .flat_map(|&element| children(element, "UUID"))
        .filter_map(|uuid| Some((uuid.attribute("FileName")?, uuid.text())))
        .collect();
    let file = context.path.file_name()?.to_string_lossy();
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
