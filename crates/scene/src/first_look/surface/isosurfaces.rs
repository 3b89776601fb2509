//! Isosurface statistics of a volume, for all isovalues in one pass: area, contrast, and the share of the surface on
//! the volume's box.
//!
//! The number of neighbour pairs on either side of a value is the area of its isosurface, and their differences are
//! the gradient there (Pekar, Wiemker & Hempel 2001).

use rayon::prelude::*;

use chiaroscuro_volume::{HISTOGRAM_BINS, Volume};

/// Number of voxels to sample: larger volumes are subsampled along each axis.
const SAMPLED_VOXELS: f64 = (1u64 << 21) as f64;

/// Largest share of an object's surface that may lie on the volume's box. Of 47 volumes of thirteen domains, those
/// that were shown as boxes had 0.40 and more, all others at most 0.24.
const MAX_BOX_SHARE: f64 = 0.25;

/// Stricter upper limit of a replacement's share on the box, well below [`MAX_BOX_SHARE`], and the factor of merit by
/// which a replacement between the two limits must exceed the best one below it. Of ten volumes whose best
/// replacement exceeds the stricter limit, those that lose nothing by it have factors of 1.0 to 1.5; those of which
/// only crumbs would be left, 5 and 7.
const STRICT_BOX_SHARE: f64 = 0.1;
const MERIT_FACTOR: f64 = 3.0;

/// Usual share of the volume that an object occupies, and its standard deviation in powers of ten.
const USUAL_VOLUME_SHARE: (f64, f64) = (0.08, 0.9);

/// Statistics of the isosurfaces at densities 0, 1/n, 2/n, …
pub(crate) struct IsosurfaceStatistics {
    /// Number of neighbour pairs across the isovalue.
    area: Vec<f64>,
    /// Sum of the density differences of these pairs.
    contrast: Vec<f64>,
    /// Number of voxels on the volume's faces above the isovalue.
    on_faces: Vec<f64>,
    /// Number of voxels above the isovalue.
    inside: Vec<f64>,
    voxels: f64,
}

/// Difference arrays of area and contrast over density bins, and the histogram of voxels.
#[derive(Clone)]
struct IsosurfaceAccumulator {
    area: Vec<f64>,
    contrast: Vec<f64>,
    inside: Vec<f64>,
}

impl IsosurfaceAccumulator {
    fn new() -> Self {
        let none = vec![0.0; HISTOGRAM_BINS + 2];
        Self { area: none.clone(), contrast: none.clone(), inside: none }
    }

    fn merge(mut self, other: &Self) -> Self {
        let sum = |into: &mut Vec<f64>, from: &[f64]| into.iter_mut().zip(from).for_each(|(a, b)| *a += b);
        sum(&mut self.area, &other.area);
        sum(&mut self.contrast, &other.contrast);
        sum(&mut self.inside, &other.inside);
        self
    }

    /// Adds a pair of neighbours with a weight.
    fn add_pair(&mut self, one: f32, other: f32, weight: f64) {
        let (low, high) = (density_bin(one.min(other)) + 1, density_bin(one.max(other)) + 1);
        let difference = f64::from((one - other).abs()) * weight;
        self.area[low] += weight;
        self.area[high] -= weight;
        self.contrast[low] += difference;
        self.contrast[high] -= difference;
    }
}

fn density_bin(density: f32) -> usize {
    ((density * HISTOGRAM_BINS as f32) as usize).min(HISTOGRAM_BINS - 1)
}

/// Returns cumulative sums from the first element.
fn cumulative_sums(changes: &[f64]) -> Vec<f64> {
    changes
        .iter()
        .scan(0.0, |sum, change| {
            *sum += change;
            Some(*sum)
        })
        .collect()
}

/// Returns cumulative sums from the last element.
fn reverse_cumulative_sums(counts: &[f64]) -> Vec<f64> {
    let mut sums: Vec<f64> = cumulative_sums(&counts.iter().rev().copied().collect::<Vec<_>>());
    sums.reverse();
    sums
}

impl IsosurfaceStatistics {
    /// Computes the statistics of a volume. Missing voxels are on neither side.
    pub(crate) fn measure(volume: &Volume) -> Self {
        let [nx, ny, nz] = volume.dims();
        let voxels = volume.voxel_count() as f64;
        let missing = volume.missing();
        let step = (voxels / SAMPLED_VOXELS).cbrt().ceil().max(1.0) as usize;
        // Each sampled voxel stands for a block; on a face, for a square.
        let (block, square) = ((step * step * step) as f64, (step * step) as f64);
        let changes = (0..nz)
            .step_by(step)
            .collect::<Vec<_>>()
            .into_par_iter()
            .fold(IsosurfaceAccumulator::new, |mut changes, z| {
                let slice = volume.slice_densities(z);
                let next = (z + 1 < nz).then(|| volume.slice_densities(z + 1));
                let is_there =
                    |z: usize, at: usize| missing.is_none_or(|missing| !missing.contains(z * nx * ny + at));
                for y in (0..ny).step_by(step) {
                    for x in (0..nx).step_by(step) {
                        let at = y * nx + x;
                        if !is_there(z, at) {
                            continue;
                        }
                        let here = slice[at];
                        changes.inside[density_bin(here)] += block;
                        if x + 1 < nx && is_there(z, at + 1) {
                            changes.add_pair(here, slice[at + 1], block);
                        }
                        if y + 1 < ny && is_there(z, at + nx) {
                            changes.add_pair(here, slice[at + nx], block);
                        }
                        if let Some(next) = next.as_ref().filter(|_| is_there(z + 1, at)) {
                            changes.add_pair(here, next[at], block);
                        }
                    }
                }
                changes
            })
            .reduce(IsosurfaceAccumulator::new, |a, b| a.merge(&b));
        let mut on_faces = vec![0.0; HISTOGRAM_BINS];
        let mut face = |place: [usize; 3]| {
            if let Some(density) = volume.density_at(place) {
                on_faces[density_bin(density as f32)] += square;
            }
        };
        let at = |n: usize| (0..n).step_by(step);
        // A volume that is one voxel thick has two faces along that axis, too.
        for (x, y) in at(nx).flat_map(|x| at(ny).map(move |y| (x, y))) {
            face([x, y, 0]);
            face([x, y, nz - 1]);
        }
        for (x, z) in at(nx).flat_map(|x| at(nz).map(move |z| (x, z))) {
            face([x, 0, z]);
            face([x, ny - 1, z]);
        }
        for (y, z) in at(ny).flat_map(|y| at(nz).map(move |z| (y, z))) {
            face([0, y, z]);
            face([nx - 1, y, z]);
        }
        Self {
            area: cumulative_sums(&changes.area),
            contrast: cumulative_sums(&changes.contrast),
            on_faces: reverse_cumulative_sums(&on_faces),
            inside: reverse_cumulative_sums(&changes.inside),
            voxels,
        }
    }

    /// Returns the share of an object's surface that lies on the volume's box.
    fn box_share(&self, bin: usize) -> f64 {
        let surface = self.area[bin] + self.on_faces[bin];
        if surface == 0.0 { 0.0 } else { self.on_faces[bin] / surface }
    }

    /// Returns the merit of an isosurface as the surface of an object: distinct, large, compact, of a usual size, and
    /// not the box.
    fn merit(&self, bin: usize, largest_area: f64) -> f64 {
        if self.area[bin] == 0.0 || self.inside[bin] == 0.0 {
            return 0.0;
        }
        let gradient = self.contrast[bin] / self.area[bin];
        let (usual, spread) = USUAL_VOLUME_SHARE;
        let unusual = (self.inside[bin] / self.voxels / usual).log10() / spread;
        gradient
            * (self.area[bin] / largest_area).sqrt()
            * (1.0 - self.box_share(bin)).powi(2)
            * self.compactness_of_bin(bin)
            * (-0.5 * unusual * unusual).exp()
    }

    /// Returns `start`, the density at which the object begins, unless mainly the volume's box would be shown: then
    /// that of the best isosurface that is not.
    pub(crate) fn threshold_avoiding_box(&self, start: f64) -> f64 {
        let bins = HISTOGRAM_BINS;
        let first = ((start * bins as f64) as usize).min(bins - 1);
        if self.box_share(first) <= MAX_BOX_SHARE {
            return start;
        }
        self.best_threshold().unwrap_or(start)
    }

    /// Returns the mean change of density from voxel to voxel across an isosurface; `None` if it is empty.
    pub(crate) fn slope(&self, density: f64) -> Option<f64> {
        let bin = density_bin(density as f32);
        (self.area[bin] > 0.0).then(|| self.contrast[bin] / self.area[bin])
    }

    /// Returns the compactness of the region above a density: 0 for single voxels, nearly 1 for large pieces.
    pub(crate) fn compactness(&self, density: f64) -> f64 {
        self.compactness_of_bin(density_bin(density as f32))
    }

    /// Returns the number of voxels above a density.
    pub(crate) fn inside(&self, density: f64) -> f64 {
        self.inside[density_bin(density as f32)]
    }

    fn compactness_of_bin(&self, bin: usize) -> f64 {
        // A single voxel has six faces.
        let surface = self.area[bin] + self.on_faces[bin];
        if self.inside[bin] == 0.0 { 0.0 } else { 1.0 - (surface / (6.0 * self.inside[bin])).min(1.0) }
    }

    /// Returns the density of the best isosurface that is not mainly the volume's box.
    pub(crate) fn best_threshold(&self) -> Option<f64> {
        let bins = HISTOGRAM_BINS;
        let largest = self.area.iter().copied().fold(0.0, f64::max);
        let best_below = |most: f64| {
            let allowed = (1..bins).filter(|&bin| self.box_share(bin) <= most);
            allowed
                .map(|bin| (self.merit(bin, largest), bin))
                .filter(|(merit, _)| *merit > 0.0)
                .max_by(|(a, _), (b, _)| a.total_cmp(b))
        };
        let hardly_blocky = best_below(STRICT_BOX_SHARE);
        let (most, bin) = best_below(MAX_BOX_SHARE)?;
        let bin = hardly_blocky.filter(|(merit, _)| MERIT_FACTOR * merit >= most).map_or(bin, |(_, bin)| bin);
        Some(bin as f64 / bins as f64)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use chiaroscuro_volume::Samples;

    /// Returns a ball of 200 in a haze that reaches the faces.
    fn ball_in_haze(haze: u8) -> Volume {
        let n = 40;
        let value = |at: usize| {
            let p = [at % n, at / n % n, at / n / n].map(|c| c as f64 - 19.5);
            if p.iter().map(|c| c * c).sum::<f64>() < 100.0 { 200 } else { haze + (at % n / 8) as u8 }
        };
        let voxels = (0..n * n * n).map(value).collect();
        Volume::with_spacing("ball", [n; 3], DVec3::ONE, Samples::U8(voxels)).unwrap()
    }

    #[test]
    fn areas_and_shares_are_those_of_a_ball() {
        let volume = ball_in_haze(0);
        let surfaces = IsosurfaceStatistics::measure(&volume);
        let bin = density_bin(volume.density_of(100.0) as f32);
        // Neighbour pairs across a sphere: the projections along 6 directions, 6 · π r².
        let expected = 6.0 * std::f64::consts::PI * 100.0;
        assert!((surfaces.area[bin] / expected - 1.0).abs() < 0.05, "{}", surfaces.area[bin]);
        let inside = 4.0 / 3.0 * std::f64::consts::PI * 1000.0;
        assert!((surfaces.inside[bin] / inside - 1.0).abs() < 0.05, "{}", surfaces.inside[bin]);
        assert_eq!(surfaces.box_share(bin), 0.0);
        assert_eq!(surfaces.on_faces[0], 6.0 * 1600.0);
    }

    #[test]
    fn the_box_is_not_the_object() {
        let volume = ball_in_haze(60);
        let surfaces = IsosurfaceStatistics::measure(&volume);
        let (low, high) = (volume.density_of(61.0), volume.density_of(150.0));
        assert_eq!(surfaces.threshold_avoiding_box(high), high, "what is no box stays");
        let start = surfaces.threshold_avoiding_box(low);
        assert!(start > volume.density_of(64.0) && start < volume.density_of(200.0), "{start}");
    }

    #[test]
    fn crumbs_do_not_stand_for_what_ends_a_little_at_the_box() {
        // A ball of which a face cuts off a slice, in a haze that reaches all faces; and crumbs of 2 × 2 × 2 in its
        // centre.
        let n = 40;
        let value = |at: usize| {
            let place = [at % n, at / n % n, at / n / n];
            let p = DVec3::from(place.map(|c| c as f64)) - DVec3::new(4.0, 20.0, 20.0);
            let is_crumb = p.length() < 6.0 && place.iter().all(|c| c / 2 % 2 == 0);
            if is_crumb {
                250
            } else if p.length() < 10.0 {
                200
            } else {
                60 + (at % n / 8) as u8
            }
        };
        let voxels = (0..n * n * n).map(value).collect();
        let volume = Volume::with_spacing("cut", [n; 3], DVec3::ONE, Samples::U8(voxels)).unwrap();
        let surfaces = IsosurfaceStatistics::measure(&volume);
        let [ball, crumbs] =
            [150.0, 225.0].map(|value| surfaces.box_share(density_bin(volume.density_of(value) as f32)));
        assert!(
            ball > STRICT_BOX_SHARE && ball < MAX_BOX_SHARE && crumbs < STRICT_BOX_SHARE,
            "{ball} {crumbs}"
        );
        let start = surfaces.threshold_avoiding_box(volume.density_of(61.0));
        assert!(start < volume.density_of(200.0), "{start}");
    }

    #[test]
    fn what_is_everywhere_the_same_has_no_surface() {
        let flat = Volume::with_spacing("flat", [8; 3], DVec3::ONE, Samples::U8(vec![3; 512])).unwrap();
        assert!(IsosurfaceStatistics::measure(&flat).threshold_avoiding_box(0.4).is_finite());
    }
}
