//! Lists of the bricks that are splatted into each sheet.

use glam::{DAffine3, DVec3};

use crate::plan::{SheetFrame, SliceOrder};
use crate::volume::brick_list;
use chiaroscuro_volume::BRICK_EDGE;

/// Bricks of all sheets, sheet by sheet.
pub(crate) struct SheetLists {
    /// Start of each sheet's list, with the end of the last as an additional entry.
    pub starts: Vec<u32>,
    /// Packed coordinates of each brick, and the word where its voxels begin.
    pub bricks: Vec<[u32; 2]>,
}

/// Lists for every slab the bricks with voxels that reach it. `half_depth` is half the depth of a kernel.
pub(crate) fn slab_lists(
    frame: &SheetFrame,
    sheets_from_index: &DAffine3,
    bricks: impl Iterator<Item = ([usize; 3], u32)>,
    half_depth: f64,
) -> SheetLists {
    let count = frame.slab_count as usize;
    let mut lists = vec![Vec::new(); count];
    let last = (BRICK_EDGE - 1) as f64;
    for (brick, first_word) in bricks {
        let corner = DVec3::from(brick.map(|c| (c * BRICK_EDGE) as f64));
        let depths = (0..8).map(|side| {
            let step = DVec3::new(f64::from(side & 1), f64::from(side >> 1 & 1), f64::from(side >> 2));
            sheets_from_index.transform_point3(corner + step * last).z
        });
        let (near, far) =
            depths.fold((f64::INFINITY, f64::NEG_INFINITY), |(near, far), z| (near.min(z), far.max(z)));
        let slab = |depth: f64| (depth - frame.first_depth) / frame.slab;
        let first = slab(near - half_depth).floor().max(0.0) as usize;
        let end = (slab(far + half_depth).floor() + 1.0).clamp(0.0, count as f64) as usize;
        let packed = [brick_list::pack_coordinates(brick), first_word];
        for list in lists.iter_mut().take(end).skip(first) {
            list.push(packed);
        }
    }
    concatenate(lists)
}

/// Lists for every slice the bricks that it cuts.
pub(crate) fn slice_lists(
    slices: &SliceOrder,
    bricks: impl Iterator<Item = ([usize; 3], u32)>,
) -> SheetLists {
    let mut layers = vec![Vec::new(); (slices.count as usize).div_ceil(BRICK_EDGE)];
    for (brick, first_word) in bricks {
        layers[brick[slices.axis]].push([brick_list::pack_coordinates(brick), first_word]);
    }
    concatenate((0..slices.count).map(|k| layers[slices.slice(k) / BRICK_EDGE].clone()).collect())
}

/// Concatenates the lists of all sheets.
fn concatenate(lists: Vec<Vec<[u32; 2]>>) -> SheetLists {
    let mut starts = vec![0];
    let mut all: Vec<[u32; 2]> = Vec::new();
    for list in lists {
        all.extend(list);
        starts.push(all.len() as u32);
    }
    // Bindings must not be empty.
    if all.is_empty() {
        all.push([0; 2]);
    }
    SheetLists { starts, bricks: all }
}
