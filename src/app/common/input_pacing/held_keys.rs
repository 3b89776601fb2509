//! Held keys: names the release of a key as its press was named.
//!
//! A key is named by the character that it types. Where Shift is released first, a colon is pressed and a semicolon
//! released, and the toolkit would take the colon for held until the window loses the focus.

use eframe::egui::{Event, Key};

/// Keys that are held: their place on the keyboard, and their name when they were pressed.
#[derive(Debug, Default)]
pub(super) struct HeldKeys(Vec<(Key, Key)>);

impl HeldKeys {
    /// Renames repetitions and releases of held keys to the names of their presses.
    pub(super) fn rename_events(&mut self, events: &mut [Event]) {
        for event in events {
            match event {
                Event::Key { key, physical_key: Some(place), pressed, .. } => {
                    let held = self.0.iter().position(|(at, _)| at == place);
                    match (held, *pressed) {
                        (Some(at), true) => *key = self.0[at].1,
                        (Some(at), false) => *key = self.0.swap_remove(at).1,
                        (None, true) => self.0.push((*place, *key)),
                        (None, false) => {}
                    }
                }
                // The toolkit forgets all held keys then.
                Event::WindowFocused(false) => self.0.clear(),
                _ => {}
            }
        }
    }
}
