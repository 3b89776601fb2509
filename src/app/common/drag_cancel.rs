//! Cancelling of a drag by Escape: settings changed since the button went down are restored.

use eframe::egui::{self, Key, Modifiers};

use chiaroscuro_scene::Settings;

/// Settings to restore when a drag is cancelled.
#[derive(Debug, Default)]
pub(crate) struct DragCancel {
    /// Settings of the look when the button went down.
    before: Option<Settings>,
    /// True if Escape was pressed during a drag in this frame.
    requested: bool,
}

impl DragCancel {
    /// Consumes the key before anything else sees it; the toolkit ends the drag itself.
    pub(crate) fn begin(&mut self, ctx: &egui::Context, settings: &Settings) {
        let (pressed, down, drags) = ctx.input(|input| {
            let pointer = &input.pointer;
            (pointer.any_pressed(), pointer.any_down(), pointer.is_decidedly_dragging())
        });
        if pressed {
            // Another button during a drag does not start a new one.
            self.before.get_or_insert_with(|| settings.clone());
        } else if !down {
            self.before = None;
        }
        let is_held = self.before.is_some() && drags;
        self.requested = is_held && ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape));
    }

    /// Restores the settings, after all widgets that the drag could change have been shown once more.
    pub(crate) fn end(&mut self, settings: &mut Settings) {
        if std::mem::take(&mut self.requested)
            && let Some(before) = self.before.take()
        {
            *settings = before;
        }
    }
}
