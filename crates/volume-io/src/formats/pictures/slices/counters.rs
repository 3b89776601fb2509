//! Meaning of the numbers in a file name: slices, channels, time steps or positions, by the letters before them.
//!
//! Microscopes write such names, each vendor in an order of its own: `Series001_z00_ch00` (Leica), `s_C001Z001T001`
//! (Olympus), `exp_w1_s2_t3` (`MetaMorph`, `ImageXpress`), `img_channel000_position001_time000000000_z000`
//! (Micro-Manager), `r01c01f01p01-ch1sk1` (Operetta), `A - 01(fld 1 wv DAPI z 1)` (IN Cell), `b0t0z0c0` (Zeiss).

/// Meaning of a number in a file name, the likeliest to count slices first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum NameCounter {
    /// Slice number, with a word for slices before it.
    Slice,
    /// Unspecific number: without a word before it, or with one that only says that it counts.
    Number,
    Time,
    /// Series, position or sample number: any other word is before it.
    Place,
    Channel,
}

/// Words that mark slice numbers.
const SLICES: [&str; 17] = [
    "z", "zs", "zstep", "zplane", "zslice", "zpos", "slice", "sl", "slc", "plane", "pln", "pl", "depth",
    "section", "sec", "layer", "focus",
];

/// Words that only say that something is counted. `s` and `p` can mean slice and plane, or site and position.
const NUMBERS: [&str; 19] = [
    "s", "p", "i", "idx", "index", "im", "img", "image", "n", "no", "nr", "num", "page", "file", "frame",
    "scan", "rec", "recon", "raw",
];

const TIMES: [&str; 8] = ["t", "time", "tp", "tm", "timepoint", "timestep", "timelapse", "sk"];

const CHANNELS: [&str; 17] = [
    "c",
    "ch",
    "chn",
    "chan",
    "channel",
    "w",
    "wv",
    "wl",
    "wave",
    "wavelength",
    "lambda",
    "fluor",
    "dye",
    "color",
    "colour",
    "cam",
    "camera",
];

/// Characters between a word and its number.
const SEPARATORS: [char; 8] = [' ', '_', '-', '.', '=', '#', '(', '['];

/// Meaning of each number of a name, by the text before it.
pub(super) fn name_counters<'a>(texts: impl IntoIterator<Item = &'a str>) -> Vec<NameCounter> {
    let words: Vec<Option<String>> = texts.into_iter().map(counter_word).collect();
    let has = |word: &str| words.iter().flatten().any(|other| other == word);
    let (has_wavelengths, has_channels) = (has("w"), has("ch"));
    let counter = |word: &Option<String>| match word.as_deref() {
        None => NameCounter::Number,
        // Beside wavelengths `s` is a site, beside channels `c` a column of wells.
        Some("s") if has_wavelengths => NameCounter::Place,
        Some("c") if has_channels => NameCounter::Place,
        Some(word) => counter_of_word(word).unwrap_or(NameCounter::Place),
    };
    words.iter().map(counter).collect()
}

/// Number with the word before it, as a name for the user: `ch01`.
pub(super) fn counter_label(text: &str, digits: &str) -> String {
    counter_word(text).unwrap_or_default() + digits
}

fn counter_of_word(word: &str) -> Option<NameCounter> {
    if SLICES.contains(&word) {
        Some(NameCounter::Slice)
    } else if NUMBERS.contains(&word) {
        Some(NameCounter::Number)
    } else if TIMES.contains(&word) {
        Some(NameCounter::Time)
    } else {
        CHANNELS.contains(&word).then_some(NameCounter::Channel)
    }
}

/// Word that marks a number, in lower case: the letters directly before it, or, across a separator, a known word.
fn counter_word(text: &str) -> Option<String> {
    let trimmed = text.trim_end_matches(SEPARATORS);
    let start = trimmed.char_indices().rev().take_while(|(_, c)| c.is_alphabetic()).last();
    let letters = &trimmed[start.map_or(trimmed.len(), |(at, _)| at)..];
    let whole = letters.to_lowercase();
    if counter_of_word(&whole).is_some() {
        return Some(whole);
    }
    // `brainT01`: the capital letters at the end.
    let capitals = letters.trim_start_matches(|c: char| !c.is_uppercase());
    let last = letters.char_indices().rev().take_while(|(_, c)| c.is_uppercase()).last();
    let last = last.map_or("", |(at, _)| &letters[at..]).to_lowercase();
    for tail in [capitals.to_lowercase(), last] {
        if counter_of_word(&tail).is_some() {
            return Some(tail);
        }
    }
    let is_next = trimmed.len() == text.len() && !letters.is_empty();
    // Hardly any word ends in z.
    is_next.then(|| if whole.ends_with('z') { "z".to_owned() } else { whole })
}

/// Index of the number that counts the slices: among those that vary, the last of the likeliest meaning.
pub(super) fn slice_column(varying: &[usize], counters: &[NameCounter]) -> Option<usize> {
    let kind = |column: usize| counters.get(column).copied().unwrap_or(NameCounter::Number);
    let likeliest = varying.iter().map(|&column| kind(column)).min()?;
    varying.iter().copied().rfind(|&column| kind(column) == likeliest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_before_numbers_say_what_they_count() {
        use NameCounter::{Channel, Number, Place, Slice, Time};
        for (text, expected) in [
            ("_z", Slice),
            ("slice_", Slice),
            ("cells z ", Slice),
            ("cellz", Slice),
            ("stackZ", Slice),
            ("_ch", Channel),
            ("channel=", Channel),
            ("(wv ", Channel),
            ("brainT", Time),
            ("TimePoint_", Time),
            ("", Number),
            ("_", Number),
            ("mouse_", Number),
            ("img_", Number),
            ("_s", Number),
            ("mouse", Place),
            ("Series", Place),
            ("XY", Place),
        ] {
            assert_eq!(name_counters([text]), [expected], "{text:?}");
        }
        assert_eq!(name_counters(["exp_w", "_s", "_t"]), [Channel, Place, Time]);
        assert_eq!(name_counters(["r", "c", "f", "p", "-ch"]), [Place, Place, Place, Number, Channel]);
    }

    #[test]
    fn numbers_are_named_with_their_words() {
        for (text, label) in [("exp_ch", "ch01"), ("(wv ", "wv01"), ("brainT", "t01"), ("", "01")] {
            assert_eq!(counter_label(text, "01"), label, "{text:?}");
        }
    }

    #[test]
    fn the_likeliest_number_counts_the_slices() {
        use NameCounter::{Channel, Number, Place, Slice, Time};
        for (kinds, expected) in [
            (&[Slice, Channel][..], 0),
            (&[Channel, Number], 1),
            (&[Number, Channel], 0),
            (&[Number, Number], 1),
            (&[Place, Time], 1),
            (&[Time, Place], 0),
            (&[Time, Slice, Number], 1),
            (&[Channel], 0),
        ] {
            let all: Vec<usize> = (0..kinds.len()).collect();
            assert_eq!(slice_column(&all, kinds), Some(expected), "{kinds:?}");
        }
        assert_eq!(slice_column(&[], &[]), None);
        assert_eq!(
            slice_column(&[0, 2], &[Channel, Slice, Channel]),
            Some(2),
            "what does not vary counts nothing"
        );
    }
}
