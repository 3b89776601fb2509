//! Steep edges for voxels that are classified before they are spread.

use super::{BakedTransfer, LUT_SIZE};

/// Index of the table's last entry.
const LAST_ENTRY: f32 = (LUT_SIZE - 1) as f32;

/// Number of equal neighbouring entries from which on an extinction counts as held: a class of labels has four at
/// least, a curve between two points none.
const MIN_HELD_ENTRIES: usize = 3;

/// Number of entries between two held extinctions up to which extinction changes linearly between them: steps of the
/// table would be as wide as the edge.
const MAX_LINEAR_ENTRIES: f32 = 8.0;

/// Range of coverage in which an edge rises from one held extinction to the next.
///
/// It ends above a half, where the edges of voxels are, and begins so low that thin structures stay: at its middle a
/// plate of one voxel covers 0.83 of the narrow blur, a rod 0.69 and a single voxel 0.58; half a voxel aside it is
/// 0.46 of a plate. Edges lie a third of a voxel farther out.
const EDGE_COVERAGE: [f32; 2] = [0.1, 0.6];

impl BakedTransfer {
    /// Creates a white table over relative extinction, as [`Self::linear_ramp`] does, in which extinction changes
    /// steeply between those that this function holds over a range of densities, and not at all near them: blurred
    /// labels then have narrow edges, and translucent ones keep their opacity.
    pub fn crisp_ramp(&self) -> Self {
        let largest = self.max_extinction();
        let held = self.held_entries();
        let steep = |entry: f32| {
            let above = held.partition_point(|&level| level < entry).clamp(1, held.len() - 1);
            let (low, high) = (held[above - 1], held[above]);
            if high - low <= MAX_LINEAR_ENTRIES {
                return entry;
            }
            let [first, last] = EDGE_COVERAGE;
            let coverage = (entry - low) / (high - low);
            low + (high - low) * ((coverage - first) / (last - first)).clamp(0.0, 1.0)
        };
        let unit = largest / LAST_ENTRY;
        Self::new((0..LUT_SIZE).map(|entry| [1.0, 1.0, 1.0, unit * steep(entry as f32)]).collect())
    }

    /// Returns the places in a table over relative extinction of those that are held over a range of densities, of none
    /// and of the largest, ascending; among the first entries whole ones, so that interpolation keeps even faint ones.
    fn held_entries(&self) -> Vec<f32> {
        let unit = self.max_extinction().max(f32::MIN_POSITIVE) / LAST_ENTRY;
        let runs = self.entries.chunk_by(|a, b| a[3] == b[3]).filter(|run| run.len() >= MIN_HELD_ENTRIES);
        let place = |run: &[[f32; 4]]| {
            let place = (run[0][3] / unit).min(LAST_ENTRY);
            if place <= MAX_LINEAR_ENTRIES { place.ceil() } else { place }
        };
        let mut places: Vec<f32> = runs.map(place).chain([0.0, LAST_ENTRY]).collect();
        places.sort_unstable_by(f32::total_cmp);
        places.dedup();
        places
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table_of(levels: &[f32]) -> BakedTransfer {
        let each = LUT_SIZE / levels.len();
        let level = |entry: usize| levels[(entry / each).min(levels.len() - 1)];
        BakedTransfer::new((0..LUT_SIZE).map(|entry| [0.5, 0.5, 0.5, level(entry)]).collect())
    }

    fn extinction_at(table: &BakedTransfer, share: f64) -> f64 {
        table.sample(share)[3]
    }

    #[test]
    fn held_extinctions_stay_and_edges_between_them_are_steep() {
        let crisp = table_of(&[0.0, 0.003, 8.0, 2.0]).crisp_ramp();
        for held in [0.0, 0.003, 2.0, 8.0] {
            let stays = extinction_at(&crisp, held / 8.0);
            assert!((stays - held).abs() < 1e-3 * held.max(0.1), "{held}: {stays}");
        }
        // From a quarter of the largest extinction to all of it.
        let coverage = |share: f64| 0.25 + 0.75 * share;
        assert!((extinction_at(&crisp, coverage(0.08)) - 2.0).abs() < 1e-3);
        assert!((extinction_at(&crisp, coverage(0.35)) - 5.0).abs() < 0.05);
        assert!((extinction_at(&crisp, coverage(0.62)) - 8.0).abs() < 1e-3);
    }

    #[test]
    fn extinction_never_falls_as_coverage_rises() {
        for levels in [&[1.0][..], &[0.0, 1.0], &[0.0], &[0.3, 0.301, 0.302, 5.0], &[0.1, 0.2, 0.4, 0.8, 1.0]]
        {
            let crisp = table_of(levels).crisp_ramp();
            assert!(crisp.entries.windows(2).all(|pair| pair[0][3] <= pair[1][3]), "{levels:?}");
            let largest = levels.iter().copied().fold(0.0, f32::max);
            assert!(
                (crisp.max_extinction() - largest).abs() < 1e-6 && crisp.entries[0][3] == 0.0,
                "{levels:?}"
            );
        }
    }
}
