//! Pacing of input: what the hands do one after another is handed to the window one thing per frame.
//!
//! The toolkit takes all events of a frame together. It looks for the widget under the pointer where the pointer is after
//! the last of them, and gives all characters to the field that has the focus then. While a slow frame is drawn much can
//! happen: a handle is pressed and dragged away, which would drag what lies at the end of the movement; a number is typed
//! and left by Tab, and would go to the next field, with all that is typed there. So events are handed on in their order,
//! until one that decides where the next go: a press, a release, a key that moves the focus or stands for a command. Those
//! behind it wait for the next frame, which is asked for at once. Nothing is dropped, and where frames are quick nothing
//! waits. Positions are in points, times in seconds.

#[cfg(test)]
mod tests;

use std::collections::VecDeque;

use eframe::egui::{self, Event, InputOptions, Key, Modifiers, PointerButton, Pos2};

use super::shortcuts::{are_letters_reserved, is_function_key};

/// A frame that takes longer than this is slow: about half of what the toolkit lets pass between two clicks of a double
/// click (0.3 s).
const SLOW_FRAME_S: f32 = 0.15;

/// The longest frame that clicks are stretched for: further apart they are no double click for anybody.
const LONGEST_FRAME_S: f32 = 2.0;

/// Share of the longest frame so far that counts for the frame after it: a slow one is forgotten after a dozen quick ones.
const FRAME_DECAY: f32 = 0.8;

/// Events that wait for a frame of their own.
#[derive(Debug)]
pub(crate) struct InputPacing {
    waiting: VecDeque<Event>,
    /// The focus may move in this frame by what the frame before was given: characters wait until it has.
    focus_settles: bool,
    /// Points that a click may move between press and release.
    click_distance: f32,
    /// How long frames take at present.
    frame_s: f32,
}

impl Default for InputPacing {
    fn default() -> Self {
        Self {
            waiting: VecDeque::new(),
            focus_settles: false,
            click_distance: InputOptions::default().max_click_dist,
            frame_s: 0.0,
        }
    }
}

/// Role of an event in the order of things.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    /// It may come with any other.
    Free,
    Move,
    Press,
    Release,
    /// Goes into the field that has the focus.
    Character,
    /// A key, or a wish of a screen reader, that does something at once. `types`: it is a character as well.
    /// `moves_focus`: another field may have the focus afterwards.
    Command {
        types: bool,
        moves_focus: bool,
    },
}

impl Role {
    /// `next` is the event behind it; `is_typing` means that letters are for a text.
    fn new(event: &Event, next: Option<&Event>, is_typing: bool) -> Self {
        match event {
            Event::PointerMoved(_) => Self::Move,
            Event::PointerButton { pressed: true, .. } => Self::Press,
            Event::PointerButton { pressed: false, .. } => Self::Release,
            Event::Text(_) | Event::Ime(_) | Event::Paste(_) | Event::PasteImage(_) | Event::Cut => {
                Self::Character
            }
            Event::Key { key, pressed: true, modifiers, .. } => {
                let leaves = leaves_field(*key, *modifiers);
                if is_typing && !leaves && !steps(*key) {
                    Self::Character
                } else {
                    // Space presses the button that has the focus.
                    let moves_focus = leaves || *key == Key::Space;
                    Self::Command { types: matches!(next, Some(Event::Text(_))), moves_focus }
                }
            }
            Event::AccessKitActionRequest(_) => Self::Command { types: false, moves_focus: true },
            _ => Self::Free,
        }
    }
}

/// Whether a key does more than edit the text of a field: it leaves the field, or stands for a command everywhere.
fn leaves_field(key: Key, modifiers: Modifiers) -> bool {
    matches!(key, Key::Tab | Key::Enter | Key::Escape)
        || is_function_key(key)
        || modifiers.command
        || modifiers.ctrl
}

/// Whether a key steps through values or rows, also while a text is edited.
fn steps(key: Key) -> bool {
    matches!(key, Key::ArrowUp | Key::ArrowDown | Key::PageUp | Key::PageDown)
}

impl InputPacing {
    /// The events of the next frame, from those that waited and those that `arrived` since. `is_typing`: letters are for a
    /// text.
    fn next_frame(&mut self, arrived: Vec<Event>, is_typing: bool) -> Vec<Event> {
        self.waiting.extend(arrived);
        let may_type = !std::mem::take(&mut self.focus_settles);
        let mut frame = Vec::new();
        let (mut has_moved, mut has_typed) = (false, false);
        while let Some(event) = self.waiting.pop_front() {
            let role = Role::new(&event, self.waiting.front(), is_typing);
            let waits = match role {
                Role::Free | Role::Move => false,
                Role::Press => has_typed,
                // What is dragged goes to the end of the movement before it is let go.
                Role::Release => has_typed || has_moved,
                Role::Character => !may_type,
                Role::Command { types, .. } => has_typed || types && !may_type,
            };
            if waits {
                self.waiting.push_front(event);
                break;
            }
            match role {
                Role::Free => frame.push(event),
                Role::Move => {
                    has_moved = true;
                    frame.push(event);
                }
                Role::Character => {
                    has_typed = true;
                    frame.push(event);
                }
                Role::Press => {
                    self.press(&mut frame, event);
                    self.focus_settles = true;
                    break;
                }
                Role::Release => {
                    frame.push(event);
                    self.focus_settles = true;
                    break;
                }
                Role::Command { moves_focus, .. } => {
                    self.command(&mut frame, event);
                    self.focus_settles = moves_focus;
                    break;
                }
            }
        }
        frame
    }

    /// Hands on a press. A click that has arrived whole stays whole, where it was pressed: in frames of their own press and
    /// release may lie further apart than a click lasts.
    fn press(&mut self, frame: &mut Vec<Event>, press: Event) {
        let Event::PointerButton { pos: origin, button, .. } = press else { return };
        frame.push(press);
        let is_near = |at: &Pos2| at.distance(origin) <= self.click_distance;
        let goes_by = |event: &Event| match event {
            Event::PointerMoved(to) => is_near(to),
            event => Role::new(event, None, false) == Role::Free,
        };
        let Some(end) = self.waiting.iter().position(|event| !goes_by(event)) else { return };
        let Some(released) = released_at(&self.waiting[end], button).filter(is_near) else { return };
        for event in self.waiting.drain(..=end) {
            match event {
                Event::PointerMoved(_) => {}
                Event::PointerButton { button, pressed, modifiers, .. } => {
                    frame.push(Event::PointerButton { pos: origin, button, pressed, modifiers });
                }
                other => frame.push(other),
            }
        }
        if released != origin {
            self.waiting.push_front(Event::PointerMoved(released));
        }
    }

    /// Hands on a key with the text that it stands for, and with its repetitions while it is held: who holds a key for a
    /// second does not want to wait for thirty frames.
    fn command(&mut self, frame: &mut Vec<Event>, command: Event) {
        let held = match &command {
            Event::Key { key, modifiers, .. } => Some((*key, *modifiers)),
            _ => None,
        };
        frame.push(command);
        while let Some(event) = self.waiting.pop_front() {
            let belongs = match &event {
                Event::Text(_) => held.is_some(),
                Event::Key { key, pressed: true, modifiers, .. } => held == Some((*key, *modifiers)),
                _ => false,
            };
            if !belongs {
                self.waiting.push_front(event);
                break;
            }
            frame.push(event);
        }
    }

    /// Gives clicks as many more seconds as slow frames take from them.
    fn stretch_clicks(&mut self, ctx: &egui::Context) {
        let last_s = ctx.input(|input| input.stable_dt).min(LONGEST_FRAME_S);
        self.frame_s = last_s.max(FRAME_DECAY * self.frame_s);
        // The press may be in the frame after the one in which it came, and the release in the one after that.
        let more_s = if self.frame_s > SLOW_FRAME_S { 2.0 * f64::from(self.frame_s) } else { 0.0 };
        let usual = InputOptions::default();
        ctx.options_mut(|options| {
            let options = &mut options.input_options;
            options.max_click_duration = usual.max_click_duration + more_s;
            options.max_double_click_delay = usual.max_double_click_delay + more_s;
        });
    }
}

/// Where a button was let go, if that is what an event says.
fn released_at(event: &Event, of: PointerButton) -> Option<Pos2> {
    match event {
        Event::PointerButton { pos, button, pressed: false, .. } if *button == of => Some(*pos),
        _ => None,
    }
}

impl egui::Plugin for InputPacing {
    fn debug_name(&self) -> &'static str {
        "input pacing"
    }

    fn input_hook(&mut self, ctx: &egui::Context, input: &mut egui::RawInput) {
        // A frame that is laid out a second time has had its events.
        if ctx.current_pass_index() > 0 {
            return;
        }
        self.stretch_clicks(ctx);
        // Letters that are nobody's need no frame each.
        let is_typing = ctx.text_edit_focused() || are_letters_reserved(ctx);
        input.events = self.next_frame(std::mem::take(&mut input.events), is_typing);
    }

    fn on_end_pass(&mut self, ui: &mut egui::Ui) {
        if !self.waiting.is_empty() {
            ui.ctx().request_repaint();
        }
    }
}
