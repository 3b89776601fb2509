//! Pacing of input: actions that follow each other are handed to the window in separate frames.
//!
//! The toolkit takes all events of a frame together. It finds the widget under the pointer by the last pointer
//! position of the frame, and gives all characters to the field that has the focus then. While a slow frame is drawn,
//! much can happen: a handle is pressed and dragged away, which would drag whatever lies at the end of the movement;
//! a number is typed and left by Tab, and would go to the next field, with everything typed there. So events are
//! handed on in their order, up to one that determines the target of the next: a press, a release, a key that moves
//! the focus or stands for a command. Later events wait for the next frame, which is requested at once. Nothing is
//! dropped, and where frames are fast nothing waits. Positions are in points, times in seconds.

mod held_keys;
#[cfg(test)]
mod tests;

use std::collections::VecDeque;

use eframe::egui::{self, Event, InputOptions, Key, Modifiers, PointerButton, Pos2};

use self::held_keys::HeldKeys;
use super::shortcuts::{are_letters_reserved, is_function_key};

/// Duration from which a frame is slow, in seconds: about half of the toolkit's limit between the clicks of a double
/// click (0.3 s).
const SLOW_FRAME_S: f32 = 0.15;

/// Longest frame for which clicks are stretched, in seconds: clicks further apart are never meant as a double click.
const MAX_STRETCHED_FRAME_S: f32 = 2.0;

/// Factor by which the longest frame time decays per frame: a slow frame is forgotten after a dozen fast ones.
const FRAME_DECAY: f32 = 0.8;

/// Queue of events that wait for a frame of their own.
#[derive(Debug)]
pub(crate) struct InputPacing {
    waiting: VecDeque<Event>,
    held_keys: HeldKeys,
    /// True if events of the previous frame may move the focus in this one: characters wait until it has moved.
    focus_settles: bool,
    /// Distance that the pointer may move during a click, in points.
    click_distance: f32,
    /// Decaying maximum of recent frame times, in seconds.
    frame_s: f32,
}

impl Default for InputPacing {
    fn default() -> Self {
        Self {
            waiting: VecDeque::new(),
            held_keys: HeldKeys::default(),
            focus_settles: false,
            click_distance: InputOptions::default().max_click_dist,
            frame_s: 0.0,
        }
    }
}

/// Role of an event in the ordering.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum EventRole {
    /// Event that may share a frame with any other.
    Free,
    Move,
    Press,
    Release,
    /// Input for the field that has the focus.
    Character,
    /// Key, or request of a screen reader, with an immediate effect. `types`: it is a character as well.
    /// `moves_focus`: another field may have the focus afterwards.
    Command {
        types: bool,
        moves_focus: bool,
    },
}

impl EventRole {
    /// Classifies an event. `next` is the event behind it; `is_typing`: letters are for a text.
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
                if is_typing && !leaves && !steps_value(*key) {
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

/// Returns true if a key does more than edit the text of a field: it leaves the field, or is a command everywhere.
fn leaves_field(key: Key, modifiers: Modifiers) -> bool {
    matches!(key, Key::Tab | Key::Enter | Key::Escape)
        || is_function_key(key)
        || modifiers.command
        || modifiers.ctrl
}

/// Returns true if a key steps through values or rows, even while text is edited.
fn steps_value(key: Key) -> bool {
    matches!(key, Key::ArrowUp | Key::ArrowDown | Key::PageUp | Key::PageDown)
}

impl InputPacing {
    /// Returns the events of the next frame, from those that have waited and those that `arrived` since. `is_typing`:
    /// letters are for a text.
    fn next_frame(&mut self, arrived: Vec<Event>, is_typing: bool) -> Vec<Event> {
        self.waiting.extend(arrived);
        let may_type = !std::mem::take(&mut self.focus_settles);
        let mut frame = Vec::new();
        let (mut has_moved, mut has_typed) = (false, false);
        while let Some(event) = self.waiting.pop_front() {
            let role = EventRole::new(&event, self.waiting.front(), is_typing);
            let waits = match role {
                EventRole::Free | EventRole::Move => false,
                EventRole::Press => has_typed,
                // A dragged object reaches the end of the movement before it is released.
                EventRole::Release => has_typed || has_moved,
                EventRole::Character => !may_type,
                EventRole::Command { types, .. } => has_typed || types && !may_type,
            };
            if waits {
                self.waiting.push_front(event);
                break;
            }
            match role {
                EventRole::Free => frame.push(event),
                EventRole::Move => {
                    has_moved = true;
                    frame.push(event);
                }
                EventRole::Character => {
                    has_typed = true;
                    frame.push(event);
                }
                EventRole::Press => {
                    self.hand_on_press(&mut frame, event);
                    self.focus_settles = true;
                    break;
                }
                EventRole::Release => {
                    frame.push(event);
                    self.focus_settles = true;
                    break;
                }
                EventRole::Command { moves_focus, .. } => {
                    self.hand_on_command(&mut frame, event);
                    self.focus_settles = moves_focus;
                    break;
                }
            }
        }
        frame
    }

    /// Hands on a press. A click that has arrived as a whole stays together, at the position of its press: in
    /// separate frames, press and release might be further apart than a click may last.
    fn hand_on_press(&mut self, frame: &mut Vec<Event>, press: Event) {
        let Event::PointerButton { pos: origin, button, .. } = press else { return };
        frame.push(press);
        let is_near = |at: &Pos2| at.distance(origin) <= self.click_distance;
        let goes_by = |event: &Event| match event {
            Event::PointerMoved(to) => is_near(to),
            event => EventRole::new(event, None, false) == EventRole::Free,
        };
        let Some(end) = self.waiting.iter().position(|event| !goes_by(event)) else { return };
        let Some(released) = release_position(&self.waiting[end], button).filter(is_near) else { return };
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

    /// Hands on a key with its text and its repetitions: a key held for a second must not take thirty frames.
    fn hand_on_command(&mut self, frame: &mut Vec<Event>, command: Event) {
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

    /// Extends the time limits of clicks by the time that slow frames take from them.
    fn stretch_clicks(&mut self, ctx: &egui::Context) {
        let last_s = ctx.input(|input| input.stable_dt).min(MAX_STRETCHED_FRAME_S);
        self.frame_s = last_s.max(FRAME_DECAY * self.frame_s);
        // The press may be handled one frame after its arrival, and the release another frame later.
        let more_s = if self.frame_s > SLOW_FRAME_S { 2.0 * f64::from(self.frame_s) } else { 0.0 };
        let usual = InputOptions::default();
        ctx.options_mut(|options| {
            let options = &mut options.input_options;
            options.max_click_duration = usual.max_click_duration + more_s;
            options.max_double_click_delay = usual.max_double_click_delay + more_s;
        });
    }
}

/// Returns the position at which a button was released, if the event is its release.
fn release_position(event: &Event, of: PointerButton) -> Option<Pos2> {
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
        // A second pass of a frame has had its events.
        if ctx.current_pass_index() > 0 {
            return;
        }
        self.held_keys.rename_events(&mut input.events);
        self.stretch_clicks(ctx);
        // Letters without a text field need no frames of their own.
        let is_typing = ctx.text_edit_focused() || are_letters_reserved(ctx);
        input.events = self.next_frame(std::mem::take(&mut input.events), is_typing);
    }

    fn on_end_pass(&mut self, ui: &mut egui::Ui) {
        if !self.waiting.is_empty() {
            ui.ctx().request_repaint();
        }
    }
}
