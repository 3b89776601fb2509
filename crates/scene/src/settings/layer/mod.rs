//! Layers of a scene: the settings that belong to one field of the volume each.
//!
//! A file can have several fields on one grid, for instance channels of a microscope. Settings that differ by field
//! are in a layer; camera, light, clipping and sampling are of the scene.

pub(crate) mod composition;
pub(crate) mod density_range;
pub(crate) mod label_table;
pub(crate) mod length;
pub(crate) mod material_box;
pub(crate) mod material_sample;

use serde::{Deserialize, Serialize};

use self::composition::{LayerBlend, LayerVisibility};
use self::material_box::MaterialBox;
use crate::{DensityRange, LabelTable, OpacityLength, Settings, TransferFunction};
use chiaroscuro_volume::MAX_FIELDS;

/// Settings that belong to one field of the volume.
///
/// Corrections of the volume are not among them: they are of the file's grid and of the numbers that it stores, which
/// all of its fields share, so they stay in [`Settings::volume`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct VolumeLayer {
    /// Range of values that is mapped to densities of 0 … 1.
    pub range: DensityRange,
    /// Looks of labels, by number. If it has entries, volumes of integers are shown by their labels, and the transfer
    /// functions are not used.
    pub labels: LabelTable,
    /// Transfer function of the eye: colour and opacity of every value.
    pub transfer: TransferFunction,
    /// Opacity that attenuates light.
    pub lighting: LightingTransfer,
    /// Length to which opacities refer.
    pub opacity_unit: OpacityLength,
    /// Presence in the picture and in its light.
    pub visibility: LayerVisibility,
    /// Effect on the layers before it; the first layer always adds its matter.
    pub blend: LayerBlend,
    /// Change of density per voxel from which on opacity is that of the curve, 0 … 1: it fades to nothing at half of
    /// it, so that edges are left. 0 leaves all opacities. Of labels, any other leaves their outlines: voxels beside
    /// another label.
    pub edges: f64,
    /// Materials by value and change, at most [`crate::MAX_MATERIAL_BOXES`]. If there are any, and no labels, they take the
    /// place of the transfer functions.
    pub materials: Vec<MaterialBox>,
    /// Leaves the layer whole where cuts hide others, if voxels are composed of several layers.
    pub ignores_cuts: bool,
}

impl Default for VolumeLayer {
    fn default() -> Self {
        Self {
            range: DensityRange::Robust,
            labels: LabelTable::default(),
            transfer: TransferFunction::default(),
            lighting: LightingTransfer::default(),
            opacity_unit: OpacityLength::Voxels(1.0),
            visibility: LayerVisibility::Shown,
            blend: LayerBlend::Add,
            edges: 0.0,
            materials: Vec::new(),
            ignores_cuts: false,
        }
    }
}

/// Opacity that attenuates light: the eye's, scaled, or a curve of its own (P §4: lower opacities here let light
/// faintly pass thin opaque structures).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LightingTransfer {
    /// Uses the eye's opacity instead of the curve.
    pub linked: bool,
    /// Factor for the extinction, linked or not.
    pub scale: f64,
    /// Opacity curve if not linked; its colours are not used.
    pub curve: TransferFunction,
}

impl Default for LightingTransfer {
    fn default() -> Self {
        Self { linked: true, scale: 1.0, curve: TransferFunction::default() }
    }
}

/// Layers of a scene, a list in JSON of 1 … [`MAX_FIELDS`] layers, one for each field of the dataset.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<VolumeLayer>")]
pub struct VolumeLayers(Vec<VolumeLayer>);

/// Number of layers that a scene of this version cannot have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum LayerCountError {
    /// Empty list, which would show nothing.
    #[error("`layers` is empty, and a look has one layer")]
    None,
    /// List longer than a picture can show.
    #[error("`layers` has {count} layers, and a picture shows {MAX_FIELDS} at most")]
    TooMany {
        /// Length of the list.
        count: usize,
    },
}

impl VolumeLayers {
    /// Creates the list of a scene that shows one field.
    pub fn new(layer: VolumeLayer) -> Self {
        Self(vec![layer])
    }

    /// Returns the first layer of the list.
    pub fn first(&self) -> &VolumeLayer {
        &self.0[0]
    }

    /// Returns the first layer, to be changed.
    pub fn first_mut(&mut self) -> &mut VolumeLayer {
        &mut self.0[0]
    }

    fn get_or_first_mut(&mut self, index: usize) -> &mut VolumeLayer {
        let index = if index < self.0.len() { index } else { 0 };
        &mut self.0[index]
    }

    fn exchange_with_first(&mut self, index: usize) {
        if index < self.0.len() {
            self.0.swap(0, index);
        }
    }

    /// Replaces all layers but the first by those of another list.
    pub fn replace_further(&mut self, from: &Self) {
        self.0.truncate(1);
        self.0.extend_from_slice(&from.0[1..]);
    }

    /// Returns all layers, to be changed.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut VolumeLayer> {
        self.0.iter_mut()
    }
}

impl Default for VolumeLayers {
    fn default() -> Self {
        Self::new(VolumeLayer::default())
    }
}

impl TryFrom<Vec<VolumeLayer>> for VolumeLayers {
    type Error = LayerCountError;

    fn try_from(layers: Vec<VolumeLayer>) -> Result<Self, LayerCountError> {
        match layers.len() {
            0 => Err(LayerCountError::None),
            1..=MAX_FIELDS => Ok(Self(layers)),
            count => Err(LayerCountError::TooMany { count }),
        }
    }
}

impl Settings {
    /// Returns the settings of the field that is shown.
    pub fn layer(&self) -> &VolumeLayer {
        self.layers.first()
    }

    /// Returns the settings of the field that is shown, to be changed. [`VolumeLayers::first_mut`] leaves the other
    /// settings free to be borrowed.
    pub fn layer_mut(&mut self) -> &mut VolumeLayer {
        self.layers.first_mut()
    }

    /// Returns the settings of a field, or of the first one if there are none for it.
    pub fn layer_at(&self, index: usize) -> &VolumeLayer {
        self.layers.get(index).unwrap_or_else(|| self.layer())
    }

    /// Returns the settings of a field, or of the first one if there are none for it, to be changed.
    pub fn layer_at_mut(&mut self, index: usize) -> &mut VolumeLayer {
        self.layers.get_or_first_mut(index)
    }

    /// Returns the settings with a layer in the place of the first one and the first one in its place, so that what
    /// applies to the first field, such as a preset, applies to another one. Twice gives the same settings.
    #[must_use]
    pub fn with_first_exchanged(mut self, index: usize) -> Self {
        self.layers.exchange_with_first(index);
        self
    }

    /// Takes the layers of another look that these settings lack, and replaces those that they have, and the camera,
    /// where they are as in `before`.
    pub fn take_layers(&mut self, from: &Self, before: &Self) {
        let known = before.layers.0.iter();
        for ((own, before), new) in self.layers.0.iter_mut().zip(known).zip(&from.layers.0) {
            if own == before {
                own.clone_from(new);
            }
        }
        let count = self.layers.0.len().min(from.layers.0.len());
        self.layers.0.extend_from_slice(&from.layers.0[count..]);
        if self.camera == before.camera {
            self.camera.clone_from(&from.camera);
        }
    }

    /// Removes a further layer, in saved looks, too: layers name their field by their place, which then is the one
    /// before for all that follow.
    pub fn remove_layer(&mut self, index: usize) {
        self.layers.remove(index);
        self.kept.iter_mut().for_each(|entry| entry.remove_layer(index));
    }

    /// Replaces the range of values that is mapped to densities.
    #[must_use]
    pub fn with_range(mut self, range: DensityRange) -> Self {
        self.layer_mut().range = range;
        self
    }

    /// Replaces the table of labels.
    #[must_use]
    pub fn with_labels(mut self, labels: LabelTable) -> Self {
        self.layer_mut().labels = labels;
        self
    }

    /// Replaces the transfer function of the eye.
    #[must_use]
    pub fn with_transfer(mut self, transfer: TransferFunction) -> Self {
        self.layer_mut().transfer = transfer;
        self
    }

    /// Replaces the opacity that attenuates light.
    #[must_use]
    pub fn with_lighting(mut self, lighting: LightingTransfer) -> Self {
        self.layer_mut().lighting = lighting;
        self
    }

    /// Replaces the length to which opacities refer.
    #[must_use]
    pub fn with_opacity_unit(mut self, opacity_unit: OpacityLength) -> Self {
        self.layer_mut().opacity_unit = opacity_unit;
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SavedEntry;

    #[test]
    fn a_list_has_one_to_four_layers() {
        let layer = VolumeLayer { range: DensityRange::Full, ..VolumeLayer::default() };
        let layers = |count: usize| VolumeLayers::try_from(vec![layer.clone(); count]);
        assert_eq!(layers(1), Ok(VolumeLayers::new(layer.clone())));
        assert_eq!(layers(0).unwrap_err().to_string(), "`layers` is empty, and a look has one layer");
        assert_eq!(layers(4).unwrap().count(), 4);
        let five = layers(5).unwrap_err().to_string();
        assert_eq!(five, "`layers` has 5 layers, and a picture shows 4 at most");
    }

    #[test]
    fn a_removed_layer_leaves_the_others_as_they_are() {
        let with = |edges: &[f64]| {
            let layer = |&edges: &f64| VolumeLayer { edges, ..VolumeLayer::default() };
            let layers = edges.iter().map(layer).collect::<Vec<_>>().try_into().unwrap();
            Settings { layers, ..Settings::default() }
        };
        let mut settings = with(&[0.1, 0.2, 0.3]);
        for (name, look) in [("all", &settings.clone()), ("first", &with(&[0.1]))] {
            assert!(settings.save_entry(SavedEntry::look(name, look)));
        }
        settings.remove_layer(1);
        let left = with(&[0.1, 0.3]).layers;
        assert_eq!(settings.layers, left);
        let saved = |at: usize| &settings.kept[at].as_look().unwrap().layers;
        assert_eq!((saved(0), saved(1)), (&left, &with(&[0.1]).layers));
        // The first one stays, and there is no third.
        settings.remove_layer(0);
        settings.remove_layer(2);
        assert_eq!(settings.layers, left);
    }

    #[test]
    fn others_are_shown_when_the_only_one_shown_is_removed() {
        let hidden = |layers: &VolumeLayers| layers.iter().map(|layer| !layer.is_seen()).collect::<Vec<_>>();
        let mut layers = VolumeLayers::try_from(vec![VolumeLayer::default(); 4]).unwrap();
        layers.show_alone(1, true);
        layers.remove(3);
        assert_eq!(hidden(&layers), [true, false, true], "the others keep their presence");
        layers.remove(1);
        assert_eq!(hidden(&layers), [false, false]);
    }
}
