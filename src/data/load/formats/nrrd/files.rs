//! Data in several files, which are not read yet.

use super::super::LoadError;
use crate::data::attempt::{Attempt, quoted};

pub(super) const FIELD: &str = "data file";

/// Refuses data in several files.
pub(super) fn check_single(attempt: Attempt<'_>, name: &str) -> Result<(), LoadError> {
    if !is_list(name) {
        return Ok(());
    }
    Err(attempt.bad_input(
        FIELD,
        format!("data in several files ({}) are not supported yet", quoted(name)),
        "join them into one file (for example: unu save -f nrrd -e gzip)",
    ))
}

/// Whether the value stands for several files: `LIST [dims]` or `FORMAT min max step [dims]`.
fn is_list(name: &str) -> bool {
    let words: Vec<_> = name.split_whitespace().collect();
    let numbers = words.iter().skip(1).filter(|word| word.parse::<i64>().is_ok()).count();
    words.first() == Some(&"LIST")
        || (words.len() >= 4 && words[0].contains('%') && numbers + 1 == words.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn several_files_are_seen() {
        assert!(is_list("LIST"));
        assert!(is_list("LIST 2"));
        assert!(is_list("slice%03d.raw 1 10 1"));
        assert!(is_list("slice%03d.raw 10 1 -1 2"));
        assert!(!is_list("LISTING.raw"));
        assert!(!is_list("100% of 3 4.raw"));
        assert!(!is_list("100%.raw"));
    }
}
