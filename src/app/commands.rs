//! What menus, keys and buttons ask for. Collected during a frame, carried out at its end.

use eframe::egui::{self, Key, KeyboardShortcut, Modifiers};

/// Something the user asked for.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Command {
    /// Ask for a volume and open it.
    OpenDialog,
    /// Show the window for typing a path.
    OpenPath,
    /// Open a file or a built-in volume.
    Open(String),
    /// Stop opening.
    CancelOpening,
    /// Save the settings where they belong, or ask where.
    SaveSettings,
    /// Ask for settings and apply them.
    LoadSettings,
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
    /// Add a light.
    AddLight,
    /// The automatic transfer function.
    AutomaticTransfer,
    /// Measure the brightness and set the balance.
    Balance,
    /// Show or hide the side panel.
    ToggleSide,
    /// Show or hide the handles of the lights.
    ToggleHandles,
    /// Show two looks in one picture, or one again.
    ToggleCompare,
    /// Show a slice of a light volume.
    ShowLightVolume,
    /// Ask for settings to compare with.
    CompareWithFile,
    /// Show keys and mouse.
    ShowHelp,
    /// Show what this is and what it runs on.
    ShowAbout,
}

/// A command with its key, as help shows it.
pub(super) const SHORTCUTS: [(KeyboardShortcut, Command); 13] = [
    (KeyboardShortcut::new(Modifiers::COMMAND, Key::O), Command::OpenDialog),
    (KeyboardShortcut::new(Modifiers::COMMAND, Key::L), Command::OpenPath),
    (KeyboardShortcut::new(Modifiers::COMMAND, Key::S), Command::SaveSettings),
    (KeyboardShortcut::new(Modifiers::COMMAND, Key::E), Command::Export),
    (KeyboardShortcut::new(Modifiers::COMMAND, Key::Q), Command::Quit),
    // The longer one first: egui lets Shift pass where it is not asked for.
    (KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z), Command::Redo),
    (KeyboardShortcut::new(Modifiers::COMMAND, Key::Z), Command::Undo),
    (KeyboardShortcut::new(Modifiers::NONE, Key::N), Command::ToggleSide),
    (KeyboardShortcut::new(Modifiers::NONE, Key::H), Command::ToggleHandles),
    (KeyboardShortcut::new(Modifiers::NONE, Key::C), Command::ToggleCompare),
    (KeyboardShortcut::new(Modifiers::NONE, Key::R), Command::ResetView),
    (KeyboardShortcut::new(Modifiers::NONE, Key::B), Command::Balance),
    (KeyboardShortcut::new(Modifiers::NONE, Key::F1), Command::ShowHelp),
];

impl Command {
    /// What help calls it.
    pub(super) fn label(&self) -> &'static str {
        match self {
            Self::OpenDialog => "Open…",
            Self::OpenPath => "Open path…",
            Self::Open(_) => "Open built-in",
            Self::CancelOpening => "Cancel",
            Self::SaveSettings => "Save settings…",
            Self::LoadSettings => "Load settings…",
            Self::Export => "Export picture…",
            Self::Quit => "Quit",
            Self::Undo => "Undo",
            Self::Redo => "Redo",
            Self::ResetView => "Reset view",
            Self::AddLight => "Add light",
            Self::AutomaticTransfer => "Automatic transfer function",
            Self::Balance => "Balance brightness",
            Self::ToggleSide => "Side panel",
            Self::ToggleHandles => "Light handles",
            Self::ToggleCompare => "Compare two looks",
            Self::ShowLightVolume => "Light volume…",
            Self::CompareWithFile => "Compare with settings…",
            Self::ShowHelp => "Keys and mouse",
            Self::ShowAbout => "About Chiaroscuro",
        }
    }

    /// Its key, for menus.
    pub(super) fn shortcut_text(&self, ctx: &egui::Context) -> String {
        let found = SHORTCUTS.iter().find(|(_, command)| command == self);
        found.map_or_else(String::new, |(shortcut, _)| ctx.format_shortcut(shortcut))
    }
}

/// Adds the commands whose keys were pressed. Letters are left to text fields while one is edited.
pub(super) fn from_keys(ctx: &egui::Context, commands: &mut Vec<Command>) {
    let typing = ctx.egui_wants_keyboard_input()
        && ctx.memory(egui::Memory::focused).is_some_and(|id| is_text(ctx, id));
    for (shortcut, command) in &SHORTCUTS {
        let plain = shortcut.modifiers == Modifiers::NONE;
        if !(typing && plain) && ctx.input_mut(|input| input.consume_shortcut(shortcut)) {
            commands.push(command.clone());
        }
    }
}

/// Whether a widget is a text field that is being edited.
fn is_text(ctx: &egui::Context, id: egui::Id) -> bool {
    egui::TextEdit::load_state(ctx, id).is_some()
}
