//! What menus, keys and buttons ask for. Collected during a frame, carried out at its end.

use std::path::PathBuf;

use eframe::egui::{self, Event, Key, KeyboardShortcut, Modifiers};

use crate::data::KindName;
use crate::model::{COLOR_MAPS, Light, ObjectTurn, PRESETS, Preset, Rig, SceneAxis, StandardView};

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
    /// Stand the object up, or lay it down.
    TurnObject(ObjectTurn),
    /// From the next side: the object turns by a quarter about the vertical.
    TurnRound,
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
    /// Show the contact sheet of lights.
    TryLights,
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

const fn plain(key: Key, command: Command) -> (KeyboardShortcut, Command) {
    (KeyboardShortcut::new(Modifiers::NONE, key), command)
}

const fn control(key: Key, command: Command) -> (KeyboardShortcut, Command) {
    (KeyboardShortcut::new(Modifiers::COMMAND, key), command)
}

/// A command with its key, as help shows it.
pub(crate) const SHORTCUTS: [(KeyboardShortcut, Command); 41] = [
    control(Key::O, Command::OpenDialog),
    control(Key::L, Command::OpenPath),
    control(Key::S, Command::SaveSettings),
    control(Key::E, Command::Export),
    (KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::C), Command::CopyPicture),
    control(Key::P, Command::ShowPalette),
    control(Key::Q, Command::Quit),
    // The longer one first: egui lets Shift pass where it is not asked for.
    (KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z), Command::Redo),
    control(Key::Z, Command::Undo),
    plain(Key::R, Command::ResetView),
    plain(Key::F, Command::FrameAll),
    plain(Key::Num1, Command::LookFrom(StandardView::MinusY)),
    plain(Key::Num2, Command::LookFrom(StandardView::PlusY)),
    plain(Key::Num3, Command::LookFrom(StandardView::PlusX)),
    plain(Key::Num4, Command::LookFrom(StandardView::MinusX)),
    plain(Key::Num7, Command::LookFrom(StandardView::PlusZ)),
    plain(Key::Num8, Command::LookFrom(StandardView::MinusZ)),
    plain(Key::Num9, Command::LookFrom(StandardView::Isometric)),
    plain(Key::Num5, Command::ToggleProjection),
    (KeyboardShortcut::new(Modifiers::SHIFT, Key::T), Command::TurnRound),
    plain(Key::T, Command::TurnObject(ObjectTurn::Over)),
    plain(Key::F11, Command::ToggleFullScreen),
    plain(Key::Comma, Command::PreviousLight),
    plain(Key::Period, Command::NextLight),
    plain(Key::OpenBracket, Command::Dimmer),
    plain(Key::CloseBracket, Command::Brighter),
    plain(Key::S, Command::Solo),
    plain(Key::M, Command::Mute),
    plain(Key::B, Command::Balance),
    (KeyboardShortcut::new(Modifiers::SHIFT, Key::X), Command::FacePlane),
    plain(Key::X, Command::TogglePlane),
    plain(Key::K, Command::ToggleCrop),
    plain(Key::I, Command::ToggleProbe),
    (KeyboardShortcut::new(Modifiers::SHIFT, Key::G), Command::ToggleFloor),
    plain(Key::G, Command::ToggleOverlay),
    plain(Key::H, Command::ToggleHandles),
    plain(Key::C, Command::ToggleCompare),
    plain(Key::D, Command::ShowSlices),
    plain(Key::N, Command::ToggleSide),
    plain(Key::Questionmark, Command::ShowHelp),
    plain(Key::F1, Command::ShowHelp),
];

/// Digits under which views are kept.
pub(crate) const VIEW_SLOTS: std::ops::RangeInclusive<u8> = 1..=9;

const DIGITS: [Key; 9] =
    [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6, Key::Num7, Key::Num8, Key::Num9];

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
        Command::TryLights,
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
    all.extend(KindName::choices().map(Command::TreatAs));
    all.extend(StandardView::ALL.map(Command::LookFrom));
    all.extend(SceneAxis::ALL.map(|axis| Command::TurnObject(ObjectTurn::Upright(axis))));
    all.extend(Rig::ALL.map(Command::UseRig));
    all.extend(PRESETS.map(Command::UsePreset));
    all.extend((0..COLOR_MAPS.len()).flat_map(|at| [false, true].map(|back| Command::UseColors(at, back))));
    all.extend(VIEW_SLOTS.map(Command::StoreView));
    all.extend(VIEW_SLOTS.map(Command::RecallView));
    all
}

/// Adds the commands whose keys were pressed. Letters are left to text fields while one is edited.
pub(crate) fn from_keys(ctx: &egui::Context, commands: &mut Vec<Command>) {
    let typing = is_typing(ctx);
    commands.extend(view_slots(ctx));
    for (shortcut, command) in &SHORTCUTS {
        let plain = !shortcut.modifiers.command;
        if !(typing && plain) && ctx.input_mut(|input| input.consume_shortcut(shortcut)) {
            commands.push(command.clone());
        }
    }
}

/// Whether letters go into a text field.
pub(crate) fn is_typing(ctx: &egui::Context) -> bool {
    ctx.egui_wants_keyboard_input() && ctx.memory(egui::Memory::focused).is_some_and(|id| is_text(ctx, id))
}

/// Digits with Control, and Shift. By the place of the key: with Shift its sign is another on every keyboard.
fn view_slots(ctx: &egui::Context) -> Vec<Command> {
    let slot = |event: &Event| {
        let Event::Key { key, physical_key, pressed: true, modifiers, .. } = event else { return None };
        let slot = DIGITS.iter().position(|digit| *digit == physical_key.unwrap_or(*key))? as u8 + 1;
        (modifiers.command && !modifiers.alt).then_some(if modifiers.shift {
            Command::StoreView(slot)
        } else {
            Command::RecallView(slot)
        })
    };
    ctx.input(|input| input.events.iter().filter_map(slot).collect())
}

/// Whether a widget is a text field that is being edited.
fn is_text(ctx: &egui::Context, id: egui::Id) -> bool {
    egui::TextEdit::load_state(ctx, id).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_commands_share_a_key_or_a_name() {
        for (at, (key, command)) in SHORTCUTS.iter().enumerate() {
            for (other_key, other) in &SHORTCUTS[at + 1..] {
                assert!(key != other_key, "{command:?} and {other:?}");
            }
        }
        let mut names: Vec<_> = listed().iter().map(Command::label).collect();
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count);
    }

    #[test]
    fn everything_with_a_key_can_be_found_by_its_name() {
        for (_, command) in SHORTCUTS {
            assert!(listed().contains(&command) || command == Command::ShowPalette, "{command:?}");
        }
    }
}
