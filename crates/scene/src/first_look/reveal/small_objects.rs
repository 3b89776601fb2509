//! Objects of one to eight voxels, such as seeds, electrodes and spots: the kernel lowers their peaks, to 0.3 of a
//! single voxel, which thresholds would hide. Voxels are therefore classified before they are spread, as labels are.

use rayon::prelude::*;

use super::super::MIN_VISIBLE_OPACITY;
use super::transfer;
use super::voxel_clusters::VoxelClusters;
use crate::{
    ClassificationOrder, ControlPoint, DensityRange, OpacityInterpolation, ReconstructionKernel, Settings,
    TransferFunction,
};
use chiaroscuro_volume::{DataKind, Histogram, ValueRange, Volume};

/// Smallest share of the visible voxels in tiny clusters where those are the object; noise around them joins some.
const MIN_TINY_SHARE: f64 = 0.9;

/// Opacities of small objects from the dimmest tenth to the brightest: a single voxel, spread over two, is nearly
/// opaque with an extinction of three.
const OPACITIES: [f64; 2] = [0.95, 0.97];

/// Beginning of the opacity of small objects, as largest share of their height above what is around them.
const MAX_START_SHARE: f64 = 0.5;

/// Number of bins of all values in which the gap below small objects is sought.
const BINS: usize = 512;

/// Smallest gap in the values between small objects and the material around them, as a share of the range of all
/// values: noise, and bone with fillings, leave none.
const MIN_GAP_SHARE: f64 = 0.25;

/// Smallest share of small objects that lie inside the material around them, and the largest probability that as many
/// single voxels of noise would all lie there by chance.
const MIN_INSIDE_SHARE: f64 = 0.9;
const MAX_CHANCE: f64 = 0.02;

/// Smallest number of small objects within other material: one or two voxels are defects.
const MIN_INSIDE_COUNT: usize = 3;

/// Transmittance of the material around small objects, as thick as a cube of its voxels: enough to see them behind it.
const AROUND_TRANSMITTANCE: f64 = 0.6;

/// Look at small objects.
pub(crate) struct SmallObjectLook {
    /// Settings that show them, seen as before.
    pub settings: Settings,
    /// True if there is nothing else to see, so that they are framed.
    pub are_alone: bool,
}

/// Returns a look at small objects where they are all that a look shows, or lie hidden inside; `None` for other
/// volumes.
pub(crate) fn show_small_objects(
    look: &Settings,
    volume: &Volume,
    histogram: &Histogram,
    kind: DataKind,
) -> Option<SmallObjectLook> {
    if !matches!(kind, DataKind::Mask | DataKind::Scalar | DataKind::HounsfieldCt { .. }) {
        return None;
    }
    let function = &look.layer().transfer;
    let is_shown = |value: f64| function.opacity_at(value) > MIN_VISIBLE_OPACITY;
    // Known without a visit to every voxel.
    let bins = histogram.counts.iter().enumerate();
    let shown: u64 = bins
        .filter(|(bin, _)| is_shown(volume.value_of((*bin as f64 + 0.5) / histogram.counts.len() as f64)))
        .map(|(_, count)| count)
        .sum();
    let are_few = shown as f64 <= 2.0 * VoxelClusters::MAX_SHARE * histogram.total as f64;
    let clusters = are_few.then(|| VoxelClusters::find(volume, is_shown)).flatten();
    let alone = clusters.filter(|clusters| clusters.tiny_share() >= MIN_TINY_SHARE);
    let are_alone = alone.is_some();
    let transfer = match alone {
        Some(clusters) => small_object_transfer(function, volume, &clusters),
        None => inner_object_transfer(look, volume, kind)?,
    };
    let is_beyond = transfer.points.iter().any(|point| point.value > volume.ranges().robust.high);
    let mut settings = look.clone().with_transfer(transfer);
    if is_beyond {
        settings.layer_mut().range = DensityRange::Full;
    }
    settings.sampling.classification = ClassificationOrder::Pre;
    // Sharper than the B-spline.
    (settings.sampling.kernel, settings.shadows.kernel) =
        (ReconstructionKernel::Prefiltered, ReconstructionKernel::Prefiltered);
    Some(SmallObjectLook { settings, are_alone })
}

/// Returns the values of the dimmest tenth of small objects, and of the brightest.
fn value_ends(volume: &Volume, clusters: &VoxelClusters) -> [f64; 2] {
    let peaks = clusters.peaks(volume);
    [peaks.len() / 10, peaks.len() - 1].map(|at| peaks[at])
}

/// Returns a function that shows small objects alone, in the colours that their values have.
fn small_object_transfer(
    function: &TransferFunction,
    volume: &Volume,
    clusters: &VoxelClusters,
) -> TransferFunction {
    let background = volume.quantile(0.5);
    let [dimmest, highest] = value_ends(volume, clusters);
    let latest = background + MAX_START_SHARE * (dimmest - background);
    let start = function.points.first().map_or(latest, |point| point.value).min(latest);
    let point = |value: f64, of: f64, opacity: f64| ControlPoint { value, opacity, ..function.point_at(of) };
    let mut points = vec![
        point(start, dimmest, 0.0),
        point(dimmest, dimmest, OPACITIES[0]),
        point(highest, highest, OPACITIES[1]),
    ];
    points.dedup_by(|a, b| a.value <= b.value);
    TransferFunction { points, interpolation: OpacityInterpolation::Opacity, ..function.clone() }
}

/// Returns a function that shows small objects inside the material that a look shows, and that translucent; `None` if
/// there are none.
fn inner_object_transfer(look: &Settings, volume: &Volume, kind: DataKind) -> Option<TransferFunction> {
    let gap = widest_gap(volume)?;
    let clusters = VoxelClusters::find(volume, |value| value >= gap.high)?;
    if clusters.tiny.len() < MIN_INSIDE_COUNT || clusters.tiny_share() < MIN_TINY_SHARE {
        return None;
    }
    let function = &look.layer().transfer;
    let first = function.points.first()?;
    let material = match kind {
        // Electrodes lie in the brain rather than in the bone.
        DataKind::HounsfieldCt { water } => water + transfer::SKIN_END_HU,
        _ => first.value,
    };
    let around = clusters.surroundings(volume);
    let inside = around.iter().filter(|value| **value >= material).count() as f64 / around.len() as f64;
    let chance = share_above(volume, material).powi(around.len().try_into().unwrap_or(i32::MAX));
    if inside < MIN_INSIDE_SHARE || chance > MAX_CHANCE {
        return None;
    }
    let [dimmest, highest] = value_ends(volume, &clusters);
    let thickness = (share_above(volume, first.value) * volume.voxel_count() as f64).cbrt();
    let translucent = 1.0 - AROUND_TRANSMITTANCE.powf(1.0 / thickness.max(1.0));
    let color = function.points.last()?.color;
    let start = f64::midpoint(gap.low, dimmest);
    // The material as it was, in steps that end before the gap.
    let outer = function.points.iter().filter(|point| point.value < gap.low);
    let outer = outer.map(|point| ControlPoint { opacity: point.opacity.min(translucent), ..*point });
    let last = ControlPoint { value: gap.low, opacity: translucent, ..function.point_at(gap.low) };
    let inner = [(start, translucent), (dimmest, OPACITIES[0]), (highest.max(dimmest), OPACITIES[1])];
    let inner = inner.map(|(value, opacity)| ControlPoint::new(value, color, opacity));
    let points = outer.chain([last]).chain(inner).collect();
    Some(TransferFunction { points, interpolation: OpacityInterpolation::Opacity, ..function.clone() })
}

/// Returns the widest gap in the values of a volume that only few lie above; `None` if it is narrow.
fn widest_gap(volume: &Volume) -> Option<ValueRange> {
    let range = volume.value_range();
    let counts = value_counts(volume, range)?;
    let most = (volume.voxel_count() as f64 * VoxelClusters::MAX_SHARE) as usize;
    let (mut above, mut end, mut widest) = (0, BINS, 0..0);
    // Downwards from the highest value; a gap ends at a bin with values.
    for bin in (0..BINS).rev().filter(|&bin| counts[bin] > 0) {
        if end < BINS && end - (bin + 1) > widest.len() {
            widest = bin + 1..end;
        }
        above += counts[bin];
        if above > most {
            break;
        }
        end = bin;
    }
    let value = |bin: usize| range.value_at(bin as f64 / BINS as f64);
    let is_wide = widest.len() as f64 >= MIN_GAP_SHARE * BINS as f64;
    is_wide.then(|| ValueRange::new(value(widest.start), value(widest.end)))
}

/// Returns the share of a volume's voxels from a value on.
fn share_above(volume: &Volume, value: f64) -> f64 {
    let range = volume.value_range();
    let first = ((range.share_of(value).clamp(0.0, 1.0) * BINS as f64) as usize).min(BINS - 1);
    let counts = value_counts(volume, range).unwrap_or_else(|| vec![1; BINS]);
    counts[first..].iter().sum::<usize>() as f64 / counts.iter().sum::<usize>().max(1) as f64
}

/// Counts all voxels by their values, in [`BINS`] bins; `None` for a volume of one value.
fn value_counts(volume: &Volume, range: ValueRange) -> Option<Vec<usize>> {
    ValueRange::non_degenerate(range.low, range.high)?;
    let slice = volume.dims()[0] * volume.dims()[1];
    let count_slice = |z: usize| {
        let mut counts = vec![0; BINS];
        for voxel in z * slice..(z + 1) * slice {
            let value = volume.samples().value(voxel);
            if range.contains(value) && volume.missing().is_none_or(|missing| !missing.contains(voxel)) {
                counts[((range.share_of(value) * BINS as f64) as usize).min(BINS - 1)] += 1;
            }
        }
        counts
    };
    let add = |mut sum: Vec<usize>, counts: Vec<usize>| {
        sum.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
        sum
    };
    Some((0..volume.dims()[2]).into_par_iter().map(count_slice).reduce(|| vec![0; BINS], add))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::first_look::{FirstLookOptions, first_settings, first_settings_with};
    use chiaroscuro_volume::{KindName, Samples};

    const N: usize = 32;

    /// Returns a pseudo-random number between 0 and 1.
    fn random(at: usize) -> f64 {
        let mut state = (at as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        state = (state ^ (state >> 31)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Returns places of seeds within a distance of the centre, apart from each other, in voxels.
    fn places(count: usize, reach: f64) -> Vec<[usize; 3]> {
        let mut places: Vec<[usize; 3]> = Vec::new();
        for at in 0.. {
            let place = [0, 1, 2].map(|axis| 4 + (random(3 * at + axis) * (N - 8) as f64) as usize);
            let from_centre = DVec3::from(place.map(|c| c as f64 - 15.5)).length();
            let is_apart = |other: &[usize; 3]| (0..3).any(|axis| place[axis].abs_diff(other[axis]) > 3);
            if from_centre < reach && places.iter().all(is_apart) {
                places.push(place);
            }
            if places.len() == count || at > 100_000 {
                return places;
            }
        }
        places
    }

    /// Returns a material by places relative to the centre, with seeds of an edge in voxels.
    fn seeds(
        material: impl Fn(DVec3, usize) -> f64,
        places: &[[usize; 3]],
        edge: usize,
        seed: f64,
    ) -> Volume {
        let value = |at: usize| {
            let place = [at % N, at / N % N, at / N / N];
            let is_in = |first: &[usize; 3]| {
                (0..3).all(|axis| (first[axis]..first[axis] + edge).contains(&place[axis]))
            };
            let p = DVec3::from(place.map(|c| c as f64 - 15.5));
            let own = places.iter().position(is_in).map(|number| seed * (1.0 + 0.3 * random(number)));
            own.unwrap_or_else(|| material(p, at)) as f32
        };
        Volume::with_spacing("t", [N; 3], DVec3::ONE, Samples::F32((0..N * N * N).map(value).collect()))
            .unwrap()
    }

    fn look(volume: &Volume) -> Settings {
        first_settings(volume, &Histogram::from_volume(volume))
    }

    fn is_for_small_objects(look: &Settings) -> bool {
        look.sampling.classification == ClassificationOrder::Pre
            && look.sampling.kernel == ReconstructionKernel::Prefiltered
            && look.shadows.kernel == ReconstructionKernel::Prefiltered
    }

    /// Asserts that a voxel of a value is opaque, whatever the kernel makes of its height.
    fn assert_shown(look: &Settings, seed: f64) {
        assert!(look.layer().transfer.opacity_at(seed) > 0.9, "{:?}", look.layer().transfer);
        assert!(is_for_small_objects(look));
    }

    fn phantom(p: DVec3, at: usize) -> f64 {
        if p.length() < 13.0 { 100.0 + 10.0 * random(at) } else { 5.0 * random(at) }
    }

    #[test]
    fn seeds_alone_are_opaque_whatever_surrounds_them() {
        let places = places(20, 15.0);
        for edge in [1, 2] {
            for (name, around) in [("nothing", 0.0), ("a level", 50.0)] {
                let volume = seeds(|_, _| around, &places, edge, 900.0);
                assert_shown(&look(&volume), 1000.0);
                let noisy = seeds(|_, at| around + 30.0 * random(at), &places, edge, 900.0);
                let look = look(&noisy);
                assert_shown(&look, 1000.0);
                let noise = look.layer().transfer.opacity_at(around + 30.0);
                assert!(noise < 0.01, "{name}: noise stays hidden: {noise}");
            }
        }
    }

    #[test]
    fn seeds_in_masks_are_opaque() {
        let places = places(20, 15.0);
        let value = |at: usize| u8::from(places.contains(&[at % N, at / N % N, at / N / N]));
        let samples = Samples::U8((0..N * N * N).map(value).collect());
        let mask = Volume::with_spacing("t", [N; 3], DVec3::ONE, samples).unwrap();
        assert_eq!(mask.kind().kind, DataKind::Mask);
        assert_shown(&look(&mask), 1.0);
    }

    #[test]
    fn colors_are_those_of_the_values() {
        let volume = seeds(|_, _| 0.0, &places(20, 15.0), 1, 900.0);
        let plain = crate::first_look::transfer_for_kind(&volume, &Histogram::from_volume(&volume), None);
        let (own, shown) = (plain.sample(1000.0).color, look(&volume).layer().transfer.sample(1000.0).color);
        let apart = own.iter().zip(shown).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // Colours between the dimmest and the brightest seeds are mixed: within a fifth of what those span.
        let ends = [900.0, 1170.0].map(|value| plain.sample(value).color);
        let span = ends[0].iter().zip(ends[1]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 0.2 * span, "{own:?} {shown:?} {span}");
    }

    #[test]
    fn seeds_in_a_phantom_are_seen_through_it() {
        for edge in [1, 2] {
            let volume = seeds(phantom, &places(12, 10.0), edge, 900.0);
            let look = look(&volume);
            assert_shown(&look, 1000.0);
            let glass = look.layer().transfer.opacity_at(105.0);
            assert!(glass < 0.05, "{glass}");
            // It is still there, and the whole of it framed.
            assert!(glass > 0.01, "{glass}");
            let plain = self::look(&seeds(phantom, &[], 1, 0.0));
            assert!((look.camera.distance / plain.camera.distance - 1.0).abs() < 0.05);
        }
    }

    #[test]
    fn electrodes_are_seen_through_bone() {
        let head = |p: DVec3, at: usize| match p.length() {
            r if r < 10.0 || (12.0..13.5).contains(&r) => 40.0 + 20.0 * random(at),
            r if r < 12.0 => 900.0 + 200.0 * random(at),
            _ => -1000.0 + 20.0 * random(at),
        };
        let wishes =
            FirstLookOptions { data_kind: Some(KindName::HounsfieldCt), ..FirstLookOptions::default() };
        let volume = seeds(head, &places(12, 7.0), 1, 3000.0);
        let look = first_settings_with(&volume, &Histogram::from_volume(&volume), wishes);
        assert_shown(&look, 3400.0);
        let bone = look.layer().transfer.opacity_at(1000.0);
        assert!(bone < 0.05, "{bone}");
    }

    #[test]
    fn noise_defects_and_larger_things_change_nothing() {
        let plain = look(&seeds(phantom, &[], 1, 0.0));
        assert!(!is_for_small_objects(&plain));
        let inside = places(12, 10.0);
        for (name, volume) in [
            ("two defects", seeds(phantom, &inside[..2], 1, 900.0)),
            ("a block", seeds(phantom, &inside[..3], 4, 900.0)),
            ("seeds hardly brighter", seeds(phantom, &inside, 1, 120.0)),
            // As many voxels anywhere: noise of the camera.
            ("salt", seeds(phantom, &places(12, 100.0), 1, 900.0)),
        ] {
            assert!(!is_for_small_objects(&look(&volume)), "{name}");
        }
        // White noise alone, and blocks alone.
        assert!(!is_for_small_objects(&look(&seeds(|_, at| random(at), &[], 1, 0.0))));
        assert!(!is_for_small_objects(&look(&seeds(|_, _| 0.0, &inside[..5], 4, 900.0))));
    }
}
