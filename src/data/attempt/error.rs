//! Errors of loading a volume, with messages that say how to proceed.

use std::fmt;
use std::io;
use std::path::Path;

use super::choice::{Choice, Unclear};
use super::held::{Aspect, Watch};
use super::offer::{Dimension, Offer};
use crate::data::foreign::plain;

/// Maximum number of offers that a message lists: about the lines of a screen.
const MOST_LISTED: usize = 24;

/// Parts of a message to the user, displayed as `WHAT: WHY (file, field); HELP`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Explanation {
    /// Operation that failed, as `cannot read the RAW volume`.
    pub what: String,
    /// Cause: what was expected and what was found.
    pub why: String,
    /// Location: the file and, after a comma, the field or option.
    pub place: String,
    /// Advice on how to proceed.
    pub help: String,
}

impl fmt::Display for Explanation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} ({}); {}", self.what, self.why, self.place, self.help)
    }
}

/// Kinds of failure that callers treat differently.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LoadErrorKind {
    /// The file or the options are wrong, damaged or of an unsupported kind.
    BadInput,
    /// The volume exceeds a limit, the memory budget for example.
    Limit,
    /// The file does not exist or cannot be read.
    Io,
    /// The user cancelled the load.
    Cancelled,
}

/// Error of loading a volume.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The file or the options are wrong, damaged or of an unsupported kind.
    #[error("{0}")]
    BadInput(Box<Explanation>),
    /// The volume exceeds a limit, the memory budget for example.
    #[error("{0}")]
    Limit(Box<Explanation>),
    /// The file does not exist or cannot be read.
    #[error("{explanation}")]
    Io {
        /// Message shown to the user.
        explanation: Box<Explanation>,
        /// Error of the operating system, if a system call failed.
        #[source]
        source: Option<io::Error>,
    },
    /// The file holds several volumes, and none of them is selected.
    #[error("{explanation}")]
    Several {
        /// Message to the user, which lists the volumes.
        explanation: Box<Explanation>,
        /// Dimension in which the volumes differ.
        dimension: Dimension,
        /// All volumes that can be selected.
        offers: Vec<Offer>,
    },
    /// The user cancelled the load.
    #[error("loading was cancelled")]
    Cancelled,
}

impl LoadError {
    /// Returns the kind of this failure.
    pub fn kind(&self) -> LoadErrorKind {
        match self {
            Self::BadInput(_) | Self::Several { .. } => LoadErrorKind::BadInput,
            Self::Limit(_) => LoadErrorKind::Limit,
            Self::Io { .. } => LoadErrorKind::Io,
            Self::Cancelled => LoadErrorKind::Cancelled,
        }
    }

    /// Returns true if the error concerns a field or an option of the given name.
    pub fn is_about(&self, field: &str) -> bool {
        let of = |place: &str| place.strip_suffix(field).is_some_and(|rest| rest.ends_with(", "));
        self.explanation().is_some_and(|explanation| of(&explanation.place))
    }

    /// Returns the parts of the message; `None` if the load was cancelled.
    pub fn explanation(&self) -> Option<&Explanation> {
        match self {
            Self::BadInput(explanation)
            | Self::Limit(explanation)
            | Self::Several { explanation, .. }
            | Self::Io { explanation, .. } => Some(explanation),
            Self::Cancelled => None,
        }
    }
}

/// Context from which the errors of one operation are made: the operation and its file.
#[derive(Debug, Clone, Copy)]
pub(in crate::data) struct Attempt<'a> {
    /// The operation, as it reads after "cannot": `read the RAW volume`.
    pub(in crate::data) what: &'a str,
    /// Path of the file that is read.
    pub(in crate::data) path: &'a Path,
}

impl Attempt<'_> {
    pub(in crate::data) fn bad_input(
        &self,
        field: &str,
        why: impl Into<String>,
        help: impl Into<String>,
    ) -> LoadError {
        LoadError::BadInput(Box::new(self.explain(field, why.into(), help.into())))
    }

    pub(in crate::data) fn limit(
        &self,
        field: &str,
        why: impl Into<String>,
        help: impl Into<String>,
    ) -> LoadError {
        LoadError::Limit(Box::new(self.explain(field, why.into(), help.into())))
    }

    /// Resolves the user's selection among several volumes to an index.
    ///
    /// # Errors
    /// [`LoadError::Several`] if nothing is selected or no volume matches; its message lists the volumes.
    pub(in crate::data) fn chosen(
        &self,
        choice: &Choice,
        dimension: Dimension,
        offers: Vec<Offer>,
    ) -> Result<usize, LoadError> {
        let unclear = match choice.of(dimension, &offers) {
            Ok(at) => return Ok(at),
            Err(unclear) => unclear,
        };
        let mut list: Vec<String> = offers.iter().take(MOST_LISTED).map(Offer::to_string).collect();
        if offers.len() > MOST_LISTED {
            list.push(format!("and {} more", offers.len() - MOST_LISTED));
        }
        let (option, plural, count) = (dimension.option(), dimension.plural(), offers.len());
        let why = match unclear {
            Unclear::Several => format!("it holds {count} {plural}"),
            Unclear::Unknown(said) => format!("{} is none of its {count} {plural}", quoted(&said)),
        };
        let help = format!("choose one with {option}: {}", list.join(", "));
        Err(LoadError::Several { explanation: Box::new(self.explain(option, why, help)), dimension, offers })
    }

    /// Rejects a selection in an aspect that the file does not have, i.e. for which no reader has queried the choice.
    /// Index 0 is accepted everywhere.
    ///
    /// # Errors
    /// `BadInput` with the aspects that exist, unless the choice falls back to the first volume.
    pub(crate) fn refuse_unasked(&self, choice: &Choice, watch: &Watch) -> Result<(), LoadError> {
        let is_unasked = |aspect: Aspect| {
            let said = choice.said_of(aspect).filter(|said| said != "0")?;
            (!watch.was_asked(aspect)).then_some((aspect, said))
        };
        let Some((aspect, said)) = Aspect::ALL.into_iter().find_map(is_unasked) else { return Ok(()) };
        if choice.otherwise_first {
            return Ok(());
        }
        let held = watch.held();
        let several = held.several.iter().map(|several| {
            let (option, plural, last) = (
                several.dimension.option(),
                several.dimension.plural(),
                several.offers.len().saturating_sub(1),
            );
            let named =
                several.offers.iter().take(MOST_LISTED).any(|offer| offer.key.parse::<usize>().is_err());
            if named {
                let keys = several.offers.iter().take(MOST_LISTED).map(|offer| offer.key.as_str());
                format!("{plural} ({option} {})", keys.collect::<Vec<_>>().join(", "))
            } else {
                format!("{plural} ({option} 0 to {last})")
            }
        });
        let components = held.components.map(|components| {
            format!("components (--component 0 to {})", components.count.saturating_sub(1))
        });
        let there: Vec<String> = several.chain(components).collect();
        let (option, plural) = (aspect.option(), aspect.plural());
        let help = if there.is_empty() {
            format!("it holds one volume: leave {option} out")
        } else {
            format!("leave {option} out; it has {}", there.join(" and "))
        };
        let why = format!("{} is named, and it has no {plural} to choose from", quoted(&said));
        Err(self.bad_input(option, why, help))
    }

    /// Error for a requested region that is empty or reaches beyond the grid.
    pub(in crate::data) fn outside(&self, [x, y, z]: [usize; 3]) -> LoadError {
        let why = format!("there are {x} x {y} x {z} voxels");
        self.bad_input("--region", why, "a region of at least one of them helps")
    }

    /// Error for a path of the wrong kind, such as a folder in place of a file.
    pub(in crate::data) fn not_a_file(&self, why: &str, help: &str) -> LoadError {
        LoadError::Io {
            explanation: Box::new(self.explain("", why.to_owned(), help.to_owned())),
            source: None,
        }
    }

    pub(in crate::data) fn io(&self, source: io::Error) -> LoadError {
        let (why, help) = match source.kind() {
            io::ErrorKind::NotFound => ("there is no such file".to_owned(), "check the path"),
            io::ErrorKind::PermissionDenied => {
                ("it may not be read by this user".to_owned(), "change its permissions or copy it")
            }
            _ => (source.to_string(), "check the path and the disk"),
        };
        LoadError::Io { explanation: Box::new(self.explain("", why, help.to_owned())), source: Some(source) }
    }

    /// Logs a warning about an assumption that was made about the file.
    pub(in crate::data) fn warn(&self, what: impl fmt::Display) {
        log::warn!("{}: {what}", plain(&self.path.to_string_lossy(), 4096));
    }

    fn explain(&self, field: &str, why: String, help: String) -> Explanation {
        let file = plain(&self.path.to_string_lossy(), 4096);
        let place = if field.is_empty() { file } else { format!("{file}, {field}") };
        Explanation { what: format!("cannot {}", self.what), why, place, help }
    }
}

/// Quotes text from a file for a message: shortened, and without control characters.
pub(in crate::data) fn quoted(text: &str) -> String {
    format!("\"{}\"", plain(text, 60))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_say_what_why_where_and_what_helps() {
        let attempt = Attempt { what: "read the RAW volume", path: Path::new("dir/a\nb.raw") };
        let error = attempt.bad_input("--dims", "a dimension is 0", "give three numbers above 0");
        assert_eq!(
            error.to_string(),
            "cannot read the RAW volume: a dimension is 0 (dir/a·b.raw, --dims); give three numbers above 0"
        );
        assert_eq!(error.kind(), LoadErrorKind::BadInput);
    }

    #[test]
    fn what_is_quoted_is_harmless() {
        assert_eq!(quoted("a\u{1b}[2Jb"), "\"a·[2Jb\"");
    }
}
