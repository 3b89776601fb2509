//! Choice of the volume over which others are shown: the picture has its grid.

use std::path::Path;

use super::VolumeOpener;
use super::layers::{LayerFile, LayerReplacement};
use super::second_volume::{common_volume, world_box};
use crate::app::text;
use crate::app::worker::loader::{OpenedVolume, ReadChoices};
use chiaroscuro_volume::{DataKind, MAX_FIELDS, Volume, math::Aabb};

/// Largest ratio of the volumes of two voxels at which the smaller one is worth another grid: voxels a fifth shorter.
const FINER_VOXEL: f64 = 0.5;

/// Share of the open volume's box that a finer one must have in it, so that little is lost outside its grid.
const COVERED_SHARE: f64 = 0.8;

/// Returns true if an open volume is better shown over another one than that one over it: labels over what they are
/// of, and coarse voxels over fine ones, which would be lost in a coarse grid.
pub(super) fn is_better_base(volume: &Volume, open: &Volume) -> bool {
    let is_label = |volume: &Volume| matches!(volume.kind().kind, DataKind::LabelMap { .. } | DataKind::Mask);
    if is_label(volume) || is_label(open) {
        return is_label(open) && !is_label(volume) && !is_much_coarser(volume, open);
    }
    let [finer, coarser] = [volume, open].map(world_box);
    let size = |bounds: &Aabb| (bounds.max - bounds.min).element_product();
    is_much_coarser(open, volume) && common_volume(&finer, &coarser) >= COVERED_SHARE * size(&coarser)
}

/// Returns true if details of a fine volume would be lost on the grid of a coarse one.
fn is_much_coarser(coarse: &Volume, fine: &Volume) -> bool {
    let voxel = |volume: &Volume| volume.world_from_index().matrix3.determinant().abs();
    voxel(fine) < FINER_VOXEL * voxel(coarse)
}

impl VolumeOpener<'_> {
    /// Returns true if the open volumes can become layers over another one: files that can be read again as they are,
    /// and not more than fit.
    pub(super) fn can_become_layers(&self) -> bool {
        let Some(open) = &self.editor.document.volume else { return false };
        let is_as_read = open.reading.raw.is_none() && open.volume.corrections().is_none();
        is_as_read && self.editor.document.settings.layers.count() < MAX_FIELDS
    }

    /// Shows a volume that has been read, and the open ones as layers over it.
    pub(super) fn show_below(&mut self, opened: OpenedVolume) {
        self.state.requests.layers_over = self.open_volumes_as_layers();
        self.show_opened_with_session(opened);
    }

    /// Opens a volume, and then shows those that are open now as layers over it.
    pub(super) fn open_below(&mut self, source: &Path) {
        let layers = self.open_volumes_as_layers();
        if self.start_loading(source, ReadChoices::default()) {
            self.state.requests.pending_look = None;
            self.state.requests.layers_over = layers;
        }
    }

    /// Adds the volumes that were open before as layers, if there are any.
    pub(super) fn add_layers_over(&mut self) {
        let layers = std::mem::take(&mut self.state.requests.layers_over);
        if !layers.is_empty() {
            self.editor.messages.note(text::opening::shown_below(self.editor.document.volume_name()));
            self.add_layers(layers, LayerReplacement::BELOW_ALL);
        }
    }

    /// Returns the open volumes as layers, with the looks that the user has changed.
    fn open_volumes_as_layers(&self) -> Vec<LayerFile> {
        let document = &self.editor.document;
        let Some(open) = &document.volume else { return Vec::new() };
        let further = open.further.iter().map(|volume| (&volume.origin.source, volume.origin.choice.clone()));
        let volumes = std::iter::once((&open.source, open.held.choice())).chain(further);
        let shown = volumes.zip(document.settings.layers.iter());
        let mut layers = Vec::new();
        for (index, ((source, choice), look)) in shown.enumerate() {
            let is_changed = look != document.defaults.layer_at(index);
            let mut layer = LayerFile::new(source, choice);
            layer.look = is_changed.then(|| look.clone());
            layers.push(layer);
        }
        layers
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_volume::Samples;
    use glam::{DAffine3, DVec3};

    fn volume(edge: usize, spacing: f64, value: impl Fn(usize) -> i16) -> Volume {
        let map = DAffine3::from_scale(DVec3::splat(spacing));
        let values = Samples::I16((0..edge.pow(3)).map(value).collect());
        Volume::new("t", [edge; 3], map, values).unwrap().with_anatomical_axes(true)
    }

    #[test]
    fn labels_and_coarse_scans_lie_over_fine_ones() {
        let scan = |edge, spacing| volume(edge, spacing, |at| (at * 7919 % 1777) as i16);
        let labels = |edge, spacing| volume(edge, spacing, |at| (at / 9000 % 3) as i16);
        assert!(matches!(labels(32, 1.0).kind().kind, DataKind::LabelMap { .. } | DataKind::Mask));
        assert!(is_better_base(&scan(32, 1.0), &scan(16, 2.0)));
        assert!(!is_better_base(&scan(16, 2.0), &scan(32, 1.0)));
        assert!(!is_better_base(&scan(32, 1.0), &scan(30, 1.1)), "about as fine");
        assert!(!is_better_base(&scan(16, 1.0), &scan(16, 2.0)), "of a part");
        assert!(is_better_base(&scan(32, 1.0), &labels(32, 1.0)));
        assert!(!is_better_base(&labels(32, 1.0), &scan(32, 1.0)));
        assert!(!is_better_base(&scan(8, 4.0), &labels(32, 1.0)), "labels that are finer");
    }
}
