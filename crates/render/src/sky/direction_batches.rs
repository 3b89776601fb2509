//! Batches of directions in which light is swept through blocks, and the size of their textures.

use glam::DVec3;
use rayon::prelude::*;

use crate::pipelines::uniforms::MAX_BATCH_DIRECTIONS;
use crate::plan::{SweepFrame, SweepTiles};

/// Number of blocks times directions in a batch: some 0.2 s on a software adapter.
pub(crate) const BATCH_BLOCKS: usize = 1 << 23;

/// Size up to which the sheets of a batch may always grow, in bytes: enough for previews, and quickly cleared.
const SMALL_BATCH_BYTES: usize = 4 << 20;
/// Maximum size of the sheets of a batch, in bytes.
const MAX_BATCH_BYTES: usize = 128 << 20;

/// Cost of reading and writing the sums of a block, as the number of bytes of sheets that could be cleared in that
/// time.
///
/// On a software adapter it is 7.7 ns per block, and 0.4 ns per byte. Sheets are created and cleared for every
/// filling.
const BYTES_PER_SUM: f64 = 20.0;

/// Maximum depth of a 3D texture on all adapters.
const MAX_LAYERS: usize = 2048;

/// Returns columns, rows and layers of the sheets for batches of these directions, with one layer for each slice,
/// where light is followed in `followed` directions in all.
///
/// With E directions in a batch, sheets take E times the bytes of one direction, and sums are updated in K / E
/// batches of K directions; the total cost is minimal where E² is K times the cost of the sums divided by the cost of
/// the sheets.
pub(crate) fn sheet_size<'a>(
    frames: impl Iterator<Item = &'a SweepFrame>,
    format: wgpu::TextureFormat,
    followed: usize,
) -> [usize; 3] {
    let mut blocks = 0;
    let (most, count) = frames.fold(([1; 3], 0), |([width, height, slices], count), frame| {
        blocks = frame.dims.iter().product();
        let [columns, rows] = frame.size.map(|n| n as usize);
        ([width.max(columns), height.max(rows), slices.max(frame.slices())], count + 1)
    });
    let [width, height, slices] = most;
    let bytes = format.block_copy_size(None).unwrap_or(8) as usize * width * height * slices;
    let best = (followed as f64 * BYTES_PER_SUM * blocks as f64 / bytes as f64).sqrt().round() as usize;
    let most = count.min(MAX_BATCH_DIRECTIONS).min(MAX_LAYERS / slices).min(MAX_BATCH_BYTES / bytes);
    [width, height, slices * best.max(SMALL_BATCH_BYTES / bytes).min(most).max(1)]
}

/// Parallel rays of one direction.
#[derive(Debug)]
pub(crate) struct DirectionRays {
    pub frame: SweepFrame,
    /// Tiles of rays that have to be followed, with their ranges of slices.
    pub tiles: SweepTiles,
}

/// Directions in which light is followed, divided into batches.
#[derive(Debug)]
pub(crate) struct DirectionBatches {
    rays: Vec<DirectionRays>,
    /// Number of directions in a batch; the last may have fewer.
    directions_per_batch: usize,
}

impl DirectionBatches {
    /// Divides the directions into as few batches as the layers of the sheets and the time per batch allow. Rays are
    /// followed through `boxes`, in blocks.
    pub(crate) fn new(frames: Vec<SweepFrame>, layers: usize, boxes: &[[DVec3; 2]]) -> Self {
        let slices = frames.iter().map(SweepFrame::slices).max().unwrap_or(1);
        Self::with_max_per_batch(layers / slices, frames, boxes)
    }

    /// Divides the directions into batches, for rays that store only the transmittance at their ends and so need one
    /// layer each.
    pub(crate) fn with_end_layers(frames: Vec<SweepFrame>, boxes: &[[DVec3; 2]]) -> Self {
        Self::with_max_per_batch(MAX_BATCH_DIRECTIONS, frames, boxes)
    }

    fn with_max_per_batch(most: usize, frames: Vec<SweepFrame>, boxes: &[[DVec3; 2]]) -> Self {
        let blocks: usize = frames.first().map_or(1, |frame| frame.dims.iter().product());
        let most = (BATCH_BLOCKS / blocks.max(1)).min(most).clamp(1, MAX_BATCH_DIRECTIONS);
        // As even as possible, since a pass over fewer directions takes as long as one over all.
        let each = frames.len().div_ceil(frames.len().div_ceil(most).max(1)).max(1);
        let rays = |frame: SweepFrame| DirectionRays { tiles: SweepTiles::covering(&frame, boxes), frame };
        Self { rays: frames.into_par_iter().map(rays).collect(), directions_per_batch: each }
    }

    /// Returns the number of batches.
    pub(crate) fn count(&self) -> usize {
        self.rays.len().div_ceil(self.directions_per_batch)
    }

    /// Returns the number of directions in all batches.
    pub(crate) fn directions(&self) -> usize {
        self.rays.len()
    }

    /// Returns the number of directions in a batch; the last may have fewer.
    pub(crate) fn directions_per_batch(&self) -> usize {
        self.directions_per_batch
    }

    /// Returns the rays of all batches.
    pub(crate) fn all(&self) -> &[DirectionRays] {
        &self.rays
    }

    /// Returns the rays of a batch; empty beyond the last.
    pub(crate) fn rays(&self, batch: usize) -> &[DirectionRays] {
        self.rays.chunks(self.directions_per_batch).nth(batch).unwrap_or_default()
    }

    /// Returns the largest numbers of columns and rows of rays in any direction.
    pub(crate) fn max_size(&self) -> [usize; 2] {
        [0, 1].map(|side| self.rays.iter().map(|rays| rays.frame.size[side] as usize).max().unwrap_or(1))
    }
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;

    use super::*;
    use crate::plan::sweep_directions;
    use chiaroscuro_volume::math::SceneSpace;

    const ONE: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;
    const COLORS: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

    fn frames(dims: [usize; 3], count: u32) -> Vec<SweepFrame> {
        let scene = SceneSpace::new(dims, DAffine3::IDENTITY);
        sweep_directions(count).into_iter().map(|towards| SweepFrame::new(&scene, 1, towards)).collect()
    }

    #[test]
    fn every_direction_is_in_one_batch_that_fits() {
        for (dims, count) in [([26, 24, 41], 12), ([151, 162, 28], 48), ([200; 3], 6), ([400, 1, 1], 24)] {
            for format in [ONE, COLORS] {
                let frames = frames(dims, count);
                let [width, height, layers] = sheet_size(frames.iter(), format, count as usize);
                let batches = DirectionBatches::new(frames, layers, &[]);
                assert_eq!(batches.directions(), count as usize);
                let mut before = 0;
                for batch in 0..batches.count() {
                    let frames: Vec<_> = batches.rays(batch).iter().map(|rays| &rays.frame).collect();
                    before += frames.len();
                    assert!((1..=batches.directions_per_batch()).contains(&frames.len()), "{dims:?}");
                    assert!(frames.iter().map(|frame| frame.slices()).sum::<usize>() <= layers, "{dims:?}");
                    let [widest, highest] =
                        [0, 1].map(|side| frames.iter().map(|frame| frame.size[side] as usize).max());
                    assert!(widest <= Some(width) && highest <= Some(height), "{dims:?}");
                }
                assert_eq!(before, count as usize, "{dims:?}");
                assert!(batches.rays(batches.count()).is_empty());
            }
        }
    }

    #[test]
    fn batches_are_even_and_sheets_no_larger_than_they_need_be() {
        let of = |dims, count, format| {
            let frames = frames(dims, count);
            let size = sheet_size(frames.iter(), format, count as usize);
            (DirectionBatches::new(frames, size[2], &[]), size)
        };
        let (small, [.., layers]) = of([26, 24, 41], 6, ONE);
        assert_eq!((small.count(), small.directions_per_batch(), layers), (1, 6, 6 * 41));
        let (more, _) = of([26, 24, 41], 12, ONE);
        assert_eq!((more.count(), more.directions_per_batch()), (2, 6));
        // In a flat grid, slanted rays take 23 times as many texels as there are blocks.
        let (flat, _) = of([151, 162, 28], 6, ONE);
        assert_eq!(flat.directions_per_batch(), 2);
        let (flat, _) = of([151, 162, 28], 48, ONE);
        assert!((4..=6).contains(&flat.directions_per_batch()), "{}", flat.directions_per_batch());
        // A single direction is allowed to exceed the limit.
        let (large, [width, height, layers]) = of([300; 3], 6, COLORS);
        assert_eq!((large.count(), layers), (6, 300));
        assert!(8 * width * height * layers > MAX_BATCH_BYTES);
    }
}
