//! Data files of an NRRD volume: one file, a list, or a numbered pattern.
//!
//! `data file: NAME`, `data file: LIST [dims]` with names in the lines after it, and
//! `data file: FORMAT min max step [dims]` with a format of C like `slice%03d.raw`.

use super::super::LoadError;
use super::header::NrrdHeader;
use chiaroscuro_volume::{LoadContext, quoted};

pub(super) const FIELD: &str = "data file";

/// Maximum number of files of one volume: eight times the slices of the longest scans.
const MAX_FILES: u64 = 1 << 16;

/// Maximum width to which numbers in names are padded.
const MAX_DIGITS: usize = 32;

/// Returns the names of the data files, each with an equal share of the data; `None` if the data follow the header.
pub(super) fn data_file_names(
    context: LoadContext<'_>,
    header: &NrrdHeader,
    sizes: &[u64],
) -> Result<Option<Vec<String>>, LoadError> {
    let Some(field) = header.get(FIELD) else { return Ok(None) };
    let words: Vec<_> = field.split_whitespace().collect();
    let (names, dimension) = if words.first() == Some(&"LIST") {
        (header.files.clone(), words.get(1).copied())
    } else if let Some(numbers) = pattern_numbers(&words) {
        (expand_pattern(context, words[0], numbers)?, words.get(4).copied())
    } else {
        return Ok(Some(vec![field.to_owned()]));
    };
    check_count(context, names.len() as u64, dimension, sizes)?;
    Ok(Some(names))
}

/// Parses minimum, maximum and step of `FORMAT min max step [dims]`.
fn pattern_numbers(words: &[&str]) -> Option<[i64; 3]> {
    let numbers: Option<Vec<i64>> = words.iter().skip(1).map(|word| word.parse().ok()).collect();
    match (words.first()?.contains('%'), numbers?.as_slice()) {
        (true, &[min, max, step] | &[min, max, step, _]) => Some([min, max, step]),
        _ => None,
    }
}

fn expand_pattern(
    context: LoadContext<'_>,
    format: &str,
    [min, max, step]: [i64; 3],
) -> Result<Vec<String>, LoadError> {
    let wrong = |why: String| context.bad_input_error(FIELD, why, "write it like: slice%03d.raw 1 20 1");
    let steps = i128::from(max).checked_sub(i128::from(min)).unwrap_or_default();
    if step == 0 || (steps != 0 && (steps > 0) != (step > 0)) {
        return Err(wrong(format!("no steps of {step} lead from {min} to {max}")));
    }
    let count = (steps / i128::from(step)).unsigned_abs() + 1;
    if count > u128::from(MAX_FILES) {
        return Err(context.limit_error(
            FIELD,
            format!("{count} files are more than the {MAX_FILES} that are supported"),
            "join them into one file (for example: unu save -f nrrd -e gzip)",
        ));
    }
    let (before, width, is_filled, behind) = split_format(format)
        .ok_or_else(|| wrong(format!("{} is not a name with one number like %03d", quoted(format))))?;
    let name = |at: i128| {
        let number = i128::from(min) + at * i128::from(step);
        let number = if is_filled { format!("{number:0width$}") } else { format!("{number:width$}") };
        format!("{before}{number}{behind}")
    };
    Ok((0..count as i128).map(name).collect())
}

/// Splits a C format with one integer: text before it, width, true for zero padding, text behind it.
fn split_format(format: &str) -> Option<(String, usize, bool, String)> {
    const PERCENT_PLACEHOLDER: &str = "\0";
    let escaped = format.replace("%%", PERCENT_PLACEHOLDER);
    let (before, rest) = escaped.split_once('%')?;
    let end = rest.find(|c: char| !c.is_ascii_digit())?;
    let (digits, rest) = rest.split_at(end);
    let behind = rest.strip_prefix(['d', 'i', 'u'])?;
    let width: usize = if digits.is_empty() { 0 } else { digits.parse().ok()? };
    let is_whole = !behind.contains('%') && width <= MAX_DIGITS;
    let text = |text: &str| text.replace(PERCENT_PLACEHOLDER, "%");
    is_whole.then(|| (text(before), width, digits.starts_with('0'), text(behind)))
}

/// Checks that the number of files matches the dimension that each file holds.
fn check_count(
    context: LoadContext<'_>,
    count: u64,
    dimension: Option<&str>,
    sizes: &[u64],
) -> Result<(), LoadError> {
    let wrong = |why: String| context.bad_input_error(FIELD, why, "check the list of files against sizes");
    if count == 0 || count > MAX_FILES {
        return Err(wrong(format!("1 to {MAX_FILES} files were expected, {count} are named")));
    }
    // By default each file is a slice along the slowest axis.
    let dimension = match dimension {
        None => sizes.len().saturating_sub(1),
        Some(text) => {
            text.parse().ok().filter(|dimension| (1..=sizes.len()).contains(dimension)).ok_or_else(|| {
                wrong(format!(
                    "a dimension from 1 to {} was expected, {} was found",
                    sizes.len(),
                    quoted(text)
                ))
            })?
        }
    };
    let expected = sizes[dimension..].iter().fold(1u64, |product, &size| product.saturating_mul(size));
    // Files of the full dimension are equal slabs along the slowest axis.
    let is_right = if dimension == sizes.len() {
        sizes.last().is_some_and(|&size| size % count == 0)
    } else {
        count == expected
    };
    if is_right {
        return Ok(());
    }
    Err(wrong(format!("{count} files do not make up the array: {expected} were expected")))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn names_are_counted_up_and_down() {
        let context = LoadContext { operation: "test", path: Path::new("t") };
        let names = |format: &str, numbers| expand_pattern(context, format, numbers).unwrap().join(" ");
        assert_eq!(names("s%03d.raw", [8, 10, 1]), "s008.raw s009.raw s010.raw");
        assert_eq!(names("%d", [3, -1, -2]), "3 1 -1");
        assert_eq!(names("100%%_%i.raw", [5, 5, 1]), "100%_5.raw");
        assert_eq!(names("a%02u", [1, 4, 2]), "a01 a03");
        for (format, numbers) in [
            ("%d", [1, 2, 0]),
            ("%d", [1, 2, -1]),
            ("%d", [0, i64::MAX, 1]),
            ("%d", [i64::MIN, i64::MAX, 1]),
            ("%s", [1, 2, 1]),
            ("%d%d", [1, 2, 1]),
            ("%", [1, 2, 1]),
            ("%99999999999999999999d", [1, 2, 1]),
            ("%999d", [1, 2, 1]),
        ] {
            assert!(expand_pattern(context, format, numbers).is_err(), "{format} {numbers:?}");
        }
    }

    #[test]
    fn patterns_are_told_from_names() {
        let numbers = |text: &str| pattern_numbers(&text.split_whitespace().collect::<Vec<_>>());
        assert_eq!(numbers("slice%03d.raw 1 10 1"), Some([1, 10, 1]));
        assert_eq!(numbers("slice%03d.raw 10 1 -1 2"), Some([10, 1, -1]));
        for name in ["LISTING.raw", "100% of 3 4.raw", "100%.raw", "a 1 2 3", "a%d 1 2"] {
            assert_eq!(numbers(name), None, "{name}");
        }
    }
}
