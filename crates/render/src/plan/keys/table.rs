//! Keys of the lookup tables of the transfer functions.

use crate::plan::{RenderRequest, VolumeKey};
use chiaroscuro_scene::{
    ColorMixing, Easing, LabelMaterial, LayerBlend, LightingTransfer, MaterialBox, OpacityInterpolation,
    OpacityLength, Settings, TransferFunction, VolumeLayer,
};

/// Inputs of both lookup tables.
#[derive(Debug, Clone, PartialEq)]
pub struct TablesKey {
    /// Volume whose shown range and bricks the tables refer to.
    pub volume: VolumeKey,
    /// Pages whose densities the bounds of cells hold for.
    pub bounds: u64,
    /// Transfer function of the eye.
    pub eye: EyeTableKey,
    /// Opacities of the material that attenuate light.
    pub lighting: OpacityKey,
    /// Transmission colours of the material, if shadows are coloured.
    pub transmission: Option<TransmissionKey>,
    /// True if the bounds of cells hold for all kernels in use.
    pub cells_are_bounds: bool,
}

/// Inputs of the eye's table: for each layer the curve with its colours, or looks of labels, and the opacity unit.
#[derive(Debug, Clone, PartialEq)]
pub struct EyeTableKey(Vec<EyeLayerKey>);

#[derive(Debug, Clone, PartialEq)]
struct EyeLayerKey {
    looks: EyeTableLooks,
    material_colors: Vec<[f32; 3]>,
    unit: OpacityLength,
    composition: CompositionKey,
}

/// Inputs by which a layer is composed with others.
#[derive(Debug, Clone, PartialEq)]
struct CompositionKey {
    has_matter: bool,
    blend: LayerBlend,
    edges: f64,
    /// Materials without their colours.
    materials: Vec<MaterialBox>,
}

#[derive(Debug, Clone, PartialEq)]
enum EyeTableLooks {
    Values(TransferFunction),
    Labels(Vec<LabelMaterial>),
}

/// Inputs of the opacities that attenuate light: for each layer, without colours.
#[derive(Debug, Clone, PartialEq)]
pub struct OpacityKey(Vec<OpacityLayerKey>);

#[derive(Debug, Clone, PartialEq)]
struct OpacityLayerKey {
    opacities: LightingOpacities,
    scale: f64,
    unit: OpacityLength,
    composition: CompositionKey,
}

/// Inputs of the extinction of each colour channel, apart from opacities.
#[derive(Debug, Clone, PartialEq)]
pub struct TransmissionKey {
    /// Colours of each layer.
    colors: Vec<TransmissionColors>,
    share: f64,
}

#[derive(Debug, Clone, PartialEq)]
enum TransmissionColors {
    Values(Vec<[f32; 3]>, ColorMixing),
    Labels(Vec<[f32; 3]>),
}

#[derive(Debug, Clone, PartialEq)]
enum LightingOpacities {
    Values { points: Vec<([f64; 2], Easing)>, interpolation: OpacityInterpolation },
    Labels(Vec<(i64, f64)>),
}

impl TablesKey {
    /// Creates the key of both tables of a picture.
    pub(super) fn new(request: &RenderRequest) -> Self {
        let settings = &request.settings;
        Self {
            volume: request.volume_key(),
            bounds: request.shown_pages().bounds,
            eye: EyeTableKey::new(settings),
            lighting: OpacityKey::new(settings),
            transmission: TransmissionKey::new(settings),
            cells_are_bounds: settings.cell_bounds_hold(),
        }
    }
}

impl EyeTableKey {
    /// Creates the key of the eye's table in a look.
    pub(super) fn new(settings: &Settings) -> Self {
        Self(settings.layers.iter().enumerate().map(EyeLayerKey::new).collect())
    }
}

impl EyeLayerKey {
    fn new((index, layer): (usize, &VolumeLayer)) -> Self {
        let looks = if layer.labels.is_empty() {
            EyeTableLooks::Values(layer.transfer.clone())
        } else {
            EyeTableLooks::Labels(layer.labels.materials())
        };
        let composition = CompositionKey::new(index, layer, layer.is_seen());
        let material_colors = used_materials(layer).map(|material| material.color).collect();
        Self { looks, material_colors, unit: layer.opacity_unit, composition }
    }
}

/// Materials by which a layer is drawn.
fn used_materials(layer: &VolumeLayer) -> impl Iterator<Item = &MaterialBox> {
    layer.materials.iter().filter(|_| layer.has_materials())
}

impl CompositionKey {
    fn new(index: usize, layer: &VolumeLayer, has_matter: bool) -> Self {
        // There is nothing before the first layer.
        let blend = if index == 0 { LayerBlend::Add } else { layer.blend };
        let materials = used_materials(layer).map(|material| MaterialBox { color: [0.0; 3], ..*material });
        Self { has_matter, blend, edges: layer.edges, materials: materials.collect() }
    }
}

impl OpacityKey {
    /// Creates the key of the opacities that attenuate light in a look.
    pub(super) fn new(settings: &Settings) -> Self {
        Self(settings.layers.iter().enumerate().map(OpacityLayerKey::new).collect())
    }
}

impl OpacityLayerKey {
    fn new((index, layer): (usize, &VolumeLayer)) -> Self {
        let LightingTransfer { linked, scale, curve } = &layer.lighting;
        let opacities = if layer.labels.is_empty() {
            let curve = if *linked { &layer.transfer } else { curve };
            let TransferFunction { points, interpolation, mixing: _ } = curve;
            LightingOpacities::Values {
                points: points.iter().map(|point| ([point.value, point.opacity], point.easing)).collect(),
                interpolation: *interpolation,
            }
        } else {
            let materials = layer.labels.materials().into_iter();
            LightingOpacities::Labels(materials.map(|material| (material.number, material.opacity)).collect())
        };
        Self {
            opacities,
            scale: *scale,
            unit: layer.opacity_unit,
            composition: CompositionKey::new(index, layer, layer.casts_shadows()),
        }
    }
}

impl TransmissionKey {
    /// Creates the key of the colour channels' extinction in a look; `None` if shadows are grey.
    pub(super) fn new(settings: &Settings) -> Option<Self> {
        let share = settings.shadows.transmission;
        settings
            .has_colored_shadows()
            .then(|| Self { colors: settings.layers.iter().map(TransmissionColors::new).collect(), share })
    }
}

impl TransmissionColors {
    fn new(layer: &VolumeLayer) -> Self {
        if !layer.labels.is_empty() {
            let materials = layer.labels.materials().into_iter();
            return Self::Labels(materials.map(|material| material.color).collect());
        }
        let LightingTransfer { linked, scale: _, curve } = &layer.lighting;
        let curve = if *linked { &layer.transfer } else { curve };
        let materials = used_materials(layer).map(|material| material.color);
        Self::Values(curve.points.iter().map(|point| point.color).chain(materials).collect(), curve.mixing)
    }
}
