//! Grouping of images into volumes: those of one series with equal size and parallel planes.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::super::LoadError;
use super::header::DicomHeader;
use super::header::acquisition_attributes::AcquisitionAttribute;
use super::header::image_plane::ImagePlane;
use super::header::segments::SegmentationType;
use super::mosaic::Mosaic;
use super::pixels::layout::{PhotometricKind, PixelLayout};
use super::pixels::size_check::{check_file_size, supported_codec};
use super::slice_layer::{DicomSlice, GapFill};
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::LoadContext;

/// Tolerance of direction cosines within which planes count as parallel.
const PARALLEL_TOLERANCE: f64 = 1e-3;

/// Relative tolerance within which pixel spacings count as equal.
const SPACING_TOLERANCE: f64 = 1e-3;

/// Maximum number of groups of a series that an image is compared with: a scan has three directions, a radial scan of
/// a joint has dozens.
const MAX_COMPARED_GROUPS: usize = 64;

/// Images that form a volume, or one volume per phase.
#[derive(Debug)]
pub(super) struct ImageGroup {
    pub(super) layout: PixelLayout,
    pub(super) slices: Vec<DicomSlice>,
    /// Rule for filling missing slices.
    pub(super) gap_fill: GapFill,
    /// True if the images are masks of segments.
    pub(super) has_masks: bool,
}

/// File whose pixels cannot be read, and the reason.
#[derive(Debug)]
pub(super) struct UnreadableFile {
    /// Index of the file among the headers.
    pub(super) file: usize,
    pub(super) error: LoadError,
}

/// All groups of images among the files, and the files left out.
#[derive(Debug, Default)]
pub(super) struct ImageGroups {
    /// Groups in ascending order of their series numbers.
    pub(super) groups: Vec<ImageGroup>,
    /// Distinct image types; [`AcquisitionAttribute::ImageType`] holds indices into this list.
    pub(super) image_types: Vec<String>,
    pub(super) unreadable: Vec<UnreadableFile>,
}

/// Groups the images of all files into volumes.
pub(super) fn group_images(headers: &[DicomHeader]) -> ImageGroups {
    let image_types: BTreeSet<&str> = headers.iter().flat_map(image_types_of).collect();
    let image_types: Vec<String> = image_types.into_iter().map(str::to_owned).collect();
    // A file of several frames is a group of its own.
    let own_group = |file: usize| (headers[file].frame_count() > 1).then_some(file);
    let mut of_series: BTreeMap<(i64, &str, Option<usize>, PixelLayout), Vec<ImageGroup>> = BTreeMap::new();
    let mut unreadable = Vec::new();
    for (file, header) in headers.iter().enumerate() {
        let shape = match readable_layout(header) {
            Ok(shape) => shape,
            Err(why) => {
                unreadable.push(UnreadableFile { file, error: why });
                continue;
            }
        };
        let mosaic = Mosaic::new(header);
        let shape = mosaic.as_ref().map_or(shape, |mosaic| mosaic.tile_shape(shape));
        let number = header.values.series_number.map_or(i64::MAX, |number| number as i64);
        let groups =
            of_series.entry((number, &header.values.series_uid, own_group(file), shape)).or_default();
        let slices = frame_slices(file, header, &image_types).flat_map(|slice| match &mosaic {
            Some(mosaic) => mosaic.tiles(&slice),
            None => vec![slice],
        });
        for slice in slices {
            let is_parallel = |group: &&mut ImageGroup| {
                group.slices.first().is_some_and(|first| are_parallel(&first.plane, &slice.plane))
            };
            match groups.iter_mut().rev().take(MAX_COMPARED_GROUPS).find(is_parallel) {
                Some(group) => group.slices.push(slice),
                None => groups.push(ImageGroup::from_slice(header, shape, &slice)),
            }
        }
    }
    ImageGroups { groups: of_series.into_values().flatten().collect(), image_types, unreadable }
}

/// Returns the frames of a file as slices.
fn frame_slices<'a>(
    file: usize,
    header: &'a DicomHeader,
    image_types: &'a [String],
) -> impl Iterator<Item = DicomSlice> + 'a {
    let count = usize::try_from(header.frame_count()).unwrap_or(usize::MAX);
    (0..count.min(super::header::element_context::MAX_FRAMES)).map(move |frame| {
        let mut plane = header.values.plane(frame);
        let text = header.values.image_type(frame);
        let number = image_types.binary_search_by(|known| known.as_str().cmp(text)).ok();
        plane.attributes.set(AcquisitionAttribute::ImageType, number.map(|number| number as f64));
        DicomSlice { file, frame, tile: None, plane }
    })
}

/// Returns the image types of a file and its frames.
fn image_types_of(header: &DicomHeader) -> impl Iterator<Item = &str> {
    let of_frames = header.values.frame_types.iter().map(String::as_str);
    of_frames.chain([header.values.image_type.as_str()])
}

/// Returns the pixel layout of a file, if it is supported and the file is long enough for its frames.
pub(super) fn readable_layout(header: &DicomHeader) -> Result<PixelLayout, LoadError> {
    let context = LoadContext { operation: super::READ_FILE, path: &header.path };
    let shape = PixelLayout::from_header(context, header)?;
    supported_codec(context, header)?;
    check_file_size(context, header, &shape)?;
    Ok(shape)
}

/// Formats a remark: how many of `total` items are left out, and why the first of them.
pub(super) fn omission_remark(count: usize, total: usize, what: &str, why: &LoadError) -> String {
    let are = if count == 1 { "is" } else { "are" };
    format!("{count} of {total} {what} {are} left out: {}", sanitised(&why.to_string(), 400))
}

fn are_parallel(one: &ImagePlane, other: &ImagePlane) -> bool {
    let same_orientation = match (one.orientation, other.orientation) {
        (None, None) => true,
        (Some(one), Some(other)) => {
            one.iter().zip(other).all(|(a, b)| (*a - b).abs().max_element() < PARALLEL_TOLERANCE)
        }
        _ => false,
    };
    let same_spacing = match (one.spacing, other.spacing) {
        (None, None) => true,
        (Some(one), Some(other)) => {
            one.iter().zip(other).all(|(a, b)| *a == b || (a - b).abs() <= SPACING_TOLERANCE * a.abs())
        }
        _ => false,
    };
    same_orientation && same_spacing
}

impl ImageGroup {
    fn from_slice(header: &DicomHeader, shape: PixelLayout, first: &DicomSlice) -> Self {
        let found = &header.values;
        let is_fraction = found.segmentation == Some(SegmentationType::Fractional);
        let has_frames_by_segment =
            matches!(found.segmentation, Some(SegmentationType::Binary | SegmentationType::Fractional));
        // Fractions of a single segment are a scalar field, not a mask.
        let has_masks = has_frames_by_segment && !(is_fraction && found.segments.len() == 1);
        let filling = match (found.segmentation, shape.colors) {
            (Some(_), _) => GapFill::NoSegment,
            (None, PhotometricKind::Palette) => GapFill::Nearest,
            (None, _) => GapFill::Interpolate,
        };
        Self { layout: shape, slices: vec![*first], gap_fill: filling, has_masks }
    }

    /// Returns the group's name for the user: modality, description and direction.
    pub(super) fn name(&self, headers: &[DicomHeader]) -> String {
        let Some(first) = self.slices.first() else { return String::new() };
        let found = &headers[first.file].values;
        let words = [&found.modality, found.description(), direction(&first.plane)];
        let words: Vec<&str> = words.into_iter().filter(|word| !word.is_empty()).collect();
        words.join(" ")
    }
}

/// Returns the anatomical direction of a plane, in the terms of radiology.
fn direction(plane: &ImagePlane) -> &'static str {
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
