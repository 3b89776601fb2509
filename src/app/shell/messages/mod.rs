//! Messages to the user: a notification over the picture, with details on click, and a list of all messages.

mod list;
mod notification;

use std::collections::VecDeque;
use std::fmt::Display;
use std::time::{Duration, Instant};

use chiaroscuro_files::{sanitised, without_controls};

/// Time for which a note stays, in seconds; errors stay until they are dismissed.
const NOTE_S: f64 = 6.0;

/// Time for which the status bar counts an unread message: long enough for a user to return from an interruption.
const UNREAD_TIME: Duration = Duration::from_mins(1);

/// Maximum number of messages in the list: enough for a long day.
const MAX_MESSAGES: usize = 200;

/// Maximum number of characters of a headline: more than the widest screen shows.
const MAX_HEADLINE_CHARS: usize = 500;

/// Maximum number of characters of the details: two long paths with an explanation.
const MAX_DETAILS_CHARS: usize = 10_000;

/// Message to the user, an error or a note.
#[derive(Debug, Clone, PartialEq, Eq)]
struct UserMessage {
    headline: String,
    details: String,
    is_error: bool,
}

impl UserMessage {
    /// Returns the message in one line: the headline and the first reason.
    fn one_line(&self) -> String {
        let words = match self.details.lines().next().map(str::trim) {
            // Some errors begin with the headline.
            Some(reason) if reason.to_lowercase().starts_with(&self.headline.to_lowercase()) => {
                reason.to_owned()
            }
            Some(reason) if !reason.is_empty() => format!("{}: {reason}", self.headline),
            _ => self.headline.clone(),
        };
        // Errors of the library begin in lower case.
        let mut letters = words.chars();
        letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
    }
}

/// Current message, errors so far, and the list of all messages.
#[derive(Debug, Default)]
pub(crate) struct MessageLog {
    current: Option<UserMessage>,
    expanded: bool,
    /// Time at which the note disappears, in seconds of the window's clock; set when it is first shown.
    until_s: Option<f64>,
    /// Errors since the last volume was opened, for test automation.
    errors: Vec<String>,
    /// Latest note since the last volume was opened, even if it has disappeared.
    note: Option<String>,
    /// All messages with their times, the latest last.
    history: VecDeque<(Instant, UserMessage)>,
    /// Time at which the list was last on screen.
    list_seen: Option<Instant>,
    /// True while the list is open.
    pub list_open: bool,
}

impl MessageLog {
    /// Shows an error with its details, until it is dismissed.
    pub(crate) fn error(&mut self, short: impl Into<String>, details: impl Into<String>) {
        let (short, details) = (short.into(), details.into());
        log::error!("{short}: {details}");
        self.errors.push(sanitised(&short, MAX_HEADLINE_CHARS));
        self.show(UserMessage { headline: short, details, is_error: true });
    }

    /// Returns the value of a result. Shows an error if there is one, and returns the type's default value then.
    pub(crate) fn report<T: Default>(&mut self, short: &str, result: Result<T, impl Display>) -> T {
        result.unwrap_or_else(|err| {
            self.error(short, err.to_string());
            T::default()
        })
    }

    /// Shows a note that disappears automatically.
    pub(crate) fn note(&mut self, short: impl Into<String>) {
        let short = short.into();
        self.note = Some(sanitised(&short, MAX_HEADLINE_CHARS));
        self.show(UserMessage { headline: short, details: String::new(), is_error: false });
    }

    /// Records an undo or redo, which the status bar shows; removes a note from the picture.
    pub(crate) fn note_step(&mut self, words: &str) {
        self.note = Some(sanitised(words, MAX_HEADLINE_CHARS));
        if self.current.as_ref().is_some_and(|message| !message.is_error) {
            self.current = None;
        }
    }

    fn show(&mut self, UserMessage { headline: short, details, is_error }: UserMessage) {
        // Names and errors come from files, and a label takes as long to lay out as it is.
        let short = sanitised(&short, MAX_HEADLINE_CHARS);
        let details = without_controls(&details).chars().take(MAX_DETAILS_CHARS).collect();
        self.expanded = false;
        self.until_s = None;
        let message = UserMessage { headline: short, details, is_error };
        if self.history.len() == MAX_MESSAGES {
            self.history.pop_front();
        }
        self.history.push_back((Instant::now(), message.clone()));
        self.current = Some(message);
    }

    /// Clears the current message, the errors and the latest note when a new volume is open; the list stays.
    pub(crate) fn clear(&mut self) {
        let (past, listed, lists) = (std::mem::take(&mut self.history), self.list_seen, self.list_open);
        *self = Self { history: past, list_seen: listed, list_open: lists, ..Self::default() };
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
    #[cfg(any(test, feature = "testing"))]
    pub(crate) fn latest_note(&self) -> Option<&str> {
        self.note.as_deref()
    }

    /// Returns true while a note is shown, which disappears automatically.
    #[cfg(feature = "testing")]
    pub(crate) fn shows_note(&self) -> bool {
        self.current.as_ref().is_some_and(|message| !message.is_error)
    }

    /// Number of recent messages that were not seen in the list, and the time until the newest of them is no longer
    /// counted.
    pub(crate) fn unread(&self) -> (usize, Duration) {
        let is_new = |when: &Instant| {
            when.elapsed() < UNREAD_TIME && self.list_seen.is_none_or(|listed| *when > listed)
        };
        let new: Vec<_> = self.history.iter().map(|(when, _)| when).filter(|when| is_new(when)).collect();
        let left = new.last().map_or(Duration::ZERO, |when| UNREAD_TIME.saturating_sub(when.elapsed()));
        (new.len(), left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_are_counted_until_they_are_looked_up_or_old() {
        let mut messages = MessageLog::default();
        assert_eq!(messages.unread().0, 0);
        messages.note("one");
        messages.error("two", "why");
        messages.note_step("Undone: turn camera");
        assert_eq!(messages.latest_note(), Some("Undone: turn camera"));
        assert_eq!(messages.unread().0, 2, "a step is no message");
        assert!(messages.current.as_ref().is_some_and(|message| message.is_error), "what went wrong stays");
        messages.list_seen = Some(Instant::now());
        assert_eq!(messages.unread().0, 0);
        messages.note("three");
        let (count, left) = messages.unread();
        assert!(count == 1 && left <= UNREAD_TIME && left > UNREAD_TIME / 2, "{count} {left:?}");
        if let Some(long_ago) = Instant::now().checked_sub(2 * UNREAD_TIME) {
            (messages.list_seen, messages.history[2].0) = (None, long_ago);
            assert_eq!(messages.unread().0, 2);
            messages.history.iter_mut().for_each(|(when, _)| *when = long_ago);
            assert_eq!(messages.unread(), (0, Duration::ZERO));
        }
    }

    #[test]
    fn foreign_words_are_harmless_and_short() {
        let mut messages = MessageLog::default();
        messages.error("a\u{1b}[2J\nb".to_owned() + &"x".repeat(1 << 20), "c\u{202e}\n".repeat(1 << 20));
        let UserMessage { headline: short, details, .. } = messages.current.clone().unwrap();
        assert!(short.starts_with("a·[2J·bxx") && details.starts_with("c·\nc·\n"), "{short} {details}");
        let length = |text: &str| text.chars().count();
        // One more character marks the cut.
        assert_eq!((length(&short), length(&details)), (MAX_HEADLINE_CHARS + 1, MAX_DETAILS_CHARS));
        assert_eq!(messages.errors(), [short]);
        let said = |details: &str| {
            let details = details.to_owned();
            UserMessage { headline: "not exported".to_owned(), details, is_error: true }.one_line()
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
