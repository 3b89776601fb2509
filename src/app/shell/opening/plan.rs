//! Decision about the look of a volume that has been opened: a pure function of the request, of what is kept from the
//! volume before, and of the session.

use super::similarity::VolumeSimilarity;
use chiaroscuro_scene::{LookRecord, Settings};

/// Look that waits for the volume that is being opened.
#[derive(Debug)]
pub(crate) enum PendingLook {
    /// Look of a file, applied to the first look of the volume.
    Record(Box<LookRecord>),
    /// All settings, replacing the first look.
    Settings(Box<Settings>),
    /// Current look at the time when the volume is ready.
    Current,
    /// Current look, if the volume is similar enough to the one before.
    CurrentIfSimilar,
}

/// Circumstances in which an opened volume replaces the one before.
#[derive(Debug)]
pub(super) struct OpenRequest {
    /// Look that was requested with the volume.
    pub requested: Option<PendingLook>,
    /// True if the user keeps the look for the next volume.
    pub keeps_look: bool,
    /// Similarity to the volume that is open; `None` if none is.
    pub similarity: Option<VolumeSimilarity>,
    /// True if a session was read for this volume, or could not be read.
    pub has_session: bool,
    /// True if the command line or a safe start adjusts the first look.
    pub has_adjustment: bool,
}

/// Look from which a volume starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum StartingLook {
    /// First look of the volume, whose balance has been measured.
    FirstLook,
    /// Current look with the view of the first look, which has the up axis of the volume; to be balanced again.
    KeptLook,
}

/// Corrections of the file's metadata that a look is shown with.
#[derive(Debug, Clone, Copy)]
pub(super) enum CorrectionsOrigin {
    /// Corrections with which the file was opened.
    OpenedFile,
    /// Corrections of the current look.
    CurrentLook,
}

/// Change of the look that a volume starts from.
#[derive(Debug)]
pub(super) enum LookChange {
    /// Applies the session.
    Session,
    /// Applies the look of a file.
    Record(Box<LookRecord>),
    /// Replaces all settings.
    Settings(Box<Settings>),
    /// Goes back to the current look, view included.
    Current(CorrectionsOrigin),
    /// Adjusts the look as the command line or a safe start says.
    Adjustment,
}

/// Decision about the look of an opened volume.
#[derive(Debug)]
pub(super) struct OpenPlan {
    /// Look from which the volume starts.
    pub start: StartingLook,
    /// Changes of that look, in the order in which they are made.
    pub changes: Vec<LookChange>,
    /// True if the selected light stays selected.
    pub keeps_selection: bool,
    /// True if lights are placed automatically: a look that the user has chosen stays.
    pub places_lights: bool,
}

impl OpenPlan {
    /// Decides on the look of an opened volume.
    pub(super) fn new(request: OpenRequest) -> Self {
        let OpenRequest { requested, keeps_look, similarity, has_session, has_adjustment } = request;
        // Similarity matters only where it was asked for; another file has corrections of its own.
        let (requested, is_same_kind) = match requested {
            None => (None, false),
            Some(PendingLook::Record(record)) => (Some(LookChange::Record(record)), false),
            Some(PendingLook::Settings(settings)) => (Some(LookChange::Settings(settings)), false),
            Some(PendingLook::Current) => (Some(LookChange::Current(CorrectionsOrigin::CurrentLook)), false),
            Some(PendingLook::CurrentIfSimilar) => match similarity {
                Some(VolumeSimilarity::SameGrid) => {
                    (Some(LookChange::Current(CorrectionsOrigin::OpenedFile)), false)
                }
                other => (None, other == Some(VolumeSimilarity::SameKind)),
            },
        };
        let is_kept = similarity.is_some() && (keeps_look || is_same_kind);
        let keeps_selection = matches!(requested, Some(LookChange::Current(_)));
        let session = has_session.then_some(LookChange::Session);
        let adjustment = has_adjustment.then_some(LookChange::Adjustment);
        let changes: Vec<LookChange> = [session, requested, adjustment].into_iter().flatten().collect();
        Self {
            start: if is_kept { StartingLook::KeptLook } else { StartingLook::FirstLook },
            places_lights: !is_kept && changes.is_empty(),
            keeps_selection,
            changes,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the plan in words, for the table: the start, the changes in order, and what else is done.
    fn in_words(plan: &OpenPlan) -> String {
        let start = match plan.start {
            StartingLook::FirstLook => "first",
            StartingLook::KeptLook => "kept",
        };
        let changes = plan.changes.iter().map(|change| match change {
            LookChange::Session => "session",
            LookChange::Record(_) => "record",
            LookChange::Settings(_) => "settings",
            LookChange::Current(CorrectionsOrigin::OpenedFile) => "current as file",
            LookChange::Current(CorrectionsOrigin::CurrentLook) => "current",
            LookChange::Adjustment => "adjustment",
        });
        let also = [(plan.keeps_selection, "selection"), (plan.places_lights, "lights")];
        let also = also.into_iter().filter_map(|(on, name)| on.then_some(name));
        let list = |parts: Vec<&str>| parts.join(", ");
        format!("{start}; {}; {}", list(changes.collect()), list(also.collect()))
    }

    fn record() -> PendingLook {
        let text =
            LookRecord::to_json_with_unknown(&Settings::default(), None, None, &serde_json::Value::Null);
        PendingLook::Record(Box::new(LookRecord::parse(&text).unwrap()))
    }

    fn settings() -> PendingLook {
        PendingLook::Settings(Box::default())
    }

    #[test]
    fn every_case_of_opening_has_its_look() {
        use PendingLook::{Current, CurrentIfSimilar};
        use VolumeSimilarity::{Different, SameGrid, SameKind};
        // Request: look, similarity to the open volume; keeps look, session, adjustment. Plan in words.
        let table = [
            // The first volume of the window.
            (None, None, [false, false, false], "first; ; lights"),
            (None, None, [true, false, false], "first; ; lights"),
            (None, None, [false, true, false], "first; session; "),
            (None, None, [false, false, true], "first; adjustment; "),
            (None, None, [true, true, true], "first; session, adjustment; "),
            (Some(record()), None, [false, false, false], "first; record; "),
            (Some(record()), None, [false, true, true], "first; session, record, adjustment; "),
            (Some(settings()), None, [false, false, false], "first; settings; "),
            (Some(CurrentIfSimilar), None, [false, false, false], "first; ; lights"),
            // Another volume; its similarity matters only if it was asked for.
            (None, Some(SameGrid), [false, false, false], "first; ; lights"),
            (None, Some(SameKind), [false, false, false], "first; ; lights"),
            (None, Some(Different), [false, false, false], "first; ; lights"),
            (None, Some(Different), [true, false, false], "kept; ; "),
            (Some(record()), Some(SameKind), [false, false, false], "first; record; "),
            (Some(record()), Some(SameKind), [true, false, false], "kept; record; "),
            (Some(settings()), Some(SameGrid), [false, false, false], "first; settings; "),
            (Some(settings()), Some(SameGrid), [true, false, false], "kept; settings; "),
            // Another series, channel, time step or component of the file.
            (Some(Current), Some(SameGrid), [false, false, false], "first; current; selection"),
            (Some(Current), Some(Different), [false, false, false], "first; current; selection"),
            (Some(Current), Some(Different), [true, true, false], "kept; session, current; selection"),
            // The next file of the folder.
            (
                Some(CurrentIfSimilar),
                Some(SameGrid),
                [false, false, false],
                "first; current as file; selection",
            ),
            (
                Some(CurrentIfSimilar),
                Some(SameGrid),
                [true, false, false],
                "kept; current as file; selection",
            ),
            (Some(CurrentIfSimilar), Some(SameKind), [false, false, false], "kept; ; "),
            (Some(CurrentIfSimilar), Some(Different), [false, false, false], "first; ; lights"),
            (Some(CurrentIfSimilar), Some(Different), [true, false, false], "kept; ; "),
            (Some(CurrentIfSimilar), Some(SameKind), [false, true, true], "kept; session, adjustment; "),
        ];
        for (requested, similarity, [keeps_look, has_session, has_adjustment], wanted) in table {
            let case = format!("{requested:?}, {similarity:?}, {keeps_look} {has_session} {has_adjustment}");
            let plan =
                OpenPlan::new(OpenRequest { requested, keeps_look, similarity, has_session, has_adjustment });
            assert_eq!(in_words(&plan), wanted, "{case}");
        }
    }
}
