//! The picture: sheets composited front to back as seen from the eye (P eq. 9).

use rayon::prelude::*;

use super::Reference;
use super::back_project::Attenuation;
use super::shade::Shader;
use super::sheet::Stack;
use crate::plan::{SheetFrame, eye_frame};

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
        let shader = Shader::new(self, attenuations);
        // Colour so far, and in place of alpha the transmittance.
        let mut rays = vec![[0.0, 0.0, 0.0, 1.0]; stack.pixel_count()];
        for first in (0..frame.slab_count).step_by(SLABS_AT_ONCE as usize) {
            let slabs = first..(first + SLABS_AT_ONCE).min(frame.slab_count);
            let sheets: Vec<_> = slabs.clone().into_par_iter().map(|k| stack.densities(k)).collect();
            rays.par_iter_mut().enumerate().for_each(|(pixel, ray)| {
                for (k, sheet) in slabs.clone().zip(&sheets) {
                    let Some(sample) = stack.classify(pixel as u32, k, sheet[pixel]) else {
                        continue;
                    };
                    let level = frame.stretch_level(frame.depth_of(f64::from(k)));
                    let color = shader.color(sample.point, sample.rgb, level);
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
        Stack::new(self, frame, (sampling.kernel, sampling.quadrature), table)
    }
}
