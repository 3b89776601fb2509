//! List of all steps of the undo history, with the change that each made.

use super::{History, HistoryStep};
use crate::app::text;

/// Descriptions of all steps, the oldest first, and the number of steps that are done, 0 at the start.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct HistorySteps {
    /// Description of each step.
    pub names: Vec<String>,
    /// Number of steps that are done.
    pub current: usize,
}

impl History {
    /// Lists all undo and redo steps around `now`.
    pub(crate) fn list_steps(&self, now: &HistoryStep) -> HistorySteps {
        let names = |is_back: bool| {
            // A step is known only by taking it, here on a copy.
            let mut history = Self { undoer: self.undoer.clone(), last_step: None };
            let (mut at, mut names) = (now.clone(), Vec::new());
            while if is_back { history.can_undo(&at) } else { history.can_redo(&at) } {
                let before = at.clone();
                let changed = if is_back {
                    history.undo(&mut at);
                    text::change_descriptions::describe_change(&at.settings, &before.settings)
                } else {
                    history.redo(&mut at);
                    text::change_descriptions::describe_change(&before.settings, &at.settings)
                };
                names.push(changed.unwrap_or_else(|| text::change_descriptions::KIND_OF_DATA.to_owned()));
            }
            names
        };
        let mut all = names(true);
        all.reverse();
        let taken = all.len();
        all.extend(names(false));
        HistorySteps { names: all, current: taken }
    }
}
