//! Eye pass with adaptive slabs: field and light are sampled at the faces between slabs, and what a slab shows is
//! integrated between them.

use glam::DVec3;
use rayon::prelude::*;

use crate::Reference;
use crate::field::classified::TransferSide;
use crate::field::integrated_table::IntegratedTable;
use crate::shade::{ShadedSample, Shader};
use crate::sheet_stack::SheetStack;

/// Number of the stack's slabs in a step, which a segment does not exceed.
const STEP_SLABS: u32 = 4;

/// Number of the stack's slabs in an undivided slab.
const UNDIVIDED_SLABS: u32 = 2;

/// Optical depth of a segment that shows nothing.
const EMPTY_DEPTH: f64 = 4e-6;

/// Attenuation below which a light is gone.
const MIN_SHARE: f64 = 1e-12;

/// Face of a slab where a ray crosses it.
#[derive(Clone, Copy)]
struct Face {
    depth: f64,
    /// Density, or the share of the largest extinction of classified voxels.
    density: f64,
    /// Colour times share of classified voxels.
    rgb: DVec3,
    presence: f64,
}

/// Light at a face.
struct FaceLight {
    /// Gradient in scene space.
    gradient: DVec3,
    /// Attenuation of each light that has any.
    attenuations: Vec<Option<f64>>,
}

/// Material between two faces: slabs that are shaded together.
struct Segment {
    begin: Face,
    depth: f64,
    opacity: f64,
    /// Sums of the opacities of parts times their depths along the ray, densities and colours.
    places: f64,
    densities: f64,
    colors: DVec3,
}

impl Segment {
    fn new(begin: Face) -> Self {
        Self { begin, depth: 0.0, opacity: 0.0, places: 0.0, densities: 0.0, colors: DVec3::ZERO }
    }
}

/// Ray of a pixel while it is composited.
struct AdaptiveRay<'a, 'r> {
    reference: &'a Reference<'r>,
    stack: &'a SheetStack<'r>,
    shader: &'a Shader<'r>,
    table: &'a IntegratedTable,
    pixel: [f64; 2],
    color: DVec3,
    transmittance: f64,
    segment: Segment,
    /// Light at the beginning of the segment, if the one before it ended there.
    light: Option<FaceLight>,
}

impl<'r> Reference<'r> {
    /// Renders [`Self::picture`] with adaptive slabs.
    pub(super) fn picture_adaptive(&self, stack: &SheetStack<'r>, shader: &Shader<'r>) -> Vec<[f64; 4]> {
        let table = IntegratedTable::new(self.gathered_table(TransferSide::Eye), self.classified.is_some());
        let seen = |pixel: usize| {
            let nothing = Face { depth: 0.0, density: 0.0, rgb: DVec3::ZERO, presence: 0.0 };
            let mut ray = AdaptiveRay {
                reference: self,
                stack,
                shader,
                table: &table,
                pixel: stack.pixel_position(pixel as u32),
                color: DVec3::ZERO,
                transmittance: 1.0,
                segment: Segment::new(nothing),
                light: None,
            };
            ray.segment = Segment::new(ray.face(0));
            let mut begin = 0;
            for first in (0..stack.frame.slab_count).step_by(UNDIVIDED_SLABS as usize) {
                ray.add_slab(first);
                let behind = first + UNDIVIDED_SLABS;
                let shown = ray.transmittance * ray.segment.opacity;
                let is_much = shown > self.settings.sampling.max_undivided_share;
                // Segments begin where steps do, or behind another.
                let is_empty = ray.segment.depth <= EMPTY_DEPTH && behind.is_multiple_of(STEP_SLABS);
                let is_last = behind >= stack.frame.slab_count;
                if is_much || is_empty || is_last || behind - begin >= STEP_SLABS {
                    ray.end_segment(behind, shown);
                    begin = behind;
                }
            }
            [ray.color.x, ray.color.y, ray.color.z, 1.0 - ray.transmittance]
        };
        (0..stack.pixel_count()).into_par_iter().map(seen).collect()
    }
}

impl AdaptiveRay<'_, '_> {
    /// Adds the undivided slab that begins at slab `first` of the stack, or its halves, to the segment.
    fn add_slab(&mut self, first: u32) {
        let [a, m, b] = [0, 1, 2].map(|half| self.face(first + half));
        let length = (b.depth - a.depth) * self.obliquity();
        let largest = self.table.max_between(a.density, b.density);
        let left = self.transmittance * (1.0 - self.segment.opacity);
        if left * -(-largest * length).exp_m1() > self.reference.settings.sampling.max_undivided_share {
            self.add_between(&a, &m);
            self.add_between(&m, &b);
        } else {
            self.add_between(&a, &b);
        }
    }

    /// Adds the material between two faces, between which the field is linear.
    fn add_between(&mut self, a: &Face, b: &Face) {
        let length = b.depth - a.depth;
        let present = 0.5 * (a.presence + b.presence) * length * self.obliquity();
        let tau = present * self.extinction_between(a.density, b.density);
        let segment = &mut self.segment;
        segment.depth += tau;
        let opacity = -(-segment.depth).exp_m1();
        let share = opacity - segment.opacity;
        segment.opacity = opacity;
        // Approximates 1/τ − 1/(e^τ − 1), the mean place of visible light in a homogeneous medium.
        let at = (6.0 + tau) / (12.0 + tau * (4.0 + tau));
        segment.places += share * (a.depth + at * length);
        segment.densities += share * (a.density + (b.density - a.density) * at);
        segment.colors += share * a.rgb.lerp(b.rgb, at);
    }

    /// Shades and composites the segment, which ends in front of slab `behind` of the stack and shows a share of the
    /// visible light; and begins another.
    fn end_segment(&mut self, behind: u32, shown: f64) {
        let end = self.face(behind);
        let segment = std::mem::replace(&mut self.segment, Segment::new(end));
        let known = self.light.take();
        if segment.depth <= EMPTY_DEPTH {
            self.transmittance *= 1.0 - segment.opacity;
            return;
        }
        let near = known.unwrap_or_else(|| self.light_at(&segment.begin));
        let far = self.light_at(&end);
        let attenuations: Vec<_> = near
            .attenuations
            .iter()
            .zip(&far.attenuations)
            .map(|(a, b)| Some(mean_attenuation((*a)?, (*b)?, segment.depth)))
            .collect();
        let depth = segment.places / segment.opacity;
        let density = segment.densities / segment.opacity;
        let at =
            ((depth - segment.begin.depth) / (end.depth - segment.begin.depth).max(1e-9)).clamp(0.0, 1.0);
        let gradient = near.gradient.lerp(far.gradient, at);
        let rgb = match self.reference.classified(TransferSide::Eye) {
            Some(_) if density > 0.0 => segment.colors / segment.opacity / density,
            Some(_) => DVec3::ZERO,
            None => self.table.color_at(density),
        };
        let sample = ShadedSample {
            point: self.stack.frame.point(self.pixel[0], self.pixel[1], depth),
            density,
            gradient,
            level: self.stack.frame.stretch_level(depth),
        };
        let color = self.shader.color_with(&sample, rgb.to_array(), &attenuations);
        self.color += DVec3::from(color) * shown;
        self.transmittance *= 1.0 - segment.opacity;
        self.light = Some(far);
    }

    fn obliquity(&self) -> f64 {
        self.stack.frame.obliquity(self.pixel[0], self.pixel[1])
    }

    /// Returns the face in front of slab `k` of the stack, or in the cut that the ray meets before.
    fn face(&self, k: u32) -> Face {
        let [i, j] = self.pixel;
        let depth = self.stack.depth_within_cut(self.pixel, self.stack.frame.depth_of(f64::from(k) - 0.5));
        let point = self.stack.frame.point(i, j, depth);
        let level = self.stack.frame.stretch_level(depth);
        let (density, presence) = self.stack.sampled_at(point, level);
        let rgb = match self.reference.classified(TransferSide::Eye) {
            Some(classified) => {
                DVec3::from(classified.colors.each_ref().map(|color| color.fetch(point, level)))
            }
            None => DVec3::ZERO,
        };
        Face { depth, density, rgb, presence }
    }

    /// Returns the mean extinction between two densities.
    fn extinction_between(&self, a: f64, b: f64) -> f64 {
        self.table.mean_between(a, b)[3]
    }

    /// Returns the light at a face.
    fn light_at(&self, face: &Face) -> FaceLight {
        let [i, j] = self.pixel;
        let point = self.stack.frame.point(i, j, face.depth);
        let level = self.stack.frame.stretch_level(face.depth);
        let ends = self.reference.end_gradient(&self.reference.visible_faces(), point, level);
        let gradient = self.shader.gradient(point, level) + ends * self.shader.normal_sign(face.density);
        let sample = ShadedSample { point, density: face.density, gradient, level };
        FaceLight { gradient, attenuations: self.shader.attenuations(&sample) }
    }
}

/// Returns the mean over the visible material of a segment of optical depth τ of a light that changes exponentially with
/// the eye's optical depth, from `a` to `b`: ∫ a e^(−t (1 + λ/τ)) dt / ∫ e^−t dt over 0 … τ, with λ = ln(a/b).
fn mean_attenuation(a: f64, b: f64, tau: f64) -> f64 {
    let (a, b) = (a.max(MIN_SHARE), b.max(MIN_SHARE));
    let mean = |x: f64| if x.abs() < 1e-9 { 1.0 - x / 2.0 } else { -(-x).exp_m1() / x };
    a * mean(tau + (a / b).ln()) / mean(tau)
}

#[cfg(test)]
mod tests {
    use super::mean_attenuation;

    #[test]
    fn light_and_opacity_are_integrated_together() {
        for (a, b, tau) in [(1.0_f64, 1.0, 0.3), (0.8, 0.05, 2.0), (0.1, 0.9, 5.0), (0.4, 0.4, 1e-7)] {
            let steps = 20_000;
            let (mut lit, mut opaque) = (0.0, 0.0);
            for step in 0..steps {
                let t = tau * (f64::from(step) + 0.5) / f64::from(steps);
                lit += (-t).exp() * a * (b / a).powf(t / tau);
                opaque += (-t).exp();
            }
            assert!((mean_attenuation(a, b, tau) - lit / opaque).abs() < 1e-6, "{a} {b} {tau}");
        }
    }
}
