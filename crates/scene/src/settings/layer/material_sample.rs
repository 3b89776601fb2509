//! Samples of materials that were picked in the picture, and the boxes that separate them.

use glam::{DVec3, IVec3};

use super::material_box::{MATERIAL_COLORS, MAX_MATERIAL_BOXES, MaterialBox};
use chiaroscuro_volume::{ValueRange, Volume};

/// Number of voxels behind a picked place among which that with the least change is taken: the surface itself is a mixture with what
/// lies before it, over two or three voxels of most scans.
const REACH: usize = 8;

/// Factor by which changes rise from the voxel with the least change to the next border, and by which they fall from
/// the border that was picked.
const BORDER_FACTOR: f64 = 2.0;

/// Half of the edge of the cube in which values are measured, in voxels.
const MEASURED_HALF_EDGE: i32 = 2;

/// Least deviation of a material, as a share of the range of values: noise of eight bits.
const MIN_DEVIATION: f64 = 1.0 / 256.0;

/// Number of deviations on either side within which a material's values lie.
const DEVIATIONS: f64 = 3.0;

/// Share of the difference between two materials below which a voxel's change is inside one of them: at their border
/// a scan changes by a quarter to a half of it from voxel to voxel.
const BORDER_CHANGE: f64 = 0.25;

/// Factor from the median of changes to their largest usual one, which noise seldom exceeds.
const USUAL_CHANGE: f64 = 2.0;

/// Opacity of materials that were picked.
const OPACITY: f64 = 0.8;

/// Softness of materials that were picked: neighbours meet at their limits.
const SOFTNESS: f64 = 0.1;

/// Statistics of a material at a picked place: its values, and their changes over a voxel, in data units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaterialSample {
    /// Mean of the values.
    pub mean: f64,
    /// Standard deviation of the values.
    pub deviation: f64,
    /// Largest usual change of a value over a voxel.
    pub change: f64,
}

impl MaterialSample {
    /// Measures the material behind a place, along a direction into the volume, both in index space; `None` outside.
    pub fn measure(volume: &Volume, index: DVec3, direction: DVec3) -> Option<Self> {
        let step = direction / direction.abs().max_element().max(f64::MIN_POSITIVE);
        let along = (0..=REACH).map(|at| (index + at as f64 * step).round().as_ivec3());
        let mut least_changing: Option<(f64, IVec3)> = None;
        let mut largest = 0.0_f64;
        for place in along.filter(|place| value(volume, *place).is_some()) {
            let change = change(volume, place);
            largest = largest.max(change);
            match least_changing {
                Some((least, _)) if change > BORDER_FACTOR * least && largest > BORDER_FACTOR * least => {
                    break;
                }
                Some((least, _)) if change >= least => {}
                _ => least_changing = Some((change, place)),
            }
        }
        let (_, middle) = least_changing?;
        let edge = -MEASURED_HALF_EDGE..=MEASURED_HALF_EDGE;
        let cube = edge.clone().flat_map(|z| {
            let edge = edge.clone();
            edge.clone().flat_map(move |y| edge.clone().map(move |x| IVec3::new(x, y, z)))
        });
        let mut near: Vec<(f64, IVec3)> =
            cube.filter_map(|by| Some((value(volume, middle + by)?, middle + by))).collect();
        // The cube may reach into other materials: voxels with the nearest values belong to this one.
        let own = value(volume, middle)?;
        near.sort_by(|(a, _), (b, _)| (a - own).abs().total_cmp(&(b - own).abs()));
        near.truncate(near.len().div_ceil(2));
        let count = near.len() as f64;
        let mean = near.iter().map(|(value, _)| value).sum::<f64>() / count;
        let deviation = (near.iter().map(|(value, _)| (value - mean).powi(2)).sum::<f64>() / count).sqrt();
        let mut changes: Vec<f64> = near.iter().map(|(_, place)| change(volume, *place)).collect();
        changes.sort_by(f64::total_cmp);
        Some(Self { mean, deviation, change: USUAL_CHANGE * changes[changes.len() / 2] })
    }

    /// Returns the change of the value over the voxel at a place in index space.
    pub fn change_at(volume: &Volume, index: DVec3) -> f64 {
        change(volume, index.round().as_ivec3())
    }

    /// Returns boxes that separate samples, at most [`MAX_MATERIAL_BOXES`], in the order of the
    /// samples: between two of different values the limit lies where both are as likely, and borders that pass through
    /// the values of a third are left out by their changes. Materials of the same values are separated by their
    /// changes.
    pub fn separating_boxes(picked: &[Self], range: ValueRange) -> Vec<MaterialBox> {
        let picked = &picked[..picked.len().min(MAX_MATERIAL_BOXES)];
        let part = |(at, own): (usize, &Self)| {
            let others =
                || picked.iter().enumerate().filter(|(other, _)| *other != at).map(|(_, other)| other);
            let spread = own.spread(range);
            let is_like = |other: &Self| (other.mean - own.mean).abs() < spread + other.spread(range);
            let next = |is_above: bool| {
                let beside = others().filter(|other| !is_like(other) && (other.mean > own.mean) == is_above);
                beside.min_by(|a, b| (a.mean - own.mean).abs().total_cmp(&(b.mean - own.mean).abs()))
            };
            let limit = |other: &Self| {
                let (own_spread, other_spread) = (spread, other.spread(range));
                (own.mean * other_spread + other.mean * own_spread) / (own_spread + other_spread)
            };
            let half_width = DEVIATIONS * spread;
            let (below, above) = (next(false), next(true));
            let far =
                |neighbour: Option<&Self>| neighbour.map_or(0.0, |other| (limit(other) - own.mean).abs());
            let low = below.map_or(own.mean - half_width.max(far(above)), limit);
            // Values above those of all samples belong to the material with the highest values.
            let high = match (above, below) {
                (Some(above), _) => limit(above),
                (None, Some(_)) => range.high.max(own.mean + half_width),
                (None, None) => own.mean + half_width,
            };
            let gap = [below, above].into_iter().flatten().map(|other| (other.mean - own.mean).abs());
            let gap = gap.fold(f64::INFINITY, f64::min);
            let mut changes = [0.0, range.span()];
            if above.is_some() {
                changes[1] = (BORDER_CHANGE * gap).max(own.change);
            }
            for other in others().filter(|other| is_like(other)) {
                let limit = f64::midpoint(own.change, other.change);
                let end = usize::from(own.change <= other.change);
                changes[end] = if end == 1 { changes[1].min(limit) } else { changes[0].max(limit) };
            }
            // Limits from several neighbours may cross.
            changes.sort_by(f64::total_cmp);
            let color = MATERIAL_COLORS[at];
            MaterialBox { values: [low, high], changes, softness: SOFTNESS, color, opacity: OPACITY }
        };
        picked.iter().enumerate().map(part).collect()
    }

    fn spread(&self, range: ValueRange) -> f64 {
        self.deviation.max(MIN_DEVIATION * range.span())
    }
}

/// Returns the value of a voxel; `None` outside of the grid, and where it is missing or hidden by more than half.
fn value(volume: &Volume, place: IVec3) -> Option<f64> {
    let dims = volume.dims().map(|n| n as i32);
    let place = place.to_array();
    let is_inside = (0..3).all(|axis| (0..dims[axis]).contains(&place[axis]));
    if !is_inside {
        return None;
    }
    let [x, y, z] = place.map(|at| at as usize);
    let [nx, ny, _] = volume.dims();
    // Padding is finite, and no material.
    (volume.presence(x + nx * (y + ny * z)) >= 0.5).then(|| volume.value(x, y, z))
}

/// Returns the change of the value over a voxel: the length of its gradient, by differences of its neighbours.
fn change(volume: &Volume, place: IVec3) -> f64 {
    let Some(own) = value(volume, place) else { return 0.0 };
    let beside = |step: IVec3| value(volume, place + step).unwrap_or(own);
    let differences = IVec3::AXES.map(|axis| 0.5 * (beside(axis) - beside(-axis)));
    differences.iter().map(|difference| difference * difference).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_volume::Samples;

    const RANGE: ValueRange = ValueRange::new(0.0, 1000.0);

    /// Layers along x of 0, 400 and 900 with borders three voxels wide, and some noise.
    fn layers() -> Volume {
        let value = |at: usize| {
            let x = (at % 48) as f64;
            let ramp = |from: f64| ((x - from) / 3.0).clamp(0.0, 1.0);
            let noise = ((at * 7919) % 13) as f64 - 6.0;
            (400.0 * ramp(10.0) + 500.0 * ramp(28.0) + noise) as f32
        };
        let samples = Samples::F32((0..48 * 16 * 16).map(value).collect());
        Volume::with_spacing("layers", [48, 16, 16], DVec3::ONE, samples).unwrap()
    }

    #[test]
    fn materials_are_measured_behind_their_surfaces() {
        let volume = layers();
        for (x, mean) in [(11.0, 400.0), (20.0, 400.0), (29.5, 900.0), (2.0, 0.0)] {
            let found = MaterialSample::measure(&volume, DVec3::new(x, 8.0, 8.0), DVec3::X).unwrap();
            assert!((found.mean - mean).abs() < 8.0, "{x}: {found:?}");
            assert!(found.deviation < 8.0 && found.change < 20.0, "{x}: {found:?}");
        }
        assert_eq!(MaterialSample::measure(&volume, DVec3::splat(90.0), DVec3::X), None);
    }

    #[test]
    fn two_materials_meet_between_and_borders_belong_to_neither() {
        let volume = layers();
        let pick = |x: f64| MaterialSample::measure(&volume, DVec3::new(x, 8.0, 8.0), DVec3::X).unwrap();
        let [inner, outer] = MaterialSample::separating_boxes(&[pick(30.0), pick(12.0)], RANGE)[..] else {
            panic!("two")
        };
        assert!(
            (inner.values[0] - outer.values[1]).abs() < 1e-9 && (600.0..700.0).contains(&inner.values[0])
        );
        assert!(inner.values[1] >= 1000.0 && inner.changes[1] >= 1000.0, "{inner:?}");
        assert!(outer.values[0] < 200.0 && outer.values[0] > 100.0, "{outer:?}");
        // The border between 0 and 900 would change by 300 from voxel to voxel.
        assert!((100.0..150.0).contains(&outer.changes[1]), "{outer:?}");
        assert_ne!(inner.color, outer.color);
    }

    #[test]
    fn the_same_values_are_separated_by_their_changes() {
        let material = |mean, change| MaterialSample { mean, deviation: 10.0, change };
        let found = MaterialSample::separating_boxes(&[material(500.0, 4.0), material(505.0, 60.0)], RANGE);
        assert_eq!(found[0].changes, [0.0, 32.0]);
        assert_eq!(found[1].changes, [32.0, 1000.0]);
        assert!(found[0].values[1] > 500.0 && found[1].values[0] < 500.0);
        let alone = MaterialSample::separating_boxes(&[material(500.0, 4.0)], RANGE);
        assert_eq!((alone[0].values, alone[0].changes), ([470.0, 530.0], [0.0, 1000.0]));
    }
}
