//! Question whether a dropped volume is shown over the open one, where both lie in the same place.

use std::path::{Path, PathBuf};

use eframe::egui;

use super::VolumeOpener;
use super::base_volume::{common_volume, is_better_base, world_box};
use crate::app::common::overlay_windows;
use crate::app::text;
use crate::app::worker::loader::OpenedVolume;
use chiaroscuro_volume::{Volume, math::Aabb};

/// Share of the smaller of two boxes that they have in common if they are scans of one body.
const COMMON_SHARE: f64 = 0.5;

/// Question about a volume that was dropped while another is open.
#[derive(Default)]
pub(super) struct SecondVolumeQuestion {
    /// File that was dropped, until it has been read.
    dropped: Option<PathBuf>,
    /// Volume that was read, and waits for the answer.
    waiting: Option<Box<OpenedVolume>>,
}

impl SecondVolumeQuestion {
    /// Notes that a file was dropped, so that the question may be asked when it has been read.
    pub(super) fn note_dropped(&mut self, path: &Path) {
        self.dropped = Some(path.to_owned());
    }

    /// Ends the question: another volume is opened.
    pub(super) fn close(&mut self) {
        *self = Self::default();
    }

    /// Shows the question, if there is one. Returns true for showing both volumes, false for the dropped one alone.
    fn ui(&self, ctx: &egui::Context, open: &str) -> Option<bool> {
        let waiting = self.waiting.as_ref()?;
        let (mut is_open, mut answer) = (true, None);
        let window = egui::Window::new(text::opening::SECOND_VOLUME).open(&mut is_open);
        let window = window.constrain_to(overlay_windows::window_area(ctx));
        let window = window.collapsible(false).resizable(false).default_pos([140.0, 90.0]);
        let shown = window.show(ctx, |ui| {
            ui.set_max_width(420.0);
            ui.label(text::opening::lies_over(waiting.dataset.volume().name(), open));
            ui.horizontal(|ui| {
                for (words, both) in [(text::opening::SHOW_BOTH, true), (text::opening::OPEN_ALONE, false)] {
                    if ui.button(words).clicked() {
                        answer = Some(both);
                    }
                }
            });
        });
        is_open &= !overlay_windows::escape_closes(ctx, shown.as_ref().map(|shown| &shown.response));
        answer.or_else(|| (!is_open).then_some(false))
    }
}

impl VolumeOpener<'_> {
    /// Shows a volume that has been read, or first asks whether it is shown over the open one.
    pub(super) fn show_or_ask(&mut self, opened: Box<OpenedVolume>) {
        let is_dropped = self.state.second_volume.dropped.take().is_some_and(|path| path == opened.source);
        let shown = self.editor.viewport.dataset();
        let is_other = self.editor.document.volume.as_ref().is_some_and(|open| open.source != opened.source);
        let lies_over = shown.is_some_and(|shown| lies_over(opened.dataset.volume(), shown.volume()));
        if is_dropped && is_other && lies_over && self.state.requests.pending_look.is_none() {
            self.state.second_volume.waiting = Some(opened);
        } else {
            self.show_opened_with_session(*opened);
        }
    }

    /// Shows the question about a dropped volume, and shows the volume as the user answers.
    pub(super) fn show_second_volume_question(&mut self) {
        let open = self.editor.document.volume_name();
        let Some(both) = self.state.second_volume.ui(self.ctx, open) else { return };
        let Some(opened) = self.state.second_volume.waiting.take() else { return };
        let is_base = self.editor.viewport.dataset().is_some_and(|shown| {
            is_better_base(opened.dataset.volume(), shown.volume()) && self.can_become_layers()
        });
        if both && is_base {
            self.show_below(*opened);
        } else if both {
            self.add_layer(&opened.source);
        } else {
            self.show_opened_with_session(*opened);
        }
    }
}

/// Returns true if a volume lies where another one does: in the space of a body, if both files state it; else in a grid
/// of the same dimensions.
fn lies_over(volume: &Volume, open: &Volume) -> bool {
    if !(volume.is_anatomical() && open.is_anatomical()) {
        return volume.dims() == open.dims();
    }
    let [a, b] = [volume, open].map(world_box);
    let size = |bounds: &Aabb| (bounds.max - bounds.min).element_product();
    common_volume(&a, &b) >= COMMON_SHARE * size(&a).min(size(&b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_volume::Samples;
    use glam::{DAffine3, DMat3, DVec3};

    fn volume(dims: [usize; 3], spacing: f64, origin: [f64; 3], is_anatomical: bool) -> Volume {
        let map = DAffine3 {
            matrix3: DMat3::from_diagonal(DVec3::splat(spacing)),
            translation: DVec3::from(origin),
        };
        let values = (0..dims.iter().product::<usize>()).map(|at| at as u8).collect();
        Volume::new("t", dims, map, Samples::U8(values)).unwrap().with_anatomical_axes(is_anatomical)
    }

    #[test]
    fn scans_of_one_body_share_its_space() {
        let ct = volume([20, 20, 20], 1.0, [0.0; 3], true);
        assert!(lies_over(&volume([8, 8, 8], 2.0, [3.0; 3], true), &ct), "a coarser scan of a part");
        assert!(!lies_over(&volume([20, 20, 20], 1.0, [15.0; 3], true), &ct), "corners overlap");
        assert!(!lies_over(&volume([20, 20, 20], 1.0, [90.0; 3], true), &ct), "somewhere else");
        // Positions that files do not state mean nothing.
        assert!(lies_over(&volume([20, 20, 20], 3.0, [90.0; 3], false), &ct));
        assert!(!lies_over(&volume([20, 20, 21], 1.0, [0.0; 3], false), &ct));
    }
}
