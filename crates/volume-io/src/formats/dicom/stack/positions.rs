//! Positions of images along a line, several of which may coincide.

use crate::formats::dicom::header::acquisition_attributes::AcquisitionAttributes;

/// Distance in millimetres below which positions always coincide: files store six digits.
const COINCIDENCE_MM: f64 = 1e-6;

/// Maximum extent of coincident images, as a share of the distance to the next position.
const MAX_GROUP_EXTENT: f64 = 0.1;

/// Position of an image along the line across it, and its acquisition attributes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ImagePose {
    /// Position along the line, in millimetres.
    pub(crate) position_mm: f64,
    pub(crate) attributes: AcquisitionAttributes,
}

/// Indices of images grouped by position; no group is empty.
#[derive(Debug)]
pub(crate) struct PositionGroups(pub(crate) Vec<Vec<usize>>);

impl PositionGroups {
    /// Groups images, given in order of position: each that is nearer to its predecessor than the tolerance joins its
    /// group.
    pub(crate) fn new(poses: &[ImagePose], pictures: &[usize], tolerance_mm: f64) -> Self {
        let mut places: Vec<Vec<usize>> = Vec::new();
        let mut last = f64::NEG_INFINITY;
        for &picture in pictures {
            let place = poses[picture].position_mm;
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

    /// Returns the number of distinct positions.
    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    /// Returns the maximum number of images at one position.
    pub(crate) fn max_coincident(&self) -> usize {
        self.0.iter().map(Vec::len).max().unwrap_or(0)
    }

    /// Returns the first image of each position.
    pub(crate) fn first_of_each(&self) -> Vec<usize> {
        self.0.iter().filter_map(|place| place.first().copied()).collect()
    }

    /// Returns the tolerance within which positions coincide, in millimetres: the distances between neighbours above
    /// it are at least ten times those below.
    pub(crate) fn tolerance_mm(poses: &[ImagePose], order: &[usize]) -> f64 {
        let place = |picture: &usize| poses[*picture].position_mm;
        let distances: Vec<f64> = order.windows(2).map(|two| place(&two[1]) - place(&two[0])).collect();
        let mut sorted = distances.clone();
        sorted.sort_by(f64::total_cmp);
        // From long to short distances: the first split that leaves narrow groups.
        for (at, two) in sorted.windows(2).enumerate().rev() {
            let longer = sorted.len() - 1 - at;
            let is_jump = two[0] < MAX_GROUP_EXTENT * two[1];
            // A single long distance is a gap.
            if !is_jump || longer < 2 && two[0] > COINCIDENCE_MM {
                continue;
            }
            let widest = distances.iter().fold([0.0f64; 2], |[widest, width], &distance| {
                let width = if distance <= two[0] { width + distance } else { 0.0 };
                [widest.max(width), width]
            });
            if widest[0] <= MAX_GROUP_EXTENT * two[1] {
                return two[0].max(COINCIDENCE_MM);
            }
        }
        // All images coincide, or no two of them do.
        COINCIDENCE_MM
    }
}

/// Counts neighbouring images that are nearer to each other than `near_mm`, in order of position.
pub(crate) fn count_coincident(pictures: &[usize], poses: &[ImagePose], near_mm: f64) -> usize {
    let distance = |two: &[usize]| poses[two[1]].position_mm - poses[two[0]].position_mm;
    pictures.windows(2).filter(|two| distance(two) < near_mm).count()
}

/// Returns the median distance between positions within the parts, each in order of position; `None` if no part has
/// two positions.
pub(crate) fn median_spacing<'a>(
    parts: impl Iterator<Item = &'a Vec<usize>>,
    poses: &[ImagePose],
    tolerance_mm: f64,
) -> Option<f64> {
    let distances = parts
        .flat_map(|part| part.windows(2).map(|two| poses[two[1]].position_mm - poses[two[0]].position_mm));
    let mut distances: Vec<f64> = distances.filter(|&distance| distance > tolerance_mm).collect();
    distances.sort_by(f64::total_cmp);
    distances.get(distances.len().checked_sub(1)? / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(places_mm: &[f64]) -> Vec<usize> {
        let pose = |&place_mm: &f64| ImagePose {
            position_mm: place_mm,
            attributes: AcquisitionAttributes::default(),
        };
        let poses: Vec<ImagePose> = places_mm.iter().map(pose).collect();
        let order: Vec<usize> = (0..poses.len()).collect();
        let tolerance_mm = PositionGroups::tolerance_mm(&poses, &order);
        PositionGroups::new(&poses, &order, tolerance_mm).0.iter().map(Vec::len).collect()
    }

    #[test]
    fn the_usual_distance_says_what_lies_at_one_place() {
        assert_eq!(places(&[0.0, 2.0, 4.0, 6.0]), [1; 4]);
        assert_eq!(places(&[0.0, 0.0, 2.0, 2.0, 4.0]), [2, 2, 1]);
        // Positions of a hundred phases, with jitter.
        let many: Vec<f64> = (0..400).map(|n| f64::from(n / 100) * 2.0 + f64::from(n % 100) * 1e-3).collect();
        assert_eq!(places(&many), [100; 4]);
        // Thin slices, thick slices, and a gap.
        assert_eq!(places(&[0.0, 0.6, 1.2, 1.8, 6.8, 11.8, 111.8]), [1; 7]);
        assert_eq!(places(&[5.0; 4]), [4]);
        assert_eq!(places(&[0.0, 1.0, 100.0]), [1; 3]);
        assert_eq!(places(&[0.0, 1e300]), [1, 1]);
        assert_eq!(places(&[-1e308, 1e308, 1e308]), [1, 2]);
    }
}
