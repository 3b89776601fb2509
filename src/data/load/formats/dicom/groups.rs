//! Which pictures belong together: those of one series that are of one size and lie in parallel.

use std::collections::BTreeMap;

use glam::DVec3;

use super::super::LoadError;
use super::header::Header;
use super::header::plane::Plane;
use super::pixels::shape::Shape;
use super::pixels::store::check_room;
use crate::data::attempt::{Attempt, Offer};
use crate::data::plain;

/// Pictures whose places differ by less in every cosine lie in parallel.
const PARALLEL: f64 = 1e-3;

/// Distances between pixels that differ by less, as a share, are the same.
const SAME_SPACING: f64 = 1e-3;

/// Groups of a series that a picture is compared with: a scan has three directions, a look around a joint has dozens.
const MOST_COMPARED: usize = 64;

/// A picture.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slice {
    /// Its file, by its number among the headers.
    pub(super) file: usize,
    /// From 0.
    pub(super) frame: usize,
    pub(super) plane: Plane,
}

/// Pictures that make a volume, or one for each time step.
#[derive(Debug)]
pub(super) struct Group {
    pub(super) shape: Shape,
    pub(super) slices: Vec<Slice>,
}

/// Puts the pictures of all files together, the series by their numbers; and says what was left out.
///
/// # Errors
/// What is wrong with the pixels of the first file, if there is something wrong with those of all.
pub(super) fn groups(headers: &[Header]) -> Result<(Vec<Group>, Option<String>), LoadError> {
    // A file of many frames is a volume by itself.
    let own = |file: usize| (headers[file].frame_count() > 1).then_some(file);
    let mut of_series: BTreeMap<(i64, &str, Option<usize>, Shape), Vec<Group>> = BTreeMap::new();
    let (mut wrong, mut count_of_wrong) = (None, 0);
    for (file, header) in headers.iter().enumerate() {
        let shape = match shape_of(header) {
            Ok(shape) => shape,
            Err(error) => {
                wrong = wrong.or(Some(error));
                count_of_wrong += 1;
                continue;
            }
        };
        let number = header.found.series_number.map_or(i64::MAX, |number| number as i64);
        let groups = of_series.entry((number, &header.found.series, own(file), shape)).or_default();
        let count = usize::try_from(header.frame_count()).unwrap_or(usize::MAX);
        for frame in 0..count.min(super::header::found::MOST_FRAMES) {
            let slice = Slice { file, frame, plane: header.found.plane(frame) };
            let fits = |group: &&mut Group| {
                group.slices.first().is_some_and(|first| lie_in_parallel(&first.plane, &slice.plane))
            };
            match groups.iter_mut().rev().take(MOST_COMPARED).find(fits) {
                Some(group) => group.slices.push(slice),
                None => groups.push(Group { shape, slices: vec![slice] }),
            }
        }
    }
    let all: Vec<Group> = of_series.into_values().flatten().collect();
    match wrong {
        Some(error) if all.is_empty() => Err(error),
        wrong => Ok((all, wrong.map(|error| left_out(count_of_wrong, &error)))),
    }
}

/// Says how many files are left out, and why the first of them.
pub(super) fn left_out(count: usize, why: &LoadError) -> String {
    let files =
        if count == 1 { "a file is left out".to_owned() } else { format!("{count} files are left out") };
    format!("{files}: {}", plain(&why.to_string(), 400))
}

/// How the pixels of a file are stored, if it has room for them.
pub(super) fn shape_of(header: &Header) -> Result<Shape, LoadError> {
    let attempt = Attempt { what: super::WHAT, path: &header.path };
    let shape = Shape::of(attempt, header)?;
    check_room(attempt, header, &shape)?;
    Ok(shape)
}

fn lie_in_parallel(one: &Plane, other: &Plane) -> bool {
    let turned = match (one.orientation, other.orientation) {
        (None, None) => true,
        (Some(one), Some(other)) => {
            one.iter().zip(other).all(|(a, b)| (*a - b).abs().max_element() < PARALLEL)
        }
        _ => false,
    };
    let spaced = match (one.spacing, other.spacing) {
        (None, None) => true,
        (Some(one), Some(other)) => {
            one.iter().zip(other).all(|(a, b)| *a == b || (a - b).abs() <= SAME_SPACING * a.abs())
        }
        _ => false,
    };
    turned && spaced
}

impl Group {
    /// How users are offered it.
    pub(super) fn offer(&self, number: usize, headers: &[Header]) -> Offer {
        let dims = [self.shape.columns as u64, self.shape.rows as u64, self.slices.len() as u64];
        let Some(first) = self.slices.first() else { return Offer::numbered(number, "", dims) };
        let found = &headers[first.file].found;
        let words = [&found.modality, found.description(), direction(&first.plane)];
        let words: Vec<&str> = words.into_iter().filter(|word| !word.is_empty()).collect();
        Offer::numbered(number, &words.join(" "), dims)
    }
}

/// Across which way pictures lie, in the words of radiology.
fn direction(plane: &Plane) -> &'static str {
    let Some(normal) = plane.normal() else { return "" };
    let steep = |axis: DVec3| normal.dot(axis).abs() > 0.8;
    if steep(DVec3::Z) {
        "axial"
    } else if steep(DVec3::Y) {
        "coronal"
    } else if steep(DVec3::X) {
        "sagittal"
    } else {
        "oblique"
    }
}
