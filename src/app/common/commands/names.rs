//! Names of commands, and further words by which they are found.

use std::borrow::Cow;

use super::AppCommand;
use crate::app::common::searchable_settings::synonyms_of;
use crate::app::text;
use chiaroscuro_scene::{COLOR_MAPS, ObjectRotation, SceneAxis};

impl AppCommand {
    /// Returns the name while this axis of the scene points up; the names of standard views depend on it.
    pub(crate) fn label_with(&self, up: SceneAxis) -> Cow<'static, str> {
        match self {
            Self::LookFrom(view) => text::commands::look_from(view.name(up)).into(),
            other => other.label(),
        }
    }

    /// Returns search words in addition to the name and to the synonyms of the palette.
    pub(crate) fn search_words(&self) -> &'static str {
        match self {
            Self::Reveal(place) => synonyms_of(*place),
            // The domain, and the name on the command line.
            Self::UsePreset(preset) | Self::OpenScene(preset) => preset.name,
            _ => "",
        }
    }

    /// Returns the name of the command for menus and help.
    pub(crate) fn label(&self) -> Cow<'static, str> {
        let label = match self {
            Self::LookFrom(view) => return text::commands::look_from(view.name(SceneAxis::default())).into(),
            Self::TurnObject(ObjectRotation::MakeUpright(axis)) => {
                return text::commands::upright(text::camera::axis(*axis).name).into();
            }
            Self::TurnObject(ObjectRotation::TipBack) => text::commands::TILT,
            Self::RotateObject => text::commands::ROTATE,
            Self::UseRig(rig) => return text::commands::use_rig(rig.name()).into(),
            Self::UsePreset(preset) => return text::commands::use_preset(preset.title).into(),
            Self::UseColors(at, back) => {
                let name = COLOR_MAPS.get(*at).map_or("", |map| map.name);
                return text::commands::use_colors(name, *back).into();
            }
            Self::TreatAs(kind) => return text::commands::treat_as(*kind).into(),
            Self::ShowChooser(aspect) => return text::chooser::command(*aspect).into(),
            Self::StepChoice(aspect, is_forward) => return text::chooser::step(*aspect, *is_forward).into(),
            Self::OpenChoice(..) => text::commands::SHOW_CHOICE,
            Self::OpenScene(scene) => return text::commands::open_scene(scene.title).into(),
            Self::ShowStart => text::commands::SHOW_START,
            Self::OpenAgain(..) => text::menu::OPEN_RECENT,
            Self::Subsample(thinning) => return text::commands::subsample(*thinning).into(),
            Self::TogglePlayback => text::commands::TOGGLE_PLAYBACK,
            Self::UseNumberedFiles => text::commands::USE_NUMBERED_FILES,
            Self::MeasureSeriesRange => text::commands::MEASURE_SERIES_RANGE,
            Self::AddLayer => text::commands::ADD_LAYER,
            Self::ShowTogether(aspect) => text::chooser::show_together(*aspect),
            Self::RemoveLayer => text::commands::REMOVE_LAYER,
            Self::ImportTransfer => text::commands::IMPORT_TRANSFER,
            Self::ExportTransfer => text::commands::EXPORT_TRANSFER,
            Self::InvertTransfer => text::commands::INVERT_TRANSFER,
            Self::SaveView => text::commands::SAVE_VIEW,
            Self::SaveLookInStrip => text::commands::SAVE_LOOK,
            Self::GoToSaved(..) => text::commands::GO_TO_SAVED,
            Self::ReplaceSaved(_) => text::saved_views::REPLACE.name,
            Self::CompareSaved(..) => text::saved_views::COMPARE.name,
            Self::ExportContactSheet => text::commands::EXPORT_CONTACT_SHEET,
            Self::ToggleStrip => text::commands::TOGGLE_STRIP,
            Self::StoreView(slot) => return text::commands::store_view(*slot).into(),
            Self::RecallView(slot) => return text::commands::recall_view(*slot).into(),
            Self::FrameAll => text::commands::FRAME_ALL,
            Self::NextRenderMode => text::commands::NEXT_RENDER_MODE,
            Self::UseRenderMode(mode) => {
                return text::commands::use_render_mode(text::shading::mode_text(*mode).name).into();
            }
            Self::ToggleProjection => text::commands::TOGGLE_PROJECTION,
            Self::ToggleFullScreen => text::commands::TOGGLE_FULL_SCREEN,
            Self::ToggleOverlay => text::commands::TOGGLE_OVERLAY,
            Self::ToggleProbe => text::commands::TOGGLE_PROBE,
            Self::ToggleCrop => text::commands::TOGGLE_CROP,
            Self::TogglePlane => text::commands::TOGGLE_PLANE,
            Self::FacePlane => text::commands::FACE_PLANE,
            Self::CutByShape(kind) => text::cuts::cut_by_shape(*kind).name,
            Self::PickMaterials => text::materials::PICK.name,
            Self::RemoveShapeCuts => text::cuts::REMOVE_SHAPES.name,
            Self::ToggleFloor => text::commands::TOGGLE_FLOOR,
            Self::ToggleTable => text::commands::TOGGLE_TABLE,
            Self::ShowPalette => text::commands::SHOW_PALETTE,
            Self::UseLights(_) => text::commands::USE_LIGHTS,
            Self::UseLook(_) => text::commands::USE_LOOK,
            Self::TryLooks => text::commands::TRY_LOOKS,
            Self::SuggestLight => text::commands::SUGGEST_LIGHT,
            Self::Reveal(place) => return text::commands::reveal(place.section, place.row).into(),
            Self::CancelExport => text::commands::CANCEL_EXPORT,
            Self::UseEnvironmentMap => text::commands::USE_ENVIRONMENT_MAP,
            Self::TryLights => text::commands::TRY_LIGHTS,
            Self::TryPresets => text::commands::TRY_PRESETS,
            Self::NextLight => text::commands::NEXT_LIGHT,
            Self::PreviousLight => text::commands::PREVIOUS_LIGHT,
            Self::Solo => text::commands::SOLO,
            Self::Mute => text::commands::MUTE,
            Self::Brighter => text::commands::BRIGHTER,
            Self::Dimmer => text::commands::DIMMER,
            Self::OpenDialog => text::commands::OPEN_DIALOG,
            Self::OpenFolder => text::commands::OPEN_FOLDER,
            Self::NextFile => text::commands::NEXT_FILE,
            Self::PreviousFile => text::commands::PREVIOUS_FILE,
            Self::OpenDropped(_) => text::commands::OPEN_DROPPED,
            Self::OpenPath => text::commands::OPEN_PATH,
            Self::Open(_) => text::commands::OPEN_BUILT_IN,
            Self::CancelOpening => text::commands::CANCEL_OPENING,
            Self::ReopenLast => text::commands::REOPEN_LAST,
            Self::SaveSettings => text::commands::SAVE_SETTINGS,
            Self::LoadSettings => text::commands::LOAD_SETTINGS,
            Self::Export => text::commands::EXPORT,
            Self::CopyPicture => text::commands::COPY_PICTURE,
            Self::ToggleKeepLook => text::commands::KEEP_LOOK_FOR_NEXT,
            Self::Quit => text::commands::QUIT,
            Self::Undo => text::commands::UNDO,
            Self::Redo => text::commands::REDO,
            Self::ToggleHistory => text::commands::TOGGLE_HISTORY,
            Self::GoSteps(_) => text::history::TITLE,
            Self::ToggleMessages => text::commands::TOGGLE_MESSAGES,
            Self::ResetView => text::commands::RESET_VIEW,
            Self::AddLight => text::commands::ADD_LIGHT,
            Self::AutomaticTransfer => text::commands::AUTOMATIC_TRANSFER,
            Self::Balance => text::commands::BALANCE,
            Self::ToggleSide => text::commands::TOGGLE_SIDE,
            Self::Scale(1) => text::commands::LARGER,
            Self::Scale(-1) => text::commands::SMALLER,
            Self::Scale(_) => text::commands::DEFAULT_SIZE,
            Self::ToggleTransfer => text::commands::TOGGLE_TRANSFER,
            Self::TogglePictureOnly => text::commands::PICTURE_ONLY,
            Self::ToggleHandles => text::commands::TOGGLE_HANDLES,
            Self::ToggleCompare => text::commands::TOGGLE_COMPARE,
            Self::ShowSlices => text::commands::SHOW_SLICES,
            Self::ShowLightVolume => text::commands::SHOW_LIGHT_VOLUME,
            Self::CompareWithFile => text::commands::COMPARE_WITH_FILE,
            Self::ShowHelp => text::help::KEYS_AND_MOUSE,
            Self::ShowAbout => text::help::ABOUT,
        };
        label.into()
    }
}
