//! Eye pass: sheets composited front to back as seen from the eye (P eq. 9).

mod preintegrated;

use std::ops::Range;

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::Reference;
use super::back_project::AttenuationVolume;
use super::extent::cut::UncutRegion;
use super::shade::{ShadedSample, Shader};
use super::sheet_stack::{CutTreatment, SheetStack, SlabContribution};
use chiaroscuro_render::plan::{GradientSteps, SheetFrame, picture_frame};
use chiaroscuro_scene::{BakedTransfer, MAX_SLAB_PARTS};

/// Share of what is visible along a ray above which a slab is divided.
const MAX_SLAB_SHARE: f64 = 1.0 / 8.0;

/// Safety factor of the density's expected change across a slab over that of the gradient at its middle.
const CHANGE_SAFETY: f64 = 1.25;

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
        let frame = self.eye_frame(size);
        let stack = self.eye_stack(&frame);
        let faces = self.visible_faces();
        let shader = Shader::new(self, attenuations);
        if self.settings.has_adaptive_slabs() {
            return self.picture_by_need(&stack, &shader);
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
                    let color = shader
                        .color(&ShadedSample { point: sample.point, density, gradient, level }, sample.rgb);
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

/// State of a ray during compositing.
struct CompositedRay {
    pixel: u32,
    /// Linear, premultiplied RGB, and the transmittance.
    color_and_transmittance: [f64; 4],
}

impl Reference<'_> {
    /// Renders [`Self::picture`] with slabs by need: four slabs of the stack at a time where that suffices.
    pub(super) fn picture_by_need(&self, stack: &SheetStack<'_>, shader: &Shader<'_>) -> Vec<[f64; 4]> {
        let table = self.settings.bake_eye(self.range, &self.scene);
        let seen = |pixel: usize| {
            let mut ray =
                CompositedRay { pixel: pixel as u32, color_and_transmittance: [0.0, 0.0, 0.0, 1.0] };
            for first in (0..stack.frame.slab_count).step_by(MAX_SLAB_PARTS as usize) {
                if self.needs_no_division(stack, shader, &table, &ray, first) {
                    self.add_slab(stack, shader, &table, &mut ray, first, MAX_SLAB_PARTS);
                } else {
                    (first..first + MAX_SLAB_PARTS)
                        .for_each(|k| self.add_slab(stack, shader, &table, &mut ray, k, 1));
                }
            }
            let [r, g, b, transmittance] = ray.color_and_transmittance;
            [r, g, b, 1.0 - transmittance]
        };
        (0..stack.pixel_count()).into_par_iter().map(seen).collect()
    }

    /// Returns true if one sample suffices for the undivided slab that begins at slab `first` of the stack.
    fn needs_no_division(
        &self,
        stack: &SheetStack<'_>,
        shader: &Shader<'_>,
        table: &BakedTransfer,
        ray: &CompositedRay,
        first: u32,
    ) -> bool {
        let is_whole = (first..first + MAX_SLAB_PARTS).all(|k| stack.is_uncut(ray.pixel, k));
        let frame = stack.frame;
        let [i, j] = stack.pixel_position(ray.pixel);
        let middle = f64::from(first) + 0.5 * f64::from(MAX_SLAB_PARTS - 1);
        let depth = frame.depth_of(middle);
        let point = frame.point(i, j, depth);
        let thickness = f64::from(MAX_SLAB_PARTS) * frame.slab;
        let density = stack.density_at([i, j, middle]);
        // Scene space contains the obliquity: one unit of depth is 1 / cos θ long there.
        let along = self.scene.scene_from_index.transform_vector3(frame.direction.at(i, j));
        let change = shader.prefiltered_gradient(point, frame.stretch_level(depth)).dot(along).abs();
        let change = 0.5 * CHANGE_SAFETY * thickness * change;
        // Presence is not evaluated where the middle shows nothing.
        let is_asked = table.sample(density)[3] > 0.0;
        let most_there = if is_asked { self.max_presence(stack, along, [i, j, middle]) } else { 1.0 };
        let largest = most_there * table.max_extinction_in(density - change, density + change);
        let share = ray.color_and_transmittance[3] * -(-largest * thickness * frame.obliquity(i, j)).exp_m1();
        is_whole && share <= MAX_SLAB_SHARE
    }

    /// Returns an upper bound of the presence within the undivided slab around `k`, near missing voxels.
    fn max_presence(&self, stack: &SheetStack<'_>, along: DVec3, [i, j, k]: [f64; 3]) -> f64 {
        // The presence of classified voxels is part of their spread extinction.
        if self.presence.is_none() || self.classified.is_some() {
            return 1.0;
        }
        let frame = stack.frame;
        let depth = frame.depth_of(k);
        let rise =
            self.missing_gradient(frame.point(i, j, depth), frame.stretch_level(depth)).dot(along).abs();
        let thickness = f64::from(MAX_SLAB_PARTS) * frame.slab;
        (stack.presence_at([i, j, k]) + 0.5 * CHANGE_SAFETY * thickness * rise).min(1.0)
    }

    /// Composites a slab that is `width` slabs of the stack thick.
    fn add_slab(
        &self,
        stack: &SheetStack<'_>,
        shader: &Shader<'_>,
        table: &BakedTransfer,
        ray: &mut CompositedRay,
        first: u32,
        width: u32,
    ) {
        let [i, j] = stack.pixel_position(ray.pixel);
        let middle = f64::from(first) + 0.5 * f64::from(width - 1);
        let density = stack.density_at([i, j, middle]);
        let found = stack.sample_of(ray.pixel, middle, f64::from(width), table.sample(density));
        let Some(SlabContribution { point, rgb, optical_depth }) = found else { return };
        let level = stack.frame.stretch_level(stack.frame.depth_of(middle));
        let faces: DVec3 = self.end_gradient(&self.visible_faces(), point, level);
        let gradient = shader.gradient(point, level) + faces * shader.normal_sign(density);
        let color = shader.color(&ShadedSample { point, density, gradient, level }, rgb);
        let opacity = -(-optical_depth).exp_m1();
        let left = ray.color_and_transmittance[3];
        for (seen, color) in ray.color_and_transmittance.iter_mut().zip(color) {
            *seen += left * opacity * color;
        }
        ray.color_and_transmittance[3] = left * (-optical_depth).exp();
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
