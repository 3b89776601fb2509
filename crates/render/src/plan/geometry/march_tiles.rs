//! March tiles: the tiles of a light's sheets that have to be marched, since something is looked up or attenuates
//! light there, for each chunk of slabs.

use std::ops::RangeInclusive;

use glam::{DAffine3, DMat3, DVec2, DVec3};
use rayon::prelude::*;

use crate::plan::LightView;
use chiaroscuro_volume::math::SceneSpace;

/// Edge of a tile in pixels: that of a workgroup.
pub const TILE_EDGE: u32 = 8;

/// Bit at which the row begins in a tile's entry, above the column. Sheets have at most a few thousand pixels across.
pub const TILE_ROW_BIT: u32 = 15;

/// Bit set in the entry of a tile that is in no earlier chunk: light arrives there unattenuated.
pub const TILE_FIRST_BIT: u32 = 31;

/// Minimum number of boxes that a thread projects at a time: a tenth of a millisecond of work.
const MIN_BOXES_PER_TASK: usize = 1024;

/// Mark of a tile that is in no earlier chunk.
const FIRST_MARK: u32 = 1 << TILE_FIRST_BIT;

/// Minimum distance to the light's plane, in anchor distances; nearer boxes may cover any number of pixels.
const MIN_SPREAD: f64 = 0.05;

/// Margin in pixels and slabs to either side, for rounding in shaders.
const ROUNDING_MARGIN: f64 = 1.0;

/// Tiles of a view's sheets for each chunk of slabs, in row order.
///
/// An entry holds the tile's column, its row (from bit 15), and a bit for the first chunk in which it occurs (bit
/// 31).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MarchTiles {
    chunks: Vec<Vec<u32>>,
}

impl MarchTiles {
    /// Returns every tile in every chunk of `chunk` slabs.
    pub fn all(view: &LightView, chunk: u32) -> Self {
        let mut marked = TileMarks::new(view, chunk);
        marked.chunks.iter_mut().for_each(|tiles| tiles.fill(true));
        marked.into_tiles()
    }

    /// Returns the tiles, chunk by chunk, that contain parts of boxes of index space, given by their lower and upper
    /// corners. If transmittance behind all sheets is read, too (`begins_everywhere`), every tile of the first chunk
    /// is included, where light has to begin.
    pub fn covering(
        view: &LightView,
        scene: &SceneSpace,
        chunk: u32,
        boxes: impl Iterator<Item = [DVec3; 2]>,
        begins_everywhere: bool,
    ) -> Self {
        let mut marked = TileMarks::new(view, chunk);
        if begins_everywhere {
            marked.mark(BoxExtent { pixels: [DVec2::NEG_INFINITY, DVec2::INFINITY], slabs: [0.0; 2] });
        }
        let turned = DAffine3::from_mat3(view.axes.transpose());
        let local_from_index = turned * DAffine3::from_translation(-view.anchor) * scene.scene_from_index;
        let extent = |&[low, high]: &[DVec3; 2]| {
            let corner = local_from_index.transform_point3(low);
            box_extent(view, corner, local_from_index.matrix3 * DMat3::from_diagonal(high - low))
        };
        let boxes: Vec<_> = boxes.collect();
        let extents: Vec<_> = boxes.par_iter().with_min_len(MIN_BOXES_PER_TASK).map(extent).collect();
        extents.into_iter().flatten().for_each(|extent| marked.mark(extent));
        marked.into_tiles()
    }

    /// Returns the tile entries of a chunk.
    pub fn chunk(&self, at: usize) -> &[u32] {
        self.chunks.get(at).map_or(&[], Vec::as_slice)
    }
}

/// Ranges of pixels and slabs, each from its lower to its upper end.
struct BoxExtent {
    pixels: [DVec2; 2],
    slabs: [f64; 2],
}

/// Returns the ranges of pixels and slabs that contain a box, given by a corner and three edges in the light's axes;
/// `None` if it is completely behind the light.
fn box_extent(view: &LightView, corner: DVec3, edges: DMat3) -> Option<BoxExtent> {
    let frame = &view.frame;
    if frame.inverse_distance == 0.0 {
        // Pixels of parallel light are equally wide at all depths.
        let scale = DVec3::new(frame.pitch, frame.pitch, frame.slab).recip();
        let first = view.first_pixel.extend(frame.first_depth / frame.slab + 0.5);
        let sum = |limit: fn(DVec3, DVec3) -> DVec3| {
            let [x, y, z] = [edges.x_axis, edges.y_axis, edges.z_axis].map(|edge| limit(edge, DVec3::ZERO));
            (corner + x + y + z) * scale - first
        };
        let (low, high) = (sum(DVec3::min) - ROUNDING_MARGIN, sum(DVec3::max) + ROUNDING_MARGIN);
        return Some(BoxExtent { pixels: [low.truncate(), high.truncate()], slabs: [low.z, high.z] });
    }
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let mut nearest = f64::INFINITY;
    for side in 0..8 {
        let along = [0, 1, 2].map(|axis| f64::from(side >> axis & 1));
        let local = corner + edges * DVec3::from(along);
        let spread = 1.0 + local.z * frame.inverse_distance;
        nearest = nearest.min(spread);
        let pixel = local.truncate() / (frame.pitch * spread.max(MIN_SPREAD)) - view.first_pixel;
        let at = pixel.extend((local.z - frame.first_depth) / frame.slab - 0.5);
        (low, high) = (low.min(at), high.max(at));
    }
    let slabs = [low.z - ROUNDING_MARGIN, high.z + ROUNDING_MARGIN];
    if nearest > MIN_SPREAD {
        let pixels = [low.truncate() - ROUNDING_MARGIN, high.truncate() + ROUNDING_MARGIN];
        return Some(BoxExtent { pixels, slabs });
    }
    let behind = frame.inverse_distance > 0.0
        && frame.first_depth + (slabs[1] + 0.5) * frame.slab < -1.0 / frame.inverse_distance;
    (!behind).then_some(BoxExtent { pixels: [DVec2::NEG_INFINITY, DVec2::INFINITY], slabs })
}

/// Tile marks under construction.
struct TileMarks {
    /// Number of tile columns and rows.
    size: [u32; 2],
    /// Number of slabs in a chunk.
    chunk: u32,
    chunks: Vec<Vec<bool>>,
    /// True for chunks of which every tile is marked.
    full: Vec<bool>,
}

impl TileMarks {
    fn new(view: &LightView, chunk: u32) -> Self {
        let size = view.frame.size.map(|n| n.div_ceil(TILE_EDGE));
        let count = view.frame.slab_count.div_ceil(chunk).max(1) as usize;
        let chunks = vec![vec![false; (size[0] * size[1]) as usize]; count];
        Self { size, chunk, chunks, full: vec![false; count] }
    }

    fn mark(&mut self, BoxExtent { pixels: [low, high], slabs: [first, last] }: BoxExtent) {
        let Some(chunks) = pieces_covering(first, last, self.chunk, self.chunks.len()) else {
            return;
        };
        let [Some(columns), Some(rows)] =
            [0, 1].map(|axis| pieces_covering(low[axis], high[axis], TILE_EDGE, self.size[axis] as usize))
        else {
            return;
        };
        let is_all = columns == (0..=self.size[0] as usize - 1) && rows == (0..=self.size[1] as usize - 1);
        for (tiles, full) in self.chunks[chunks.clone()].iter_mut().zip(&mut self.full[chunks]) {
            if std::mem::replace(full, *full || is_all) {
                continue;
            }
            for row in rows.clone() {
                let start = row * self.size[0] as usize;
                tiles[start + columns.start()..=start + columns.end()].fill(true);
            }
        }
    }

    fn into_tiles(self) -> MarchTiles {
        let mut is_new = vec![true; (self.size[0] * self.size[1]) as usize];
        let width = self.size[0];
        let list = |tiles: &Vec<bool>| {
            let marked = tiles.iter().zip(&mut is_new).zip(0..).filter(|((marked, _), _)| **marked);
            let entry = |((_, is_new), at): ((&bool, &mut bool), u32)| {
                let first = if std::mem::take(is_new) { FIRST_MARK } else { 0 };
                (at % width) | ((at / width) << TILE_ROW_BIT) | first
            };
            marked.map(entry).collect()
        };
        MarchTiles { chunks: self.chunks.iter().map(list).collect() }
    }
}

/// Returns the range of pieces of a length, out of `count`, that contain the integers around `low` … `high`; `None`
/// if they are all outside.
fn pieces_covering(low: f64, high: f64, length: u32, count: usize) -> Option<RangeInclusive<usize>> {
    // One less where the cast, which saturates, rounds a fraction up towards zero. Faster than `floor`, which is a
    // call on processors that are not known to have an instruction for it.
    let floor = |at: f64| (at as i64).saturating_sub(i64::from((at as i64) as f64 > at));
    let piece = |at: i64| at.div_euclid(i64::from(length));
    let (first, last) = (piece(floor(low)), piece(floor(-high).saturating_neg()));
    let end = count as i64 - 1;
    (last >= 0 && first <= end).then(|| first.max(0) as usize..=last.min(end) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::light_views;
    use chiaroscuro_scene::{LightGeometry, SceneLight, ShadowSettings};

    const CHUNK: u32 = 8;

    fn scene() -> SceneSpace {
        SceneSpace::new([40, 30, 20], DAffine3::from_scale(DVec3::new(1.0, 1.2, 2.0)))
    }

    fn views(kind: LightGeometry, position: [f64; 3]) -> Vec<LightView> {
        light_views(
            &SceneLight { kind, position, ..SceneLight::default() },
            &ShadowSettings::default(),
            &scene(),
        )
    }

    fn has(tiles: &MarchTiles, [i, j]: [u32; 2], slab: u32) -> bool {
        let wanted = (i / TILE_EDGE) | ((j / TILE_EDGE) << TILE_ROW_BIT);
        tiles.chunk((slab / CHUNK) as usize).iter().any(|tile| tile & !FIRST_MARK == wanted)
    }

    #[test]
    fn rays_through_a_box_meet_it_in_its_tiles() {
        let scene = scene();
        let [low, high] = [DVec3::new(10.0, 8.0, 3.0), DVec3::new(17.0, 15.0, 12.0)];
        for (kind, position) in [
            (LightGeometry::Parallel, [1.0, 2.0, 3.0]),
            (LightGeometry::Perspective, [1.0, 2.0, 3.0]),
            (LightGeometry::Perspective, [0.1, 0.2, 0.0]),
            (LightGeometry::Perspective, [-0.4, -0.2, -0.1]),
        ] {
            let mut met = 0;
            for view in views(kind, position) {
                let tiles = MarchTiles::covering(&view, &scene, CHUNK, std::iter::once([low, high]), false);
                let [width, height] = view.frame.size;
                for (i, j) in (0..height).flat_map(|j| (0..width).map(move |i| (i, j))) {
                    for k in 0..view.frame.slab_count {
                        let depth = view.frame.depth_of(f64::from(k));
                        let p = view.frame.point(f64::from(i), f64::from(j), depth);
                        if p.cmpge(low).all() && p.cmple(high).all() {
                            assert!(has(&tiles, [i, j], k), "{kind:?} {position:?}: ({i}, {j}, {k})");
                            met += 1;
                        }
                    }
                }
            }
            assert!(met > 500, "{kind:?} {position:?}: {met}");
        }
    }

    #[test]
    fn a_small_box_has_few_tiles() {
        let scene = scene();
        let view = &views(LightGeometry::Perspective, [1.0, 2.0, 3.0])[0];
        let around = |low: DVec3| std::iter::once([low, low + 1.0]);
        let count = |tiles: &MarchTiles| tiles.chunks.iter().map(Vec::len).sum::<usize>();
        let few = count(&MarchTiles::covering(view, &scene, CHUNK, around(DVec3::splat(10.0)), false));
        assert!((1..=8).contains(&few), "{few}");
        assert_eq!(count(&MarchTiles::covering(view, &scene, CHUNK, around(DVec3::splat(500.0)), false)), 0);
        let all = MarchTiles::all(view, CHUNK);
        let each = view.frame.size.map(|n| n.div_ceil(TILE_EDGE) as usize).iter().product::<usize>();
        assert_eq!(count(&all), each * view.frame.slab_count.div_ceil(CHUNK) as usize);
    }

    #[test]
    fn every_tile_is_first_once() {
        let scene = scene();
        let view = &views(LightGeometry::Parallel, [1.0, 0.3, 0.2])[0];
        let boxes =
            [[DVec3::splat(2.0), DVec3::splat(6.0)], [DVec3::splat(9.0), DVec3::new(30.0, 12.0, 15.0)]];
        let tiles = MarchTiles::covering(view, &scene, CHUNK, boxes.into_iter(), false);
        let mut seen = std::collections::BTreeSet::new();
        for tile in tiles.chunks.iter().flatten() {
            assert_eq!(tile & FIRST_MARK != 0, seen.insert(tile & !FIRST_MARK), "{tile:x}");
        }
        assert!(seen.len() > 4);
    }

    #[test]
    fn light_begins_everywhere_where_all_that_comes_out_is_read() {
        let scene = scene();
        let view = &views(LightGeometry::Parallel, [1.0, 0.3, 0.2])[0];
        let far = std::iter::once([DVec3::splat(12.0), DVec3::splat(18.0)]);
        let tiles = MarchTiles::covering(view, &scene, CHUNK, far, true);
        let all = MarchTiles::all(view, CHUNK);
        assert_eq!(tiles.chunk(0), all.chunk(0));
        let rest = |tiles: &MarchTiles| tiles.chunks.iter().skip(1).map(Vec::len).sum::<usize>();
        assert!((1..rest(&all) / 2).contains(&rest(&tiles)), "{}", rest(&tiles));
    }

    #[test]
    fn what_is_behind_a_light_is_in_none_of_its_tiles() {
        let scene = scene();
        let views = views(LightGeometry::Perspective, [0.1, 0.2, 0.0]);
        let light = scene.scene_from_index.inverse().transform_point3(DVec3::new(0.1, 0.2, 0.0));
        let far = [light + DVec3::new(6.0, -1.0, -1.0), light + DVec3::new(8.0, 1.0, 1.0)];
        let is_listed = |forward: DVec3| {
            let view = views.iter().find(|view| view.axes.z_axis.dot(forward) > 0.99).unwrap();
            let tiles = MarchTiles::covering(view, &scene, CHUNK, std::iter::once(far), false);
            tiles.chunks.iter().any(|tiles| !tiles.is_empty())
        };
        assert!(is_listed(DVec3::X) && !is_listed(DVec3::NEG_X));
    }
}
