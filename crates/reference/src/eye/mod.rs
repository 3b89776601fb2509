//! Eye pass: sheets composited front to back as seen from the eye (P eq. 9).

mod adaptive;
mod antialiasing;
mod preintegrated;

use std::ops::Range;

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::Reference;
use super::back_project::AttenuationVolume;
use super::extent::cut::UncutRegion;
use super::shade::{ShadedSample, Shader};
use super::sheet_stack::{CutTreatment, SheetStack};
use chiaroscuro_render::plan::{GradientSteps, SheetFrame, picture_frame};

/// Number of slabs held in memory at once.
const SLABS_IN_MEMORY: u32 = 32;

impl Reference<'_> {
    /// Returns the eye's rays and slabs for a picture of the given size.
    pub fn eye_frame(&self, size: [u32; 2]) -> SheetFrame {
        picture_frame(self.settings, &self.scene, size)
    }

    /// Returns the mean densities of slab `k`, row by row from the top left.
    pub fn eye_sheet(&self, size: [u32; 2], k: u32) -> Vec<f64> {
        self.eye_stack(&self.eye_frame(size)).densities(k)
    }

    /// Renders the picture: linear, premultiplied RGBA before tone mapping, row by row from the top left.
    /// `attenuations` holds a volume for each light in order, from this reference or another renderer.
    ///
    /// C += T·(1 − e^−τ)·c, T ← T·e^−τ; no ray ends early.
    pub fn picture(&self, size: [u32; 2], attenuations: &[Option<AttenuationVolume>]) -> Vec<[f64; 4]> {
        self.picture_in(&self.eye_frame(size), attenuations)
    }

    /// Renders the picture of a frame.
    fn picture_in(&self, frame: &SheetFrame, attenuations: &[Option<AttenuationVolume>]) -> Vec<[f64; 4]> {
        let stack = self.eye_stack(frame);
        let faces = self.visible_faces();
        let shader = Shader::new(self, attenuations);
        if self.settings.has_adaptive_slabs() {
            return self.picture_adaptive(&stack, &shader);
        }
        if self.settings.has_preintegrated_slabs() {
            return self.picture_preintegrated(&stack, &shader);
        }
        // Accumulated colour, with the transmittance in place of alpha.
        let mut rays = vec![[0.0, 0.0, 0.0, 1.0]; stack.pixel_count()];
        let margin = frame.gradient_steps().slabs;
        for first in (0..frame.slab_count).step_by(SLABS_IN_MEMORY as usize) {
            let slabs = first..(first + SLABS_IN_MEMORY).min(frame.slab_count);
            let sheets = SheetDensities::new(&stack, slabs.start.saturating_sub(margin)..slabs.end + margin);
            let materials: Vec<_> = slabs.clone().into_par_iter().map(|k| stack.materials(k)).collect();
            rays.par_iter_mut().enumerate().for_each(|(pixel, ray)| {
                for k in slabs.clone() {
                    let Some(sample) =
                        stack.sample(pixel as u32, k, materials[(k - slabs.start) as usize][pixel])
                    else {
                        continue;
                    };
                    let level = frame.stretch_level(frame.depth_of(f64::from(k)));
                    let gradient = if self.settings.has_sheet_gradients() {
                        let in_index = sheets.gradient(pixel as u32, k);
                        self.scene.index_from_scene.matrix3.transpose() * in_index
                    } else {
                        shader.gradient(sample.point, level)
                    };
                    let density = sheets.at(k)[pixel];
                    // Normals of faces point out of the solid, whichever way opacity changes with density.
                    let gradient = gradient
                        + self.end_gradient(&faces, sample.point, level) * shader.normal_sign(density);
                    let point = sample.point;
                    let shaded = ShadedSample { point, density, gradient, level };
                    let color = shader.color(&shaded, sample.rgb);
                    let opacity = -(-sample.optical_depth).exp_m1();
                    for channel in 0..3 {
                        ray[channel] += ray[3] * opacity * color[channel];
                    }
                    ray[3] *= (-sample.optical_depth).exp();
                }
            });
        }
        rays.into_iter().map(|[r, g, b, transmittance]| [r, g, b, 1.0 - transmittance]).collect()
    }

    /// Returns the gradient at the ends of solids: at faces, and at missing voxels.
    fn end_gradient(&self, faces: &UncutRegion, point: DVec3, level: f64) -> DVec3 {
        self.face_gradient(faces, point, level) + self.missing_gradient(point, level)
    }

    fn eye_stack<'r>(&'r self, frame: &'r SheetFrame) -> SheetStack<'r> {
        let sampling = &self.settings.sampling;
        SheetStack::new(
            self,
            frame,
            sampling.kernel,
            sampling.quadrature,
            CutTreatment::Visible(self.visible_region()),
        )
    }
}

/// Densities of some neighbouring sheets of a stack.
struct SheetDensities<'s> {
    frame: &'s SheetFrame,
    first: u32,
    densities: Vec<Vec<f64>>,
}

impl<'s> SheetDensities<'s> {
    fn new(stack: &SheetStack<'s>, slabs: Range<u32>) -> Self {
        let slabs = slabs.start..slabs.end.min(stack.frame.slab_count);
        let densities = slabs.clone().into_par_iter().map(|k| stack.densities(k)).collect();
        Self { frame: stack.frame, first: slabs.start, densities }
    }

    fn at(&self, k: u32) -> &[f64] {
        &self.densities[(k - self.first) as usize]
    }

    /// Returns the gradient in index space from differences between neighbouring sheets and pixels, by Cramer's rule.
    /// Densities are 0 before the first slab and behind the last.
    fn gradient(&self, pixel: u32, k: u32) -> DVec3 {
        let [width, height] = self.frame.size;
        let GradientSteps { pixels, slabs } = self.frame.gradient_steps();
        let (i, j) = (pixel % width, pixel / width);
        let sheet = |k: Option<u32>, i: u32, j: u32| match k {
            Some(k) if k < self.frame.slab_count => self.at(k)[(i + j * width) as usize],
            _ => 0.0,
        };
        let (left, right) = (i.saturating_sub(pixels), (i + pixels).min(width - 1));
        let (above, below) = (j.saturating_sub(pixels), (j + pixels).min(height - 1));
        let per_i = (sheet(Some(k), right, j) - sheet(Some(k), left, j)) / f64::from((right - left).max(1));
        let per_j = (sheet(Some(k), i, below) - sheet(Some(k), i, above)) / f64::from((below - above).max(1));
        let behind = sheet(Some(k + slabs), i, j) - sheet(k.checked_sub(slabs), i, j);
        let per_depth = behind / (2.0 * f64::from(slabs) * self.frame.slab);
        let depth = self.frame.depth_of(f64::from(k));
        let moves = DMat3::from_cols(
            self.frame.origin.per_i + self.frame.direction.per_i * depth,
            self.frame.origin.per_j + self.frame.direction.per_j * depth,
            self.frame.direction.at(f64::from(i), f64::from(j)),
        );
        moves.transpose().inverse() * DVec3::new(per_i, per_j, per_depth)
    }
}
