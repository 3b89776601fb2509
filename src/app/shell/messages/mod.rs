//! Messages to the user: a notification over the picture, with details on click, and a list of all messages.

mod list;
mod notice;

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use crate::data::{plain, without_controls};

/// Time for which a note stays, in seconds; errors stay until they are dismissed.
const NOTE_S: f64 = 6.0;

/// Time for which the status bar counts an unread message: long enough for a user to return from an interruption.
const COUNTED: Duration = Duration::from_mins(1);

/// Maximum number of messages in the list: enough for a long day.
const MOST: usize = 200;

/// Maximum number of characters of a headline: more than the widest screen shows.
const LONGEST_SHORT: usize = 500;

/// Maximum number of characters of the details: two long paths with an explanation.
const LONGEST_DETAILS: usize = 10_000;

/// Message to the user, an error or a note.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Message {
    short: String,
    details: String,
    is_error: bool,
}

impl Message {
    /// Returns the message in one line: the headline and the first reason.
    fn words(&self) -> String {
        let words = match self.details.lines().next().map(str::trim) {
            // Some errors begin with the headline.
            Some(reason) if reason.to_lowercase().starts_with(&self.short.to_lowercase()) => {
                reason.to_owned()
            }
            Some(reason) if !reason.is_empty() => format!("{}: {reason}", self.short),
            _ => self.short.clone(),
        };
        // Errors of the library begin in lower case.
        let mut letters = words.chars();
        letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
    }
}

/// Current message, errors so far, and the list of all messages.
#[derive(Debug, Default)]
pub(crate) struct Messages {
    current: Option<Message>,
    expanded: bool,
    /// Time at which the note disappears, in seconds of the window's clock; set when it is first shown.
    until_s: Option<f64>,
    /// Errors since the last volume was opened, for test automation.
    errors: Vec<String>,
    /// Latest note since the last volume was opened, even if it has disappeared.
    note: Option<String>,
    /// All messages with their times, the latest last.
    past: VecDeque<(Instant, Message)>,
    /// Time at which the list was last on screen.
    listed: Option<Instant>,
    /// True while the list is open.
    pub lists: bool,
}

impl Messages {
    /// Shows an error with its details, until it is dismissed.
    pub(crate) fn error(&mut self, short: impl Into<String>, details: impl Into<String>) {
        let (short, details) = (short.into(), details.into());
        log::error!("{short}: {details}");
        self.errors.push(plain(&short, LONGEST_SHORT));
        self.show(Message { short, details, is_error: true });
    }

    /// Shows a note that disappears automatically.
    pub(crate) fn note(&mut self, short: impl Into<String>) {
        let short = short.into();
        self.note = Some(plain(&short, LONGEST_SHORT));
        self.show(Message { short, details: String::new(), is_error: false });
    }

    /// Records an undo or redo, which the status bar shows; removes a note from the picture.
    pub(crate) fn step(&mut self, words: &str) {
        self.note = Some(plain(words, LONGEST_SHORT));
        if self.current.as_ref().is_some_and(|message| !message.is_error) {
            self.current = None;
        }
    }

    fn show(&mut self, Message { short, details, is_error }: Message) {
        // Names and errors come from files, and a label takes as long to lay out as it is.
        let short = plain(&short, LONGEST_SHORT);
        let details = without_controls(&details).chars().take(LONGEST_DETAILS).collect();
        self.expanded = false;
        self.until_s = None;
        let message = Message { short, details, is_error };
        if self.past.len() == MOST {
            self.past.pop_front();
        }
        self.past.push_back((Instant::now(), message.clone()));
        self.current = Some(message);
    }

    /// Clears the current message, the errors and the latest note when a new volume is open; the list stays.
    pub(crate) fn clear(&mut self) {
        let (past, listed, lists) = (std::mem::take(&mut self.past), self.listed, self.lists);
        *self = Self { past, listed, lists, ..Self::default() };
    }

    /// Hides the current message; errors stay recorded.
    pub(crate) fn dismiss(&mut self) {
        self.current = None;
    }

    /// Errors since the last volume was opened.
    pub(crate) fn errors(&self) -> &[String] {
        &self.errors
    }

    /// Latest note, even if it has disappeared.
    pub(crate) fn latest_note(&self) -> Option<&str> {
        self.note.as_deref()
    }

    /// Returns true while a note is shown, which disappears automatically.
    pub(crate) fn shows_note(&self) -> bool {
        self.current.as_ref().is_some_and(|message| !message.is_error)
    }

    /// Number of recent messages that were not seen in the list, and the time until the newest of them is no longer
    /// counted.
    pub(crate) fn unread(&self) -> (usize, Duration) {
        let is_new =
            |when: &Instant| when.elapsed() < COUNTED && self.listed.is_none_or(|listed| *when > listed);
        let new: Vec<_> = self.past.iter().map(|(when, _)| when).filter(|when| is_new(when)).collect();
        let left = new.last().map_or(Duration::ZERO, |when| COUNTED.saturating_sub(when.elapsed()));
        (new.len(), left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_are_counted_until_they_are_looked_up_or_old() {
        let mut messages = Messages::default();
        assert_eq!(messages.unread().0, 0);
        messages.note("one");
        messages.error("two", "why");
        messages.step("Undone: turn camera");
        assert_eq!(messages.latest_note(), Some("Undone: turn camera"));
        assert_eq!(messages.unread().0, 2, "a step is no message");
        assert!(messages.current.as_ref().is_some_and(|message| message.is_error), "what went wrong stays");
        messages.listed = Some(Instant::now());
        assert_eq!(messages.unread().0, 0);
        messages.note("three");
        let (count, left) = messages.unread();
        assert!(count == 1 && left <= COUNTED && left > COUNTED / 2, "{count} {left:?}");
        if let Some(long_ago) = Instant::now().checked_sub(2 * COUNTED) {
            (messages.listed, messages.past[2].0) = (None, long_ago);
            assert_eq!(messages.unread().0, 2);
            messages.past.iter_mut().for_each(|(when, _)| *when = long_ago);
            assert_eq!(messages.unread(), (0, Duration::ZERO));
        }
    }

    #[test]
    fn foreign_words_are_harmless_and_short() {
        let mut messages = Messages::default();
        messages.error("a\u{1b}[2J\nb".to_owned() + &"x".repeat(1 << 20), "c\u{202e}\n".repeat(1 << 20));
        let Message { short, details, .. } = messages.current.clone().unwrap();
        assert!(short.starts_with("a·[2J·bxx") && details.starts_with("c·\nc·\n"), "{short} {details}");
        let length = |text: &str| text.chars().count();
        // One more character marks the cut.
        assert_eq!((length(&short), length(&details)), (LONGEST_SHORT + 1, LONGEST_DETAILS));
        assert_eq!(messages.errors(), [short]);
        let said = |details: &str| {
            let details = details.to_owned();
            Message { short: "not exported".to_owned(), details, is_error: true }.words()
        };
        assert_eq!(said(""), "Not exported");
        assert_eq!(said("/a/b.png: no such folder\nmore"), "Not exported: /a/b.png: no such folder");
        assert_eq!(
            said("not exported: there is no room"),
            "Not exported: there is no room",
            "once is enough"
        );
    }
}
