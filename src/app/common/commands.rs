//! What menus, keys and buttons ask for. Collected during a frame, carried out at its end.

use std::borrow::Cow;
use std::path::PathBuf;

use crate::app::text;
use crate::model::{COLOR_MAPS, Light, PRESETS, Preset, Rig, Settings, StandardView};

/// Something the user asked for.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Command {
    /// Ask for a volume and open it.
    OpenDialog,
    /// Show the window for typing a path.
    OpenPath,
    /// Open a file or a built-in volume.
    Open(PathBuf),
    /// Read the open volume again, so many voxels along each axis averaged into one.
    Average(usize),
    /// Stop opening.
    CancelOpening,
    /// The volume and the look with which the run before ended.
    GoOn,
    /// Save the settings where they belong, or ask where.
    SaveSettings,
    /// Ask for settings and apply them.
    LoadSettings,
    /// Put the picture on the clipboard.
    CopyPicture,
    /// Show the next volume as this one, or not.
    KeepLook,
    /// Show the export window.
    Export,
    /// Close the window.
    Quit,
    /// One step back.
    Undo,
    /// One step forward again.
    Redo,
    /// The camera as it was when the volume was opened.
    ResetView,
    /// All of the volume, from where the eye is.
    FrameAll,
    /// From a side.
    LookFrom(StandardView),
    /// Perspective or orthographic.
    ToggleProjection,
    /// Keep the view under a digit.
    StoreView(u8),
    /// Look from the view that is kept under a digit.
    RecallView(u8),
    /// The window fills the screen, or not.
    ToggleFullScreen,
    /// Show or hide the chips of the lights, box, scale bar and cube.
    ToggleOverlay,
    /// Say what is under the pointer, and what light gets there.
    ToggleProbe,
    /// Find a command by its name.
    ShowPalette,
    /// Add a light.
    AddLight,
    /// Other lights instead of those that are there.
    UseRig(Rig),
    /// These lights.
    UseLights(Vec<Light>),
    /// This look, whole.
    UseLook(Box<Settings>),
    /// Show the contact sheet of looks.
    TryLooks,
    /// Show the contact sheet of lights.
    TryLights,
    /// Show the best places for the selected light.
    SuggestLight,
    /// Show the contact sheet of presets.
    TryPresets,
    /// Select the light after the selected one.
    NextLight,
    /// Select the light before the selected one.
    PreviousLight,
    /// Only the selected light shines, or all.
    Solo,
    /// The selected light shines or not.
    Mute,
    /// Make the selected light brighter.
    Brighter,
    /// Make the selected light dimmer.
    Dimmer,
    /// The automatic transfer function.
    AutomaticTransfer,
    /// One of the library.
    UsePreset(Preset),
    /// Other colours for the visible values: the index of a colour map, and whether it is reversed.
    UseColors(usize, bool),
    /// Ask for a transfer function of another program.
    ImportTransfer,
    /// Ask where to write the transfer function for other programs.
    ExportTransfer,
    /// Opacities the other way round.
    InvertTransfer,
    /// Crop to the box, or show all.
    ToggleCrop,
    /// Cut at the plane, or show all.
    TogglePlane,
    /// The plane across the line of sight, through what the eye turns about.
    FacePlane,
    /// Show the floor under the volume, or not.
    ToggleFloor,
    /// Measure the brightness and set the balance.
    Balance,
    /// Show or hide the side panel.
    ToggleSide,
    /// Show or hide the handles of the lights.
    ToggleHandles,
    /// Show two looks in one picture, or one again.
    ToggleCompare,
    /// Show cuts through the data, or not.
    ShowSlices,
    /// Show a slice of a light volume.
    ShowLightVolume,
    /// Ask for settings to compare with.
    CompareWithFile,
    /// Show keys and mouse.
    ShowHelp,
    /// Show what this is and what it runs on.
    ShowAbout,
}

/// Digits under which views are kept.
pub(crate) const VIEW_SLOTS: std::ops::RangeInclusive<u8> = 1..=9;

/// Every command that can be asked for by its name.
pub(crate) fn listed() -> Vec<Command> {
    let mut all = vec![
        Command::OpenDialog,
        Command::OpenPath,
        Command::GoOn,
        Command::SaveSettings,
        Command::LoadSettings,
        Command::Export,
        Command::CopyPicture,
        Command::KeepLook,
        Command::Undo,
        Command::Redo,
        Command::ResetView,
        Command::FrameAll,
        Command::ToggleProjection,
        Command::ToggleFullScreen,
        Command::ToggleOverlay,
        Command::ToggleProbe,
        Command::ToggleCrop,
        Command::TogglePlane,
        Command::FacePlane,
        Command::ToggleFloor,
        Command::AddLight,
        Command::TryLooks,
        Command::TryLights,
        Command::SuggestLight,
        Command::TryPresets,
        Command::NextLight,
        Command::PreviousLight,
        Command::Solo,
        Command::Mute,
        Command::Brighter,
        Command::Dimmer,
        Command::Balance,
        Command::AutomaticTransfer,
        Command::InvertTransfer,
        Command::ImportTransfer,
        Command::ExportTransfer,
        Command::ToggleSide,
        Command::ToggleHandles,
        Command::ToggleCompare,
        Command::CompareWithFile,
        Command::ShowSlices,
        Command::ShowLightVolume,
        Command::ShowHelp,
        Command::ShowAbout,
        Command::Quit,
    ];
    all.extend([1, 2, 4].map(Command::Average));
    all.extend(StandardView::ALL.map(Command::LookFrom));
    all.extend(Rig::ALL.map(Command::UseRig));
    all.extend(PRESETS.map(Command::UsePreset));
    all.extend((0..COLOR_MAPS.len()).flat_map(|at| [false, true].map(|back| Command::UseColors(at, back))));
    all.extend(VIEW_SLOTS.map(Command::StoreView));
    all.extend(VIEW_SLOTS.map(Command::RecallView));
    all
}

impl Command {
    /// What help calls it.
    pub(crate) fn label(&self) -> Cow<'static, str> {
        let label = match self {
            Self::LookFrom(view) => return text::commands::look_from(view.name()).into(),
            Self::UseRig(rig) => return text::commands::use_rig(rig.name()).into(),
            Self::UsePreset(preset) => {
                return text::commands::use_preset(preset.domain(), &preset.title()).into();
            }
            Self::UseColors(at, back) => {
                let name = COLOR_MAPS.get(*at).map_or("", |map| map.name);
                return text::commands::use_colors(name, *back).into();
            }
            Self::Average(block) => return text::commands::average(*block).into(),
            Self::ImportTransfer => text::commands::IMPORT_TRANSFER,
            Self::ExportTransfer => text::commands::EXPORT_TRANSFER,
            Self::InvertTransfer => text::commands::INVERT_TRANSFER,
            Self::StoreView(slot) => return text::commands::store_view(*slot).into(),
            Self::RecallView(slot) => return text::commands::recall_view(*slot).into(),
            Self::FrameAll => text::commands::FRAME_ALL,
            Self::ToggleProjection => text::commands::TOGGLE_PROJECTION,
            Self::ToggleFullScreen => text::commands::TOGGLE_FULL_SCREEN,
            Self::ToggleOverlay => text::commands::TOGGLE_OVERLAY,
            Self::ToggleProbe => text::commands::TOGGLE_PROBE,
            Self::ToggleCrop => text::commands::TOGGLE_CROP,
            Self::TogglePlane => text::commands::TOGGLE_PLANE,
            Self::FacePlane => text::commands::FACE_PLANE,
            Self::ToggleFloor => text::commands::TOGGLE_FLOOR,
            Self::ShowPalette => text::commands::SHOW_PALETTE,
            Self::UseLights(_) => text::commands::USE_LIGHTS,
            Self::UseLook(_) => text::commands::USE_LOOK,
            Self::TryLooks => text::commands::TRY_LOOKS,
            Self::TryLights => text::commands::TRY_LIGHTS,
            Self::SuggestLight => text::commands::SUGGEST_LIGHT,
            Self::TryPresets => text::commands::TRY_PRESETS,
            Self::NextLight => text::commands::NEXT_LIGHT,
            Self::PreviousLight => text::commands::PREVIOUS_LIGHT,
            Self::Solo => text::commands::SOLO,
            Self::Mute => text::commands::MUTE,
            Self::Brighter => text::commands::BRIGHTER,
            Self::Dimmer => text::commands::DIMMER,
            Self::OpenDialog => text::commands::OPEN_DIALOG,
            Self::OpenPath => text::commands::OPEN_PATH,
            Self::Open(_) => text::commands::OPEN_BUILT_IN,
            Self::CancelOpening => text::commands::CANCEL_OPENING,
            Self::GoOn => text::commands::GO_ON,
            Self::SaveSettings => text::commands::SAVE_SETTINGS,
            Self::LoadSettings => text::commands::LOAD_SETTINGS,
            Self::Export => text::commands::EXPORT,
            Self::CopyPicture => text::commands::COPY_PICTURE,
            Self::KeepLook => text::commands::KEEP_LOOK,
            Self::Quit => text::commands::QUIT,
            Self::Undo => text::commands::UNDO,
            Self::Redo => text::commands::REDO,
            Self::ResetView => text::commands::RESET_VIEW,
            Self::AddLight => text::commands::ADD_LIGHT,
            Self::AutomaticTransfer => text::commands::AUTOMATIC_TRANSFER,
            Self::Balance => text::commands::BALANCE,
            Self::ToggleSide => text::commands::TOGGLE_SIDE,
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
