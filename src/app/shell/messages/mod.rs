//! What went wrong, or went well: a notice over the picture, with details on click, and a list of all that was said.

mod list;
mod notice;

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use crate::data::{plain, without_controls};

/// How long a note stays; errors stay until they are dismissed.
const NOTE_S: f64 = 6.0;

/// How long the status bar counts a message that nobody has looked up: as long as somebody may come back to it who was
/// interrupted.
const COUNTED: Duration = Duration::from_mins(1);

/// Messages that are remembered: those of a long day.
const MOST: usize = 200;

/// Characters of a message: more than the widest screen shows.
const LONGEST_SHORT: usize = 500;

/// Characters of the details: two long paths, and what is said of them.
const LONGEST_DETAILS: usize = 10_000;

/// A message to the user.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Message {
    short: String,
    details: String,
    is_error: bool,
}

impl Message {
    /// What is said in a row: what happened, and the first reason for it.
    fn words(&self) -> String {
        let words = match self.details.lines().next().map(str::trim) {
            // Some errors begin with what has happened.
            Some(reason) if reason.to_lowercase().starts_with(&self.short.to_lowercase()) => {
                reason.to_owned()
            }
            Some(reason) if !reason.is_empty() => format!("{}: {reason}", self.short),
            _ => self.short.clone(),
        };
        // Errors of the library are parts of sentences.
        let mut letters = words.chars();
        letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
    }
}

/// The latest message and the errors so far.
#[derive(Debug, Default)]
pub(crate) struct Messages {
    current: Option<Message>,
    expanded: bool,
    /// When the note goes, in seconds of the window's clock; set when it is first shown.
    until_s: Option<f64>,
    /// Since the last volume was opened, for automation.
    errors: Vec<String>,
    /// The latest since then, also when it has gone.
    note: Option<String>,
    /// All that was said, the latest last, and when.
    past: VecDeque<(Instant, Message)>,
    /// When the list of them was on screen last.
    listed: Option<Instant>,
    /// The list of them is shown.
    pub lists: bool,
}

impl Messages {
    /// Something went wrong.
    pub(crate) fn error(&mut self, short: impl Into<String>, details: impl Into<String>) {
        let (short, details) = (short.into(), details.into());
        log::error!("{short}: {details}");
        self.errors.push(plain(&short, LONGEST_SHORT));
        self.show(Message { short, details, is_error: true });
    }

    /// Something worth knowing.
    pub(crate) fn note(&mut self, short: impl Into<String>) {
        let short = short.into();
        self.note = Some(plain(&short, LONGEST_SHORT));
        self.show(Message { short, details: String::new(), is_error: false });
    }

    /// A step of the history was taken: the status bar says so, and nothing is laid over the picture.
    pub(crate) fn step(&mut self, words: &str) {
        self.note = Some(plain(words, LONGEST_SHORT));
        if self.current.as_ref().is_some_and(|message| !message.is_error) {
            self.current = None;
        }
    }

    fn show(&mut self, Message { short, details, is_error }: Message) {
        // Names and errors come from files, and a label of any length takes as long to lay out.
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

    /// A new volume is there: what was said before is over.
    pub(crate) fn clear(&mut self) {
        let (past, listed, lists) = (std::mem::take(&mut self.past), self.listed, self.lists);
        *self = Self { past, listed, lists, ..Self::default() };
    }

    /// What is being said is over; what went wrong stays known.
    pub(crate) fn dismiss(&mut self) {
        self.current = None;
    }

    /// Errors so far.
    pub(crate) fn errors(&self) -> &[String] {
        &self.errors
    }

    /// The latest note, which may be over.
    pub(crate) fn latest_note(&self) -> Option<&str> {
        self.note.as_deref()
    }

    /// Whether a note lies over the picture, which goes by itself.
    pub(crate) fn shows_note(&self) -> bool {
        self.current.as_ref().is_some_and(|message| !message.is_error)
    }

    /// How many messages have come lately that were not looked up in the list, and how long that holds.
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
        // One more says that it was cut.
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
