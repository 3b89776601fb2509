//! Keyboard shortcuts of commands, and their suspension while text is typed.

use eframe::egui::gui_zoom::kb_shortcuts;
use eframe::egui::{self, Event, Key, KeyboardShortcut, Modifiers};

use super::commands::AppCommand;
use crate::app::text;
use chiaroscuro_scene::{ObjectRotation, StandardView};

const fn plain(key: Key, command: AppCommand) -> (KeyboardShortcut, AppCommand) {
    (KeyboardShortcut::new(Modifiers::NONE, key), command)
}

const fn control(key: Key, command: AppCommand) -> (KeyboardShortcut, AppCommand) {
    (KeyboardShortcut::new(Modifiers::COMMAND, key), command)
}

/// Shortcuts with their commands, in the order in which help shows them.
pub(crate) const SHORTCUTS: [(KeyboardShortcut, AppCommand); 50] = [
    // Shortcuts with Shift come first: egui lets Shift pass where it is not required.
    (KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::O), AppCommand::OpenFolder),
    control(Key::O, AppCommand::OpenDialog),
    control(Key::L, AppCommand::OpenPath),
    plain(Key::PageDown, AppCommand::NextFile),
    plain(Key::PageUp, AppCommand::PreviousFile),
    control(Key::S, AppCommand::SaveSettings),
    control(Key::E, AppCommand::Export),
    (KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::C), AppCommand::CopyPicture),
    control(Key::P, AppCommand::ShowPalette),
    control(Key::Q, AppCommand::Quit),
    (KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z), AppCommand::Redo),
    control(Key::Z, AppCommand::Undo),
    plain(Key::Y, AppCommand::TogglePlayback),
    plain(Key::R, AppCommand::ResetView),
    plain(Key::F, AppCommand::FrameAll),
    plain(Key::Num1, AppCommand::LookFrom(StandardView::MinusY)),
    plain(Key::Num2, AppCommand::LookFrom(StandardView::PlusY)),
    plain(Key::Num3, AppCommand::LookFrom(StandardView::PlusX)),
    plain(Key::Num4, AppCommand::LookFrom(StandardView::MinusX)),
    plain(Key::Num7, AppCommand::LookFrom(StandardView::PlusZ)),
    plain(Key::Num8, AppCommand::LookFrom(StandardView::MinusZ)),
    plain(Key::Num9, AppCommand::LookFrom(StandardView::Isometric)),
    plain(Key::Num5, AppCommand::ToggleProjection),
    plain(Key::O, AppCommand::NextRenderMode),
    (KeyboardShortcut::new(Modifiers::SHIFT, Key::T), AppCommand::RotateObject),
    plain(Key::T, AppCommand::TurnObject(ObjectRotation::TipBack)),
    plain(Key::F11, AppCommand::ToggleFullScreen),
    plain(Key::Comma, AppCommand::PreviousLight),
    plain(Key::Period, AppCommand::NextLight),
    plain(Key::OpenBracket, AppCommand::Dimmer),
    plain(Key::CloseBracket, AppCommand::Brighter),
    plain(Key::S, AppCommand::Solo),
    plain(Key::M, AppCommand::Mute),
    plain(Key::B, AppCommand::Balance),
    (KeyboardShortcut::new(Modifiers::SHIFT, Key::X), AppCommand::FacePlane),
    plain(Key::X, AppCommand::TogglePlane),
    plain(Key::K, AppCommand::ToggleCrop),
    plain(Key::I, AppCommand::ToggleProbe),
    (KeyboardShortcut::new(Modifiers::SHIFT, Key::G), AppCommand::ToggleFloor),
    plain(Key::G, AppCommand::ToggleOverlay),
    plain(Key::H, AppCommand::ToggleHandles),
    plain(Key::C, AppCommand::ToggleCompare),
    plain(Key::D, AppCommand::ShowSlices),
    (KeyboardShortcut::new(Modifiers::SHIFT, Key::V), AppCommand::ToggleStrip),
    plain(Key::V, AppCommand::TryLooks),
    (KeyboardShortcut::new(Modifiers::SHIFT, Key::N), AppCommand::ToggleTransfer),
    plain(Key::N, AppCommand::ToggleSide),
    control(Key::Backslash, AppCommand::TogglePictureOnly),
    plain(Key::Questionmark, AppCommand::ShowHelp),
    plain(Key::F1, AppCommand::ShowHelp),
];

const DIGITS: [Key; 9] =
    [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6, Key::Num7, Key::Num8, Key::Num9];

impl AppCommand {
    /// Returns the command's shortcut for menus, or an empty text.
    pub(crate) fn shortcut_text(&self, ctx: &egui::Context) -> String {
        match self {
            Self::StoreView(slot) => return text::commands::store_view_keys(*slot),
            Self::RecallView(slot) => return text::commands::recall_view_keys(*slot),
            // The toolkit handles these shortcuts itself.
            Self::Scale(1) => return ctx.format_shortcut(&kb_shortcuts::ZOOM_IN),
            Self::Scale(-1) => return ctx.format_shortcut(&kb_shortcuts::ZOOM_OUT),
            Self::Scale(_) => return ctx.format_shortcut(&kb_shortcuts::ZOOM_RESET),
            _ => {}
        }
        let found = SHORTCUTS.into_iter().find(|(_, command)| command == self);
        found.map_or_else(String::new, |(shortcut, _)| key_text(ctx, shortcut))
    }
}

/// Formats a shortcut as its key is printed on the keyboard.
pub(crate) fn key_text(ctx: &egui::Context, shortcut: KeyboardShortcut) -> String {
    let named = ctx.format_shortcut(&shortcut);
    let signs: [_; 6] = [
        (Key::OpenBracket, "["),
        (Key::CloseBracket, "]"),
        (Key::Comma, ","),
        (Key::Period, "."),
        (Key::Questionmark, "?"),
        (Key::Backslash, "\\"),
    ];
    signs.into_iter().fold(named, |text, (key, sign)| text.replace(key.name(), sign))
}

/// Adds the commands whose shortcuts were pressed. Letters go to text fields while one is edited, in the frame after
/// that, and while a window for text input is open.
pub(crate) fn commands_from_keys(ctx: &egui::Context, commands: &mut Vec<AppCommand>) {
    if is_typing(ctx) {
        reserve_letters(ctx);
    }
    let typing = are_letters_reserved(ctx);
    commands.extend(view_digit_commands(ctx));
    for (shortcut, command) in &SHORTCUTS {
        let plain = !shortcut.modifiers.command && !is_function_key(shortcut.logical_key);
        if !(typing && plain) && ctx.input_mut(|input| input.consume_shortcut(shortcut)) {
            commands.push(command.clone());
        }
    }
}

/// Returns true for F1, F2 and so on, which type no text.
pub(crate) fn is_function_key(key: Key) -> bool {
    key.name().strip_prefix('F').is_some_and(|number| number.parse::<u8>().is_ok())
}

/// Identifier under which the last pass is stored in which letters were reserved for text.
fn reserved_id() -> egui::Id {
    egui::Id::unique("letters are for text")
}

/// Reserves letters and digits for text, in this frame and the next. Windows for text input call it while they are
/// open, so that text typed beside their field does not execute twenty commands.
pub(crate) fn reserve_letters(ctx: &egui::Context) {
    let pass = ctx.cumulative_pass_nr();
    ctx.data_mut(|data| data.insert_temp(reserved_id(), pass));
}

/// Returns true if letters and digits are reserved for text.
pub(crate) fn are_letters_reserved(ctx: &egui::Context) -> bool {
    let last: Option<u64> = ctx.data(|data| data.get_temp(reserved_id()));
    last.is_some_and(|last| ctx.cumulative_pass_nr() <= last + 1)
}

/// Returns true if typed letters go into a text field.
pub(crate) fn is_typing(ctx: &egui::Context) -> bool {
    ctx.egui_wants_keyboard_input()
        && ctx.memory(egui::Memory::focused).is_some_and(|id| is_text_field(ctx, id))
}

/// Returns the commands of the digits pressed with Control, or with Control and Shift. Digits are identified by the
/// physical key: with Shift, each keyboard layout has other characters.
fn view_digit_commands(ctx: &egui::Context) -> Vec<AppCommand> {
    let slot = |event: &Event| {
        let Event::Key { key, physical_key, pressed: true, modifiers, .. } = event else { return None };
        let slot = DIGITS.iter().position(|digit| *digit == physical_key.unwrap_or(*key))? as u8 + 1;
        (modifiers.command && !modifiers.alt).then_some(if modifiers.shift {
            AppCommand::StoreView(slot)
        } else {
            AppCommand::RecallView(slot)
        })
    };
    ctx.input(|input| input.events.iter().filter_map(slot).collect())
}

/// Returns true if a widget is a text field that is being edited.
fn is_text_field(ctx: &egui::Context, id: egui::Id) -> bool {
    egui::TextEdit::load_state(ctx, id).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::common::commands::searchable_commands;

    #[test]
    fn no_two_commands_share_a_key_or_a_name() {
        for (at, (key, command)) in SHORTCUTS.iter().enumerate() {
            for (other_key, other) in &SHORTCUTS[at + 1..] {
                assert!(key != other_key, "{command:?} and {other:?}");
            }
        }
        let mut names: Vec<_> = searchable_commands().iter().map(AppCommand::label).collect();
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count);
    }

    /// Returns the commands of a frame in which G was pressed; `reserves`: the letters of that frame are reserved for
    /// text.
    fn commands_of_g(ctx: &egui::Context, reserves: bool) -> Vec<AppCommand> {
        let key = Event::Key {
            key: Key::G,
            physical_key: None,
            pressed: true,
            repeat: false,
            modifiers: Modifiers::NONE,
        };
        let mut commands = Vec::new();
        let input = egui::RawInput { events: vec![key], ..egui::RawInput::default() };
        let mut output = ctx.run_ui(input, |ui| {
            commands_from_keys(ui.ctx(), &mut commands);
            if reserves {
                reserve_letters(ui.ctx());
            }
        });
        output.textures_delta.clear();
        commands
    }

    #[test]
    fn letters_are_no_commands_while_a_window_takes_text_nor_in_the_frame_after() {
        let ctx = egui::Context::default();
        let found = [false, true, true, false, false].map(|reserves| commands_of_g(&ctx, reserves).len());
        assert_eq!(found, [1, 1, 0, 0, 1]);
    }

    #[test]
    fn everything_with_a_key_can_be_found_by_its_name() {
        for (_, command) in SHORTCUTS {
            assert!(
                searchable_commands().contains(&command) || command == AppCommand::ShowPalette,
                "{command:?}"
            );
        }
    }
}
