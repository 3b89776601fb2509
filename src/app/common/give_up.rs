//! Escape while the mouse drags something: what the hand has changed since the button went down is as it was.

use eframe::egui::{self, Key, Modifiers};

use crate::model::Settings;

/// What a drag can go back to.
#[derive(Debug, Default)]
pub(in crate::app) struct GiveUp {
    /// The look when the button went down.
    before: Option<Settings>,
    /// In this frame.
    is_asked: bool,
}

impl GiveUp {
    /// Takes the key, before anything else sees it; the window library ends the drag by itself.
    pub(in crate::app) fn begin(&mut self, ctx: &egui::Context, settings: &Settings) {
        let (pressed, down, drags) = ctx.input(|input| {
            let pointer = &input.pointer;
            (pointer.any_pressed(), pointer.any_down(), pointer.is_decidedly_dragging())
        });
        if pressed {
            // Another button during a drag begins no other one.
            self.before.get_or_insert_with(|| settings.clone());
        } else if !down {
            self.before = None;
        }
        let is_held = self.before.is_some() && drags;
        self.is_asked = is_held && ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape));
    }

    /// Goes back, after all that the drag could change has been shown once more.
    pub(in crate::app) fn end(&mut self, settings: &mut Settings) {
        if std::mem::take(&mut self.is_asked)
            && let Some(before) = self.before.take()
        {
            *settings = before;
        }
    }
}
