//! In which batches light is followed, and how much room their rays take.

use glam::DVec3;
use rayon::prelude::*;

use crate::gpu::pipelines::uniforms::MAX_SKY_RAYS;
use crate::plan::{SweepFrame, SweepTiles};

/// Blocks times directions of a batch: some 0.2 s on a software adapter.
pub(crate) const BATCH_BLOCKS: usize = 1 << 23;

/// Bytes of the rays of a batch, where those of one direction are not more: enough for previews, and soon cleared.
const SMALL_BATCH_BYTES: usize = 4 << 20;
/// And most of them.
const BATCH_BYTES: usize = 128 << 20;

/// Reading and writing the sums of a block takes as long as clearing so many bytes of sheets, which are made anew for every
/// filling (7.7 ns and 0.4 ns a byte on a software adapter).
const BYTES_PER_SUM: f64 = 20.0;

/// Most layers of a 3D texture everywhere.
const MOST_LAYERS: usize = 2048;

/// Columns, rows and layers of sheets of a format for the rays from any of these directions, in a layer for each slice, where
/// light is followed in so many directions in all.
///
/// Of E directions in a batch sheets take E bytes of one, and sums are added to in K / E batches: together they take least
/// where E² is K times what sums take, over what sheets take.
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
    let most = count.min(MAX_SKY_RAYS).min(MOST_LAYERS / slices).min(BATCH_BYTES / bytes);
    [width, height, slices * best.max(SMALL_BATCH_BYTES / bytes).min(most).max(1)]
}

/// The rays of a direction.
#[derive(Debug)]
pub(crate) struct Rays {
    pub frame: SweepFrame,
    /// Where they have to be followed.
    pub tiles: SweepTiles,
}

/// Directions in which light is followed, batch by batch.
#[derive(Debug)]
pub(crate) struct Batches {
    rays: Vec<Rays>,
    /// Directions of a batch; of the last, they may be fewer.
    each: usize,
}

impl Batches {
    /// As few as sheets of so many layers have room for, and as take no longer than they may. Rays are followed through boxes,
    /// in blocks.
    pub(crate) fn new(frames: Vec<SweepFrame>, layers: usize, boxes: &[[DVec3; 2]]) -> Self {
        let slices = frames.iter().map(SweepFrame::slices).max().unwrap_or(1);
        Self::of_at_most(layers / slices, frames, boxes)
    }

    /// The same of rays that keep what is left of them at their ends alone.
    pub(crate) fn of_ends(frames: Vec<SweepFrame>, boxes: &[[DVec3; 2]]) -> Self {
        Self::of_at_most(MAX_SKY_RAYS, frames, boxes)
    }

    fn of_at_most(most: usize, frames: Vec<SweepFrame>, boxes: &[[DVec3; 2]]) -> Self {
        let blocks: usize = frames.first().map_or(1, |frame| frame.dims.iter().product());
        let most = (BATCH_BLOCKS / blocks.max(1)).min(most).clamp(1, MAX_SKY_RAYS);
        // As even as can be: a pass over fewer takes as long as one over all.
        let each = frames.len().div_ceil(frames.len().div_ceil(most).max(1)).max(1);
        let rays = |frame: SweepFrame| Rays { tiles: SweepTiles::through(&frame, boxes), frame };
        Self { rays: frames.into_par_iter().map(rays).collect(), each }
    }

    /// How many batches there are.
    pub(crate) fn count(&self) -> usize {
        self.rays.len().div_ceil(self.each)
    }

    /// How many directions there are.
    pub(crate) fn directions(&self) -> usize {
        self.rays.len()
    }

    /// Directions of a batch; of the last, they may be fewer.
    pub(crate) fn each(&self) -> usize {
        self.each
    }

    /// Rays of a batch; none beyond the last.
    pub(crate) fn rays(&self, batch: usize) -> &[Rays] {
        self.rays.chunks(self.each).nth(batch).unwrap_or_default()
    }

    /// Columns and rows of the rays of any direction.
    pub(crate) fn widest(&self) -> [usize; 2] {
        [0, 1].map(|side| self.rays.iter().map(|rays| rays.frame.size[side] as usize).max().unwrap_or(1))
    }
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;

    use super::*;
    use crate::math::SceneSpace;
    use crate::plan::sweep_directions;

    const ONE: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;
    const COLORS: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

    fn frames(dims: [usize; 3], count: u32) -> Vec<SweepFrame> {
        let scene = SceneSpace::new(dims, DAffine3::IDENTITY);
        sweep_directions(count).into_iter().map(|towards| SweepFrame::new(&scene, 1, towards)).collect()
    }

    #[test]
    fn every_direction_is_in_one_batch_that_fits() {
        for (dims, count) in [([26, 24, 41], 14), ([151, 162, 28], 64), ([200; 3], 7), ([400, 1, 1], 9)] {
            for format in [ONE, COLORS] {
                let frames = frames(dims, count);
                let [width, height, layers] = sheet_size(frames.iter(), format, count as usize);
                let batches = Batches::new(frames, layers, &[]);
                assert_eq!(batches.directions(), count as usize);
                let mut before = 0;
                for batch in 0..batches.count() {
                    let frames: Vec<_> = batches.rays(batch).iter().map(|rays| &rays.frame).collect();
                    before += frames.len();
                    assert!((1..=batches.each()).contains(&frames.len()), "{dims:?}");
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
            (Batches::new(frames, size[2], &[]), size)
        };
        let (small, [.., layers]) = of([26, 24, 41], 6, ONE);
        assert_eq!((small.count(), small.each(), layers), (1, 6, 6 * 41));
        let (more, _) = of([26, 24, 41], 14, ONE);
        assert_eq!((more.count(), more.each()), (2, 7));
        // Of a flat one rays take 23 times the room of its blocks.
        let (flat, _) = of([151, 162, 28], 6, ONE);
        assert_eq!(flat.each(), 2);
        let (flat, _) = of([151, 162, 28], 64, ONE);
        assert!((4..=6).contains(&flat.each()), "{}", flat.each());
        // One direction has room, whatever it takes.
        let (large, [width, height, layers]) = of([300; 3], 6, COLORS);
        assert_eq!((large.count(), layers), (6, 300));
        assert!(8 * width * height * layers > BATCH_BYTES);
    }
}
