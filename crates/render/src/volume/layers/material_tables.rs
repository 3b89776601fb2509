//! Materials by value and change as the shader reads them.

use crate::pipelines::uniforms::MaterialUniform;
use chiaroscuro_scene::{BakedTransfer, MaterialBox, SoftInterval, VolumeLayer};
use chiaroscuro_volume::ValueRange;

/// Region of a material with its colour and extinction on one side, the eye's or light's.
#[derive(Debug, Clone)]
pub(super) struct MaterialTable {
    intervals: [SoftInterval; 2],
    /// Table that has the material's colour and extinction at all densities.
    matter: BakedTransfer,
}

impl MaterialTable {
    /// Creates the table of a layer's material: `bake` makes that of a layer over the range of values.
    pub(super) fn new(
        material: &MaterialBox,
        layer: &VolumeLayer,
        range: ValueRange,
        bake: impl Fn(&VolumeLayer) -> BakedTransfer,
    ) -> Self {
        let constant = VolumeLayer { transfer: material.constant_transfer(), ..layer.clone() };
        Self { intervals: material.intervals(range), matter: bake(&constant) }
    }

    /// Returns the extinction, per scene unit.
    pub(super) fn extinction(&self) -> f32 {
        self.matter.max_extinction()
    }

    /// Returns the table for one colour of light.
    pub(super) fn for_light_color(&self, color: usize) -> Self {
        Self { intervals: self.intervals, matter: self.matter.for_light_color(color) }
    }

    /// Returns the parameters of the shader, with the opacity over a length in scene units, or with the extinction if
    /// there is none.
    pub(super) fn uniform(&self, opacity_length: Option<f64>) -> MaterialUniform {
        let [densities, changes] = self.intervals.map(|interval| interval.corners().map(|at| at as f32));
        let entry = |table: &BakedTransfer| table.entries[0];
        let [r, g, b, amount] = match opacity_length {
            None => entry(&self.matter),
            Some(length) => entry(&self.matter.with_opacities(length)),
        };
        MaterialUniform { densities, changes, matter: [r * amount, g * amount, b * amount, amount] }
    }
}
