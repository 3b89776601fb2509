//! Search for commands and settings by words: by their names, search words and synonyms.

use super::synonyms::{self, Synonym};
use crate::app::common::commands::{self, Command};
use crate::app::text;
use crate::model::SceneAxis;

/// Length from which on a word is also matched inside others, in characters ("light" in "spotlight"): one or two
/// letters occur in most words.
const WITHIN: usize = 3;

/// State of the window that decides the names and rows that can be found.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Subject {
    /// Scene axis that points up, which some names contain.
    pub up: SceneAxis,
    /// True if the volume has labels.
    pub has_labels: bool,
}

/// Command or setting that was found.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Finding {
    pub command: Command,
    /// Remark beside its name; empty if the name is enough.
    pub note: &'static str,
}

/// Result of a search by words.
#[derive(Debug, Default)]
pub(super) struct Findings {
    /// Sentence that says that the program lacks the feature, if one was searched for that it does not have.
    pub missing: Option<&'static str>,
    /// Matching commands, best match first.
    pub found: Vec<Finding>,
}

/// Finds the commands that match all words of a text by name, search words or synonyms: first those whose names begin
/// with it, then those whose names contain all words, then those reached through synonyms.
pub(super) fn matching(text: &str, Subject { up, has_labels }: Subject) -> Findings {
    let text = text.to_lowercase();
    let wanted: Vec<&str> = words(&text).collect();
    let beginning = wanted.join(" ");
    let synonyms = synonyms::all(has_labels);
    let is_meant = |synonym: &&Synonym| {
        let said: Vec<&str> = words(synonym.sought.words).collect();
        !wanted.is_empty() && wanted.iter().all(|word| is_said(word, &said))
    };
    let meant: Vec<&Synonym> = synonyms.iter().filter(is_meant).collect();
    let ranked = |command: Command| {
        let label = command.label_with(up).to_lowercase();
        let name: Vec<&str> = words(&label).collect();
        let of_table = synonyms.iter().filter(|synonym| synonym.targets.contains(&command));
        let others: Vec<&str> = words(command.search_words())
            .chain(of_table.flat_map(|synonym| words(synonym.sought.words)))
            .collect();
        let is_found = wanted.iter().all(|word| is_said(word, &name) || is_said(word, &others));
        let is_named = wanted.iter().all(|word| is_said(word, &name));
        let begins = name.join(" ").starts_with(&beginning);
        // Ordered by the position among the targets of the synonyms.
        let place = |synonym: &Synonym| synonym.targets.iter().position(|target| *target == command);
        let meaning = meant.iter().enumerate().find_map(|(at, synonym)| Some((at, place(synonym)?)));
        let note = meaning.map_or("", |(at, _)| meant[at].sought.note);
        let is_there = meaning.is_none_or(|(at, _)| meant[at].is_there);
        let finding = Finding { command, note: if is_there { note } else { "" } };
        is_found.then_some(((!begins, !is_named, meaning.unwrap_or((usize::MAX, 0))), finding))
    };
    let is_of_volume = |command: &Command| match command {
        Command::Reveal(place) => has_labels || place.section != text::labels::TITLE,
        _ => true,
    };
    let mut found: Vec<_> = commands::listed().into_iter().filter(is_of_volume).filter_map(ranked).collect();
    found.sort_by_key(|(rank, _)| *rank);
    Findings {
        missing: meant.iter().find(|synonym| !synonym.is_there).map(|synonym| synonym.sought.note),
        found: found.into_iter().map(|(_, finding)| finding).collect(),
    }
}

/// Splits a text into words, at characters that are neither letters nor digits.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty())
}

/// Returns true if one of several words begins with a word, or contains it if it is long enough.
fn is_said(word: &str, among: &[&str]) -> bool {
    let is_long = word.chars().count() >= WITHIN;
    among.iter().any(|said| said.starts_with(word) || is_long && said.contains(word))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::common::reveal::Place;
    use crate::data::load::{Aspect, Dimension};
    use crate::model::{ObjectTurn, StandardView};

    /// Commands that a text finds, for a volume without labels.
    fn found(text: &str, up: SceneAxis) -> Vec<Command> {
        let findings = matching(text, Subject { up, has_labels: false });
        findings.found.into_iter().map(|finding| finding.command).collect()
    }

    #[test]
    fn commands_are_found_by_parts_of_their_names() {
        let found = |text| found(text, SceneAxis::default());
        let with_labels = matching("", Subject { has_labels: true, ..Subject::default() });
        assert_eq!(with_labels.found.len(), commands::listed().len());
        assert_eq!(found("balance").first(), Some(&Command::Balance));
        assert!(found("light solo").contains(&Command::Solo));
        assert!(found("no such thing").is_empty());
    }

    #[test]
    fn settings_are_found_by_their_names_and_by_what_else_they_are_called() {
        for (words, section, row) in [
            ("shadow strength", "Shadows", "Strength"),
            ("ambient occlusion", "Sky and scattering", "Soft light"),
            ("subsurface", "Sky and scattering", "Bounces"),
            ("spotlight", "Lights", "Kind"),
            ("stained glass", "Shadows", "Shadow colour"),
            ("window level", "Transfer function", "Level"),
            ("window/level", "Transfer function", "Window"),
            ("contrast", "Data", "Range"),
            ("voxel size", "Data", "Spacing"),
            ("Voxel-Size", "Data", "Spacing"),
            ("mirror", "Data", "Flip"),
            ("slope, intercept", "Data", "Values"),
            ("anisotropy", "Sky and scattering", "Anisotropy"),
            ("rotate environment", "Sky and scattering", "Turn"),
            ("shadow catcher", "Floor", "Shadow alone"),
            ("b-spline", "Camera", "Kernel"),
            ("step size", "Shadows", "Slab"),
            ("two-sided", "Shading", "Lit sides"),
            ("zoom", "Camera", "Distance"),
        ] {
            let found = found(words, SceneAxis::default());
            let is_it = |command: &Command| matches!(command, Command::Reveal(place) if place.section == section && place.row == Some(row));
            assert!(found.iter().any(is_it), "{words}: {found:?}");
        }
        assert!(found("screenshot", SceneAxis::default()).contains(&Command::Export));
    }

    #[test]
    fn every_command_is_found_by_its_name() {
        let subject = Subject { has_labels: true, ..Subject::default() };
        for command in commands::listed() {
            let name = command.label_with(SceneAxis::default());
            let found = matching(&name, subject).found;
            assert!(found.iter().any(|finding| finding.command == command), "{name}: {found:?}");
        }
    }

    #[test]
    fn what_is_called_like_that_comes_before_what_is_found_by_other_words() {
        for word in ["distance", "opacity", "kernel", "density"] {
            let found = found(word, SceneAxis::default());
            let is_called =
                |command: &Command| command.label_with(SceneAxis::default()).to_lowercase().contains(word);
            assert!(found.first().is_some_and(is_called), "{word}: {found:?}");
            assert!(found.is_sorted_by_key(|command| !is_called(command)), "{word}: {found:?}");
        }
    }

    #[test]
    fn one_or_two_letters_begin_words() {
        let in_sky = found("sky y", SceneAxis::default());
        assert!(in_sky.is_empty(), "{in_sky:?}");
        assert!(!found("ao", SceneAxis::default()).is_empty());
        assert!(found("light", SceneAxis::default()).contains(&Command::Solo));
    }

    #[test]
    fn turning_the_object_is_found_by_what_people_call_it() {
        for words in ["flip", "upside down", "lay down", "stand up", "rotate 90", "Turn object"] {
            let found = found(words, SceneAxis::default());
            assert!(found.contains(&Command::TurnObject(ObjectTurn::Over)), "{words}: {found:?}");
        }
        assert!(found("rotate 90", SceneAxis::default()).contains(&Command::TurnRound));
        let above = found("above +y", SceneAxis::PlusY);
        assert_eq!(above, [Command::LookFrom(StandardView::PlusZ)], "names say what is up");
    }

    /// Pairs of search words, their first result, and whether the feature is reported as missing.
    #[test]
    fn what_people_call_things_leads_to_what_is_nearest() {
        let channel = Aspect::Of(Dimension::Channel);
        let frame = Aspect::Of(Dimension::Frame);
        for (words, nearest, is_missing) in [
            ("measure", Command::ToggleProbe, false),
            ("ruler", Command::ToggleProbe, false),
            ("animation", Command::Export, false),
            ("turntable", Command::Export, false),
            ("annotation", Command::Export, true),
            ("play", Command::StepChoice(frame, true), true),
            ("composite", Command::Choose(channel), true),
            ("mip", Command::TryLooks, true),
            ("maximum intensity projection", Command::TryLooks, true),
            ("remove table", Command::ToggleCrop, true),
            ("island", Command::ToggleCrop, true),
            ("segmentation", Command::OpenDialog, true),
        ] {
            let findings = matching(words, Subject::default());
            assert_eq!(findings.found.first().map(|finding| &finding.command), Some(&nearest), "{words}");
            assert_eq!(findings.missing.is_some(), is_missing, "{words}: {:?}", findings.missing);
        }
        for (words, section, row, is_missing) in [
            ("resample", "Data", Some("Subsample"), false),
            ("denoise", "Camera", Some("Kernel"), true),
            ("depth of field", "Camera", Some("Field of view"), true),
            ("ambient occlusion", "Sky and scattering", Some("Soft light"), false),
            ("window level", "Transfer function", Some("Level"), false),
        ] {
            let findings = matching(words, Subject::default());
            let first = findings.found.first().map(|finding| finding.command.clone());
            let is_it = |place: Place| (place.section, place.row) == (section, row);
            assert!(matches!(first, Some(Command::Reveal(place)) if is_it(place)), "{words}: {first:?}");
            assert_eq!(findings.missing.is_some(), is_missing, "{words}: {:?}", findings.missing);
        }
        for words in ["stereo", "fusion"] {
            assert!(matching(words, Subject::default()).missing.is_some(), "{words}");
        }
        let measure = matching("measure", Subject::default());
        assert!(measure.found[0].note.contains("two clicks"), "{measure:?}");
        assert!(matching("", Subject::default()).missing.is_none());
    }

    #[test]
    fn labels_are_found_where_the_volume_has_some() {
        let labels = |has_labels| {
            let found = matching("segmentation", Subject { has_labels, ..Subject::default() }).found;
            let is_of_labels = |command: &Command| matches!(command, Command::Reveal(place) if place.section == text::labels::TITLE);
            found.iter().position(|finding| is_of_labels(&finding.command))
        };
        assert_eq!([labels(true), labels(false)], [Some(0), None]);
    }
}
