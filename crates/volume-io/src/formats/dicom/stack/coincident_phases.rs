//! Phases of coincident images that no single attribute separates: by rank at each position, or by order of
//! acquisition.

use std::cmp::Ordering;

use super::positions::{ImagePose, PositionGroups};
use crate::formats::dicom::header::acquisition_attributes::{AcquisitionAttribute, AcquisitionAttributes};

/// Compares two coincident images: the first attribute in which they differ decides.
pub(crate) fn compare_acquisition(a: &AcquisitionAttributes, b: &AcquisitionAttributes) -> Ordering {
    let compared = AcquisitionAttribute::ALL.into_iter().map(|attribute| {
        let [a, b] = [a, b].map(|taken| taken.get(attribute).unwrap_or(0.0));
        a.total_cmp(&b)
    });
    compared.into_iter().find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
}

/// Assigns images to phases by rank: the first of each position, the second, and so on. Positions with fewer images
/// assign theirs to the phases of the nearest times; `None` if there are no suitable times.
pub(crate) fn phases_by_rank(places: &PositionGroups, poses: &[ImagePose]) -> Option<Vec<Vec<usize>>> {
    let mut sorted = places.0.clone();
    for place in &mut sorted {
        place.sort_by(|&a, &b| compare_acquisition(&poses[a].attributes, &poses[b].attributes));
    }
    let count = places.max_coincident();
    if sorted.iter().all(|place| place.len() == count) {
        return Some((0..count).map(|rank| sorted.iter().map(|place| place[rank]).collect()).collect());
    }
    [AcquisitionAttribute::TriggerTime, AcquisitionAttribute::ReferenceTime]
        .into_iter()
        .find_map(|attribute| phases_by_nearest_time(&sorted, count, poses, attribute))
}

/// Assigns images to phases by a time that restarts at each position, where positions may lack images.
fn phases_by_nearest_time(
    places: &[Vec<usize>],
    count: usize,
    poses: &[ImagePose],
    attribute: AcquisitionAttribute,
) -> Option<Vec<Vec<usize>>> {
    let time = |picture: usize| poses[picture].attributes.get(attribute);
    let mut places: Vec<Vec<(f64, usize)>> = places
        .iter()
        .map(|place| {
            let timed = place.iter().map(|&picture| Some((time(picture)?, picture)));
            timed.collect::<Option<Vec<(f64, usize)>>>()
        })
        .collect::<Option<_>>()?;
    for place in &mut places {
        place.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
    let usual = |rank: usize| {
        let whole = places.iter().filter(|place| place.len() == count);
        let mut times: Vec<f64> = whole.map(|place| place[rank].0).collect();
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    };
    let usual: Vec<f64> = (0..count).map(usual).collect();
    let is_rising = usual.windows(2).all(|two| two[0] < two[1]);
    let mut ranks = vec![Vec::new(); count];
    for place in &places {
        let mut least = 0;
        for (at, &(time, picture)) in place.iter().enumerate() {
            // Leaves enough ranks for the remaining images.
            let most = count - (place.len() - at);
            let distance = |rank: &usize| (usual[*rank] - time).abs();
            let rank = (least..=most).min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
            ranks[rank].push(picture);
            least = rank + 1;
        }
    }
    is_rising.then_some(ranks)
}

/// Assigns images to phases in order of their instance numbers, with a new phase whenever a position recurs; `None`
/// if that makes more phases than the maximum number of coincident images, or fragments of phases.
pub(crate) fn phases_by_instance_number(
    places: &PositionGroups,
    poses: &[ImagePose],
) -> Option<Vec<Vec<usize>>> {
    let mut pictures = Vec::new();
    for (place, at_place) in places.0.iter().enumerate() {
        for &picture in at_place {
            pictures.push((poses[picture].attributes.get(AcquisitionAttribute::Instance)?, place, picture));
        }
    }
    pictures.sort_by(|a, b| a.0.total_cmp(&b.0));
    let count = places.max_coincident();
    let mut turns: Vec<Vec<(usize, usize)>> = vec![Vec::new()];
    let mut last_turn = vec![0; places.len()];
    for (_, place, picture) in pictures {
        if last_turn[place] == turns.len() {
            if turns.len() == count {
                return None;
            }
            turns.push(Vec::new());
        }
        last_turn[place] = turns.len();
        if let Some(turn) = turns.last_mut() {
            turn.push((place, picture));
        }
    }
    if turns.iter().any(|turn| 2 * turn.len() <= places.len()) {
        return None;
    }
    for turn in &mut turns {
        turn.sort_unstable();
    }
    Some(turns.into_iter().map(|turn| turn.into_iter().map(|(_, picture)| picture).collect()).collect())
}
