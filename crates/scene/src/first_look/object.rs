//! Visible object of a volume: an occupancy grid of cells that the transfer function shows, without specks and the
//! table it lies on.

use glam::DVec3;
use rayon::prelude::*;

use super::MIN_VISIBLE_OPACITY;
use crate::Settings;
use chiaroscuro_volume::{HISTOGRAM_BINS, Volume, math::SceneSpace};

/// Largest number of cells along an axis: single pixels of the compared views.
const MAX_CELLS: usize = 128;

/// Fraction (1/16) of a cell's voxels that must be visible: a line through a cell of four voxels.
const OCCUPANCY_DIVISOR: usize = 16;

/// Size limit of specks, as a share of the largest part, and the distance within which they are kept, as a share of
/// the longest edge of the other parts' box. Framing those costs little, and cutting them off would be noticed.
const SPECK_SHARE: f64 = 0.01;
const SPECK_REACH: f64 = 0.1;

/// Table limits as shares of the volume: minimum length and width, and maximum thickness, for a part at one of its
/// faces.
const TABLE_SHARES: (f64, f64) = (0.7, 0.06);

/// Occupancy grid: cells of a volume that the object occupies.
pub(super) struct VisibleObject {
    /// Number of cells along each axis.
    pub(super) cells: [usize; 3],
    /// Number of voxels along the edges of a cell; the last cells may have fewer.
    edge: [usize; 3],
    dims: [usize; 3],
    /// Occupied cells, x fastest.
    occupied: Vec<bool>,
}

/// Connected component of the object, with its bounding box in cells.
struct ObjectPart {
    cells: Vec<usize>,
    low: [usize; 3],
    high: [usize; 3],
}

impl VisibleObject {
    /// Returns the object that settings show, without specks and tables; everything visible if nothing else is left.
    pub(super) fn from_settings(settings: &Settings, volume: &Volume) -> Self {
        Self::from_visible(settings, volume).without_specks_and_tables()
    }

    /// Returns all visible cells, specks and tables included.
    pub(super) fn from_visible(settings: &Settings, volume: &Volume) -> Self {
        let volume = &volume.with_density_mapping(settings.shown_content(&volume.ranges()));
        let (settings, range) = (settings.resolved_for(volume), volume.table_range());
        let dims = volume.dims();
        let edge = dims.map(|n| n.div_ceil(MAX_CELLS));
        let cells = [0, 1, 2].map(|axis| dims[axis].div_ceil(edge[axis]));
        // Visibility by density bin, so that each voxel needs one look-up.
        let shown: Vec<bool> = (0..=HISTOGRAM_BINS)
            .map(|bin| {
                // Labels lie at least four bins apart, so that no two share a bin.
                settings.layer().transfer.opacity_at(range.value_at(bin as f64 / HISTOGRAM_BINS as f64))
                    > MIN_VISIBLE_OPACITY
            })
            .collect();
        let counts: Vec<usize> = (0..cells[2])
            .into_par_iter()
            .flat_map_iter(|layer| {
                let mut counts = vec![0usize; cells[0] * cells[1]];
                for z in layer * edge[2]..((layer + 1) * edge[2]).min(dims[2]) {
                    let is_there = |at: usize| {
                        let voxel = z * dims[0] * dims[1] + at;
                        volume.missing().is_none_or(|missing| !missing.contains(voxel))
                    };
                    for (at, density) in volume.slice_densities(z).into_iter().enumerate() {
                        let (x, y) = (at % dims[0], at / dims[0]);
                        let is_shown = shown[(density * HISTOGRAM_BINS as f32) as usize] && is_there(at);
                        counts[y / edge[1] * cells[0] + x / edge[0]] += usize::from(is_shown);
                    }
                }
                counts
            })
            .collect();
        let enough = (edge.iter().product::<usize>() / OCCUPANCY_DIVISOR).max(1);
        // Single voxels are all that there is of some objects.
        let enough = if counts.iter().any(|&count| count >= enough) { enough } else { 1 };
        let occupied = counts.into_iter().map(|count| count >= enough).collect();
        Self { cells, edge, dims, occupied }
    }

    fn coordinates(&self, cell: usize) -> [usize; 3] {
        [cell % self.cells[0], cell / self.cells[0] % self.cells[1], cell / self.cells[0] / self.cells[1]]
    }

    /// Returns true if the object occupies a cell; false outside the grid.
    pub(super) fn is_occupied(&self, [x, y, z]: [i64; 3]) -> bool {
        let inside = |n: i64, axis: usize| usize::try_from(n).ok().filter(|&n| n < self.cells[axis]);
        let (Some(x), Some(y), Some(z)) = (inside(x, 0), inside(y, 1), inside(z, 2)) else { return false };
        self.occupied[(z * self.cells[1] + y) * self.cells[0] + x]
    }

    /// Returns half the longest edge of a cell, in scene units.
    pub(super) fn half_edge(&self, scene: &SceneSpace) -> f64 {
        let edges = DVec3::AXES
            .into_iter()
            .zip(self.edge)
            .map(|(axis, edge)| scene.scene_from_index.transform_vector3(axis * edge as f64).length());
        edges.fold(0.0, f64::max) / 2.0
    }

    /// Returns true if no cell is occupied.
    pub(super) fn is_empty(&self) -> bool {
        !self.occupied.contains(&true)
    }

    /// Iterates over the occupied cells.
    pub(super) fn occupied_cells(&self) -> impl Iterator<Item = [usize; 3]> + '_ {
        (0..self.occupied.len()).filter(|&cell| self.occupied[cell]).map(|cell| self.coordinates(cell))
    }

    /// Returns the centre of a cell, in index space.
    pub(super) fn cell_centre(&self, cell: [usize; 3]) -> DVec3 {
        let along = |axis: usize| {
            let first = cell[axis] * self.edge[axis];
            let last = (first + self.edge[axis]).min(self.dims[axis]) - 1;
            (first + last) as f64 / 2.0
        };
        DVec3::new(along(0), along(1), along(2))
    }

    /// Finds connected components by flood fill with 26-connectivity.
    fn connected_components(&self) -> Vec<ObjectPart> {
        let mut is_left = self.occupied.clone();
        let mut parts = Vec::new();
        let mut waiting = Vec::new();
        for start in 0..is_left.len() {
            if !std::mem::take(&mut is_left[start]) {
                continue;
            }
            let mut part = ObjectPart { cells: Vec::new(), low: [usize::MAX; 3], high: [0; 3] };
            waiting.push(start);
            while let Some(cell) = waiting.pop() {
                let at = self.coordinates(cell);
                part.cells.push(cell);
                part.low = [0, 1, 2].map(|axis| part.low[axis].min(at[axis]));
                part.high = [0, 1, 2].map(|axis| part.high[axis].max(at[axis]));
                let near =
                    |axis: usize| at[axis].saturating_sub(1)..=(at[axis] + 1).min(self.cells[axis] - 1);
                for z in near(2) {
                    for y in near(1) {
                        for x in near(0) {
                            let next = (z * self.cells[1] + y) * self.cells[0] + x;
                            if std::mem::take(&mut is_left[next]) {
                                waiting.push(next);
                            }
                        }
                    }
                }
            }
            parts.push(part);
        }
        parts
    }

    /// Returns true if a part is thin, and covers a face of the volume.
    fn is_table(&self, part: &ObjectPart) -> bool {
        let share = |axis: usize| (part.high[axis] + 1 - part.low[axis]) as f64 / self.cells[axis] as f64;
        (0..3).any(|axis| {
            let others = [(axis + 1) % 3, (axis + 2) % 3];
            let is_at_face =
                others.iter().any(|&other| part.low[other] == 0 || part.high[other] + 1 == self.cells[other])
                    || part.low[axis] == 0
                    || part.high[axis] + 1 == self.cells[axis];
            share(axis) < TABLE_SHARES.1
                && others.iter().all(|&other| share(other) > TABLE_SHARES.0)
                && is_at_face
        })
    }

    fn without_specks_and_tables(mut self) -> Self {
        let parts = self.connected_components();
        let largest_of = |parts: &[&ObjectPart]| parts.iter().map(|part| part.cells.len()).max().unwrap_or(0);
        let no_tables: Vec<&ObjectPart> = parts.iter().filter(|part| !self.is_table(part)).collect();
        let all: Vec<&ObjectPart> = parts.iter().collect();
        // The rest beside a table must be more than specks on it.
        let is_object = largest_of(&no_tables) as f64 >= SPECK_SHARE * largest_of(&all) as f64;
        let kept = if is_object && !no_tables.is_empty() { no_tables } else { all };
        let least = SPECK_SHARE * largest_of(&kept) as f64;
        let (large, small): (Vec<&ObjectPart>, Vec<&ObjectPart>) =
            kept.into_iter().partition(|part| part.cells.len() as f64 >= least);
        let low = [0, 1, 2].map(|axis| large.iter().map(|part| part.low[axis]).min().unwrap_or(0));
        let high = [0, 1, 2].map(|axis| large.iter().map(|part| part.high[axis]).max().unwrap_or(0));
        let longest = (0..3).map(|axis| high[axis] + 1 - low[axis]).max().unwrap_or(1);
        let reach = (longest as f64 * SPECK_REACH) as usize;
        let is_close = |part: &&ObjectPart| {
            (0..3).all(|axis| part.low[axis] + reach >= low[axis] && part.high[axis] <= high[axis] + reach)
        };
        let mut is_there = vec![false; self.occupied.len()];
        for part in large.iter().copied().chain(small.into_iter().filter(is_close)) {
            part.cells.iter().for_each(|&cell| is_there[cell] = true);
        }
        self.occupied = is_there;
        self
    }

    /// Returns the share of cell faces that lie on the volume's box.
    pub(super) fn box_share(&self) -> f64 {
        let (mut faces, mut on_box) = (0usize, 0usize);
        for cell in self.occupied_cells() {
            for (axis, step) in (0..3).flat_map(|axis| [-1, 1].map(|step| (axis, step))) {
                let mut next = cell.map(|n| n as i64);
                next[axis] += step;
                faces += usize::from(!self.is_occupied(next));
                on_box += usize::from(next[axis] < 0 || next[axis] == self.cells[axis] as i64);
            }
        }
        on_box as f64 / faces.max(1) as f64
    }

    /// Returns the largest part alone.
    pub(super) fn largest_part(mut self) -> Self {
        let parts = self.connected_components();
        let largest = parts.iter().max_by_key(|part| part.cells.len());
        let mut occupied = vec![false; self.occupied.len()];
        largest.iter().flat_map(|part| &part.cells).for_each(|&cell| occupied[cell] = true);
        self.occupied = occupied;
        self
    }

    /// Returns the share of occupied cells that belong to the largest part.
    pub(super) fn largest_part_share(&self) -> f64 {
        let sizes: Vec<usize> = self.connected_components().iter().map(|part| part.cells.len()).collect();
        let all: usize = sizes.iter().sum();
        sizes.into_iter().max().unwrap_or(0) as f64 / all.max(1) as f64
    }

    /// Returns the compactness, by surface per volume: nearly 1 for large solid shapes, 0 for isolated cells.
    pub(super) fn compactness(&self) -> f64 {
        let (mut cells, mut faces) = (0usize, 0usize);
        for cell in self.occupied_cells() {
            cells += 1;
            for (axis, step) in (0..3).flat_map(|axis| [-1, 1].map(|step| (axis, step))) {
                let mut next = cell.map(|n| n as i64);
                next[axis] += step;
                faces += usize::from(!self.is_occupied(next));
            }
        }
        1.0 - faces as f64 / (6 * cells.max(1)) as f64
    }

    /// Returns the first and last voxels of the object in every row of cells, in index space.
    pub(super) fn outline(&self) -> Vec<DVec3> {
        let [nx, ny, nz] = self.cells;
        let mut ends = Vec::new();
        for (z, y) in (0..nz).flat_map(|z| (0..ny).map(move |y| (z, y))) {
            let row = &self.occupied[(z * ny + y) * nx..][..nx];
            let first = row.iter().position(|&is| is);
            let last = row.iter().rposition(|&is| is);
            if let (Some(first), Some(last)) = (first, last) {
                let middle = self.cell_centre([first, y, z]);
                let low = (first * self.edge[0]) as f64;
                let high = (((last + 1) * self.edge[0]).min(self.dims[0]) - 1) as f64;
                ends.extend([low, high].map(|x| DVec3::new(x, middle.y, middle.z)));
            }
        }
        ends
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::first_look::tests::threshold_settings;
    use chiaroscuro_volume::Samples;

    fn object(dims: [usize; 3], is_bright: impl Fn([usize; 3]) -> bool) -> VisibleObject {
        let value = |at: usize| {
            let place = [at % dims[0], at / dims[0] % dims[1], at / dims[0] / dims[1]];
            if is_bright(place) { 255 } else { 0 }
        };
        let voxels = (0..dims.iter().product()).map(value).collect();
        let volume = Volume::with_spacing("t", dims, DVec3::ONE, Samples::U8(voxels)).unwrap();
        VisibleObject::from_settings(&threshold_settings(), &volume)
    }

    /// Returns the corners of the framed object.
    fn corners(object: &VisibleObject) -> [DVec3; 2] {
        let outline = object.outline();
        let fold =
            |start: DVec3, with: fn(DVec3, DVec3) -> DVec3| outline.iter().fold(start, |a, b| with(a, *b));
        [fold(DVec3::INFINITY, DVec3::min), fold(DVec3::NEG_INFINITY, DVec3::max)]
    }

    fn is_in_block([x, y, z]: [usize; 3]) -> bool {
        (10..30).contains(&x) && (12..30).contains(&y) && (14..30).contains(&z)
    }

    const BLOCK: [DVec3; 2] = [DVec3::new(10.0, 12.0, 14.0), DVec3::new(29.0, 29.0, 29.0)];

    #[test]
    fn specks_do_not_count() {
        let specks = [[1, 1, 1], [38, 3, 38], [2, 38, 20]];
        let object = object([40; 3], |place| is_in_block(place) || specks.contains(&place));
        assert_eq!(corners(&object), BLOCK);
    }

    #[test]
    fn crumbs_beside_the_object_are_not_cut_off() {
        let object = object([40; 3], |place| is_in_block(place) || place == [20, 20, 12]);
        assert_eq!(corners(&object), [DVec3::new(10.0, 12.0, 12.0), BLOCK[1]]);
    }

    #[test]
    fn two_objects_are_two_objects() {
        let object =
            object([40; 3], |place| is_in_block(place) || place.iter().all(|&n| (2..8).contains(&n)));
        assert_eq!(corners(&object)[0], DVec3::splat(2.0));
    }

    #[test]
    fn tables_do_not_count_unless_there_is_nothing_else() {
        let is_on_table = |[x, _, z]: [usize; 3]| z < 2 && (4..36).contains(&x);
        assert_eq!(corners(&object([40; 3], |place| is_in_block(place) || is_on_table(place))), BLOCK);
        let alone = corners(&object([40; 3], is_on_table));
        assert_eq!(alone, [DVec3::new(4.0, 0.0, 0.0), DVec3::new(35.0, 39.0, 1.0)]);
    }

    #[test]
    fn large_volumes_have_cells_of_several_voxels() {
        let object = object([300, 20, 20], |[x, y, z]| (60..240).contains(&x) && y == 10 && z == 11);
        assert_eq!(object.cells, [100, 20, 20]);
        assert_eq!(corners(&object), [DVec3::new(60.0, 10.0, 11.0), DVec3::new(239.0, 10.0, 11.0)]);
    }

    #[test]
    fn blocks_end_where_the_data_do() {
        assert_eq!(object([16; 3], |_| true).box_share(), 1.0);
        assert_eq!(object([40; 3], is_in_block).box_share(), 0.0);
        // Half of the volume, with a surface of four square faces' area: all but the inner one lie on the box.
        let half = object([16; 3], |[x, _, _]| x < 8);
        assert!((half.box_share() - 3.0 / 4.0).abs() < 1e-12);
    }

    #[test]
    fn nothing_has_no_outline() {
        assert!(object([16; 3], |_| false).outline().is_empty());
    }
}
