//! Composition of layers: how the matter of several fields becomes that of one picture.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::{VolumeLayer, VolumeLayers};
use crate::{BakedTransfer, ClassificationOrder, Settings};
use chiaroscuro_volume::math::SceneSpace;
use chiaroscuro_volume::{Dataset, DensityMapping, MAX_FIELDS, ValueRange, ValueRanges, Volume, VolumeId};

/// Presence of a layer in the picture and in its light.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LayerVisibility {
    /// Seen, and attenuates light.
    #[default]
    Shown,
    /// Not seen, but goes on attenuating light.
    CastsShadows,
    /// Neither seen nor attenuating light.
    Hidden,
}

/// Effect of a layer on the matter of the layers before it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LayerBlend {
    /// Adds its own matter: extinctions add up, and the colour is their weighted mean.
    #[default]
    Add,
    /// Colours the matter of the layers before it, as far as its opacity goes. Adds no matter.
    Tint,
    /// Keeps the matter of the layers before it as far as its opacity goes, and removes the rest. Adds no matter.
    Gate,
    /// Replaces red of the colour of the layers before it by its density, as an sRGB value. Adds no matter.
    Red,
    /// Replaces green likewise.
    Green,
    /// Replaces blue likewise.
    Blue,
}

/// Way in which the layers of a scene become the matter of one picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LayerComposition {
    /// The first field alone.
    First,
    /// The first field, whose colours others tint: its matter is that of the field alone.
    Tinted,
    /// Voxels that are composed of several fields, or classified by more than their value.
    Composed,
}

impl LayerBlend {
    /// Blends in the order of lists.
    pub const ALL: [Self; 6] = [Self::Add, Self::Tint, Self::Gate, Self::Red, Self::Green, Self::Blue];

    /// Blends that replace red, green and blue.
    pub const CHANNELS: [Self; 3] = [Self::Red, Self::Green, Self::Blue];

    /// Returns the channel of colour that the blend replaces, from 0 for red.
    pub fn channel(self) -> Option<usize> {
        Self::CHANNELS.iter().position(|channel| *channel == self)
    }

    /// Returns true if the layer changes the colour of matter and not its amount.
    pub fn changes_color_alone(self) -> bool {
        self == Self::Tint || self.channel().is_some()
    }

    /// Returns true if the layer has a colour of its own, of its matter or of its tint.
    pub fn has_own_color(self) -> bool {
        self == Self::Add || self == Self::Tint
    }

    /// Returns true if the layer has matter of its own.
    pub fn adds_matter(self) -> bool {
        self == Self::Add
    }
}

impl VolumeLayer {
    /// Returns the quantity that densities of the layer's field represent, for a field with these value ranges.
    pub fn density_mapping(&self, ranges: &ValueRanges) -> DensityMapping {
        if self.labels.is_empty() {
            DensityMapping::Range(self.shown_range(ranges, None))
        } else {
            DensityMapping::Labels
        }
    }

    /// Returns true if the layer has an effect on what is seen.
    pub fn is_seen(&self) -> bool {
        self.visibility == LayerVisibility::Shown
    }

    /// Returns true if the layer has an effect on light.
    pub fn casts_shadows(&self) -> bool {
        self.visibility != LayerVisibility::Hidden
    }

    /// Returns true if the layer has an effect where cuts hide others.
    pub fn is_never_cut(&self) -> bool {
        self.ignores_cuts && self.casts_shadows()
    }

    /// Returns the opacity unit in scene units, safe to divide by.
    pub fn opacity_unit_in_scene(&self, scene: &SceneSpace) -> f64 {
        self.opacity_unit.scene_units(scene).max(1e-9)
    }

    /// Returns the transfer function of the eye as a table over a value range; empty if the layer is not seen.
    pub fn bake_eye(&self, range: ValueRange, scene: &SceneSpace) -> BakedTransfer {
        let scale = if self.is_seen() { 1.0 } else { 0.0 };
        self.transfer.bake(range, self.opacity_unit_in_scene(scene), scale)
    }

    /// Returns the lighting transfer function as a table over a value range; empty if the layer casts no shadows.
    pub fn bake_lighting(&self, range: ValueRange, scene: &SceneSpace) -> BakedTransfer {
        let function = if self.lighting.linked { &self.transfer } else { &self.lighting.curve };
        let scale = if self.casts_shadows() { self.lighting.scale } else { 0.0 };
        function.bake(range, self.opacity_unit_in_scene(scene), scale)
    }

    /// Returns true if the layer changes the picture of those before it: unless it is hidden, or only tints unseen.
    fn has_effect_on_others(&self) -> bool {
        self.is_seen() || self.casts_shadows() && !self.blend.changes_color_alone()
    }

    /// Returns true if opacity depends on more than the value, so that voxels are classified first.
    fn depends_on_gradients(&self) -> bool {
        self.edges > 0.0 || self.has_materials()
    }

    /// Returns the layer as it is drawn for a field: labels are replaced by a transfer function over their classes.
    fn resolve_labels(&mut self, field: &Volume) {
        if let Some(labels) = field.labels().filter(|_| !self.labels.is_empty()) {
            self.transfer = self.labels.step_function(labels);
            self.lighting.linked = true;
        }
    }
}

impl VolumeLayers {
    /// Returns all layers.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &VolumeLayer> + DoubleEndedIterator {
        self.0.iter()
    }

    /// Returns the number of layers, at least 1.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// Returns a layer.
    pub fn get(&self, index: usize) -> Option<&VolumeLayer> {
        self.0.get(index)
    }

    /// Adds a layer at the end, unless there are [`MAX_FIELDS`].
    pub fn push(&mut self, layer: VolumeLayer) {
        if self.0.len() < MAX_FIELDS {
            self.0.push(layer);
        }
    }

    /// Returns true if all layers but one are hidden.
    pub fn is_alone(&self, index: usize) -> bool {
        let is_other_hidden =
            |(at, layer): (usize, &VolumeLayer)| at == index || layer.visibility == LayerVisibility::Hidden;
        self.0.iter().enumerate().all(is_other_hidden)
    }

    /// Shows one layer and hides the others, or shows all of them.
    pub fn show_alone(&mut self, index: usize, is_alone: bool) {
        for (at, layer) in self.0.iter_mut().enumerate() {
            let is_shown = at == index || !is_alone;
            layer.visibility = if is_shown { LayerVisibility::Shown } else { LayerVisibility::Hidden };
        }
    }

    /// Removes a further layer; the first one stays. If it was the only one that was shown, the others are shown again.
    pub fn remove(&mut self, index: usize) {
        if !(1..self.0.len()).contains(&index) {
            return;
        }
        if self.is_alone(index) && self.0[index].casts_shadows() {
            self.show_alone(index, false);
        }
        self.0.remove(index);
    }

    /// Keeps the first layers, at least one.
    pub fn truncate(&mut self, count: usize) {
        self.0.truncate(count.max(1));
    }
}

impl Settings {
    /// Returns the way in which layers become the matter of one picture. Tints of a field that is classified after
    /// reconstruction leave its matter, and need no more than a colour, except where light takes colours, too.
    pub fn layer_composition(&self) -> LayerComposition {
        let further = || self.layers.iter().skip(1).filter(|layer| layer.has_effect_on_others());
        let first = self.layer();
        // Tints are of voxels in any case.
        let by_gradients = |(at, layer): (usize, &VolumeLayer)| {
            layer.casts_shadows()
                && layer.depends_on_gradients()
                && (at == 0 || !layer.blend.changes_color_alone())
        };
        if self.layers.iter().enumerate().any(by_gradients) {
            LayerComposition::Composed
        } else if further().next().is_none() {
            LayerComposition::First
        } else if further().all(|layer| layer.blend.changes_color_alone())
            && first.labels.is_empty()
            && !self.sampling.classification.is_pre()
            && !self.has_colored_shadows()
        {
            LayerComposition::Tinted
        } else {
            LayerComposition::Composed
        }
    }

    /// Returns true if matter is composed of several layers, or depends on more than a value: voxels are then
    /// classified before reconstruction.
    pub fn is_layered(&self) -> bool {
        self.layer_composition() == LayerComposition::Composed
    }

    /// Returns true if further layers change the colours of the first one, and nothing else.
    pub fn has_tints(&self) -> bool {
        self.layer_composition() == LayerComposition::Tinted
    }

    /// Returns the layers that stay whole where cuts hide others, a bit for each; none unless voxels are composed.
    pub fn layers_never_cut(&self) -> u8 {
        let never_cut = self.layers.iter().enumerate().filter(|(_, layer)| layer.is_never_cut());
        if self.is_layered() { never_cut.fold(0, |bits, (at, _)| bits | 1 << at) } else { 0 }
    }

    /// Returns the quantities that densities of the further fields represent.
    pub fn further_mappings(&self, id: &VolumeId) -> [Option<DensityMapping>; MAX_FIELDS - 1] {
        let mapping = |at: usize| {
            let (layer, ranges) = (self.layers.get(at + 1)?, id.further_ranges[at].as_ref()?);
            Some(layer.density_mapping(ranges))
        };
        std::array::from_fn(mapping)
    }

    /// Returns the settings as used for rendering a dataset: those for its [only field](Self::resolved_for), or with
    /// a layer for each of its fields. Layers without a field are left out. Modes other than matter show the first
    /// field alone.
    pub fn resolved_for_dataset(&self, dataset: &Dataset) -> Cow<'_, Self> {
        if self.layers.count() == 1 && !self.is_layered() {
            return self.resolved_for(dataset.volume());
        }
        let fields = dataset.fields();
        let mut drawn = self.clone();
        drawn.layer_mut().blend = LayerBlend::Add;
        if self.shows_matter() {
            // Layers at the end without effect change nothing, and one field is drawn sharper and faster.
            let used = self.layers.iter().take(fields.len()).rposition(VolumeLayer::has_effect_on_others);
            drawn.layers.truncate(used.map_or(1, |last| last + 1));
        } else {
            drawn.layers.truncate(1);
            drawn.layer_mut().edges = 0.0;
            drawn.layer_mut().materials.clear();
        }
        if drawn.is_layered() {
            drawn.sampling.classification = drawn.classification();
            if drawn.layers.iter().any(VolumeLayer::is_never_cut) {
                // Each layer is cut by itself, voxel by voxel.
                drawn.cuts = drawn.cuts.by_shapes();
            }
        } else {
            drawn = drawn.resolved_for(dataset.volume()).into_owned();
        }
        for (layer, field) in drawn.layers.iter_mut().zip(fields.iter()) {
            layer.resolve_labels(field.volume());
            layer.resolve_materials(field.volume());
        }
        Cow::Owned(drawn)
    }

    /// Returns the table that attenuates light in a layer's field, with extinction shares if shadows are coloured.
    pub fn bake_lighting_of(
        &self,
        layer: &VolumeLayer,
        range: ValueRange,
        scene: &SceneSpace,
    ) -> BakedTransfer {
        let baked = layer.bake_lighting(range, scene);
        if self.has_colored_shadows() {
            baked.with_extinction_shares(self.shadows.transmission)
        } else {
            baked
        }
    }

    /// Returns the order of classification if layers are composed.
    pub(crate) fn layered_classification(&self) -> Option<ClassificationOrder> {
        self.is_layered().then_some(ClassificationOrder::Pre)
    }
}
