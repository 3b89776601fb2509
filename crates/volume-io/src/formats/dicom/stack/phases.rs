//! Phases: splits images of one series at equal or nearly equal positions into volumes (phases, echoes,
//! acquisitions), none of which gets slices of another.

use std::collections::BTreeMap;

use super::coincident_phases::{phases_by_instance_number, phases_by_rank};
use super::positions::{ImagePose, PositionGroups, count_coincident, median_spacing};
use crate::formats::dicom::header::acquisition_attributes::{AcquisitionAttribute, AcquisitionAttributes};

/// Fraction of the spacing within a phase below which slices of two phases count as nearly coincident. Interleaved
/// passes, half a spacing apart, form one volume.
const COINCIDENCE_FRACTION: f64 = 0.45;

/// Fraction of the largest phase's slices below which a phase is listed behind the others.
const COMPLETE_FRACTION: f64 = 0.5;

/// Images of one volume, by index, in order of position.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PhaseImages {
    /// Name that distinguishes the phase from others; empty if it is the only one.
    pub(crate) name: String,
    pub(crate) images: Vec<usize>,
}

/// Phases of a series, with a remark on omitted images.
#[derive(Debug)]
pub(crate) struct SeriesPhases {
    pub(crate) phases: Vec<PhaseImages>,
    pub(crate) remark: Option<String>,
}

/// Subset of the images, with the attribute values that they have in common and others have not.
struct AttributeClass {
    shared: Vec<(AcquisitionAttribute, Option<f64>)>,
    /// Indices of the images, in order of position.
    images: Vec<usize>,
}

impl SeriesPhases {
    /// Splits images into phases. `image_types` holds the texts that [`AcquisitionAttribute::ImageType`] indexes.
    pub(crate) fn new(poses: &[ImagePose], image_types: &[String]) -> Self {
        let mut order: Vec<usize> = (0..poses.len()).collect();
        order.sort_by(|&a, &b| poses[a].position_mm.total_cmp(&poses[b].position_mm));
        let tolerance_mm = PositionGroups::tolerance_mm(poses, &order);
        let mut classes = vec![AttributeClass { shared: Vec::new(), images: order }];
        for attribute in AcquisitionAttribute::ALL
            .into_iter()
            .filter(|&attribute| attribute != AcquisitionAttribute::Instance)
        {
            classes = classes
                .into_iter()
                .flat_map(|class| class.split_by(attribute, poses, tolerance_mm))
                .collect();
        }
        let (mut phases, mut left_out) = (Vec::new(), 0);
        for AttributeClass { shared, images: pictures } in classes {
            let said = shared
                .into_iter()
                .filter_map(|(attribute, value)| Some(attribute.format(value?, image_types)));
            let name = said.collect::<Vec<_>>().join(", ");
            let places = PositionGroups::new(poses, &pictures, tolerance_mm);
            let most = places.max_coincident();
            if most <= 1 {
                phases.push(PhaseImages { name, images: pictures });
            } else if let Some(ranks) =
                phases_by_rank(&places, poses).or_else(|| phases_by_instance_number(&places, poses))
            {
                for (number, pictures) in ranks.iter().enumerate() {
                    let other = &ranks[usize::from(number == 0)];
                    let own = first_difference(
                        &poses[pictures[0]].attributes,
                        &poses[other[0]].attributes,
                        image_types,
                    );
                    let both = [name.as_str(), own.as_str()].into_iter().filter(|name| !name.is_empty());
                    let name = both.collect::<Vec<_>>().join(", ");
                    phases.push(PhaseImages { name, images: pictures.clone() });
                }
            } else {
                left_out += pictures.len() - places.len();
                phases.push(PhaseImages { name, images: places.first_of_each() });
            }
        }
        let largest = phases.iter().map(|phase| phase.images.len()).max().unwrap_or(0) as f64;
        phases.sort_by_key(|phase| (phase.images.len() as f64) < COMPLETE_FRACTION * largest);
        let total = poses.len();
        let remark = (left_out > 0).then(|| {
            format!(
                "{left_out} of {total} images share their position with others: the first at each is shown"
            )
        });
        Self { phases, remark }
    }
}

impl AttributeClass {
    /// Splits the class by the values of an attribute, if that separates coincident images; otherwise returns it
    /// unchanged.
    fn split_by(self, attribute: AcquisitionAttribute, poses: &[ImagePose], tolerance_mm: f64) -> Vec<Self> {
        let mut parts: BTreeMap<Option<u64>, Vec<usize>> = BTreeMap::new();
        for &picture in &self.images {
            let value = poses[picture].attributes.get(attribute);
            parts.entry(value.map(ordered_bits)).or_default().push(picture);
        }
        if parts.len() < 2 || !self.separates_coincident(&parts, poses, tolerance_mm) {
            return vec![self];
        }
        let part = |pictures: Vec<usize>| {
            let value = pictures.first().and_then(|&picture| poses[picture].attributes.get(attribute));
            let shared = [self.shared.as_slice(), &[(attribute, value)]].concat();
            Self { shared, images: pictures }
        };
        parts.into_values().map(part).collect()
    }

    /// Returns true if the parts overlap in space, and coincident images are in different parts.
    fn separates_coincident(
        &self,
        parts: &BTreeMap<Option<u64>, Vec<usize>>,
        poses: &[ImagePose],
        tolerance_mm: f64,
    ) -> bool {
        // Attributes that differ for each image do not separate phases: a part has several slices.
        const MIN_MEAN_SLICES: usize = 3;
        let (total, count) = (self.images.len(), parts.len());
        let places = PositionGroups::new(poses, &self.images, tolerance_mm).len();
        if 2 * total <= count * places && total < MIN_MEAN_SLICES * count {
            return false;
        }
        let Some(usual) = median_spacing(parts.values(), poses, tolerance_mm) else { return false };
        let near = COINCIDENCE_FRACTION * usual;
        let coincident = count_coincident(&self.images, poses, near);
        let coincident_within_parts: usize =
            parts.values().map(|part| count_coincident(part, poses, near)).sum();
        // Parts that merely adjoin have a few coincident images: they are one volume.
        let largest = parts.values().map(Vec::len).max().unwrap_or(0);
        coincident > coincident_within_parts && 4 * (coincident - coincident_within_parts) > total - largest
    }
}

/// Maps a float to bits that sort in the same order.
fn ordered_bits(value: f64) -> u64 {
    let bits = value.to_bits();
    if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
}

/// Formats the first attribute in which an image differs from another.
fn first_difference(
    taken: &AcquisitionAttributes,
    other: &AcquisitionAttributes,
    image_types: &[String],
) -> String {
    let named = AcquisitionAttribute::ALL
        .into_iter()
        .filter(|&attribute| attribute != AcquisitionAttribute::Instance);
    let mut different = named.filter(|&attribute| taken.get(attribute) != other.get(attribute));
    let found = different.find_map(|attribute| Some(attribute.format(taken.get(attribute)?, image_types)));
    found.unwrap_or_default()
}
