//! Commands of menus, keys and buttons: collected during a frame, and executed at its end.

mod names;

use std::path::PathBuf;

use super::reveal::SettingPlace;
use super::searchable_settings::SEARCHABLE_SETTINGS;
use chiaroscuro_scene::{
    COLOR_MAPS, CutShapeKind, DIGIT_KEYS, LightSettings, LightingRig, ObjectRotation, PRESETS, Preset,
    RenderMode, SceneAxis, Settings, StandardView,
};
use chiaroscuro_volume::{ChoiceAspect, Downsampling, KindName, VolumeChoice};

/// Subsamplings that commands and the data section offer.
pub(crate) const SUBSAMPLINGS: [Downsampling; 5] = [
    Downsampling::None,
    Downsampling::Every(2),
    Downsampling::Average(2),
    Downsampling::Every(4),
    Downsampling::Average(4),
];

/// Command that the user issues by a menu, key or button.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum AppCommand {
    /// Ask for a volume and open it.
    OpenDialog,
    /// Ask for a folder of slices and open it.
    OpenFolder,
    /// Show the window for typing a path.
    OpenPath,
    /// Open files that were dropped on the window.
    OpenDropped(Vec<PathBuf>),
    /// Open the next file in the folder of the open file.
    NextFile,
    /// Open the previous file in the folder of the open file.
    PreviousFile,
    /// Open a file or a built-in volume.
    Open(PathBuf),
    /// Open a built-in volume with the scene that this preset of the library is.
    OpenScene(Preset),
    /// Show the start screen with the built-in scenes and recent files.
    ShowStart,
    /// Open a recent file, and the volume of it that was open then.
    OpenAgain(PathBuf, VolumeChoice),
    /// Show the chooser of the open file's volumes in an aspect.
    ShowChooser(ChoiceAspect),
    /// Open the next (`true`) or the previous (`false`) volume of the open file.
    StepChoice(ChoiceAspect, bool),
    /// Open another volume of the open file; `true` keeps the look.
    OpenChoice(Box<VolumeChoice>, bool),
    /// Play the time steps of the open volume, or stop at the one that is shown.
    TogglePlayback,
    /// Show the numbered files beside the open one as time steps.
    UseNumberedFiles,
    /// Read the range of values of all time steps, and use it.
    MeasureSeriesRange,
    /// Read the open volume again with another subsampling.
    Subsample(Downsampling),
    /// Cancel opening and reading files.
    CancelOpening,
    /// Reopen the volume with the look of the previous run.
    ReopenLast,
    /// Save the session to its file, or ask for a file.
    SaveSettings,
    /// Ask for settings and apply them.
    LoadSettings,
    /// Copy the picture to the clipboard.
    CopyPicture,
    /// Toggle keeping the look for the next volume.
    ToggleKeepLook,
    /// Show the export dialog for pictures and turntables.
    Export,
    /// Cancel the export in progress.
    CancelExport,
    /// Close the window, which ends the program.
    Quit,
    /// Undo the last step of the history.
    Undo,
    /// Redo the step that was undone last.
    Redo,
    /// Show or hide the list of undo steps.
    ToggleHistory,
    /// Go this many steps forward, or back if it is negative.
    GoSteps(i32),
    /// Show or hide the list of all messages.
    ToggleMessages,
    /// Reset the camera to that of the first look.
    ResetView,
    /// Frame the whole object from the current direction.
    FrameAll,
    /// Look at the object from a standard view.
    LookFrom(StandardView),
    /// Turn the object over, or upright.
    TurnObject(ObjectRotation),
    /// Orbit the camera by 90° about the vertical, as if the object turned.
    RotateObject,
    /// Switch between perspective and orthographic projection.
    ToggleProjection,
    /// Show the volume in the next render mode.
    NextRenderMode,
    /// Show the volume in a render mode.
    UseRenderMode(RenderMode),
    /// Save the view in the strip.
    SaveView,
    /// Save the look in the strip.
    SaveLookInStrip,
    /// Save the view under a digit.
    StoreView(u8),
    /// Go to the view or look saved under a digit.
    RecallView(u8),
    /// Go to a saved view or look by its index; `true` takes the view of a look, too.
    GoToSaved(usize, bool),
    /// Replace a saved view or look by what is shown.
    ReplaceSaved(usize),
    /// Compare two saved looks, or the picture (`None`) with one.
    CompareSaved(Option<usize>, usize),
    /// Export a contact sheet of all saved views and looks.
    ExportContactSheet,
    /// Show or hide the strip of saved views and looks.
    ToggleStrip,
    /// Switch full screen on or off.
    ToggleFullScreen,
    /// Show or hide the light chips, bounding box, scale bar and orientation cube.
    ToggleOverlay,
    /// Switch the probe on or off, which explains the light under the pointer.
    ToggleProbe,
    /// Begin or end cutting by shapes of a kind in the picture; of boxes, hide the corner that faces the camera.
    CutByShape(CutShapeKind),
    /// Begin or end making materials from clicks in the picture.
    PickMaterials,
    /// Show all that cuts by shapes hide, by removing them.
    RemoveShapeCuts,
    /// Show the palette that finds commands by name.
    ShowPalette,
    /// Add a light beside the camera.
    AddLight,
    /// Replace the lights by a rig.
    UseRig(LightingRig),
    /// Replace the lights by the given lights.
    UseLights(Vec<LightSettings>),
    /// Replace the look by the given look.
    UseLook(Box<Settings>),
    /// Show the contact sheet of looks.
    TryLooks,
    /// Show the contact sheet of lights.
    TryLights,
    /// Show the best positions for the selected light.
    SuggestLight,
    /// Ask for an environment map, and light the scene by it.
    UseEnvironmentMap,
    /// Show the contact sheet of presets.
    TryPresets,
    /// Select the next light of the list.
    NextLight,
    /// Select the previous light of the list.
    PreviousLight,
    /// Switch off all lights but the selected one, or all on again.
    Solo,
    /// Switch the selected light on or off.
    Mute,
    /// Make the selected light brighter.
    Brighter,
    /// Make the selected light dimmer.
    Dimmer,
    /// Apply the automatic transfer function.
    AutomaticTransfer,
    /// Make a first look for this kind of data, or for the volume's own (`None`).
    TreatAs(Option<KindName>),
    /// Apply a preset of the library.
    UsePreset(Preset),
    /// Colour the visible values by a colour map, given by its index; `true` reverses it.
    UseColors(usize, bool),
    /// Ask for a volume to show with the one that is open.
    AddLayer,
    /// Show all channels or components of the open file together, as layers.
    ShowTogether(ChoiceAspect),
    /// Show the volume of the selected layer no longer.
    RemoveLayer,
    /// Ask for a transfer function of another program.
    ImportTransfer,
    /// Ask for a file, and write the transfer function for other programs.
    ExportTransfer,
    /// Invert the opacities of the transfer function.
    InvertTransfer,
    /// Switch the crop box on or off.
    ToggleCrop,
    /// Switch the clip plane on or off.
    TogglePlane,
    /// Turn the clip plane across the line of sight, through the point about which the camera orbits.
    FacePlane,
    /// Show or hide the floor under the volume.
    ToggleFloor,
    /// Hide or show the table under a body.
    ToggleTable,
    /// Measure the brightness and set the balance.
    Balance,
    /// Show or hide the side panel.
    ToggleSide,
    /// Show or hide the transfer function editor.
    ToggleTransfer,
    /// Show the picture alone, or the panels again.
    TogglePictureOnly,
    /// Enlarge (1) or shrink (−1) the interface, or reset its size (0).
    Scale(i8),
    /// Show or hide the handles in the picture.
    ToggleHandles,
    /// Switch the comparison of two looks on or off.
    ToggleCompare,
    /// Show or hide the window of orthogonal slices.
    ShowSlices,
    /// Show the window with slices of a light volume.
    ShowLightVolume,
    /// Ask for settings to compare with.
    CompareWithFile,
    /// Reveal a setting in its section.
    Reveal(SettingPlace),
    /// Show or hide the help on keys and mouse.
    ShowHelp,
    /// Show the program's version and its graphics device.
    ShowAbout,
}

/// Lists every command that can be found by its name.
pub(crate) fn searchable_commands() -> Vec<AppCommand> {
    let mut all = vec![
        AppCommand::ShowStart,
        AppCommand::OpenDialog,
        AppCommand::OpenFolder,
        AppCommand::AddLayer,
        AppCommand::RemoveLayer,
        AppCommand::OpenPath,
        AppCommand::NextFile,
        AppCommand::PreviousFile,
        AppCommand::TogglePlayback,
        AppCommand::UseNumberedFiles,
        AppCommand::MeasureSeriesRange,
        AppCommand::ReopenLast,
        AppCommand::SaveSettings,
        AppCommand::LoadSettings,
        AppCommand::Export,
        AppCommand::CopyPicture,
        AppCommand::ToggleKeepLook,
        AppCommand::Undo,
        AppCommand::Redo,
        AppCommand::ToggleHistory,
        AppCommand::ToggleMessages,
        AppCommand::ResetView,
        AppCommand::FrameAll,
        AppCommand::TurnObject(ObjectRotation::TipBack),
        AppCommand::RotateObject,
        AppCommand::ToggleProjection,
        AppCommand::NextRenderMode,
        AppCommand::ToggleFullScreen,
        AppCommand::ToggleOverlay,
        AppCommand::ToggleProbe,
        AppCommand::ToggleCrop,
        AppCommand::TogglePlane,
        AppCommand::FacePlane,
        AppCommand::CutByShape(CutShapeKind::Outline),
        AppCommand::CutByShape(CutShapeKind::Sphere),
        AppCommand::CutByShape(CutShapeKind::Box),
        AppCommand::CutByShape(CutShapeKind::HalfSpace),
        AppCommand::CutByShape(CutShapeKind::Component),
        AppCommand::RemoveShapeCuts,
        AppCommand::PickMaterials,
        AppCommand::ToggleFloor,
        AppCommand::ToggleTable,
        AppCommand::AddLight,
        AppCommand::TryLooks,
        AppCommand::TryLights,
        AppCommand::SuggestLight,
        AppCommand::UseEnvironmentMap,
        AppCommand::TryPresets,
        AppCommand::NextLight,
        AppCommand::PreviousLight,
        AppCommand::Solo,
        AppCommand::Mute,
        AppCommand::Brighter,
        AppCommand::Dimmer,
        AppCommand::Balance,
        AppCommand::AutomaticTransfer,
        AppCommand::InvertTransfer,
        AppCommand::ImportTransfer,
        AppCommand::ExportTransfer,
        AppCommand::ToggleSide,
        AppCommand::ToggleTransfer,
        AppCommand::TogglePictureOnly,
        AppCommand::ToggleStrip,
        AppCommand::Scale(1),
        AppCommand::Scale(-1),
        AppCommand::Scale(0),
        AppCommand::SaveView,
        AppCommand::SaveLookInStrip,
        AppCommand::ExportContactSheet,
        AppCommand::ToggleHandles,
        AppCommand::ToggleCompare,
        AppCommand::CompareWithFile,
        AppCommand::ShowSlices,
        AppCommand::ShowLightVolume,
        AppCommand::ShowHelp,
        AppCommand::ShowAbout,
        AppCommand::Quit,
    ];
    all.extend(SUBSAMPLINGS.map(AppCommand::Subsample));
    all.extend(ChoiceAspect::ALL.map(AppCommand::ShowChooser));
    all.extend(ChoiceAspect::SHOWN_TOGETHER.map(AppCommand::ShowTogether));
    all.extend(
        ChoiceAspect::ALL
            .into_iter()
            .flat_map(|aspect| [true, false].map(|on| AppCommand::StepChoice(aspect, on))),
    );
    all.extend(KindName::choices().map(AppCommand::TreatAs));
    all.extend(RenderMode::ALL.map(AppCommand::UseRenderMode));
    all.extend(StandardView::ALL.map(AppCommand::LookFrom));
    all.extend(SceneAxis::ALL.map(|axis| AppCommand::TurnObject(ObjectRotation::MakeUpright(axis))));
    all.extend(LightingRig::ALL.map(AppCommand::UseRig));
    let is_scene = |preset: &Preset| preset.scene_volume().is_some();
    all.extend(PRESETS.into_iter().filter(|preset| !is_scene(preset)).map(AppCommand::UsePreset));
    all.extend(PRESETS.into_iter().filter(is_scene).map(AppCommand::OpenScene));
    all.extend(SEARCHABLE_SETTINGS.iter().map(|(place, _)| AppCommand::Reveal(*place)));
    all.extend(
        (0..COLOR_MAPS.len()).flat_map(|at| [false, true].map(|back| AppCommand::UseColors(at, back))),
    );
    all.extend(DIGIT_KEYS.map(AppCommand::StoreView));
    all.extend(DIGIT_KEYS.map(AppCommand::RecallView));
    all
}
