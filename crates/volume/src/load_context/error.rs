//! Errors of loading a volume, with messages that say how to proceed.

use std::fmt;
use std::io;
use std::path::Path;

use super::choice::{ChoiceError, VolumeChoice};
use super::file_contents::{ChoiceAspect, ContentsRecorder};
use super::offer::{FileDimension, VolumeOffer};
use chiaroscuro_files::sanitised;

/// Maximum number of offers that a message lists: about the lines of a screen.
const MAX_LISTED_OFFERS: usize = 24;

/// Parts of a message to the user, displayed as `WHAT: WHY (file, field); HELP`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ErrorExplanation {
    /// Operation that failed, as `cannot read the RAW volume`.
    pub what: String,
    /// Cause: what was expected and what was found.
    pub why: String,
    /// Location: the file and, after a comma, the field or option.
    pub place: String,
    /// Advice on how to proceed.
    pub help: String,
}

impl fmt::Display for ErrorExplanation {
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
    BadInput(Box<ErrorExplanation>),
    /// The volume exceeds a limit, the memory budget for example.
    #[error("{0}")]
    Limit(Box<ErrorExplanation>),
    /// The file does not exist or cannot be read.
    #[error("{explanation}")]
    Io {
        /// Message shown to the user.
        explanation: Box<ErrorExplanation>,
        /// Error of the operating system, if a system call failed.
        #[source]
        source: Option<io::Error>,
    },
    /// The file holds several volumes, and none of them is selected.
    #[error("{explanation}")]
    Several {
        /// Message to the user, which lists the volumes.
        explanation: Box<ErrorExplanation>,
        /// Dimension in which the volumes differ.
        dimension: FileDimension,
        /// All volumes that can be selected.
        offers: Vec<VolumeOffer>,
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
    pub fn explanation(&self) -> Option<&ErrorExplanation> {
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
pub struct LoadContext<'a> {
    /// The operation, as it reads after "cannot": `read the RAW volume`.
    pub operation: &'a str,
    /// Path of the file that is read.
    pub path: &'a Path,
}

impl LoadContext<'_> {
    /// Creates a [`LoadError::BadInput`] about a field of the file or an option (empty for the file as a whole): its
    /// cause and advice, each without a full stop.
    pub fn bad_input_error(&self, field: &str, why: impl Into<String>, help: impl Into<String>) -> LoadError {
        LoadError::BadInput(Box::new(self.explain(field, why.into(), help.into())))
    }

    /// Creates a [`LoadError::Limit`] about a field of the file or an option (empty for the file as a whole): its
    /// cause and advice, each without a full stop.
    pub fn limit_error(&self, field: &str, why: impl Into<String>, help: impl Into<String>) -> LoadError {
        LoadError::Limit(Box::new(self.explain(field, why.into(), help.into())))
    }

    /// Resolves the user's selection among several volumes to an index.
    ///
    /// # Errors
    /// [`LoadError::Several`] if nothing is selected or no volume matches; its message lists the volumes.
    pub fn resolve_choice(
        &self,
        choice: &VolumeChoice,
        dimension: FileDimension,
        offers: Vec<VolumeOffer>,
    ) -> Result<usize, LoadError> {
        let choice_error = match choice.resolve(dimension, &offers) {
            Ok(at) => return Ok(at),
            Err(unclear) => unclear,
        };
        let mut list: Vec<String> =
            offers.iter().take(MAX_LISTED_OFFERS).map(VolumeOffer::to_string).collect();
        if offers.len() > MAX_LISTED_OFFERS {
            list.push(format!("and {} more", offers.len() - MAX_LISTED_OFFERS));
        }
        let (option, plural, count) = (dimension.option(), dimension.plural(), offers.len());
        let why = match choice_error {
            ChoiceError::NotSelected => format!("it holds {count} {plural}"),
            ChoiceError::Unknown(said) => format!("{} is not one of its {count} {plural}", quoted(&said)),
        };
        let help = format!("choose one with {option}: {}", list.join(", "));
        Err(LoadError::Several { explanation: Box::new(self.explain(option, why, help)), dimension, offers })
    }

    /// Rejects a selection in an aspect that the file does not have, i.e. for which no reader has queried the choice.
    /// Index 0 is accepted everywhere.
    ///
    /// # Errors
    /// `BadInput` with the aspects that exist, unless the choice falls back to the first volume.
    pub fn reject_unsupported_choice(
        &self,
        choice: &VolumeChoice,
        watch: &ContentsRecorder,
    ) -> Result<(), LoadError> {
        let is_unasked = |aspect: ChoiceAspect| {
            let said = choice.selected_in_aspect(aspect).filter(|said| said != "0")?;
            (!watch.was_queried(aspect)).then_some((aspect, said))
        };
        let Some((aspect, said)) = ChoiceAspect::ALL.into_iter().find_map(is_unasked) else { return Ok(()) };
        if choice.fall_back_to_first {
            return Ok(());
        }
        let held = watch.contents();
        let several = held.alternatives.iter().map(|several| {
            let (option, plural, last) = (
                several.dimension.option(),
                several.dimension.plural(),
                several.offers.len().saturating_sub(1),
            );
            let named = several
                .offers
                .iter()
                .take(MAX_LISTED_OFFERS)
                .any(|offer| offer.key.parse::<usize>().is_err());
            if named {
                let keys = several.offers.iter().take(MAX_LISTED_OFFERS).map(|offer| offer.key.as_str());
                format!("{plural} ({option} {})", keys.collect::<Vec<_>>().join(", "))
            } else {
                format!("{plural} ({option} 0 to {last})")
            }
        });
        let components = held.components.map(|components| {
            format!("components (--component 0 to {})", components.count.saturating_sub(1))
        });
        let available: Vec<String> = several.chain(components).collect();
        let (option, plural) = (aspect.option(), aspect.plural());
        let help = if available.is_empty() {
            format!("it holds one volume: leave {option} out")
        } else {
            format!("leave {option} out; it has {}", available.join(" and "))
        };
        let why = format!("{} was selected, but it has no {plural} to choose from", quoted(&said));
        Err(self.bad_input_error(option, why, help))
    }

    /// Creates an error for a requested region that is empty or reaches beyond the grid.
    pub fn region_error(&self, [x, y, z]: [usize; 3]) -> LoadError {
        let why = format!("the region is empty, or reaches beyond the {x} x {y} x {z} voxels");
        self.bad_input_error("--region", why, "give a region of at least one voxel within them")
    }

    /// Creates an error for a path of the wrong kind, such as a folder in place of a file.
    pub fn not_a_file_error(&self, why: &str, help: &str) -> LoadError {
        LoadError::Io {
            explanation: Box::new(self.explain("", why.to_owned(), help.to_owned())),
            source: None,
        }
    }

    /// Creates a [`LoadError::Io`] from an error of the operating system, with advice for its kind.
    pub fn io_error(&self, source: io::Error) -> LoadError {
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
    pub fn warn(&self, what: impl fmt::Display) {
        log::warn!("{}: {what}", sanitised(&self.path.to_string_lossy(), 4096));
    }

    fn explain(&self, field: &str, why: String, help: String) -> ErrorExplanation {
        let file = sanitised(&self.path.to_string_lossy(), 4096);
        let place = if field.is_empty() { file } else { format!("{file}, {field}") };
        ErrorExplanation { what: format!("cannot {}", self.operation), why, place, help }
    }
}

/// Quotes text from a file for a message: shortened, and without control characters.
pub fn quoted(text: &str) -> String {
    format!("\"{}\"", sanitised(text, 60))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_say_what_why_where_and_what_helps() {
        let context = LoadContext { operation: "read the RAW volume", path: Path::new("dir/a\nb.raw") };
        let error = context.bad_input_error("--dims", "a dimension is 0", "give three numbers above 0");
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
