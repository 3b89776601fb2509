//! Data files of a `MetaImage`: the header's own file, one named file, a list, or a numbered pattern.

use super::super::LoadError;
use super::header::{DATA_FILE, MetaImageHeader};
use super::layout::MetaImageGrid;
use chiaroscuro_volume::{LoadContext, quoted};

/// Maximum number of files of a volume: eight times the slices of the longest scans.
const MAX_FILES: u64 = 1 << 16;

/// Maximum width of a number in a file name; a pattern that asks for more is treated as a plain name.
const MAX_DIGITS: usize = 20;

/// Data files in the order of their voxels; each holds an equal share.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum DataFiles {
    /// Data behind the header, in the same file.
    Attached,
    /// Data files beside the header, by name.
    Detached(Vec<String>),
}

impl DataFiles {
    pub(super) fn parse(
        context: LoadContext<'_>,
        header: &MetaImageHeader,
        grid: &MetaImageGrid,
    ) -> Result<Self, LoadError> {
        let text = header.get(DATA_FILE).unwrap_or_default();
        let words: Vec<&str> = text.split_whitespace().take(8).collect();
        match words[..] {
            ["LOCAL" | "Local" | "local"] => Ok(Self::Attached),
            ["LIST", ref arguments @ ..] => {
                let needed = list_file_count(context, arguments.first().copied(), grid)?;
                if (header.list.len() as u64) < needed {
                    return Err(context.bad_input_error(
                        DATA_FILE,
                        format!(
                            "{needed} names of files were expected after it, {} were found",
                            header.list.len()
                        ),
                        "write a name for each slice, one per line",
                    ));
                }
                Ok(Self::Detached(header.list.iter().take(needed as usize).cloned().collect()))
            }
            [pattern, ref said @ ..]
                if pattern.contains('%') && (!said.is_empty() || find_number(pattern).is_some()) =>
            {
                let numbers: Option<Vec<i64>> = said.iter().map(|word| word.parse().ok()).collect();
                match (numbers, find_number(pattern)) {
                    (Some(numbers), Some(_)) => expand_pattern(context, pattern, &numbers, grid),
                    // A name that contains spaces and a percent sign.
                    _ => Ok(Self::Detached(vec![text.to_owned()])),
                }
            }
            _ => Ok(Self::Detached(vec![text.to_owned()])),
        }
    }
}

/// Returns the number of files if each holds the first dimensions: as many as the list states, or all but the last.
fn list_file_count(
    context: LoadContext<'_>,
    said: Option<&str>,
    grid: &MetaImageGrid,
) -> Result<u64, LoadError> {
    let count = grid.sizes.len();
    let dimensions = said.map(|word| word.trim_end_matches(['D', 'd']).parse::<usize>());
    let dimensions = match dimensions {
        None => count - 1,
        Some(Ok(dimensions)) if (1..=count).contains(&dimensions) => dimensions,
        Some(_) => {
            return Err(context.bad_input_error(
                DATA_FILE,
                format!("a list of files of 1 to {count} dimensions was expected"),
                "write LIST, and a file for each slice",
            ));
        }
    };
    let files = grid.sizes.iter().skip(dimensions).fold(1u64, |product, &n| product.saturating_mul(n));
    if files <= MAX_FILES { Ok(files) } else { Err(too_many_files(context, files)) }
}

fn too_many_files(context: LoadContext<'_>, files: u64) -> LoadError {
    context.limit_error(
        DATA_FILE,
        format!("{files} files are too many: at most {MAX_FILES} are supported"),
        "join them into one file",
    )
}

/// Expands a pattern with first number, last number and step, each of which may be missing.
fn expand_pattern(
    context: LoadContext<'_>,
    pattern: &str,
    numbers: &[i64],
    grid: &MetaImageGrid,
) -> Result<DataFiles, LoadError> {
    let needed = grid.sizes.last().copied().unwrap_or(1);
    if needed > MAX_FILES {
        return Err(too_many_files(context, needed));
    }
    let number = |at: usize, default: i64| numbers.get(at).copied().unwrap_or(default);
    let first = number(0, 1);
    let last = number(1, first.saturating_add(needed as i64 - 1));
    let step = number(2, 1);
    let names: Option<Vec<String>> = (0..needed as i64)
        .map(|index| {
            let at = step.checked_mul(index)?.checked_add(first)?;
            let is_within = if step < 0 { at >= last } else { at <= last };
            is_within.then(|| format_name(pattern, at)).flatten()
        })
        .collect();
    names.map(DataFiles::Detached).ok_or_else(|| {
        context.bad_input_error(
            DATA_FILE,
            format!(
                "{needed} files were expected, {} from {first} to {last} by {step} gives fewer",
                quoted(pattern)
            ),
            "correct the numbers after the pattern",
        )
    })
}

/// Finds the number in a pattern with exactly one `%d`: its byte range, its width, and true if it is padded with
/// zeros.
fn find_number(pattern: &str) -> Option<(std::ops::Range<usize>, usize, bool)> {
    let start = pattern.find('%')?;
    let rest = pattern.get(start + 1..)?;
    let digits = rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    let width = rest.get(..digits)?;
    let is_number = rest.get(digits..)?.starts_with(['d', 'i', 'u']);
    let after = rest.get(digits + 1..)?;
    let length = if width.is_empty() { 0 } else { width.parse().ok()? };
    let is_alone = !after.contains('%');
    (is_number && is_alone && length <= MAX_DIGITS)
        .then(|| (start..start + digits + 2, length, width.starts_with('0')))
}

/// Formats the name of the file with a given number.
fn format_name(pattern: &str, number: i64) -> Option<String> {
    let (place, width, has_zeros) = find_number(pattern)?;
    let (before, after) = (pattern.get(..place.start)?, pattern.get(place.end..)?);
    Some(if has_zeros {
        format!("{before}{number:0width$}{after}")
    } else {
        format!("{before}{number:width$}{after}")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_are_filled_in() {
        for (pattern, number, name) in [
            ("a%03d.raw", 7, Some("a007.raw")),
            ("a%03d.raw", 1234, Some("a1234.raw")),
            ("%d", -3, Some("-3")),
            ("a%3i.raw", 7, Some("a  7.raw")),
            ("a%u", 7, Some("a7")),
            ("a%x", 7, None),
            ("a%s", 7, None),
            ("a%d%d", 7, None),
            ("a%999999999d", 7, None),
            ("a%99999999999999999999999d", 7, None),
            ("a%", 7, None),
            ("a%0", 7, None),
            ("a%é", 7, None),
        ] {
            assert_eq!(format_name(pattern, number).as_deref(), name, "{pattern}");
        }
    }
}
