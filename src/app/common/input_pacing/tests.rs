//! Tests of input pacing: the split of events into frames, and a context with widgets and text fields.

use eframe::egui::{self, Event, Key, Modifiers, PointerButton, Pos2, Rect, Sense, pos2, vec2};

use super::InputPacing;

fn button(pos: Pos2, pressed: bool) -> Event {
    Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE }
}

fn key_with(key: Key, modifiers: Modifiers, pressed: bool) -> Event {
    Event::Key { key, physical_key: None, pressed, repeat: false, modifiers }
}

/// Events of a key stroke: press and release.
fn key_stroke(key: Key) -> Vec<Event> {
    vec![key_with(key, Modifiers::NONE, true), key_with(key, Modifiers::NONE, false)]
}

/// Events of a word typed on a keyboard.
fn type_word(word: &str) -> Vec<Event> {
    let letter = |sign: char| {
        let key = Key::from_name(&sign.to_uppercase().to_string()).unwrap();
        let [down, up] = key_stroke(key).try_into().unwrap();
        [down, Event::Text(sign.to_string()), up]
    };
    word.chars().flat_map(letter).collect()
}

/// Splits events that have arrived in one frame into paced frames.
fn frames(events: Vec<Event>, is_typing: bool) -> Vec<Vec<Event>> {
    let mut pacing = InputPacing::default();
    let mut frames = vec![pacing.next_frame(events, is_typing)];
    while !pacing.waiting.is_empty() {
        frames.push(pacing.next_frame(Vec::new(), is_typing));
    }
    frames
}

fn is_press(event: &Event) -> bool {
    matches!(event, Event::PointerButton { pressed: true, .. })
}

const HANDLE: Pos2 = pos2(20.0, 20.0);
const FAR: Pos2 = pos2(150.0, 120.0);

/// Events of a handle that is grabbed and thrown within one frame.
fn drag_in_one_frame() -> Vec<Event> {
    let mut events = vec![Event::PointerMoved(HANDLE), button(HANDLE, true)];
    events.extend([pos2(40.0, 35.0), pos2(90.0, 80.0), FAR].map(Event::PointerMoved));
    events.push(button(FAR, false));
    events
}

#[test]
fn a_press_ends_its_frame_and_a_release_has_one_of_its_own() {
    let frames = frames(drag_in_one_frame(), false);
    assert_eq!(frames.iter().map(Vec::len).collect::<Vec<_>>(), [2, 3, 1]);
    assert!(is_press(&frames[0][1]));
    assert_eq!(frames.concat(), drag_in_one_frame(), "nothing is lost, and the order is kept");
}

#[test]
fn a_click_that_comes_whole_stays_whole_and_where_it_was_pressed() {
    let near = HANDLE + vec2(2.0, -3.0);
    let click = vec![button(HANDLE, true), Event::PointerMoved(near), button(near, false)];
    let frames = frames([click.clone(), click].concat(), false);
    let whole = vec![button(HANDLE, true), button(HANDLE, false)];
    let after = Event::PointerMoved(near);
    assert_eq!(frames, [whole.clone(), [vec![after.clone()], whole].concat(), vec![after]]);
}

#[test]
fn text_waits_for_the_field_that_tab_leads_to() {
    let word = type_word("ab");
    let events = [word.clone(), key_stroke(Key::Tab), word.clone(), key_stroke(Key::Enter)].concat();
    let frames = frames(events.clone(), true);
    let tab = key_with(Key::Tab, Modifiers::NONE, true);
    assert_eq!(frames[0], word, "the field has it before it is left");
    assert_eq!(frames[1], [tab], "Tab comes alone");
    assert_eq!(frames[2], [key_with(Key::Tab, Modifiers::NONE, false)], "a frame for the focus");
    assert_eq!(frames[3], word);
    assert_eq!(frames.concat(), events);
    assert_eq!(frames.len(), 6);
}

#[test]
fn text_after_a_command_waits_for_the_window_that_it_opens() {
    let open = vec![key_with(Key::L, Modifiers::COMMAND, true), key_with(Key::L, Modifiers::COMMAND, false)];
    let frames = frames([open.clone(), type_word("a")].concat(), false);
    assert_eq!(frames[..2], [open[..1].to_vec(), open[1..].to_vec()]);
    // Without a focused field, typed letters are commands: each comes with its text, or another field would get the
    // text.
    assert_eq!(frames[2], type_word("a")[..2]);
}

#[test]
fn keys_that_are_struck_are_counted_and_a_key_that_is_held_is_not_waited_for() {
    let undo = |pressed| key_with(Key::Z, Modifiers::COMMAND, pressed);
    let thrice = vec![[undo(true), undo(false)]; 3].concat();
    let presses = |frame: &Vec<Event>| {
        frame.iter().filter(|event| matches!(event, Event::Key { pressed: true, .. })).count()
    };
    let struck = frames(thrice, false);
    assert_eq!(struck.iter().map(presses).filter(|count| *count > 0).collect::<Vec<_>>(), [1, 1, 1]);
    let held =
        [vec![key_with(Key::ArrowLeft, Modifiers::NONE, true); 30], key_stroke(Key::ArrowLeft)].concat();
    assert!(frames(held, false).len() <= 2);
}

#[test]
fn what_comes_slowly_does_not_wait() {
    let mut pacing = InputPacing::default();
    for event in [drag_in_one_frame(), type_word("ab"), key_stroke(Key::Tab), key_stroke(Key::G)].concat() {
        let is_text = matches!(event, Event::Text(_));
        let frame = pacing.next_frame(vec![event.clone()], true);
        if !is_text {
            assert!(frame.contains(&event) || pacing.focus_settles, "{event:?}");
        }
        pacing.next_frame(Vec::new(), true);
        assert!(pacing.waiting.is_empty(), "{event:?}");
    }
}

/// Window context with input pacing, in virtual time.
struct PacingTestWindow {
    ctx: egui::Context,
    time_s: f64,
}

impl PacingTestWindow {
    fn new() -> Self {
        let ctx = egui::Context::default();
        ctx.add_plugin(InputPacing::default());
        Self { ctx, time_s: 0.0 }
    }

    /// Runs 20 frames of 0.3 s, the first with these events.
    fn run(&mut self, events: Vec<Event>, mut add: impl FnMut(&mut egui::Ui)) {
        let mut events = Some(events);
        for _ in 0..20 {
            self.time_s += 0.3;
            let input = egui::RawInput {
                screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(300.0, 200.0))),
                time: Some(self.time_s),
                events: events.take().unwrap_or_default(),
                ..egui::RawInput::default()
            };
            let mut output = self.ctx.run_ui(input, &mut add);
            output.textures_delta.clear();
        }
    }
}

#[test]
fn what_is_pressed_is_dragged_however_far_the_pointer_is_when_a_frame_begins() {
    let mut window = PacingTestWindow::new();
    let (mut handle, mut picture) = (egui::Vec2::ZERO, egui::Vec2::ZERO);
    let mut add = |ui: &mut egui::Ui| {
        let all = ui.interact(ui.max_rect(), egui::Id::unique("picture"), Sense::click_and_drag());
        let small = Rect::from_center_size(HANDLE, vec2(12.0, 12.0));
        let grip = ui.interact(small, egui::Id::unique("handle"), Sense::click_and_drag());
        picture += all.drag_delta();
        handle += grip.drag_delta();
    };
    window.run(Vec::new(), &mut add);
    window.run(drag_in_one_frame(), &mut add);
    assert_eq!((handle, picture), (FAR - HANDLE, egui::Vec2::ZERO));
}

#[test]
fn numbers_that_are_typed_with_tab_in_one_frame_go_where_they_belong() {
    let mut window = PacingTestWindow::new();
    let mut lengths = [1.0, 1.0, 1.0];
    let mut letters = 0;
    let mut add = |ui: &mut egui::Ui| {
        for (at, length) in lengths.iter_mut().enumerate() {
            let field = egui::DragValue::new(length).update_while_editing(false).max_decimals(6);
            let place = Rect::from_min_size(pos2(10.0 + 60.0 * at as f32, 10.0), vec2(50.0, 20.0));
            ui.put(place, field);
        }
        letters +=
            usize::from(!ui.ctx().text_edit_focused() && ui.input(|input| input.key_pressed(Key::Num5)));
    };
    window.run(Vec::new(), &mut add);
    let number = |text: &str| -> Vec<Event> {
        let sign = |sign: char| {
            let key = if sign == '.' { Key::Period } else { Key::from_name(&sign.to_string()).unwrap() };
            let [down, up] = key_stroke(key).try_into().unwrap();
            [down, Event::Text(sign.to_string()), up]
        };
        text.chars().flat_map(sign).collect()
    };
    let first = pos2(35.0, 20.0);
    let click = vec![Event::PointerMoved(first), button(first, true), button(first, false)];
    let tab = || key_stroke(Key::Tab);
    let events =
        [click, number("0.957"), tab(), number("0.957"), tab(), number("1.5"), key_stroke(Key::Enter)];
    window.run(events.concat(), &mut add);
    assert_eq!(lengths, [0.957, 0.957, 1.5]);
    assert_eq!(letters, 0, "digits were taken for commands");
}

#[test]
fn two_clicks_are_a_double_click_where_frames_are_slow() {
    let mut window = PacingTestWindow::new();
    let (mut clicks, mut doubles) = (0, 0);
    let mut add = |ui: &mut egui::Ui| {
        let all = ui.interact(ui.max_rect(), egui::Id::unique("picture"), Sense::click());
        clicks += usize::from(all.clicked());
        doubles += usize::from(all.double_clicked());
    };
    window.run(Vec::new(), &mut add);
    let click = [button(HANDLE, true), button(HANDLE, false)];
    window.run([click.clone(), click].concat(), &mut add);
    assert_eq!((clicks, doubles), (2, 1));
}

/// A colon is pressed with Shift, which is released first, so that the release is named by the unshifted character.
#[test]
fn a_released_key_is_named_as_it_was_pressed() {
    let key = |key, pressed| Event::Key {
        key,
        physical_key: Some(Key::Semicolon),
        pressed,
        repeat: false,
        modifiers: Modifiers::NONE,
    };
    let mut held = super::HeldKeys::default();
    let mut events = [key(Key::Colon, true), key(Key::Semicolon, false), key(Key::Semicolon, true)];
    held.rename_events(&mut events);
    assert_eq!(events, [key(Key::Colon, true), key(Key::Colon, false), key(Key::Semicolon, true)]);
    let mut events = [Event::WindowFocused(false), key(Key::Colon, true)];
    held.rename_events(&mut events);
    assert_eq!(events[1], key(Key::Colon, true), "nothing is held after the focus was lost");
}
