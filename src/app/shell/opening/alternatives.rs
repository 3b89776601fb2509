//! Switching to another series, channel, time step or component of the open file.

use super::VolumeOpener;
use super::plan::PendingLook;
use crate::app::common::alternatives::Alternatives;
use crate::app::text;
use crate::app::worker::loader::ReadChoices;
use chiaroscuro_volume::{ChoiceAspect, VolumeChoice};

impl VolumeOpener<'_> {
    /// Returns the next or the previous volume of the open file, or `None` at the end; notes if there is only one.
    pub(crate) fn neighbour_choice(
        &mut self,
        aspect: ChoiceAspect,
        is_forward: bool,
    ) -> Option<VolumeChoice> {
        let held = self.editor.document.volume.as_ref().map(|volume| &volume.held);
        let Some(all) = held.and_then(|held| Alternatives::new(held, aspect)) else {
            self.editor.messages.note(text::chooser::single_item(aspect));
            return None;
        };
        let next = if is_forward { Some(all.current() + 1) } else { all.current().checked_sub(1) };
        next.filter(|&next| next < all.count()).map(|next| all.choice(next))
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
