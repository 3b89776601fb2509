//! Command palette: finds a command or a setting by its name or by a synonym.

mod command_search;
mod synonyms;

use eframe::egui::{self, Align2, Key, Modifiers, RichText, TextEdit};

use self::command_search::{CommandMatch, PaletteContext, SearchResult, search_commands};
use crate::app::common::commands::AppCommand;
use crate::app::common::shortcuts;
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text;
use chiaroscuro_scene::SceneAxis;

/// Number of lines that are shown at once.
const VISIBLE_LINES: usize = 12;

/// State of the window with the search field.
#[derive(Debug, Default)]
pub(crate) struct CommandPalette {
    open: bool,
    text: String,
    selected_line: usize,
}

impl CommandPalette {
    /// Opens the palette with an empty search field.
    pub(crate) fn open(&mut self) {
        *self = Self { open: true, ..Self::default() };
    }

    /// Shows the palette, and adds the chosen command. Some names state which axis of the scene points up. Presets
    /// for another kind of data than that of the volume are dimmed, and rows about labels appear only if it has some.
    pub(crate) fn ui(
        &mut self,
        ctx: &egui::Context,
        up_axis: SceneAxis,
        volume: Option<&VolumeFacts>,
        commands: &mut Vec<AppCommand>,
    ) {
        if !self.open {
            return;
        }
        shortcuts::reserve_letters(ctx);
        let down = ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::ArrowDown));
        let up = ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::ArrowUp));
        let enter = ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Enter));
        let escape = ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape));
        let has_labels = volume.is_some_and(|volume| !volume.labels.is_empty());
        let SearchResult { missing_feature: missing, matches: mut found } =
            search_commands(&self.text, PaletteContext { up: up_axis, has_labels });
        let last = found.len().min(VISIBLE_LINES).saturating_sub(1);
        self.selected_line =
            (self.selected_line + usize::from(down)).saturating_sub(usize::from(up)).min(last);
        let mut run = if enter && !found.is_empty() { Some(self.selected_line) } else { None };
        let window =
            egui::Window::new(text::commands::FIND).title_bar(false).resizable(false).collapsible(false);
        window.anchor(Align2::CENTER_TOP, [0.0, 60.0]).fixed_size([440.0, 320.0]).show(ctx, |ui| {
            let field = TextEdit::singleline(&mut self.text).hint_text(text::commands::FIND_HINT);
            let response =
                ui.name_inputs(text::commands::FIND, |ui| ui.add(field.desired_width(f32::INFINITY)));
            response.request_focus();
            if response.changed() {
                self.selected_line = 0;
            }
            ui.separator();
            if let Some(missing) = missing {
                ui.add(egui::Label::new(RichText::new(missing).weak()).wrap());
                ui.add_space(2.0);
            }
            for (at, CommandMatch { command, remark: note }) in found.iter().take(VISIBLE_LINES).enumerate() {
                let label = command.label_with(up_axis);
                let suits = match (command, volume) {
                    (AppCommand::UsePreset(preset), Some(volume)) => preset.suits_data(&volume.kind),
                    _ => true,
                };
                let label = RichText::new(&*label);
                let label = if suits { label } else { label.weak() };
                let shortcut = command.shortcut_text(ui.ctx());
                let button = if note.is_empty() {
                    egui::Button::selectable(at == self.selected_line, label)
                } else {
                    egui::Button::selectable(
                        at == self.selected_line,
                        (label, RichText::new(*note).small().weak()),
                    )
                };
                let button = button.shortcut_text(shortcut);
                let mut line = ui.add_sized([ui.available_width(), 20.0], button);
                if !suits {
                    line = line.on_hover_text(text::transfer::FOR_CT);
                }
                if line.clicked() {
                    run = Some(at);
                }
            }
            if found.is_empty() && missing.is_none() {
                ui.weak(text::commands::NOTHING_FOUND);
            }
        });
        if let Some(at) = run {
            commands.push(found.swap_remove(at).command);
        }
        self.open = !(escape || run.is_some());
    }
}
