//! The list of steps.

pub(crate) const TITLE: &str = "History";

/// Before anything was changed.
pub(crate) const START: &str = "Start";

/// A step, and what it has changed.
pub(crate) fn step(number: usize, what: &str) -> String {
    format!("{number}  {what}")
}
