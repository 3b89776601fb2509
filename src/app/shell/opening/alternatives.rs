//! Switching to another series, channel, time step or component of the open file.

use super::VolumeOpener;
use super::plan::PendingLook;
use crate::app::common::alternatives::Alternatives;
use crate::app::text;
use crate::app::worker::loader::ReadChoices;
use chiaroscuro_volume::{ChoiceAspect, VolumeChoice};

impl VolumeOpener<'_> {
    /// Opens the next or the previous volume of the open file; `keeps_look` keeps the look for it.
    pub(crate) fn step_choice(&mut self, aspect: ChoiceAspect, is_forward: bool, keeps_look: bool) {
        let held = self.editor.document.volume.as_ref().map(|volume| &volume.held);
        let Some(all) = held.and_then(|held| Alternatives::new(held, aspect)) else {
            return self.editor.messages.note(text::chooser::single_item(aspect));
        };
        let next = if is_forward { Some(all.current() + 1) } else { all.current().checked_sub(1) };
        if let Some(next) = next.filter(|&next| next < all.count()) {
            let choice = all.choice(next);
            self.open_choice(&choice, keeps_look);
        }
    }

    /// Opens another volume of the open file; the current one stays until it is ready, and `keeps_look` keeps the
    /// look for it.
    pub(crate) fn open_choice(&mut self, choice: &VolumeChoice, keeps_look: bool) {
        let Some(volume) = &self.editor.document.volume else { return };
        if volume.held.choice() == *choice {
            // Cancels a choice in progress.
            self.state.loader.cancel();
            return;
        }
        let source = volume.source.clone();
        let reading = ReadChoices { choice: Some(choice.clone()), ..volume.reading.clone() };
        if self.start_loading(&source, reading) {
            self.state.requests.pending_look = keeps_look.then_some(PendingLook::Current);
        }
    }
}
