//! Eye pass with pre-integrated slabs: opacity is integrated over slabs of two steps, which are shaded in layers.

use glam::DVec3;
use rayon::prelude::*;

use crate::Reference;
use crate::shade::{ShadedSample, Shader};
use crate::sheet_stack::SheetStack;
use chiaroscuro_scene::{BakedTransfer, LUT_SIZE};

/// Number of steps after which a layer ends.
const LAYER_STEPS: u32 = 4;

/// Optical depth of the last step below which a layer ends a step earlier.
const SOFT_DEPTH: f64 = 0.5;

/// Share of a ray above which the steps of a layer count.
const FAINT_SHARE: f64 = 1.0 / 16.0;

/// Optical depth of a step that shows nothing.
const EMPTY_DEPTH: f64 = 4e-6;

/// Layer: steps that are shaded at once.
struct ShadingLayer {
    /// Share of what is visible along the ray.
    share: f64,
    /// Sum of shares times positions, in slabs of the stack.
    weighted_positions: f64,
    /// Sum of shares times densities.
    weighted_densities: f64,
    /// Steps since the share is above [`FAINT_SHARE`].
    steps: u32,
}

impl ShadingLayer {
    const NOTHING: Self = Self { share: 0.0, weighted_positions: 0.0, weighted_densities: 0.0, steps: 0 };

    /// Adds the visible share of half a step that begins at a position.
    fn add(&mut self, share: f64, place: f64, half: HalfStep) {
        let HalfStep { depth, density } = half;
        // The quotient approximates 1/τ − 1/(e^τ − 1), the mean position of visible light in a homogeneous medium.
        let within = (6.0 + depth) / (12.0 + depth * (4.0 + depth));
        self.share += share;
        self.weighted_positions += share * (place + 0.5 * within);
        self.weighted_densities += share * density;
    }
}

/// One half of a step.
#[derive(Clone, Copy)]
struct HalfStep {
    /// Optical depth of the half step.
    depth: f64,
    /// Mean of the densities at its ends.
    density: f64,
}

/// Transfer function with its extinction integrated between entries, for steps.
struct StepTable {
    table: BakedTransfer,
    /// Integrals from the first entry to each, with a distance of 1 between entries.
    integrals: Vec<f64>,
}

impl StepTable {
    fn new(table: BakedTransfer) -> Self {
        let mut sum = 0.0;
        let steps = table.entries.windows(2).map(|pair| {
            sum += 0.5 * (f64::from(pair[0][3]) + f64::from(pair[1][3]));
            sum
        });
        let integrals = std::iter::once(0.0).chain(steps).collect();
        Self { table, integrals }
    }

    /// Returns the mean extinction between two densities; for close ones, that of the entry nearest to `alike`.
    fn mean(&self, from: f64, to: f64, alike: f64) -> f64 {
        let [a, b] = [from, to].map(|density| density.clamp(0.0, 1.0) * (LUT_SIZE - 1) as f64);
        if (b - a).abs() < 1.0 {
            let nearest = (alike.clamp(0.0, 1.0) * (LUT_SIZE - 1) as f64).round() as usize;
            return f64::from(self.table.entries[nearest][3]);
        }
        (self.integral_to(b) - self.integral_to(a)) / (b - a)
    }

    /// Returns the integral up to a position in the table.
    fn integral_to(&self, at: f64) -> f64 {
        let low = (at as usize).min(LUT_SIZE - 2);
        let (first, second) = (self.integrals[low], self.integrals[low + 1]);
        first + (second - first) * (at - low as f64)
    }
}

impl Reference<'_> {
    /// Renders [`Self::picture`] in layers of pre-integrated steps.
    pub(super) fn picture_preintegrated(&self, stack: &SheetStack<'_>, shader: &Shader<'_>) -> Vec<[f64; 4]> {
        let integrated = StepTable::new(self.settings.bake_eye(self.range, &self.scene));
        let seen = |pixel: usize| self.layers(stack, shader, &integrated, pixel as u32);
        (0..stack.pixel_count()).into_par_iter().map(seen).collect()
    }

    /// Composites the layers along the ray of a pixel: linear, premultiplied RGBA.
    fn layers(
        &self,
        stack: &SheetStack<'_>,
        shader: &Shader<'_>,
        integrated: &StepTable,
        pixel: u32,
    ) -> [f64; 4] {
        let [i, j] = stack.pixel_position(pixel);
        let count = i64::from(stack.frame.slab_count);
        let mut color = DVec3::ZERO;
        let mut left = 1.0;
        let mut layer = ShadingLayer::NOTHING;
        // Each step reaches from the middle of a slab to that of the next.
        for k in -1..=count {
            let halves = Self::halves(stack, integrated, [i, j, k as f64]);
            for (number, half) in halves.into_iter().enumerate() {
                let seen = left * -(-half.depth).exp_m1();
                layer.add(seen, k as f64 + 0.5 * number as f64, half);
                left -= seen;
            }
            layer.steps += u32::from(layer.share > FAINT_SHARE);
            let last_depth: f64 = halves.iter().map(|half| half.depth).sum();
            let most = if last_depth < SOFT_DEPTH { LAYER_STEPS - 1 } else { LAYER_STEPS };
            if layer.share > 0.0 && (layer.steps >= most || last_depth < EMPTY_DEPTH || k == count) {
                color += self.shaded_layer(stack, shader, integrated, [i, j], &layer);
                layer = ShadingLayer::NOTHING;
            }
        }
        [color.x, color.y, color.z, 1.0 - left]
    }

    /// Returns the halves of a step from the middle of slab `k` to that of the next.
    fn halves(stack: &SheetStack<'_>, integrated: &StepTable, [i, j, k]: [f64; 3]) -> [HalfStep; 2] {
        let ends = [[i, j, k], [i, j, k + 1.0]];
        let length = stack.length_between(ends);
        let [a, b] = ends.map(|end| stack.density_around(end));
        let there = ends.map(|end| stack.presence_at(end)).iter().sum::<f64>() / 2.0;
        let middle = 0.5 * (a + b);
        [[a, middle], [middle, b]].map(|[from, to]| HalfStep {
            depth: 0.5 * length * there * integrated.mean(from, to, middle),
            density: 0.5 * (from + to),
        })
    }

    /// Shades a layer at its mean position, and multiplies by its share.
    fn shaded_layer(
        &self,
        stack: &SheetStack<'_>,
        shader: &Shader<'_>,
        integrated: &StepTable,
        [i, j]: [f64; 2],
        layer: &ShadingLayer,
    ) -> DVec3 {
        let depth = stack.frame.depth_of(layer.weighted_positions / layer.share);
        let density = layer.weighted_densities / layer.share;
        let (point, level) = (stack.frame.point(i, j, depth), stack.frame.stretch_level(depth));
        let ends = self.end_gradient(&self.visible_faces(), point, level);
        let gradient = shader.gradient(point, level) + ends * shader.normal_sign(density);
        let [r, g, b, _] = integrated.table.sample(density);
        let sample = ShadedSample { point, density, gradient, level };
        DVec3::from(shader.color(&sample, [r, g, b])) * layer.share
    }
}
