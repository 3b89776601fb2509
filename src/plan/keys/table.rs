//! What the lookup tables of the transfer functions are made from.

use crate::model::{
    Easing, Interpolation, LabelMaterial, Length, LightingTransfer, Mixing, Settings, TransferFunction,
};
use crate::plan::{Request, VolumeKey};

/// Everything that both lookup tables are made from, besides the volume.
#[derive(Debug, Clone, PartialEq)]
pub struct TablesKey {
    /// Volume whose shown range and bricks they refer to.
    pub volume: VolumeKey,
    /// What the eye sees.
    pub eye: EyeTableKey,
    /// What the light meets.
    pub lighting: OpacityKey,
    /// Which colours of it, where shadows are coloured.
    pub transmission: Option<TransmissionKey>,
    /// Whether the bounds of cells hold for all kernels in use.
    pub cells_are_bounds: bool,
}

/// Everything that the eye's table is made from: the curve with its colours, or looks of labels, and the length to which
/// it refers.
#[derive(Debug, Clone, PartialEq)]
pub struct EyeTableKey {
    looks: Looks,
    unit: Length,
}

#[derive(Debug, Clone, PartialEq)]
enum Looks {
    OfValues(TransferFunction),
    OfLabels(Vec<LabelMaterial>),
}

/// Everything that the opacities met by light are made from: no colours.
#[derive(Debug, Clone, PartialEq)]
pub struct OpacityKey {
    opacities: Opacities,
    scale: f64,
    unit: Length,
}

/// Everything that the shares of extinction which each colour of light meets are made from, besides opacities.
#[derive(Debug, Clone, PartialEq)]
pub struct TransmissionKey {
    colors: Colors,
    share: f64,
}

#[derive(Debug, Clone, PartialEq)]
enum Colors {
    OfValues(Vec<[f32; 3]>, Mixing),
    OfLabels(Vec<[f32; 3]>),
}

#[derive(Debug, Clone, PartialEq)]
enum Opacities {
    OfValues { points: Vec<([f64; 2], Easing)>, interpolation: Interpolation },
    OfLabels(Vec<(i64, f64)>),
}

impl TablesKey {
    /// The key of both tables of a picture.
    pub(super) fn of(request: &Request) -> Self {
        let settings = &request.settings;
        Self {
            volume: request.shown_volume(),
            eye: EyeTableKey::of(settings),
            lighting: OpacityKey::of(settings),
            transmission: TransmissionKey::of(settings),
            cells_are_bounds: settings.cells_are_bounds(),
        }
    }
}

impl EyeTableKey {
    /// The key of what the eye sees in a look.
    pub(super) fn of(settings: &Settings) -> Self {
        let looks = if settings.labels.is_empty() {
            Looks::OfValues(settings.transfer.clone())
        } else {
            Looks::OfLabels(settings.labels.materials())
        };
        Self { looks, unit: settings.opacity_unit }
    }
}

impl OpacityKey {
    /// The key of what light meets in a look.
    pub(super) fn of(settings: &Settings) -> Self {
        let LightingTransfer { linked, scale, curve } = &settings.lighting;
        let opacities = if settings.labels.is_empty() {
            let curve = if *linked { &settings.transfer } else { curve };
            let TransferFunction { points, interpolation, mixing: _ } = curve;
            Opacities::OfValues {
                points: points.iter().map(|point| ([point.value, point.opacity], point.easing)).collect(),
                interpolation: *interpolation,
            }
        } else {
            let materials = settings.labels.materials().into_iter();
            Opacities::OfLabels(materials.map(|material| (material.number, material.opacity)).collect())
        };
        Self { opacities, scale: *scale, unit: settings.opacity_unit }
    }
}

impl TransmissionKey {
    /// The key of what light of each colour meets in a look; `None` where shadows are grey.
    pub(super) fn of(settings: &Settings) -> Option<Self> {
        let colors = || {
            if !settings.labels.is_empty() {
                let materials = settings.labels.materials().into_iter();
                return Colors::OfLabels(materials.map(|material| material.color).collect());
            }
            let LightingTransfer { linked, scale: _, curve } = &settings.lighting;
            let curve = if *linked { &settings.transfer } else { curve };
            Colors::OfValues(curve.points.iter().map(|point| point.color).collect(), curve.mixing)
        };
        settings
            .has_colored_shadows()
            .then(|| Self { colors: colors(), share: settings.shadows.transmission })
    }
}
