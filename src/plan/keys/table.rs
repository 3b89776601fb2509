//! What the lookup tables of the transfer functions are made from.

use crate::model::{Easing, Interpolation, Length, LightingTransfer, Settings, TransferFunction};
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
    /// Whether the bounds of cells hold for all kernels in use.
    pub cells_are_bounds: bool,
}

/// Everything that the eye's table is made from: the curve with its colours, and the length to which it refers.
#[derive(Debug, Clone, PartialEq)]
pub struct EyeTableKey {
    curve: TransferFunction,
    unit: Length,
}

/// Everything that the opacities met by light are made from: no colours.
#[derive(Debug, Clone, PartialEq)]
pub struct OpacityKey {
    points: Vec<([f64; 2], Easing)>,
    interpolation: Interpolation,
    scale: f64,
    unit: Length,
}

impl TablesKey {
    /// The key of both tables of a picture.
    pub(super) fn of(request: &Request) -> Self {
        let settings = &request.settings;
        Self {
            volume: request.shown_volume(),
            eye: EyeTableKey::of(settings),
            lighting: OpacityKey::of(settings),
            cells_are_bounds: settings.cells_are_bounds(),
        }
    }
}

impl EyeTableKey {
    /// The key of what the eye sees in a look.
    pub(super) fn of(settings: &Settings) -> Self {
        Self { curve: settings.transfer.clone(), unit: settings.opacity_unit }
    }
}

impl OpacityKey {
    /// The key of what light meets in a look.
    pub(super) fn of(settings: &Settings) -> Self {
        let LightingTransfer { linked, scale, curve } = &settings.lighting;
        let curve = if *linked { &settings.transfer } else { curve };
        let TransferFunction { points, interpolation, mixing: _ } = curve;
        Self {
            points: points.iter().map(|point| ([point.value, point.opacity], point.easing)).collect(),
            interpolation: *interpolation,
            scale: *scale,
            unit: settings.opacity_unit,
        }
    }
}
