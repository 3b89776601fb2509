//! The list of steps.

pub(crate) const TITLE: &str = "History";

/// Before anything was changed.
pub(crate) const START: &str = "Start";

/// A step, and what it has done.
pub(crate) fn step(number: usize, what: &str) -> String {
    let mut letters = what.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    format!("{number}  {first}{}", letters.as_str())
}
