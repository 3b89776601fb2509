//! Grouping of images into volumes: those of one series with equal size and parallel planes.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::super::LoadError;
use super::header::Header;
use super::header::plane::Plane;
use super::header::segments::SegmentationType;
use super::header::taken::Attribute;
use super::layer::{Filling, Slice};
use super::mosaic::Mosaic;
use super::pixels::room::{check_room, readable_codec};
use super::pixels::shape::{Colors, Shape};
use crate::data::attempt::Attempt;
use crate::data::plain;

/// Tolerance of direction cosines within which planes count as parallel.
const PARALLEL: f64 = 1e-3;

/// Relative tolerance within which pixel spacings count as equal.
const SAME_SPACING: f64 = 1e-3;

/// Maximum number of groups of a series that an image is compared with: a scan has three directions, a radial scan of
/// a joint has dozens.
const MOST_COMPARED: usize = 64;

/// Images that form a volume, or one volume per phase.
#[derive(Debug)]
pub(super) struct Group {
    pub(super) shape: Shape,
    pub(super) slices: Vec<Slice>,
    /// Rule for filling missing slices.
    pub(super) filling: Filling,
    /// True if the images are masks of segments.
    pub(super) has_masks: bool,
}

/// File whose pixels cannot be read, and the reason.
#[derive(Debug)]
pub(super) struct UnreadableFile {
    /// Index of the file among the headers.
    pub(super) file: usize,
    pub(super) why: LoadError,
}

/// All groups of images among the files, and the files left out.
#[derive(Debug, Default)]
pub(super) struct Grouping {
    /// Groups in ascending order of their series numbers.
    pub(super) groups: Vec<Group>,
    /// Distinct image types; [`Attribute::ImageType`] holds indices into this list.
    pub(super) image_types: Vec<String>,
    pub(super) unreadable: Vec<UnreadableFile>,
}

/// Groups the images of all files into volumes.
pub(super) fn groups(headers: &[Header]) -> Grouping {
    let image_types: BTreeSet<&str> = headers.iter().flat_map(image_types_of).collect();
    let image_types: Vec<String> = image_types.into_iter().map(str::to_owned).collect();
    // A file of several frames is a group of its own.
    let own = |file: usize| (headers[file].frame_count() > 1).then_some(file);
    let mut of_series: BTreeMap<(i64, &str, Option<usize>, Shape), Vec<Group>> = BTreeMap::new();
    let mut unreadable = Vec::new();
    for (file, header) in headers.iter().enumerate() {
        let shape = match shape_of(header) {
            Ok(shape) => shape,
            Err(why) => {
                unreadable.push(UnreadableFile { file, why });
                continue;
            }
        };
        let mosaic = Mosaic::new(header);
        let shape = mosaic.as_ref().map_or(shape, |mosaic| mosaic.tile_shape(shape));
        let number = header.found.series_number.map_or(i64::MAX, |number| number as i64);
        let groups = of_series.entry((number, &header.found.series, own(file), shape)).or_default();
        let slices = frames(file, header, &image_types).flat_map(|slice| match &mosaic {
            Some(mosaic) => mosaic.tiles(&slice),
            None => vec![slice],
        });
        for slice in slices {
            let fits = |group: &&mut Group| {
                group.slices.first().is_some_and(|first| lie_in_parallel(&first.plane, &slice.plane))
            };
            match groups.iter_mut().rev().take(MOST_COMPARED).find(fits) {
                Some(group) => group.slices.push(slice),
                None => groups.push(Group::of_first(header, shape, &slice)),
            }
        }
    }
    Grouping { groups: of_series.into_values().flatten().collect(), image_types, unreadable }
}

/// Returns the frames of a file as slices.
fn frames<'a>(
    file: usize,
    header: &'a Header,
    image_types: &'a [String],
) -> impl Iterator<Item = Slice> + 'a {
    let count = usize::try_from(header.frame_count()).unwrap_or(usize::MAX);
    (0..count.min(super::header::place::MOST_FRAMES)).map(move |frame| {
        let mut plane = header.found.plane(frame);
        let text = header.found.image_type(frame);
        let number = image_types.binary_search_by(|known| known.as_str().cmp(text)).ok();
        plane.taken.set(Attribute::ImageType, number.map(|number| number as f64));
        Slice { file, frame, tile: None, plane }
    })
}

/// Returns the image types of a file and its frames.
fn image_types_of(header: &Header) -> impl Iterator<Item = &str> {
    let of_frames = header.found.frame_types.iter().map(String::as_str);
    of_frames.chain([header.found.image_type.as_str()])
}

/// Returns the pixel layout of a file, if it is supported and the file is long enough for its frames.
pub(super) fn shape_of(header: &Header) -> Result<Shape, LoadError> {
    let attempt = Attempt { what: super::WHAT, path: &header.path };
    let shape = Shape::of(attempt, header)?;
    readable_codec(attempt, header)?;
    check_room(attempt, header, &shape)?;
    Ok(shape)
}

/// Formats a remark: how many of `total` items are left out, and why the first of them.
pub(super) fn left_out(count: usize, total: usize, what: &str, why: &LoadError) -> String {
    let are = if count == 1 { "is" } else { "are" };
    format!("{count} of {total} {what} {are} left out: {}", plain(&why.to_string(), 400))
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
    fn of_first(header: &Header, shape: Shape, first: &Slice) -> Self {
        let found = &header.found;
        let is_fraction = found.segmentation == Some(SegmentationType::Fractional);
        let has_frames_by_segment =
            matches!(found.segmentation, Some(SegmentationType::Binary | SegmentationType::Fractional));
        // Fractions of a single segment are a scalar field, not a mask.
        let has_masks = has_frames_by_segment && !(is_fraction && found.segments.len() == 1);
        let filling = match (found.segmentation, shape.colors) {
            (Some(_), _) => Filling::NoSegment,
            (None, Colors::Palette) => Filling::Nearest,
            (None, _) => Filling::Means,
        };
        Self { shape, slices: vec![*first], filling, has_masks }
    }

    /// Returns the group's name for the user: modality, description and direction.
    pub(super) fn name(&self, headers: &[Header]) -> String {
        let Some(first) = self.slices.first() else { return String::new() };
        let found = &headers[first.file].found;
        let words = [&found.modality, found.description(), direction(&first.plane)];
        let words: Vec<&str> = words.into_iter().filter(|word| !word.is_empty()).collect();
        words.join(" ")
    }
}

/// Returns the anatomical direction of a plane, in the terms of radiology.
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
