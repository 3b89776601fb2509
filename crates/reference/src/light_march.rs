//! Light march: sheets are composited front to back as seen from the light, and each keeps the transmittance that it
//! will splat into the light volume (the product in P eq. 10).

use rayon::prelude::*;

use super::sheet_stack::{CutTreatment, SheetStack};
use super::{Reference, ReferenceFault};
use chiaroscuro_render::plan::{LightView, light_views};
use chiaroscuro_scene::{DepositMode, LightVolumeResolution, SceneLight, ShadowSettings};

/// Sheets of one view of a light.
#[derive(Debug, Clone)]
pub struct ViewSheets {
    /// View that the sheets belong to.
    pub view: LightView,
    /// Deposits D of every slab, front to back; each a sheet, row by row.
    pub deposits: Vec<Vec<f64>>,
    /// Transmittance behind the last slab, row by row.
    pub transmittance: Vec<f64>,
}

impl ViewSheets {
    /// Returns D of slab `k` at pixel (i, j).
    pub fn deposit(&self, i: usize, j: usize, k: usize) -> f64 {
        self.deposits[k][i + self.view.frame.size[0] as usize * j]
    }
}

impl Reference<'_> {
    /// Computes the sheets of every view of light `index`, a point light: P figure 3 up to the reverse splat.
    pub fn light_sheets(&self, index: usize) -> Vec<ViewSheets> {
        self.point_light_sheets(&self.light(index), self.light_resolution(index))
    }

    /// Computes the sheets of every view of a point light, for a volume of the given resolution.
    pub(super) fn point_light_sheets(
        &self,
        light: &SceneLight,
        resolution: LightVolumeResolution,
    ) -> Vec<ViewSheets> {
        let shadows = ShadowSettings { resolution, ..self.settings.shadows.clone() };
        light_views(light, &shadows, &self.scene).into_iter().map(|view| self.march(light, view)).collect()
    }

    fn march(&self, light: &SceneLight, view: LightView) -> ViewSheets {
        let shadows = &self.settings.shadows;
        let cutting = CutTreatment::Attenuating(self.attenuating_region());
        let stack = SheetStack::new(self, &view.frame, shadows.kernel, shadows.quadrature, cutting);
        // Materials do not depend on light, so all slabs are classified at once; then light proceeds slab by slab.
        let materials: Vec<_> =
            (0..view.frame.slab_count).into_par_iter().map(|k| stack.materials(k)).collect();
        // In front of the first slab, light is limited only by the hood.
        let cone = light.cone();
        let in_front = |pixel: u32| {
            let (i, j) = (f64::from(pixel % view.frame.size[0]), f64::from(pixel / view.frame.size[0]));
            let along = (view.axes * view.frame.slope.at(i, j).extend(1.0)).normalize();
            cone.attenuation(cone.axis.dot(along))
        };
        let mut transmittance: Vec<f64> = (0..stack.pixel_count() as u32).map(in_front).collect();
        let deposits = (0..)
            .zip(&materials)
            .map(|(k, sheet)| {
                transmittance
                    .par_iter_mut()
                    .zip(sheet)
                    .enumerate()
                    .map(|(pixel, (transmittance, &material))| {
                        let sample = stack.sample(pixel as u32, k, material);
                        let optical_depth =
                            sample.map_or(0.0, |sample| sample.optical_depth) * light.density_scale;
                        let deposit = *transmittance * self.deposited_share(optical_depth);
                        *transmittance *= (-optical_depth).exp();
                        deposit
                    })
                    .collect()
            })
            .collect();
        ViewSheets { view, deposits, transmittance }
    }

    /// Returns D/T: the mean or first transmittance within a slab of optical depth τ, relative to that in front of
    /// it.
    fn deposited_share(&self, optical_depth: f64) -> f64 {
        match self.settings.shadows.deposit {
            _ if self.options.fault == ReferenceFault::DepositAfter => (-optical_depth).exp(),
            DepositMode::Front => 1.0,
            // 1/τ ∫₀^τ e^−t dt = (1 − e^−τ)/τ
            DepositMode::SlabMean if optical_depth < 1e-4 => {
                1.0 - optical_depth / 2.0 + optical_depth * optical_depth / 6.0
            }
            DepositMode::SlabMean => -(-optical_depth).exp_m1() / optical_depth,
        }
    }
}

impl Reference<'_> {
    /// Applies the cures for darkness (P §4) to a transmittance.
    pub(super) fn apply_cures(&self, left: f64) -> f64 {
        let shadows = &self.settings.shadows;
        let light = (shadows.gain * left + shadows.ambient_offset).min(1.0);
        1.0 - shadows.strength * (1.0 - light)
    }

    /// Returns the cured share of a fully blocked light, without ambient offset.
    pub(super) fn shadowed_share(&self) -> f64 {
        1.0 - self.settings.shadows.strength
    }

    /// Removes the area of a light if it is sampled only at its centre.
    pub(super) fn with_sampled_area(&self, light: SceneLight) -> SceneLight {
        SceneLight { area: light.area.filter(|_| self.settings.shadows.area.samples > 1), ..light }
    }
}
