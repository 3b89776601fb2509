//! Measurement of the balance of light and shadow, while no picture is due.

use super::RenderWorker;
use crate::app::worker::mailbox::BalanceRequest;
use chiaroscuro_render::measure_balance_fast;

impl RenderWorker {
    /// Returns true if a balance can be measured now: pictures have priority.
    pub(super) fn can_measure(&self) -> bool {
        self.scene.is_some() && self.agenda.is_idle()
    }

    /// Measures the balance requested by the window: three small pictures with the light volumes that are present.
    pub(super) fn measure_balance(&mut self) {
        if !self.can_measure() {
            return;
        }
        let Some(BalanceRequest { id, settings }) = self.shared.mailbox().balance_request.take() else {
            return;
        };
        let Some(scene) = &mut self.scene else { return };
        let balance = measure_balance_fast(&mut scene.renderer, &scene.dataset, &settings);
        self.shared.mailbox().balance_result = Some((id, balance));
        self.ctx.request_repaint();
    }
}
