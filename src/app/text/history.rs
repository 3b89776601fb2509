//! Texts of the undo history window.

pub(crate) const TITLE: &str = "History";

/// Label of the state before the first change.
pub(crate) const START: &str = "Start";

/// Row of the list: number of a step and its description, with a capital first letter.
pub(crate) fn step(number: usize, what: &str) -> String {
    let mut letters = what.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    format!("{number}  {first}{}", letters.as_str())
}
