//! Elision of long names in the middle, so that beginnings and file extensions still tell files apart.
//!
//! Widths are in points.

use eframe::egui::{Color32, FontId, TextStyle, Ui};

/// Character in place of the omitted ones.
const ELLIPSIS: char = '…';

/// Returns the width of a text in one line, in points.
pub(crate) fn text_width(ui: &Ui, words: &str, style: &TextStyle) -> f32 {
    width_of(ui, words, style.resolve(ui.style()))
}

fn width_of(ui: &Ui, words: &str, font: FontId) -> f32 {
    ui.painter().layout_no_wrap(words.to_owned(), font, Color32::PLACEHOLDER).size().x
}

/// Shortens a name to a width, by omitting as few characters of its middle as possible.
pub(crate) fn elide_middle(ui: &Ui, name: &str, style: &TextStyle, width: f32) -> String {
    let font = style.resolve(ui.style());
    elide_to_fit(name, |words| width_of(ui, words, font.clone()) <= width)
}

/// Finds the longest form that fits: the whole name, or the name without a part of its middle.
fn elide_to_fit(name: &str, fits: impl Fn(&str) -> bool) -> String {
    if fits(name) {
        return name.to_owned();
    }
    let letters: Vec<char> = name.chars().collect();
    let without_middle = |count: usize| {
        let head = &letters[..count.div_ceil(2)];
        let tail = &letters[letters.len() - count / 2..];
        head.iter().chain([&ELLIPSIS]).chain(tail).collect::<String>()
    };
    // Binary search for the number of characters that remain.
    let (mut least, mut most) = (0, letters.len().saturating_sub(1));
    while least < most {
        let middle = (least + most).div_ceil(2);
        if fits(&without_middle(middle)) {
            least = middle;
        } else {
            most = middle - 1;
        }
    }
    without_middle(least)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_keep_their_beginnings_and_endings() {
        let elided = |name: &str, most: usize| elide_to_fit(name, |words| words.chars().count() <= most);
        assert_eq!(elided("tooth.nrrd", 10), "tooth.nrrd");
        assert_eq!(elided("subject_042_run_3_T1w.nii.gz", 15), "subject….nii.gz");
        assert_eq!(elided("subject_042_run_3_T1w.nii.gz", 14), "subject…nii.gz");
        assert_eq!(elided("Größenänderung", 6), "Grö…ng");
        assert_eq!(elided("abcdef", 1), "…");
        assert_eq!(elided("abcdef", 0), "…", "there is always something to see");
        assert_eq!(elided("", 0), "");
    }
}
