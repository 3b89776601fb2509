//! Search for commands and settings by words: by their names, search words and synonyms.

use super::synonyms::{self, Synonym};
use crate::app::common::commands::{self, AppCommand};
use crate::app::text;
use chiaroscuro_scene::SceneAxis;

/// Length from which on a word is also matched inside others, in characters ("light" in "spotlight"): one or two
/// letters occur in most words.
const MIN_SUBSTRING_CHARS: usize = 3;

/// State of the window that decides the names and rows that can be found.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PaletteContext {
    /// Scene axis that points up, which some names contain.
    pub up: SceneAxis,
    /// True if the volume has labels.
    pub has_labels: bool,
}

/// Command or setting that was found.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CommandMatch {
    pub command: AppCommand,
    /// Remark beside its name; empty if the name is enough.
    pub remark: &'static str,
}

/// Result of a search by words.
#[derive(Debug, Default)]
pub(super) struct SearchResult {
    /// Sentence that says that the program lacks the feature, if one was searched for that it does not have.
    pub missing_feature: Option<&'static str>,
    /// Matching commands, best match first.
    pub matches: Vec<CommandMatch>,
}

/// Finds the commands that match all words of a text by name, search words or synonyms: first those whose names begin
/// with it, then those whose names contain all words, then those reached through synonyms.
pub(super) fn search_commands(text: &str, PaletteContext { up, has_labels }: PaletteContext) -> SearchResult {
    let text = text.to_lowercase();
    let query_words: Vec<&str> = split_words(&text).collect();
    let beginning = query_words.join(" ");
    let synonyms = synonyms::synonym_table(has_labels);
    let is_meant = |synonym: &&Synonym| {
        let synonym_words: Vec<&str> = split_words(synonym.search_words.words).collect();
        !query_words.is_empty() && query_words.iter().all(|word| matches_any(word, &synonym_words))
    };
    let matching_synonyms: Vec<&Synonym> = synonyms.iter().filter(is_meant).collect();
    let ranked = |command: AppCommand| {
        let label = command.label_with(up).to_lowercase();
        let name: Vec<&str> = split_words(&label).collect();
        let of_table = synonyms.iter().filter(|synonym| synonym.targets.contains(&command));
        let others: Vec<&str> = split_words(command.search_words())
            .chain(of_table.flat_map(|synonym| split_words(synonym.search_words.words)))
            .collect();
        let is_found = query_words.iter().all(|word| matches_any(word, &name) || matches_any(word, &others));
        let is_named = query_words.iter().all(|word| matches_any(word, &name));
        let begins = name.join(" ").starts_with(&beginning);
        // Ordered by the position among the targets of the synonyms.
        let place = |synonym: &Synonym| synonym.targets.iter().position(|target| *target == command);
        let meaning =
            matching_synonyms.iter().enumerate().find_map(|(at, synonym)| Some((at, place(synonym)?)));
        let note = meaning.map_or("", |(at, _)| matching_synonyms[at].search_words.note);
        let is_supported = meaning.is_none_or(|(at, _)| matching_synonyms[at].is_supported);
        let finding = CommandMatch { command, remark: if is_supported { note } else { "" } };
        is_found.then_some(((!begins, !is_named, meaning.unwrap_or((usize::MAX, 0))), finding))
    };
    let is_of_volume = |command: &AppCommand| match command {
        AppCommand::Reveal(place) => has_labels || place.section != text::labels::TITLE,
        _ => true,
    };
    let mut found: Vec<_> =
        commands::searchable_commands().into_iter().filter(is_of_volume).filter_map(ranked).collect();
    found.sort_by_key(|(rank, _)| *rank);
    SearchResult {
        missing_feature: matching_synonyms
            .iter()
            .find(|synonym| !synonym.is_supported)
            .map(|synonym| synonym.search_words.note),
        matches: found.into_iter().map(|(_, finding)| finding).collect(),
    }
}

/// Splits a text into words, at characters that are neither letters nor digits.
fn split_words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty())
}

/// Returns true if one of several words begins with a word, or contains it if it is long enough.
fn matches_any(word: &str, among: &[&str]) -> bool {
    let is_long = word.chars().count() >= MIN_SUBSTRING_CHARS;
    among.iter().any(|said| said.starts_with(word) || is_long && said.contains(word))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::common::reveal::SettingPlace;
    use chiaroscuro_scene::{CutShapeKind, ObjectRotation, RenderMode, StandardView};
    use chiaroscuro_volume::{ChoiceAspect, FileDimension};

    /// Commands that a text finds, for a volume without labels.
    fn commands_for(text: &str, up: SceneAxis) -> Vec<AppCommand> {
        let findings = search_commands(text, PaletteContext { up, has_labels: false });
        findings.matches.into_iter().map(|finding| finding.command).collect()
    }

    #[test]
    fn commands_are_found_by_parts_of_their_names() {
        let found = |text| commands_for(text, SceneAxis::default());
        let with_labels =
            search_commands("", PaletteContext { has_labels: true, ..PaletteContext::default() });
        assert_eq!(with_labels.matches.len(), commands::searchable_commands().len());
        assert_eq!(found("balance").first(), Some(&AppCommand::Balance));
        assert!(found("light solo").contains(&AppCommand::Solo));
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
            let found = commands_for(words, SceneAxis::default());
            let is_it = |command: &AppCommand| matches!(command, AppCommand::Reveal(place) if place.section == section && place.row == Some(row));
            assert!(found.iter().any(is_it), "{words}: {found:?}");
        }
        assert!(commands_for("screenshot", SceneAxis::default()).contains(&AppCommand::Export));
    }

    #[test]
    fn every_command_is_found_by_its_name() {
        let subject = PaletteContext { has_labels: true, ..PaletteContext::default() };
        for command in commands::searchable_commands() {
            let name = command.label_with(SceneAxis::default());
            let found = search_commands(&name, subject).matches;
            assert!(found.iter().any(|finding| finding.command == command), "{name}: {found:?}");
        }
    }

    #[test]
    fn what_is_called_like_that_comes_before_what_is_found_by_other_words() {
        for word in ["distance", "opacity", "kernel", "density"] {
            let found = commands_for(word, SceneAxis::default());
            let is_called =
                |command: &AppCommand| command.label_with(SceneAxis::default()).to_lowercase().contains(word);
            assert!(found.first().is_some_and(is_called), "{word}: {found:?}");
            assert!(found.is_sorted_by_key(|command| !is_called(command)), "{word}: {found:?}");
        }
    }

    #[test]
    fn one_or_two_letters_begin_words() {
        let in_sky = commands_for("sky y", SceneAxis::default());
        assert!(in_sky.is_empty(), "{in_sky:?}");
        assert!(!commands_for("ao", SceneAxis::default()).is_empty());
        assert!(commands_for("light", SceneAxis::default()).contains(&AppCommand::Solo));
    }

    #[test]
    fn turning_the_object_is_found_by_what_people_call_it() {
        for words in ["flip", "upside down", "lay down", "stand up", "rotate 90", "Turn object"] {
            let found = commands_for(words, SceneAxis::default());
            assert!(found.contains(&AppCommand::TurnObject(ObjectRotation::TipBack)), "{words}: {found:?}");
        }
        assert!(commands_for("rotate 90", SceneAxis::default()).contains(&AppCommand::RotateObject));
        let above = commands_for("above +y", SceneAxis::PlusY);
        assert_eq!(above, [AppCommand::LookFrom(StandardView::PlusZ)], "names say what is up");
    }

    /// Pairs of search words, their first result, and whether the feature is reported as missing.
    #[test]
    fn what_people_call_things_leads_to_what_is_nearest() {
        let channel = ChoiceAspect::Dimension(FileDimension::Channel);
        for (words, nearest, is_missing) in [
            ("measure", AppCommand::ToggleProbe, false),
            ("ruler", AppCommand::ToggleProbe, false),
            ("animation", AppCommand::Export, false),
            ("turntable", AppCommand::Export, false),
            ("annotation", AppCommand::Export, true),
            ("play", AppCommand::TogglePlayback, false),
            ("composite", AppCommand::ShowTogether(channel), false),
            ("mip", AppCommand::UseRenderMode(RenderMode::Maximum), false),
            ("maximum intensity projection", AppCommand::UseRenderMode(RenderMode::Maximum), false),
            ("isosurface", AppCommand::UseRenderMode(RenderMode::Surface), false),
            ("remove table", AppCommand::ToggleTable, false),
            ("island", AppCommand::CutByShape(CutShapeKind::Component), false),
            ("scissors", AppCommand::CutByShape(CutShapeKind::Outline), false),
            ("segmentation", AppCommand::OpenDialog, true),
        ] {
            let findings = search_commands(words, PaletteContext::default());
            assert_eq!(findings.matches.first().map(|finding| &finding.command), Some(&nearest), "{words}");
            assert_eq!(
                findings.missing_feature.is_some(),
                is_missing,
                "{words}: {:?}",
                findings.missing_feature
            );
        }
        for (words, section, row, is_missing) in [
            ("resample", "Data", Some("Subsample"), false),
            ("denoise", "Camera", Some("Kernel"), true),
            ("depth of field", "Camera", Some("Field of view"), true),
            ("ambient occlusion", "Sky and scattering", Some("Soft light"), false),
            ("window level", "Transfer function", Some("Level"), false),
        ] {
            let findings = search_commands(words, PaletteContext::default());
            let first = findings.matches.first().map(|finding| finding.command.clone());
            let is_it = |place: SettingPlace| (place.section, place.row) == (section, row);
            assert!(matches!(first, Some(AppCommand::Reveal(place)) if is_it(place)), "{words}: {first:?}");
            assert_eq!(
                findings.missing_feature.is_some(),
                is_missing,
                "{words}: {:?}",
                findings.missing_feature
            );
        }
        assert!(search_commands("stereo", PaletteContext::default()).missing_feature.is_some());
        let measure = search_commands("measure", PaletteContext::default());
        assert!(measure.matches[0].remark.contains("two clicks"), "{measure:?}");
        assert!(search_commands("", PaletteContext::default()).missing_feature.is_none());
    }

    #[test]
    fn labels_are_found_where_the_volume_has_some() {
        let labels = |has_labels| {
            let found =
                search_commands("segmentation", PaletteContext { has_labels, ..PaletteContext::default() })
                    .matches;
            let is_of_labels = |command: &AppCommand| matches!(command, AppCommand::Reveal(place) if place.section == text::labels::TITLE);
            found.iter().position(|finding| is_of_labels(&finding.command))
        };
        assert_eq!([labels(true), labels(false)], [Some(0), None]);
    }
}
