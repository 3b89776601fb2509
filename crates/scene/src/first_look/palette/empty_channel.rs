//! Recognition of channels in which nothing was recorded but noise.

use chiaroscuro_volume::Volume;

/// Largest correlation of neighbouring voxels of noise: independent noise has a hundredth at most where it is sampled;
/// things as bright as the noise is deep, in a tenth of the volume, 0.08.
const MAX_NOISE_CORRELATION: f64 = 0.06;

/// Largest ratio of the distances from the median to the largest ten-thousandth and to the largest hundredth of noise:
/// normal noise has 1.6, and that of a few photons 2. Single voxels that are bright on purpose, as of molecules, have
/// ten and more.
const MAX_NOISE_TAIL: f64 = 3.0;

/// Returns true if the voxels of a volume are as good as independent of their neighbours, and none of them stands out.
pub(super) fn is_only_noise(volume: &Volume) -> bool {
    let median = volume.quantile(0.5);
    let [high, highest] = [0.99, 0.9999].map(|share| volume.quantile(share) - median);
    high > 0.0 && highest < MAX_NOISE_TAIL * high && correlation(volume) < MAX_NOISE_CORRELATION
}

/// Correlation of the values of neighbouring voxels in the slices of a volume, of a million pairs at most.
fn correlation(volume: &Volume) -> f64 {
    let dims = volume.dims();
    let count = volume.voxel_count();
    // A step of odd length visits all columns.
    let step = count.div_ceil(1 << 20) | 1;
    let is_present = |voxel: usize| volume.missing().is_none_or(|missing| !missing.contains(voxel));
    let pairs = || {
        (0..count.saturating_sub(dims[0])).step_by(step).flat_map(|voxel| {
            let place = [voxel % dims[0], voxel / dims[0] % dims[1]];
            let beside = [(0, 1), (1, dims[0])].into_iter();
            beside
                .filter(move |&(axis, _)| place[axis] + 1 < dims[axis])
                .map(move |(_, by)| [voxel, voxel + by])
        })
    };
    let values = || {
        let present = pairs().filter(|pair| pair.iter().all(|&voxel| is_present(voxel)));
        present.map(|pair| pair.map(|voxel| volume.samples().value(voxel)))
    };
    let (mut sum, mut number) = (0.0, 0.0);
    for [a, b] in values() {
        (sum, number) = (sum + a + b, number + 2.0);
    }
    let mean = sum / f64::max(number, 1.0);
    let (mut together, mut squares) = (0.0, 0.0);
    for [a, b] in values() {
        together += (a - mean) * (b - mean);
        squares += 0.5 * ((a - mean).powi(2) + (b - mean).powi(2));
    }
    if squares > 0.0 { together / squares } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_volume::Samples;
    use glam::DVec3;

    const EDGE: usize = 32;

    /// Sum of twelve numbers of a linear congruential generator, nearly normal, with a standard deviation of 1.
    fn noise(at: usize) -> f64 {
        let mut state = (at as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        (0..12).map(|_| next()).sum::<f64>() - 6.0
    }

    fn volume(value: impl Fn(usize) -> f64) -> Volume {
        let values = (0..EDGE.pow(3)).map(|at| (500.0 + value(at)) as i16).collect();
        Volume::with_spacing("v", [EDGE; 3], DVec3::ONE, Samples::I16(values)).unwrap()
    }

    #[test]
    fn noise_alone_is_told_from_faint_things() {
        assert!(is_only_noise(&volume(|at| 8.0 * noise(at))));
        let radius = |at: usize| {
            let place = DVec3::new((at % EDGE) as f64, (at / EDGE % EDGE) as f64, (at / EDGE / EDGE) as f64);
            place.distance(DVec3::splat(15.5))
        };
        let faint = |at: usize| 8.0 * noise(at) + if radius(at) < 8.0 { 12.0 } else { 0.0 };
        assert!(!is_only_noise(&volume(faint)), "a ball one and a half deviations above its surroundings");
        let spots = |at: usize| 8.0 * noise(at) + if at % 911 == 5 { 300.0 } else { 0.0 };
        assert!(!is_only_noise(&volume(spots)), "single voxels");
        assert!(!is_only_noise(&volume(|_| 0.0)), "nothing, which has no range either");
    }
}
