//! Finding a command by its name.

use eframe::egui::{self, Align2, Key, Modifiers, RichText, TextEdit};

use crate::app::common::commands::{self, Command};
use crate::app::common::shortcuts;
use crate::app::text;
use crate::data::DataKind;
use crate::model::SceneAxis;

/// Lines that are shown at once.
const LINES: usize = 12;

/// Letters from which on a word is also sought within others, as light in spotlight: one or two stand in most words.
const WITHIN: usize = 3;

/// The window with the search field.
#[derive(Debug, Default)]
pub(crate) struct Palette {
    open: bool,
    text: String,
    chosen: usize,
}

impl Palette {
    /// Opens it, empty.
    pub(crate) fn open(&mut self) {
        *self = Self { open: true, ..Self::default() };
    }

    /// Shows it, and adds the command that was chosen. Some names say which axis of the scene points up. Presets for another
    /// kind of data than that of the volume are dim.
    pub(crate) fn ui(
        &mut self,
        ctx: &egui::Context,
        up_axis: SceneAxis,
        kind: Option<DataKind>,
        commands: &mut Vec<Command>,
    ) {
        if !self.open {
            return;
        }
        shortcuts::reserve_letters(ctx);
        let down = ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::ArrowDown));
        let up = ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::ArrowUp));
        let enter = ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Enter));
        let escape = ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape));
        let mut found = matching(&self.text, up_axis);
        let last = found.len().min(LINES).saturating_sub(1);
        self.chosen = (self.chosen + usize::from(down)).saturating_sub(usize::from(up)).min(last);
        let mut run = if enter && !found.is_empty() { Some(self.chosen) } else { None };
        let window =
            egui::Window::new(text::commands::FIND).title_bar(false).resizable(false).collapsible(false);
        window.anchor(Align2::CENTER_TOP, [0.0, 60.0]).fixed_size([380.0, 320.0]).show(ctx, |ui| {
            let field = TextEdit::singleline(&mut self.text).hint_text(text::commands::FIND_HINT);
            let response =
                ui.name_inputs(text::commands::FIND, |ui| ui.add(field.desired_width(f32::INFINITY)));
            response.request_focus();
            if response.changed() {
                self.chosen = 0;
            }
            ui.separator();
            for (at, command) in found.iter().take(LINES).enumerate() {
                let label = command.label_with(up_axis);
                let suits = match (command, &kind) {
                    (Command::UsePreset(preset), Some(kind)) => preset.suits(kind),
                    _ => true,
                };
                let label = RichText::new(&*label);
                let label = if suits { label } else { label.weak() };
                let button = egui::Button::selectable(at == self.chosen, label)
                    .shortcut_text(command.shortcut_text(ui.ctx()));
                let mut line = ui.add_sized([ui.available_width(), 20.0], button);
                if !suits {
                    line = line.on_hover_text(text::transfer::FOR_CT);
                }
                if line.clicked() {
                    run = Some(at);
                }
            }
            if found.is_empty() {
                ui.weak(text::commands::NOTHING_FOUND);
            }
        });
        if let Some(at) = run {
            commands.push(found.swap_remove(at));
        }
        self.open = !(escape || run.is_some());
    }
}

/// Commands whose names, or what else they are found by, hold all the words of a text: first those that begin with it, then
/// those whose names hold all of it.
fn matching(text: &str, up: SceneAxis) -> Vec<Command> {
    let text = text.to_lowercase();
    let wanted: Vec<&str> = words(&text).collect();
    let beginning = wanted.join(" ");
    let ranked = |command: Command| {
        let label = command.label_with(up).to_lowercase();
        let name: Vec<&str> = words(&label).collect();
        let others: Vec<&str> = words(command.search_words()).collect();
        let is_found = wanted.iter().all(|word| is_said(word, &name) || is_said(word, &others));
        let is_named = wanted.iter().all(|word| is_said(word, &name));
        let begins = name.join(" ").starts_with(&beginning);
        is_found.then_some(((!begins, !is_named), command))
    };
    let mut found: Vec<_> = commands::listed().into_iter().filter_map(ranked).collect();
    found.sort_by_key(|(rank, _)| *rank);
    found.into_iter().map(|(_, command)| command).collect()
}

/// What stands in a text between characters that are neither letters nor digits.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty())
}

/// Whether one of several words begins with another one, or holds it if that is long enough.
fn is_said(word: &str, among: &[&str]) -> bool {
    let is_long = word.chars().count() >= WITHIN;
    among.iter().any(|said| said.starts_with(word) || is_long && said.contains(word))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{ObjectTurn, StandardView};

    #[test]
    fn commands_are_found_by_parts_of_their_names() {
        let matching = |text| matching(text, SceneAxis::default());
        assert_eq!(matching("").len(), commands::listed().len());
        assert_eq!(matching("balance").first(), Some(&Command::Balance));
        assert!(matching("light solo").contains(&Command::Solo));
        assert!(matching("no such thing").is_empty());
    }

    #[test]
    fn settings_are_found_by_their_names_and_by_what_else_they_are_called() {
        for (words, section, row) in [
            ("shadow strength", "Shadows", "Strength"),
            ("ambient occlusion", "Sky and scattering", "Soft light"),
            ("subsurface", "Sky and scattering", "Bounces"),
            ("spotlight", "Lights", "Kind"),
            ("stained glass", "Shadows", "Shadow colour"),
            ("window level", "Data", "Range"),
            ("window/level", "Data", "Range"),
            ("voxel size", "Data", "Spacing"),
            ("Voxel-Size", "Data", "Spacing"),
            ("mirror", "Data", "Flip"),
            ("slope, intercept", "Data", "Values"),
            ("anisotropy", "Sky and scattering", "Anisotropy"),
            ("rotate environment", "Sky and scattering", "Turn"),
            ("shadow catcher", "Floor", "Shadow alone"),
            ("b-spline", "Camera", "Kernel"),
            ("step size", "Shadows", "Slab"),
            ("two-sided", "Shading", "Lit sides"),
            ("zoom", "Camera", "Distance"),
        ] {
            let found = matching(words, SceneAxis::default());
            let is_it = |command: &Command| matches!(command, Command::Reveal(place) if place.section == section && place.row == Some(row));
            assert!(found.iter().any(is_it), "{words}: {found:?}");
        }
        assert!(matching("screenshot", SceneAxis::default()).contains(&Command::Export));
    }

    #[test]
    fn every_command_is_found_by_its_name() {
        for command in commands::listed() {
            let name = command.label_with(SceneAxis::default());
            let found = matching(&name, SceneAxis::default());
            assert!(found.contains(&command), "{name}: {found:?}");
        }
    }

    #[test]
    fn what_is_called_like_that_comes_before_what_is_found_by_other_words() {
        for word in ["distance", "opacity", "kernel", "density"] {
            let found = matching(word, SceneAxis::default());
            let is_called =
                |command: &Command| command.label_with(SceneAxis::default()).to_lowercase().contains(word);
            assert!(found.first().is_some_and(is_called), "{word}: {found:?}");
            assert!(found.is_sorted_by_key(|command| !is_called(command)), "{word}: {found:?}");
        }
    }

    #[test]
    fn one_or_two_letters_begin_words() {
        let in_sky = matching("sky y", SceneAxis::default());
        assert!(in_sky.is_empty(), "{in_sky:?}");
        assert!(!matching("ao", SceneAxis::default()).is_empty());
        assert!(matching("light", SceneAxis::default()).contains(&Command::Solo));
    }

    #[test]
    fn turning_the_object_is_found_by_what_people_call_it() {
        for words in ["flip", "upside down", "lay down", "stand up", "rotate 90", "Turn object"] {
            let found = matching(words, SceneAxis::default());
            assert!(found.contains(&Command::TurnObject(ObjectTurn::Over)), "{words}: {found:?}");
        }
        assert!(matching("rotate 90", SceneAxis::default()).contains(&Command::TurnRound));
        let above = matching("above +y", SceneAxis::PlusY);
        assert_eq!(above, [Command::LookFrom(StandardView::PlusZ)], "names say what is up");
    }
}
