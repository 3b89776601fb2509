//! Synonyms of commands and settings, and features that the program lacks, with the commands nearest to them.

use crate::app::common::commands::AppCommand;
use crate::app::common::searchable_settings::SEARCHABLE_SETTINGS;
use crate::app::text::palette_synonyms::{self, PaletteSynonyms};
use crate::app::text::{self, sections};
use chiaroscuro_scene::{CutShapeKind, ObjectRotation, RenderMode};
use chiaroscuro_volume::{ChoiceAspect, Downsampling, FileDimension, KindName};

/// Search words with the commands that they lead to.
#[derive(Debug)]
pub(super) struct Synonym {
    /// Search words, and the remark shown for them.
    pub search_words: PaletteSynonyms,
    /// True if the program has the feature; otherwise the remark says that it is missing.
    pub is_supported: bool,
    /// Commands that are meant, or else the nearest ones, best first.
    pub targets: Vec<AppCommand>,
}

/// Command that reveals a row of a panel, or a section as a whole.
fn reveal_row(section: &str, row: Option<&str>) -> Option<AppCommand> {
    let place = SEARCHABLE_SETTINGS.iter().map(|(place, _)| *place);
    place.into_iter().find(|place| place.section == section && place.row == row).map(AppCommand::Reveal)
}

/// Table of synonyms, for a volume with or without labels.
pub(super) fn synonym_table(has_labels: bool) -> Vec<Synonym> {
    let supported = |sought, targets: Vec<Option<AppCommand>>| Synonym {
        search_words: sought,
        is_supported: true,
        targets: targets.into_iter().flatten().collect(),
    };
    let missing = |sought, targets| Synonym { is_supported: false, ..supported(sought, targets) };
    let channel = ChoiceAspect::Dimension(FileDimension::Channel);
    let frame = ChoiceAspect::Dimension(FileDimension::Frame);
    let mut all = vec![
        supported(palette_synonyms::TILT, vec![Some(AppCommand::TurnObject(ObjectRotation::TipBack))]),
        supported(palette_synonyms::ROTATE, vec![Some(AppCommand::RotateObject)]),
        supported(palette_synonyms::SCALE, [1, -1, 0].map(AppCommand::Scale).map(Some).to_vec()),
        supported(palette_synonyms::REOPEN_LAST, vec![Some(AppCommand::ReopenLast)]),
        supported(palette_synonyms::SAVE, vec![Some(AppCommand::SaveSettings)]),
        supported(palette_synonyms::TRANSFER, vec![Some(AppCommand::ImportTransfer)]),
        supported(palette_synonyms::SOLO, vec![Some(AppCommand::Solo)]),
        supported(palette_synonyms::MUTE, vec![Some(AppCommand::Mute)]),
        supported(palette_synonyms::COMPARE, vec![Some(AppCommand::ToggleCompare)]),
        supported(palette_synonyms::PICTURE_ONLY, vec![Some(AppCommand::TogglePictureOnly)]),
        supported(palette_synonyms::EXPORT, vec![Some(AppCommand::Export)]),
        supported(palette_synonyms::ANIMATION, vec![Some(AppCommand::Export)]),
        supported(palette_synonyms::MEASURE, vec![Some(AppCommand::ToggleProbe)]),
        supported(
            palette_synonyms::ANNOTATIONS,
            vec![Some(AppCommand::ToggleOverlay), Some(AppCommand::Export)],
        ),
        supported(palette_synonyms::SKY, vec![reveal_row(sections::SOFT_LIGHT, Some(text::sky::MODE.name))]),
        supported(
            palette_synonyms::WINDOW_LEVEL,
            vec![
                reveal_row(text::transfer::TITLE, Some(text::transfer::LEVEL.name)),
                reveal_row(text::transfer::TITLE, Some(text::transfer::WINDOW.name)),
                Some(AppCommand::ShowSlices),
            ],
        ),
        supported(
            palette_synonyms::FEWER_VOXELS,
            vec![
                reveal_row(sections::DATA, Some(text::data::SUBSAMPLE.name)),
                Some(AppCommand::Subsample(Downsampling::Average(2))),
                Some(AppCommand::Subsample(Downsampling::Every(2))),
            ],
        ),
        supported(
            palette_synonyms::RAY_PROJECTIONS,
            [RenderMode::Maximum, RenderMode::Minimum, RenderMode::Mean]
                .map(|mode| Some(AppCommand::UseRenderMode(mode)))
                .to_vec(),
        ),
        supported(palette_synonyms::TABLE, vec![Some(AppCommand::ToggleTable)]),
        supported(palette_synonyms::ISOSURFACE, vec![Some(AppCommand::UseRenderMode(RenderMode::Surface))]),
        supported(
            palette_synonyms::PLAYING,
            vec![
                Some(AppCommand::TogglePlayback),
                Some(AppCommand::StepChoice(frame, true)),
                Some(AppCommand::ShowChooser(frame)),
            ],
        ),
        supported(
            palette_synonyms::COMPOSITE,
            vec![Some(AppCommand::ShowTogether(channel)), Some(AppCommand::ShowChooser(channel))],
        ),
        missing(palette_synonyms::NO_ANNOTATION, vec![Some(AppCommand::Export)]),
        missing(
            palette_synonyms::NO_FILTER,
            vec![
                reveal_row(sections::CAMERA, Some(text::sampling::KERNEL.name)),
                reveal_row(sections::SHADING, Some(text::shading::SURFACE_GRADIENT.name)),
                Some(AppCommand::Subsample(Downsampling::Average(2))),
            ],
        ),
        missing(palette_synonyms::NO_STEREO, Vec::new()),
        supported(palette_synonyms::FUSION, vec![Some(AppCommand::AddLayer)]),
        missing(
            palette_synonyms::NO_DEPTH_OF_FIELD,
            vec![reveal_row(sections::CAMERA, Some(text::camera::FIELD_OF_VIEW.name))],
        ),
        supported(
            palette_synonyms::OBJECTS,
            vec![Some(AppCommand::CutByShape(CutShapeKind::Component)), Some(AppCommand::ToggleCrop)],
        ),
        supported(
            palette_synonyms::SCISSORS,
            vec![Some(AppCommand::CutByShape(CutShapeKind::Outline)), Some(AppCommand::TogglePlane)],
        ),
    ];
    all.push(if has_labels {
        supported(palette_synonyms::LABELS, vec![reveal_row(text::labels::TITLE, None)])
    } else {
        let as_labels = AppCommand::TreatAs(Some(KindName::LabelMap));
        missing(palette_synonyms::NO_SEGMENTATION, vec![Some(AppCommand::OpenDialog), Some(as_labels)])
    });
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::common::commands::searchable_commands;

    #[test]
    fn every_target_exists() {
        let commands = searchable_commands();
        for has_labels in [false, true] {
            for Synonym { search_words: sought, is_supported: is_there, targets } in synonym_table(has_labels)
            {
                assert!(targets.iter().all(|target| commands.contains(target)), "{sought:?}: {targets:?}");
                // Stereo pictures are the only feature without a nearest command.
                let is_led = !targets.is_empty() || sought == palette_synonyms::NO_STEREO;
                assert!(is_led && (is_there || !sought.note.is_empty()), "{sought:?}");
                assert!(
                    !sought.words.is_empty() && sought.words.to_lowercase() == sought.words,
                    "{sought:?}"
                );
            }
        }
    }

    /// Guards against rows that no panel has, which would be left out silently.
    #[test]
    fn rows_are_those_of_the_panels() {
        let source = include_str!("synonyms.rs").split("#[cfg(test)]").next().unwrap_or_default();
        let named = source.matches("row(sections::").count() + source.matches("row(text::").count();
        let mut rows: Vec<_> = [false, true]
            .into_iter()
            .flat_map(synonym_table)
            .flat_map(|synonym| synonym.targets)
            .filter_map(|target| match target {
                AppCommand::Reveal(place) => Some((place.section, place.row)),
                _ => None,
            })
            .collect();
        rows.sort_unstable();
        rows.dedup();
        assert_eq!(rows.len(), named, "{rows:?}");
    }
}
