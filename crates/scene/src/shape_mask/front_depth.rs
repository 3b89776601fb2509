//! Depths at which the first surface behind an outline ends, along rays through the picture.

use rayon::prelude::*;

use super::is_visible;
use super::outline::OutlineDistance;
use chiaroscuro_volume::{ValueRange, Volume};
use glam::{DVec2, DVec3};

/// Number of rays along the longer side of an outline.
const RAYS: f64 = 256.0;

/// Step of a ray, in edges of a voxel.
const STEP_EDGES: f64 = 0.5;

/// Length of a gap that ends a surface, and of the skin behind it that is cut, too, in edges of a voxel: values fall off
/// over the width of a kernel.
const GAP_EDGES: f64 = 2.0;

/// Number of rays to either side whose depths are filtered together.
const FILTER_RAYS: usize = 5;

/// Depths at which the first run of values of a range ends, for rays through the picture plane.
pub(super) struct FrontDepth {
    low: DVec2,
    cell: f64,
    size: [usize; 2],
    /// Depth along the viewing axis in scene units, of either sign for parallel rays; NaN where a ray meets no such value.
    depths: Vec<f32>,
}

impl FrontDepth {
    /// Follows rays behind an outline through the voxels with values in a range that are visible so far.
    pub(super) fn new(outline: &OutlineDistance, volume: &Volume, hidden: &[u8], values: ValueRange) -> Self {
        let [low, high] = outline.bounds();
        let cell = (high - low).max_element().max(1e-9) / RAYS;
        let size = ((high - low) / cell).ceil().to_array().map(|cells| cells as usize + 1);
        let is_met = |index: DVec3| {
            let place = index.round();
            let last = DVec3::from(volume.dims().map(|n| (n - 1) as f64));
            if !(place.cmpge(DVec3::ZERO).all() && place.cmple(last).all()) {
                return false;
            }
            let [nx, ny, _] = volume.dims();
            let voxel = place.x as usize + nx * (place.y as usize + ny * place.z as usize);
            let value = volume.samples().value(voxel);
            (values.low..=values.high).contains(&value) && is_visible(volume, hidden, voxel)
        };
        let [near, far] = outline.depth_range();
        let step = STEP_EDGES * outline.edge();
        let count = ((far - near) / step).ceil().max(0.0) as usize;
        let gap = (GAP_EDGES / STEP_EDGES) as usize;
        let depth = |at: usize| {
            let place = low + DVec2::new((at % size[0]) as f64, (at / size[0]) as f64) * cell;
            let mut last_met = None;
            for step_number in 0..count {
                let depth = near + step_number as f64 * step;
                if is_met(outline.index_at(place, depth)) {
                    last_met = Some(step_number);
                } else if last_met.is_some_and(|met| step_number - met > gap) {
                    break;
                }
            }
            last_met.map_or(f32::NAN, |met| (near + met as f64 * step + GAP_EDGES * outline.edge()) as f32)
        };
        let depths = (0..size[0] * size[1]).into_par_iter().map(depth).collect();
        Self { low, cell, size, depths }.filtered(median).filtered(mean)
    }

    /// Replaces each depth by one of those around it, without rays that meet nothing: single rays that slip through a
    /// gap would leave needles.
    fn filtered(self, filter: impl Fn(&mut [f32]) -> f32 + Sync) -> Self {
        let [width, height] = self.size;
        let depth = |at: usize| {
            if self.depths[at].is_nan() {
                return f32::NAN;
            }
            let around =
                |at: usize, count: usize| at.saturating_sub(FILTER_RAYS)..(at + FILTER_RAYS + 1).min(count);
            let rows = around(at / width, height);
            let columns = around(at % width, width);
            let near = rows.flat_map(|y| columns.clone().map(move |x| x + width * y));
            let mut met: Vec<f32> = near.map(|at| self.depths[at]).filter(|depth| !depth.is_nan()).collect();
            filter(&mut met)
        };
        let depths = (0..width * height).into_par_iter().map(depth).collect();
        Self { depths, ..self }
    }

    /// Returns the distance, in scene units, by which a point at a depth lies before the end of the first surface;
    /// negative behind it.
    pub(super) fn distance_before_end(&self, place: DVec2, depth: f64) -> f64 {
        let at = ((place - self.low) / self.cell).round();
        let last = DVec2::new((self.size[0] - 1) as f64, (self.size[1] - 1) as f64);
        let [x, y] = at.clamp(DVec2::ZERO, last).to_array().map(|at| at as usize);
        match self.depths[x + self.size[0] * y] {
            end if end.is_nan() => f64::NEG_INFINITY,
            end => f64::from(end) - depth,
        }
    }
}

/// Returns the median of depths, at least one.
fn median(depths: &mut [f32]) -> f32 {
    let middle = depths.len() / 2;
    *depths.select_nth_unstable_by(middle, f32::total_cmp).1
}

/// Returns the mean of depths, at least one.
fn mean(depths: &mut [f32]) -> f32 {
    depths.iter().sum::<f32>() / depths.len() as f32
}
