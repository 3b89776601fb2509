//! Which pictures of one series are a volume, where several lie at the same places or nearly so: phases, echoes,
//! acquisitions. No slice of one comes among those of another.

use std::collections::BTreeMap;

use super::places::{Places, Pose, collisions, usual_distance};
use super::ranks::{by_rank, by_turn};
use crate::data::load::formats::dicom::header::taken::{Attribute, Taken};

/// Slices of two phases that are nearer to each other than this share of the distance within a phase lie at nearly the
/// same place. Halves are those of phases that were taken in turns, and are one volume.
const NEAR: f64 = 0.45;

/// Phases with less than this share of the slices of the largest stand behind the others.
const WHOLE: f64 = 0.5;

/// Pictures of one volume, by their numbers, in the order of their places.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Phase {
    /// What sets it apart from others; empty where there are none.
    pub(crate) name: String,
    pub(crate) pictures: Vec<usize>,
}

/// Pictures that are told apart, and what was left out.
#[derive(Debug)]
pub(crate) struct Phases {
    pub(crate) phases: Vec<Phase>,
    pub(crate) remark: Option<String>,
}

/// Some of the pictures, and the attributes that all of them share and others have not.
struct Class {
    shared: Vec<(Attribute, Option<f64>)>,
    /// In the order of their places.
    pictures: Vec<usize>,
}

impl Phases {
    /// Tells pictures apart. `image_types` are the texts that [`Attribute::ImageType`] counts.
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
    /// Its pictures by the values of an attribute, where that tells apart what lies at the same places; else all.
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

    /// Whether these parts overlap, and pictures that are at the same places or nearly so are in different ones.
    fn is_told_apart(
        &self,
        parts: &BTreeMap<Option<u64>, Vec<usize>>,
        poses: &[Pose],
        tolerance_mm: f64,
    ) -> bool {
        // Attributes that are another for each picture tell nothing: a part has some slices.
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
        // Where one begins as the other ends, a few are near each other: they are one volume.
        let largest = parts.values().map(Vec::len).max().unwrap_or(0);
        together > apart && 4 * (together - apart) > total - largest
    }
}

/// The bits of a number, so that they are in its order.
fn ordered_bits(value: f64) -> u64 {
    let bits = value.to_bits();
    if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
}

/// The first attribute in which a picture differs from another, in words.
fn set_apart(taken: &Taken, other: &Taken, image_types: &[String]) -> String {
    let named = Attribute::ALL.into_iter().filter(|&attribute| attribute != Attribute::Instance);
    let mut different = named.filter(|&attribute| taken.get(attribute) != other.get(attribute));
    let found = different.find_map(|attribute| Some(attribute.in_words(taken.get(attribute)?, image_types)));
    found.unwrap_or_default()
}
