//! What menus, keys and buttons ask for. Collected during a frame, carried out at its end.

mod names;

use std::path::PathBuf;

use super::places::PLACES;
use super::reveal::Place;
use crate::data::KindName;
use crate::data::load::{Aspect, Choice, Thinning};
use crate::model::{
    COLOR_MAPS, DIGITS, Light, ObjectTurn, PRESETS, Preset, Rig, SceneAxis, Settings, StandardView,
};

/// How many voxels are offered to be kept.
pub(crate) const THINNINGS: [Thinning; 5] =
    [Thinning::None, Thinning::Every(2), Thinning::Average(2), Thinning::Every(4), Thinning::Average(4)];

/// Something the user asked for.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Command {
    /// Ask for a volume and open it.
    OpenDialog,
    /// Ask for a folder of slices and open it.
    OpenFolder,
    /// Show the window for typing a path.
    OpenPath,
    /// Open what was dropped on the window.
    OpenDropped(Vec<PathBuf>),
    /// Open the file after the open one in its folder.
    NextFile,
    /// Open the file before it.
    PreviousFile,
    /// Open a file or a built-in volume.
    Open(PathBuf),
    /// Open a file that was open before, and of its volumes the one that was.
    OpenAgain(PathBuf, Choice),
    /// Show the volumes of the open file.
    Choose(Aspect),
    /// Open the volume of the open file after the one that is shown, or the one before.
    StepChoice(Aspect, bool),
    /// Open another volume of the open file, with the look as it is or with one of its own.
    TakeChoice(Box<Choice>, bool),
    /// Read the open volume again, with more or fewer of its voxels.
    Thin(Thinning),
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
    /// Stop what is being exported.
    CancelExport,
    /// Close the window.
    Quit,
    /// One step back.
    Undo,
    /// One step forward again.
    Redo,
    /// Show the list of steps, or not.
    ToggleHistory,
    /// So many steps forward, or back if they are negative.
    GoSteps(i32),
    /// Show all that was said, or not.
    ToggleMessages,
    /// The camera as it was when the volume was opened.
    ResetView,
    /// All of the volume, from where the eye is.
    FrameAll,
    /// From a side.
    LookFrom(StandardView),
    /// Stand the object up, or lay it down.
    TurnObject(ObjectTurn),
    /// From the next side: the object turns by a quarter about the vertical.
    TurnRound,
    /// Perspective or orthographic.
    ToggleProjection,
    /// Keep the view.
    KeepView,
    /// Keep the look.
    KeepInStrip,
    /// Keep the view under a digit.
    StoreView(u8),
    /// Go to what is kept under a digit.
    RecallView(u8),
    /// Go to something that is kept, by its place; to a look also with its view.
    GoToKept(usize, bool),
    /// Keep what is shown in the place of something that is kept.
    ReplaceKept(usize),
    /// Compare two looks that are kept, or the picture with one.
    CompareKept(Option<usize>, usize),
    /// Write all that is kept into one picture.
    ExportKept,
    /// Show or hide the strip of what is kept.
    ToggleKept,
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
    /// Ask for a picture of surroundings, and light the scene by it.
    UseSurroundings,
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
    /// A first look at data of this kind, or of the volume's own.
    TreatAs(Option<KindName>),
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
    /// Show or hide the transfer function editor.
    ToggleTransfer,
    /// Show the picture alone, or the panels again.
    TogglePictureOnly,
    /// Make all of the window larger (1), smaller (−1), or as large as it was (0).
    Scale(i8),
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
    /// Show where something is set.
    Reveal(Place),
    /// Show keys and mouse.
    ShowHelp,
    /// Show what this is and what it runs on.
    ShowAbout,
}

/// Every command that can be asked for by its name.
pub(crate) fn listed() -> Vec<Command> {
    let mut all = vec![
        Command::OpenDialog,
        Command::OpenFolder,
        Command::OpenPath,
        Command::NextFile,
        Command::PreviousFile,
        Command::GoOn,
        Command::SaveSettings,
        Command::LoadSettings,
        Command::Export,
        Command::CopyPicture,
        Command::KeepLook,
        Command::Undo,
        Command::Redo,
        Command::ToggleHistory,
        Command::ToggleMessages,
        Command::ResetView,
        Command::FrameAll,
        Command::TurnObject(ObjectTurn::Over),
        Command::TurnRound,
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
        Command::UseSurroundings,
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
        Command::ToggleTransfer,
        Command::TogglePictureOnly,
        Command::ToggleKept,
        Command::Scale(1),
        Command::Scale(-1),
        Command::Scale(0),
        Command::KeepView,
        Command::KeepInStrip,
        Command::ExportKept,
        Command::ToggleHandles,
        Command::ToggleCompare,
        Command::CompareWithFile,
        Command::ShowSlices,
        Command::ShowLightVolume,
        Command::ShowHelp,
        Command::ShowAbout,
        Command::Quit,
    ];
    all.extend(THINNINGS.map(Command::Thin));
    all.extend(Aspect::ALL.map(Command::Choose));
    all.extend(
        Aspect::ALL.into_iter().flat_map(|aspect| [true, false].map(|on| Command::StepChoice(aspect, on))),
    );
    all.extend(KindName::choices().map(Command::TreatAs));
    all.extend(StandardView::ALL.map(Command::LookFrom));
    all.extend(SceneAxis::ALL.map(|axis| Command::TurnObject(ObjectTurn::Upright(axis))));
    all.extend(Rig::ALL.map(Command::UseRig));
    all.extend(PRESETS.map(Command::UsePreset));
    all.extend(PLACES.iter().map(|(place, _)| Command::Reveal(*place)));
    all.extend((0..COLOR_MAPS.len()).flat_map(|at| [false, true].map(|back| Command::UseColors(at, back))));
    all.extend(DIGITS.map(Command::StoreView));
    all.extend(DIGITS.map(Command::RecallView));
    all
}
