//! Places along a line at which pictures lie, some of them at the same place.

use crate::data::load::formats::dicom::header::taken::Taken;

/// Positions that differ by less are the same in any case, millimetres: files have six digits.
const SAME_PLACE_MM: f64 = 1e-6;

/// Pictures of one place lie nearer to each other than this share of the distance to the next place.
const NARROW: f64 = 0.1;

/// A picture: where it lies along the line across it, and how it was taken.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pose {
    /// Millimetres.
    pub(crate) place_mm: f64,
    pub(crate) taken: Taken,
}

/// Pictures by their places, each with at least one.
#[derive(Debug)]
pub(crate) struct Places(pub(crate) Vec<Vec<usize>>);

impl Places {
    /// Gathers pictures, which are in the order of their places: those that are nearer to the one before them than a
    /// tolerance lie where that does.
    pub(crate) fn new(poses: &[Pose], pictures: &[usize], tolerance_mm: f64) -> Self {
        let mut places: Vec<Vec<usize>> = Vec::new();
        let mut last = f64::NEG_INFINITY;
        for &picture in pictures {
            let place = poses[picture].place_mm;
            let is_near = place - last <= tolerance_mm;
            if !is_near {
                places.push(Vec::new());
            }
            last = place;
            if let Some(place) = places.last_mut() {
                place.push(picture);
            }
        }
        Self(places)
    }

    /// How many places there are.
    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    /// Most pictures of one place.
    pub(crate) fn most_at_one(&self) -> usize {
        self.0.iter().map(Vec::len).max().unwrap_or(0)
    }

    /// The first picture of each place.
    pub(crate) fn firsts(&self) -> Vec<usize> {
        self.0.iter().filter_map(|place| place.first().copied()).collect()
    }

    /// How near pictures lie that lie at one place, millimetres: below the distance at which the distances between
    /// neighbours fall into small ones and others that are ten times as long at least.
    pub(crate) fn tolerance_mm(poses: &[Pose], order: &[usize]) -> f64 {
        let place = |picture: &usize| poses[*picture].place_mm;
        let distances: Vec<f64> = order.windows(2).map(|two| place(&two[1]) - place(&two[0])).collect();
        let mut sorted = distances.clone();
        sorted.sort_by(f64::total_cmp);
        // From long ones to short ones: the first that leaves narrow places.
        for (at, two) in sorted.windows(2).enumerate().rev() {
            let longer = sorted.len() - 1 - at;
            let is_jump = two[0] < NARROW * two[1];
            // One long distance alone is a gap.
            if !is_jump || longer < 2 && two[0] > SAME_PLACE_MM {
                continue;
            }
            let widest = distances.iter().fold([0.0f64; 2], |[widest, width], &distance| {
                let width = if distance <= two[0] { width + distance } else { 0.0 };
                [widest.max(width), width]
            });
            if widest[0] <= NARROW * two[1] {
                return two[0].max(SAME_PLACE_MM);
            }
        }
        // All at one place, or none at that of another.
        SAME_PLACE_MM
    }
}

/// How many neighbours are nearer to each other than a distance, among pictures in the order of their places.
pub(crate) fn collisions(pictures: &[usize], poses: &[Pose], near_mm: f64) -> usize {
    let distance = |two: &[usize]| poses[two[1]].place_mm - poses[two[0]].place_mm;
    pictures.windows(2).filter(|two| distance(two) < near_mm).count()
}

/// The median distance between the places of pictures within parts, each in the order of their places; `None` where no
/// part has two places.
pub(crate) fn usual_distance<'a>(
    parts: impl Iterator<Item = &'a Vec<usize>>,
    poses: &[Pose],
    tolerance_mm: f64,
) -> Option<f64> {
    let distances =
        parts.flat_map(|part| part.windows(2).map(|two| poses[two[1]].place_mm - poses[two[0]].place_mm));
    let mut distances: Vec<f64> = distances.filter(|&distance| distance > tolerance_mm).collect();
    distances.sort_by(f64::total_cmp);
    distances.get(distances.len().checked_sub(1)? / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(places_mm: &[f64]) -> Vec<usize> {
        let pose = |&place_mm: &f64| Pose { place_mm, taken: Taken::default() };
        let poses: Vec<Pose> = places_mm.iter().map(pose).collect();
        let order: Vec<usize> = (0..poses.len()).collect();
        let tolerance_mm = Places::tolerance_mm(&poses, &order);
        Places::new(&poses, &order, tolerance_mm).0.iter().map(Vec::len).collect()
    }

    #[test]
    fn the_usual_distance_says_what_lies_at_one_place() {
        assert_eq!(places(&[0.0, 2.0, 4.0, 6.0]), [1; 4]);
        assert_eq!(places(&[0.0, 0.0, 2.0, 2.0, 4.0]), [2, 2, 1]);
        // Positions of a hundred phases tremble.
        let many: Vec<f64> = (0..400).map(|n| f64::from(n / 100) * 2.0 + f64::from(n % 100) * 1e-3).collect();
        assert_eq!(places(&many), [100; 4]);
        // Thin slices, thick ones, and a gap.
        assert_eq!(places(&[0.0, 0.6, 1.2, 1.8, 6.8, 11.8, 111.8]), [1; 7]);
        assert_eq!(places(&[5.0; 4]), [4]);
        assert_eq!(places(&[0.0, 1.0, 100.0]), [1; 3]);
        assert_eq!(places(&[0.0, 1e300]), [1, 1]);
        assert_eq!(places(&[-1e308, 1e308, 1e308]), [1, 2]);
    }
}
