//! Enclosing labels: a label that hides all others, such as skin in a map of organs, is shown as a veil.

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::{LabelLook, LabelTable, OpacityLength};
use chiaroscuro_volume::{CountedLabel, Volume};

/// Smallest share of all faces towards the background that a covering label has. In maps of organs within a body it
/// is 98 % and more; of regions beside each other none has a third.
const MIN_OUTSIDE_SHARE: f64 = 0.9;

/// Smallest share of the other labels' faces that touch the cover: otherwise they lie beside it, and are not hidden.
const MIN_INSIDE_SHARE: f64 = 0.75;

/// Transmittance of a veil as thick as a cube of its voxels: enough to distinguish colours behind it, and little
/// enough that the veil is visible.
const VEIL_TRANSMITTANCE: f64 = 0.75;

/// Colour of a veil that the file gives none: neutral and light, so that it does not tint what is behind it.
const VEIL_COLOR: [f32; 3] = [0.88, 0.85, 0.82];

/// Makes a label that hides all others a veil; `opacity_unit` is the length to which opacities refer.
pub(crate) fn make_cover_translucent(labels: &mut LabelTable, volume: &Volume, opacity_unit: OpacityLength) {
    let Some(CountedLabel { number, voxels }) = find_cover(volume) else { return };
    let scene = volume.scene();
    let voxel = scene.scene_from_index.matrix3.determinant().abs();
    let thickness = (voxels as f64 * voxel).cbrt() / opacity_unit.scene_units(&scene).max(1e-9);
    let has_color = volume.metadata().labels.get(number).is_some_and(|label| label.color.is_some());
    let cover = labels.entry_mut(number);
    cover.opacity = 1.0 - VEIL_TRANSMITTANCE.powf(1.0 / thickness.max(1.0));
    if !has_color {
        cover.color = VEIL_COLOR;
    }
}

/// Returns the label that hides all others, if any.
fn find_cover(volume: &Volume) -> Option<CountedLabel> {
    let labels = volume.labels().filter(|labels| labels.has_own_classes())?;
    let faces = FaceCounts::count(volume);
    let outside: u64 = faces.outside.values().sum();
    let (&number, &own) = faces.outside.iter().max_by_key(|(_, count)| **count)?;
    // Faces between two other labels are inside, too.
    let others: u64 =
        faces.outside.iter().filter(|(other, _)| **other != number).map(|(_, count)| count).sum();
    let (mut with_it, mut between) = (0, 0);
    for (&(a, b), &count) in &faces.between {
        *(if a == number || b == number { &mut with_it } else { &mut between }) += count;
    }
    let hides = with_it as f64 >= MIN_INSIDE_SHARE * (with_it + between + others) as f64;
    let is_cover = own as f64 >= MIN_OUTSIDE_SHARE * outside as f64 && with_it > 0 && hides;
    labels.labels().iter().find(|label| label.number == number && is_cover).copied()
}

/// Counts of voxel faces between different labels.
#[derive(Default)]
struct FaceCounts {
    /// Number of faces between a label and the background.
    outside: BTreeMap<i64, u64>,
    /// Number of faces between two labels, the lower one first.
    between: BTreeMap<(i64, i64), u64>,
}

impl FaceCounts {
    fn count(volume: &Volume) -> Self {
        let [nx, ny, nz] = volume.dims();
        let label = |voxel: usize| {
            let is_missing = volume.missing().is_some_and(|missing| missing.contains(voxel));
            let number = volume.samples().value(voxel) as i64;
            Some(number).filter(|&number| !is_missing && LabelLook::default_for(number).visible)
        };
        let of_slice = |z: usize| {
            let mut faces = Self::default();
            for at in 0..nx * ny {
                let voxel = at + nx * ny * z;
                let own = label(voxel);
                let beside = [(at % nx + 1 < nx, 1), (at / nx + 1 < ny, nx), (z + 1 < nz, nx * ny)];
                for (_, offset) in beside.into_iter().filter(|(is_there, _)| *is_there) {
                    faces.add(own, label(voxel + offset));
                }
            }
            faces
        };
        (0..nz).into_par_iter().map(of_slice).reduce(Self::default, Self::merge)
    }

    fn add(&mut self, a: Option<i64>, b: Option<i64>) {
        match (a, b) {
            (Some(a), Some(b)) if a != b => *self.between.entry((a.min(b), a.max(b))).or_default() += 1,
            (Some(own), None) | (None, Some(own)) => *self.outside.entry(own).or_default() += 1,
            _ => (),
        }
    }

    fn merge(mut self, other: Self) -> Self {
        for (label, count) in other.outside {
            *self.outside.entry(label).or_default() += count;
        }
        for (pair, count) in other.between {
            *self.between.entry(pair).or_default() += count;
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use chiaroscuro_volume::Samples;

    /// Returns balls of labels, each with a centre and a radius; later ones cover earlier ones.
    fn balls(balls: &[(u8, [f64; 3], f64)]) -> Volume {
        const N: usize = 32;
        let label = |at: usize| {
            let place = DVec3::from([at % N, at / N % N, at / N / N].map(|c| c as f64));
            let last =
                balls.iter().rev().find(|(_, middle, radius)| place.distance((*middle).into()) < *radius);
            last.map_or(0, |(label, ..)| *label)
        };
        let samples = Samples::U8((0..N * N * N).map(label).collect());
        Volume::with_spacing("t", [N; 3], DVec3::ONE, samples).unwrap()
    }

    #[test]
    fn what_hides_all_others_is_a_veil() {
        let middle = [15.5; 3];
        let organs = balls(&[(7, middle, 14.0), (2, [12.0, 15.5, 15.5], 5.0), (3, [20.0, 15.5, 15.5], 4.0)]);
        assert_eq!(find_cover(&organs).map(|label| label.number), Some(7));
        let mut labels = LabelTable::default();
        make_cover_translucent(&mut labels, &organs, OpacityLength::Voxels(1.0));
        let LabelLook { opacity, color, .. } = labels.look_or_default(7).into_owned();
        assert!((0.005..0.02).contains(&opacity), "{opacity}");
        assert_eq!(color, VEIL_COLOR);
        assert_eq!(labels.len(), 1, "others stay as they are");
        // Balls side by side, a single one, and a speck beside a ball: all are visible.
        let beside = balls(&[(1, [9.0, 15.5, 15.5], 7.0), (2, [22.0, 15.5, 15.5], 7.0)]);
        let alone = balls(&[(4, middle, 10.0)]);
        let speck = balls(&[(4, middle, 10.0), (5, [2.0; 3], 1.5)]);
        for (what, volume) in [("beside", beside), ("alone", alone), ("speck", speck)] {
            assert_eq!(find_cover(&volume), None, "{what}");
        }
    }
}
