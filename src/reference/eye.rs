//! The picture: sheets composited front to back as seen from the eye (P eq. 9).

use std::ops::Range;

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::Reference;
use super::back_project::Attenuation;
use super::shade::{Sampled, Shader};
use super::sheet::{Cutting, Stack};
use crate::model::Classification;
use crate::plan::SheetFrame;
use crate::plan::eye_frame;

/// So many slabs are held in memory at once.
const SLABS_AT_ONCE: u32 = 32;

impl Reference<'_> {
    /// The eye's rays and slabs for a picture of some size.
    pub fn eye_frame(&self, size: [u32; 2]) -> SheetFrame {
        eye_frame(&self.settings.camera, &self.scene, size, self.settings.sampling.slab)
    }

    /// The mean densities of slab `k`, row by row from the top left.
    pub fn eye_sheet(&self, size: [u32; 2], k: u32) -> Vec<f64> {
        self.eye_stack(&self.eye_frame(size)).densities(k)
    }

    /// Linear, premultiplied RGBA before tone mapping, row by row from the top left. Attenuation
    /// volumes are those of the lights in their order, this reference's or another renderer's.
    ///
    /// C += T·(1 − e^−τ)·c, T ← T·e^−τ; no ray ends early.
    pub fn picture(&self, size: [u32; 2], attenuations: &[Option<Attenuation>]) -> Vec<[f64; 4]> {
        let frame = self.eye_frame(size);
        let stack = self.eye_stack(&frame);
        let seen = self.seen();
        let shader = Shader::new(self, attenuations);
        // Colour so far, and in place of alpha the transmittance.
        let mut rays = vec![[0.0, 0.0, 0.0, 1.0]; stack.pixel_count()];
        let margin = frame.gradient_steps().1;
        for first in (0..frame.slab_count).step_by(SLABS_AT_ONCE as usize) {
            let slabs = first..(first + SLABS_AT_ONCE).min(frame.slab_count);
            let sheets = Sheets::new(&stack, slabs.start.saturating_sub(margin)..slabs.end + margin);
            let materials: Vec<_> = slabs.clone().into_par_iter().map(|k| stack.materials(k)).collect();
            // Classified voxels have a density of their own only where it is reconstructed beside them.
            let density = |pixel: usize, k: u32, point: DVec3, level: f64| {
                let is_beside =
                    self.settings.sampling.classification == Classification::Pre && !self.settings.scatters();
                if is_beside { self.pyramid.fetch(point, level) } else { sheets.at(k)[pixel] }
            };
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
                    let density = density(pixel, k, sample.point, level);
                    // Faces look to where the solid ends, whichever way its opacity runs.
                    let gradient =
                        gradient + self.face_gradient(&seen, sample.point, level) * shader.turned(density);
                    let color =
                        shader.color(&Sampled { point: sample.point, density, gradient, level }, sample.rgb);
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

    fn eye_stack<'r>(&'r self, frame: &'r SheetFrame) -> Stack<'r> {
        let sampling = &self.settings.sampling;
        let table = self.settings.baked_eye(self.range, &self.scene);
        Stack::new(self, frame, sampling.kernel, sampling.quadrature, table, Cutting::Seen(self.seen()))
    }
}

/// Some neighbouring sheets of a stack.
struct Sheets<'s> {
    frame: &'s SheetFrame,
    first: u32,
    densities: Vec<Vec<f64>>,
}

impl<'s> Sheets<'s> {
    fn new(stack: &Stack<'s>, slabs: Range<u32>) -> Self {
        let slabs = slabs.start..slabs.end.min(stack.frame.slab_count);
        let densities = slabs.clone().into_par_iter().map(|k| stack.densities(k)).collect();
        Self { frame: stack.frame, first: slabs.start, densities }
    }

    fn at(&self, k: u32) -> &[f64] {
        &self.densities[(k - self.first) as usize]
    }

    /// The gradient in index space from neighbouring sheets and pixels: what the differences are the
    /// products of, by Cramer's rule. Nothing lies before the first slab or behind the last.
    fn gradient(&self, pixel: u32, k: u32) -> DVec3 {
        let [width, height] = self.frame.size;
        let (pixels, slabs) = self.frame.gradient_steps();
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
