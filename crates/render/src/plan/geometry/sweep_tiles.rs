//! Sweep tiles: the range of slices in which the rays of a sweep are followed, for each tile of rays.

use glam::{DVec2, DVec3};

use crate::plan::{CellSet, SweepFrame, TILE_EDGE};
use chiaroscuro_volume::{BRICK_EDGE, CELL_EDGE};

/// Maximum number of boxes around single cells; beyond it there is one per brick. Each takes some 20 ns per
/// direction.
const MAX_CELL_BOXES: usize = 4096;

/// Bit at which the end slice (exclusive) begins in a tile's entry, above the first slice. Grids have 2048 slices at
/// most.
pub const END_SLICE_BIT: u32 = 16;

/// Margin in rays and slices to either side, for rounding in shaders.
const ROUNDING_MARGIN: f64 = 0.01;

/// Returns boxes around the cells of a set of blocks, extended by interpolation to their neighbours: lower and upper
/// corners, in blocks. If there are many cells, the boxes surround bricks.
pub fn boxes_around(cells: &CellSet) -> Vec<[DVec3; 2]> {
    let around = |first: [usize; 3], edge: usize| {
        let low = DVec3::from(first.map(|at| at as f64));
        [low - 1.0, low + edge as f64]
    };
    if cells.count() > MAX_CELL_BOXES {
        return cells
            .bricks()
            .map(|(brick, _)| around(brick.map(|at| at * BRICK_EDGE), BRICK_EDGE))
            .collect();
    }
    cells.cells().map(|cell| around(cell.map(|at| at * CELL_EDGE), CELL_EDGE)).collect()
}

/// Slices in which the rays of a direction have to be followed.
///
/// An entry for each tile of 8 × 8 rays, row by row: the first slice, and from bit 16 on the end slice (exclusive);
/// both are 0 for tiles without any.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SweepTiles(pub Vec<u32>);

impl SweepTiles {
    /// Computes for each tile the slices from the first to the last in which its rays are in one of the boxes, in
    /// blocks.
    pub fn covering(frame: &SweepFrame, boxes: &[[DVec3; 2]]) -> Self {
        let [columns, rows] = frame.size.map(|n| n.div_ceil(TILE_EDGE) as usize);
        let mut spans = vec![[u32::MAX, 0]; columns * rows];
        let last_slice = frame.slices() as f64 - 1.0;
        let first_ray = DVec2::new(frame.first[0].into(), frame.first[1].into());
        let edge = f64::from(TILE_EDGE);
        for [low, high] in boxes {
            let [low, high] = [low, high].map(|corner| frame.slice_position(*corner));
            let (near, far) = (low.slice.min(high.slice), low.slice.max(high.slice));
            let [first, last] =
                [(near - ROUNDING_MARGIN).ceil().max(0.0), (far + ROUNDING_MARGIN).floor().min(last_slice)];
            if first > last {
                continue;
            }
            let drifts = [frame.drift * first, frame.drift * last];
            let ends = [
                low.across - drifts[0].max(drifts[1]) - first_ray - ROUNDING_MARGIN,
                high.across - drifts[0].min(drifts[1]) - first_ray + ROUNDING_MARGIN,
            ];
            let tile = |at: f64, count: usize| (at / edge).floor().clamp(0.0, count as f64 - 1.0) as usize;
            for row in tile(ends[0].y, rows)..=tile(ends[1].y, rows) {
                for column in tile(ends[0].x, columns)..=tile(ends[1].x, columns) {
                    let span = &mut spans[row * columns + column];
                    *span = [span[0].min(first as u32), span[1].max(last as u32 + 1)];
                }
            }
        }
        let packed = |[first, end]: [u32; 2]| if end == 0 { 0 } else { first | end << END_SLICE_BIT };
        Self(spans.into_iter().map(packed).collect())
    }
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;

    use super::*;
    use crate::plan::{SlicePosition, sweep_directions};
    use chiaroscuro_volume::math::SceneSpace;

    fn frames(dims: [usize; 3]) -> Vec<SweepFrame> {
        let scene = SceneSpace::new(dims, DAffine3::from_scale(DVec3::new(1.0, 0.7, 2.0)));
        sweep_directions(24).into_iter().map(|towards| SweepFrame::new(&scene, 1, towards)).collect()
    }

    /// Returns true if a tile's rays are followed in a slice.
    fn is_followed(frame: &SweepFrame, tiles: &SweepTiles, ray: [u32; 2], slice: u32) -> bool {
        let [column, row] = ray.map(|at| at / TILE_EDGE);
        let entry = tiles.0[(row * frame.size[0].div_ceil(TILE_EDGE) + column) as usize];
        (entry & 0xffff..entry >> END_SLICE_BIT).contains(&slice)
    }

    #[test]
    fn every_ray_around_a_listed_block_is_followed_there() {
        let dims = [21usize, 30, 11];
        let mut cells = CellSet { dims: dims.map(|n| n.div_ceil(BRICK_EDGE)), masks: vec![0; 3 * 4 * 2] };
        for cell in [[0, 0, 0], [10, 14, 5], [4, 9, 2], [5, 9, 2]] {
            cells.insert(cell);
        }
        for frame in frames(dims) {
            let tiles = SweepTiles::covering(&frame, &boxes_around(&cells));
            for ray in (0..frame.size[1]).flat_map(|y| (0..frame.size[0]).map(move |x| [x, y])) {
                for slice in 0..frame.slices() {
                    let at = frame.block_position(slice as f64, frame.crossing(ray, slice));
                    // Blocks that the ray passes between, or that look it up.
                    let is_near = cells.cells().any(|cell| {
                        let low = DVec3::from(cell.map(|c| (c * CELL_EDGE) as f64));
                        at.cmpgt(low - 1.0).all() && at.cmplt(low + 2.0).all()
                    });
                    let followed = is_followed(&frame, &tiles, ray, slice as u32);
                    assert!(followed || !is_near, "{frame:?}: {ray:?} in {slice}");
                }
            }
            let followed = tiles.0.iter().filter(|entry| **entry != 0).count();
            assert!(followed < tiles.0.len(), "{followed} of {}", tiles.0.len());
        }
    }

    #[test]
    fn many_cells_are_followed_brick_by_brick() {
        let all = CellSet::full([6; 3]);
        let boxes = boxes_around(&all);
        assert_eq!((boxes.len(), boxes[1]), (216, [DVec3::new(7.0, -1.0, -1.0), DVec3::new(16.0, 8.0, 8.0)]));
        for frame in frames([48; 3]) {
            let tiles = SweepTiles::covering(&frame, &boxes);
            for block in [DVec3::ZERO, DVec3::splat(47.0), DVec3::new(3.0, 40.0, 21.0)] {
                let SlicePosition { slice, across: ray } = frame.ray_position(block);
                let ray = [ray.x as u32, ray.y as u32];
                assert!(is_followed(&frame, &tiles, ray, slice as u32), "{frame:?}: {block}");
            }
        }
    }

    #[test]
    fn nothing_is_followed_nowhere() {
        for frame in frames([9, 8, 7]) {
            let tiles = SweepTiles::covering(&frame, &[]);
            assert!(tiles.0.iter().all(|entry| *entry == 0));
        }
    }
}
