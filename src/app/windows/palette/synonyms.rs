//! Synonyms of commands and settings, and features that the program lacks, with the commands nearest to them.

use crate::app::common::commands::Command;
use crate::app::common::places::PLACES;
use crate::app::text::palette::{self, Sought};
use crate::app::text::{self, sections};
use crate::data::KindName;
use crate::data::load::{Aspect, Dimension, Thinning};
use crate::model::ObjectTurn;

/// Search words with the commands that they lead to.
#[derive(Debug)]
pub(super) struct Synonym {
    /// Search words, and the remark shown for them.
    pub sought: Sought,
    /// True if the program has the feature; otherwise the remark says that it is missing.
    pub is_there: bool,
    /// Commands that are meant, or else the nearest ones, best first.
    pub targets: Vec<Command>,
}

/// Command that reveals a row of a panel, or a section as a whole.
fn row(section: &str, row: Option<&str>) -> Option<Command> {
    let place = PLACES.iter().map(|(place, _)| *place);
    place.into_iter().find(|place| place.section == section && place.row == row).map(Command::Reveal)
}

/// Table of synonyms, for a volume with or without labels.
pub(super) fn all(has_labels: bool) -> Vec<Synonym> {
    let here = |sought, targets: Vec<Option<Command>>| Synonym {
        sought,
        is_there: true,
        targets: targets.into_iter().flatten().collect(),
    };
    let missing = |sought, targets| Synonym { is_there: false, ..here(sought, targets) };
    let channel = Aspect::Of(Dimension::Channel);
    let frame = Aspect::Of(Dimension::Frame);
    let series = Aspect::Of(Dimension::Series);
    let mut all = vec![
        here(palette::TURN_OBJECT, vec![Some(Command::TurnObject(ObjectTurn::Over))]),
        here(palette::TURN_ROUND, vec![Some(Command::TurnRound)]),
        here(palette::SCALE, [1, -1, 0].map(Command::Scale).map(Some).to_vec()),
        here(palette::GO_ON, vec![Some(Command::GoOn)]),
        here(palette::SAVE, vec![Some(Command::SaveSettings)]),
        here(palette::TRANSFER, vec![Some(Command::ImportTransfer)]),
        here(palette::SOLO, vec![Some(Command::Solo)]),
        here(palette::MUTE, vec![Some(Command::Mute)]),
        here(palette::COMPARE, vec![Some(Command::ToggleCompare)]),
        here(palette::PICTURE_ONLY, vec![Some(Command::TogglePictureOnly)]),
        here(palette::EXPORT, vec![Some(Command::Export)]),
        here(palette::ANIMATION, vec![Some(Command::Export)]),
        here(palette::MEASURE, vec![Some(Command::ToggleProbe)]),
        here(palette::MARKS, vec![Some(Command::ToggleOverlay), Some(Command::Export)]),
        here(palette::SKY, vec![row(sections::SOFT_LIGHT, Some(text::sky::MODE.name))]),
        here(
            palette::WINDOW_LEVEL,
            vec![
                row(text::transfer::TITLE, Some(text::transfer::LEVEL.name)),
                row(text::transfer::TITLE, Some(text::transfer::WINDOW.name)),
                Some(Command::ShowSlices),
            ],
        ),
        here(
            palette::FEWER_VOXELS,
            vec![
                row(sections::DATA, Some(text::data::THINNING.name)),
                Some(Command::Thin(Thinning::Average(2))),
                Some(Command::Thin(Thinning::Every(2))),
            ],
        ),
        missing(
            palette::NO_PLAYING,
            vec![Some(Command::StepChoice(frame, true)), Some(Command::Choose(frame))],
        ),
        missing(
            palette::NO_COMPOSITE,
            vec![Some(Command::Choose(channel)), Some(Command::StepChoice(channel, true))],
        ),
        missing(palette::NO_PROJECTION, vec![Some(Command::TryLooks)]),
        missing(palette::NO_ANNOTATION, vec![Some(Command::Export)]),
        missing(
            palette::NO_FILTER,
            vec![
                row(sections::CAMERA, Some(text::sampling::KERNEL.name)),
                row(sections::SHADING, Some(text::shading::SURFACE_GRADIENT.name)),
                Some(Command::Thin(Thinning::Average(2))),
            ],
        ),
        missing(palette::NO_STEREO, Vec::new()),
        missing(palette::NO_FUSION, vec![Some(Command::Choose(series)), Some(Command::NextFile)]),
        missing(
            palette::NO_DEPTH_OF_FIELD,
            vec![row(sections::CAMERA, Some(text::camera::FIELD_OF_VIEW.name))],
        ),
        missing(palette::NO_OBJECTS, vec![Some(Command::ToggleCrop), Some(Command::TogglePlane)]),
    ];
    all.push(if has_labels {
        here(palette::LABELS, vec![row(text::labels::TITLE, None)])
    } else {
        let as_labels = Command::TreatAs(Some(KindName::LabelMap));
        missing(palette::NO_SEGMENTATION, vec![Some(Command::OpenDialog), Some(as_labels)])
    });
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::common::commands::listed;

    #[test]
    fn every_target_exists() {
        let commands = listed();
        for has_labels in [false, true] {
            for Synonym { sought, is_there, targets } in all(has_labels) {
                assert!(targets.iter().all(|target| commands.contains(target)), "{sought:?}: {targets:?}");
                // Stereo pictures are the only feature without a nearest command.
                let is_led = !targets.is_empty() || sought == palette::NO_STEREO;
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
            .flat_map(all)
            .flat_map(|synonym| synonym.targets)
            .filter_map(|target| match target {
                Command::Reveal(place) => Some((place.section, place.row)),
                _ => None,
            })
            .collect();
        rows.sort_unstable();
        rows.dedup();
        assert_eq!(rows.len(), named, "{rows:?}");
    }
}
