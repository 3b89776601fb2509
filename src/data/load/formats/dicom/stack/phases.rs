//! Phases: splits images of one series at equal or nearly equal positions into volumes (phases, echoes,
//! acquisitions), none of which gets slices of another.

use std::collections::BTreeMap;

use super::places::{Places, Pose, collisions, usual_distance};
use super::ranks::{by_rank, by_turn};
use crate::data::load::formats::dicom::header::taken::{Attribute, Taken};

/// Fraction of the spacing within a phase below which slices of two phases count as nearly coincident. Interleaved
/// passes, half a spacing apart, form one volume.
const NEAR: f64 = 0.45;

/// Fraction of the largest phase's slices below which a phase is listed behind the others.
const WHOLE: f64 = 0.5;

/// Images of one volume, by index, in order of position.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Phase {
    /// Name that distinguishes the phase from others; empty if it is the only one.
    pub(crate) name: String,
    pub(crate) pictures: Vec<usize>,
}

/// Phases of a series, with a remark on omitted images.
#[derive(Debug)]
pub(crate) struct Phases {
    pub(crate) phases: Vec<Phase>,
    pub(crate) remark: Option<String>,
}

/// Subset of the images, with the attribute values that they have in common and others have not.
struct Class {
    shared: Vec<(Attribute, Option<f64>)>,
    /// Indices of the images, in order of position.
    pictures: Vec<usize>,
}

impl Phases {
    /// Splits images into phases. `image_types` holds the texts that [`Attribute::ImageType`] indexes.
    pub(crate) fn new(poses: &[Pose], image_types: &[String]) -> Self {
        let mut order: Vec<usize> = (0..poses.len()).collect();
        order.sort_by(|&a, &b| poses[a].place_mm.total_cmp(&poses[b].place_mm));
        let tolerance_mm = Places::tolerance_mm(poses, &order);
        let mut classes = vec![Class { shared: Vec::new(), pictures: order }];
        for attribute in Attribute::ALL.into_iter().filter(|&attribute| attribute != Attribute::Instance) {
            classes =
                classes.into_iter().flat_map(|class| class.divided(attribute, poses, tolerance_mm)).collect();
        }
        let (mut phases, mut left_out) = (Vec::new(), 0);
        for Class { shared, pictures } in classes {
            let said = shared
                .into_iter()
                .filter_map(|(attribute, value)| Some(attribute.in_words(value?, image_types)));
            let name = said.collect::<Vec<_>>().join(", ");
            let places = Places::new(poses, &pictures, tolerance_mm);
            let most = places.most_at_one();
            if most <= 1 {
                phases.push(Phase { name, pictures });
            } else if let Some(ranks) = by_rank(&places, poses).or_else(|| by_turn(&places, poses)) {
                for (number, pictures) in ranks.iter().enumerate() {
                    let other = &ranks[usize::from(number == 0)];
                    let own = set_apart(&poses[pictures[0]].taken, &poses[other[0]].taken, image_types);
                    let both = [name.as_str(), own.as_str()].into_iter().filter(|name| !name.is_empty());
                    let name = both.collect::<Vec<_>>().join(", ");
                    phases.push(Phase { name, pictures: pictures.clone() });
                }
            } else {
                left_out += pictures.len() - places.len();
                phases.push(Phase { name, pictures: places.firsts() });
            }
        }
        let largest = phases.iter().map(|phase| phase.pictures.len()).max().unwrap_or(0) as f64;
        phases.sort_by_key(|phase| (phase.pictures.len() as f64) < WHOLE * largest);
        let total = poses.len();
        let remark = (left_out > 0).then(|| {
            format!("{left_out} of {total} pictures lie where others do: the first of each place are shown")
        });
        Self { phases, remark }
    }
}

impl Class {
    /// Splits the class by the values of an attribute, if that separates coincident images; otherwise returns it
    /// unchanged.
    fn divided(self, attribute: Attribute, poses: &[Pose], tolerance_mm: f64) -> Vec<Self> {
        let mut parts: BTreeMap<Option<u64>, Vec<usize>> = BTreeMap::new();
        for &picture in &self.pictures {
            let value = poses[picture].taken.get(attribute);
            parts.entry(value.map(ordered_bits)).or_default().push(picture);
        }
        if parts.len() < 2 || !self.is_told_apart(&parts, poses, tolerance_mm) {
            return vec![self];
        }
        let part = |pictures: Vec<usize>| {
            let value = pictures.first().and_then(|&picture| poses[picture].taken.get(attribute));
            let shared = [self.shared.as_slice(), &[(attribute, value)]].concat();
            Self { shared, pictures }
        };
        parts.into_values().map(part).collect()
    }

    /// Returns true if the parts overlap in space, and coincident images are in different parts.
    fn is_told_apart(
        &self,
        parts: &BTreeMap<Option<u64>, Vec<usize>>,
        poses: &[Pose],
        tolerance_mm: f64,
    ) -> bool {
        // Attributes that differ for each image do not separate phases: a part has several slices.
        const FEWEST_ON_AVERAGE: usize = 3;
        let (total, count) = (self.pictures.len(), parts.len());
        let places = Places::new(poses, &self.pictures, tolerance_mm).len();
        if 2 * total <= count * places && total < FEWEST_ON_AVERAGE * count {
            return false;
        }
        let Some(usual) = usual_distance(parts.values(), poses, tolerance_mm) else { return false };
        let near = NEAR * usual;
        let together = collisions(&self.pictures, poses, near);
        let apart: usize = parts.values().map(|part| collisions(part, poses, near)).sum();
        // Parts that merely adjoin have a few coincident images: they are one volume.
        let largest = parts.values().map(Vec::len).max().unwrap_or(0);
        together > apart && 4 * (together - apart) > total - largest
    }
}

/// Maps a float to bits that sort in the same order.
fn ordered_bits(value: f64) -> u64 {
    let bits = value.to_bits();
    if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
}

/// Formats the first attribute in which an image differs from another.
fn set_apart(taken: &Taken, other: &Taken, image_types: &[String]) -> String {
    let named = Attribute::ALL.into_iter().filter(|&attribute| attribute != Attribute::Instance);
    let mut different = named.filter(|&attribute| taken.get(attribute) != other.get(attribute));
    let found = different.find_map(|attribute| Some(attribute.in_words(taken.get(attribute)?, image_types)));
    found.unwrap_or_default()
}
