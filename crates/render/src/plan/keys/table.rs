//! Keys of the lookup tables of the transfer functions.

use crate::plan::{RenderRequest, VolumeKey};
use chiaroscuro_scene::{
    ColorMixing, Easing, LabelMaterial, LightingTransfer, OpacityInterpolation, OpacityLength, Settings,
    TransferFunction,
};

/// Inputs of both lookup tables.
#[derive(Debug, Clone, PartialEq)]
pub struct TablesKey {
    /// Volume whose shown range and bricks the tables refer to.
    pub volume: VolumeKey,
    /// Transfer function of the eye.
    pub eye: EyeTableKey,
    /// Opacities of the material that attenuate light.
    pub lighting: OpacityKey,
    /// Transmission colours of the material, if shadows are coloured.
    pub transmission: Option<TransmissionKey>,
    /// True if the bounds of cells hold for all kernels in use.
    pub cells_are_bounds: bool,
}

/// Inputs of the eye's table: the curve with its colours, or looks of labels, and the opacity unit.
#[derive(Debug, Clone, PartialEq)]
pub struct EyeTableKey {
    looks: EyeTableLooks,
    unit: OpacityLength,
}

#[derive(Debug, Clone, PartialEq)]
enum EyeTableLooks {
    Values(TransferFunction),
    Labels(Vec<LabelMaterial>),
}

/// Inputs of the opacities that attenuate light: no colours.
#[derive(Debug, Clone, PartialEq)]
pub struct OpacityKey {
    opacities: LightingOpacities,
    scale: f64,
    unit: OpacityLength,
}

/// Inputs of the extinction of each colour channel, apart from opacities.
#[derive(Debug, Clone, PartialEq)]
pub struct TransmissionKey {
    colors: TransmissionColors,
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
        let looks = if settings.layer().labels.is_empty() {
            EyeTableLooks::Values(settings.layer().transfer.clone())
        } else {
            EyeTableLooks::Labels(settings.layer().labels.materials())
        };
        Self { looks, unit: settings.layer().opacity_unit }
    }
}

impl OpacityKey {
    /// Creates the key of the opacities that attenuate light in a look.
    pub(super) fn new(settings: &Settings) -> Self {
        let LightingTransfer { linked, scale, curve } = &settings.layer().lighting;
        let opacities = if settings.layer().labels.is_empty() {
            let curve = if *linked { &settings.layer().transfer } else { curve };
            let TransferFunction { points, interpolation, mixing: _ } = curve;
            LightingOpacities::Values {
                points: points.iter().map(|point| ([point.value, point.opacity], point.easing)).collect(),
                interpolation: *interpolation,
            }
        } else {
            let materials = settings.layer().labels.materials().into_iter();
            LightingOpacities::Labels(materials.map(|material| (material.number, material.opacity)).collect())
        };
        Self { opacities, scale: *scale, unit: settings.layer().opacity_unit }
    }
}

impl TransmissionKey {
    /// Creates the key of the colour channels' extinction in a look; `None` if shadows are grey.
    pub(super) fn new(settings: &Settings) -> Option<Self> {
        let colors = || {
            if !settings.layer().labels.is_empty() {
                let materials = settings.layer().labels.materials().into_iter();
                return TransmissionColors::Labels(materials.map(|material| material.color).collect());
            }
            let LightingTransfer { linked, scale: _, curve } = &settings.layer().lighting;
            let curve = if *linked { &settings.layer().transfer } else { curve };
            TransmissionColors::Values(curve.points.iter().map(|point| point.color).collect(), curve.mixing)
        };
        settings
            .has_colored_shadows()
            .then(|| Self { colors: colors(), share: settings.shadows.transmission })
    }
}
