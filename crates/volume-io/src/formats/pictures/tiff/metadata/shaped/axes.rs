//! Meaning of those axes of an array that precede the axes of a page: slices, channels, time steps, or series.

use super::super::super::file::directory::MAX_PAGES;
use super::super::super::file::page::TiffPage;

/// Axis of an array, with its size and letter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct ArrayAxis {
    size: u64,
    /// Letter of tifffile's `axes` (<https://www.cgohlke.com>, `TIFF.AXES_CODES`).
    letter: char,
}

/// Axis of pages: its size, and the number of pages per step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct PageStride {
    pub(super) size: usize,
    pub(super) pages: usize,
}

/// Axes of pages by their meaning.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct PageAxes {
    pub(super) slices: Option<PageStride>,
    pub(super) channels: Option<PageStride>,
    pub(super) frames: Option<PageStride>,
    /// All other axes, slowest first.
    pub(super) series: Vec<PageStride>,
    /// True if there are several axes, and their meaning is only assumed.
    pub(super) is_assumed: bool,
    /// Number of pages of the whole array.
    pub(super) pages: usize,
}

impl PageAxes {
    /// Interprets the shape of an array whose last axes are those of a page. `None` where the page does not match
    /// them, or where the array would have more pages than any file.
    pub(super) fn new(shape: &[u64], letters: &str, page: &TiffPage) -> Option<Self> {
        let letters: Vec<char> = letters.chars().map(|letter| letter.to_ascii_uppercase()).collect();
        let is_named = letters.len() == shape.len();
        let letter = |at: usize| if is_named { letters[at] } else { '?' };
        let samples = page.samples as u64;
        let of_page = if page.is_planar {
            [(samples, 'S'), (page.height, 'Y'), (page.width, 'X')]
        } else {
            [(page.height, 'Y'), (page.width, 'X'), (samples, 'S')]
        };
        // Axes of length 1 may be present or not.
        let all: Vec<ArrayAxis> = (0..shape.len())
            .map(|at| ArrayAxis { size: shape[at], letter: letter(at) })
            .filter(|axis| axis.size != 1)
            .collect();
        let of_page: Vec<(u64, char)> = of_page.into_iter().filter(|&(size, _)| size != 1).collect();
        let outer = all.len().checked_sub(of_page.len())?;
        let (outer, inner) = all.split_at(outer);
        let is_same = inner.iter().zip(&of_page).all(|(axis, &(size, letter))| {
            // Channels may be the samples of a page.
            let is_meant =
                axis.letter == letter || axis.letter == '?' || (axis.letter == 'C' && letter == 'S');
            axis.size == size && is_meant
        });
        if is_same { Self::from_outer_axes(outer) } else { None }
    }

    /// Interprets the axes of pages, slowest first.
    fn from_outer_axes(outer: &[ArrayAxis]) -> Option<Self> {
        let mut axes = Self { pages: 1, ..Self::default() };
        let mut strides = Vec::new();
        for axis in outer.iter().rev() {
            let size = usize::try_from(axis.size).ok().filter(|&size| size > 0)?;
            strides.push(PageStride { size, pages: axes.pages });
            axes.pages = axes.pages.checked_mul(size).filter(|&pages| pages <= MAX_PAGES)?;
        }
        strides.reverse();
        let mut letters: Vec<char> = outer.iter().map(|axis| axis.letter).collect();
        if letters.iter().all(|&letter| letter == '?') {
            axes.is_assumed = letters.len() > 1;
            // The usual order of NumPy arrays: time, channel, z.
            for (letter, assumed) in
                letters.iter_mut().rev().zip(['Z', if outer.len() > 2 { 'C' } else { 'T' }, 'T'])
            {
                *letter = assumed;
            }
        }
        let slices = slice_axis(&letters);
        for (at, (&letter, &stride)) in letters.iter().zip(&strides).enumerate() {
            let place = match letter {
                _ if Some(at) == slices => &mut axes.slices,
                'C' => &mut axes.channels,
                'T' => &mut axes.frames,
                // Wavelengths of excitation and emission, lifetimes, exposures.
                'E' | 'W' | 'H' | 'L' if !letters.contains(&'C') => &mut axes.channels,
                _ => {
                    axes.series.push(stride);
                    continue;
                }
            };
            if place.is_none() { *place = Some(stride) } else { axes.series.push(stride) }
        }
        Some(axes)
    }

    /// Number of series: product of the remaining axes.
    pub(super) fn series_count(&self) -> usize {
        self.series.iter().map(|stride| stride.size).product()
    }

    /// Index of the first page of a series.
    pub(super) fn series_page(&self, series: usize) -> usize {
        let mut rest = series;
        let mut page = 0;
        for stride in self.series.iter().rev() {
            page += rest % stride.size * stride.pages;
            rest /= stride.size;
        }
        page
    }
}

/// Index of the axis along which slices lie: depth, or else the fastest axis that is not explicitly another one;
/// never channels or times.
fn slice_axis(letters: &[char]) -> Option<usize> {
    let is_other = |letter: char| matches!(letter, 'C' | 'T' | 'E' | 'W' | 'H' | 'L' | 'S');
    let last = |is: &dyn Fn(char) -> bool| letters.iter().rposition(|&letter| is(letter));
    last(&|letter| letter == 'Z')
        .or_else(|| last(&|letter| matches!(letter, 'Q' | 'I' | 'D' | '?')))
        .or_else(|| last(&|letter| !is_other(letter)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axes_of(letters: &str) -> String {
        let outer: Vec<ArrayAxis> = letters
            .chars()
            .enumerate()
            .map(|(at, letter)| ArrayAxis { size: at as u64 + 2, letter })
            .collect();
        let axes = PageAxes::from_outer_axes(&outer).unwrap();
        let size = |stride: Option<PageStride>| stride.map_or(0, |stride| stride.size);
        let series: Vec<usize> = axes.series.iter().map(|stride| stride.size).collect();
        format!("z{} c{} t{} s{series:?}", size(axes.slices), size(axes.channels), size(axes.frames))
    }

    #[test]
    fn letters_say_what_axes_stand_for() {
        for (letters, expected) in [
            ("", "z0 c0 t0 s[]"),
            ("Z", "z2 c0 t0 s[]"),
            ("?", "z2 c0 t0 s[]"),
            ("??", "z3 c0 t2 s[]"),
            ("???", "z4 c3 t2 s[]"),
            ("????", "z5 c4 t3 s[2]"),
            ("CZ", "z3 c2 t0 s[]"),
            ("ZC", "z2 c3 t0 s[]"),
            ("TCZ", "z4 c3 t2 s[]"),
            ("TZC", "z3 c4 t2 s[]"),
            ("T", "z0 c0 t2 s[]"),
            ("TC", "z0 c3 t2 s[]"),
            ("A", "z2 c0 t0 s[]"),
            ("RZ", "z3 c0 t0 s[2]"),
            ("TQ", "z3 c0 t2 s[]"),
            ("QQ", "z3 c0 t0 s[2]"),
            ("EZ", "z3 c2 t0 s[]"),
            ("ECZ", "z4 c3 t0 s[2]"),
        ] {
            assert_eq!(axes_of(letters), expected, "{letters}");
        }
    }

    #[test]
    fn pages_of_series_are_counted_along_their_axes() {
        let stride = |size, pages| PageStride { size, pages };
        let axes = PageAxes { series: vec![stride(2, 100), stride(3, 5)], ..PageAxes::default() };
        assert_eq!(axes.series_count(), 6);
        assert_eq!((0..6).map(|at| axes.series_page(at)).collect::<Vec<_>>(), [0, 5, 10, 100, 105, 110]);
    }
}
