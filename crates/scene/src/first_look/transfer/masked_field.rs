//! Masked fields, known only in a part of their box, such as statistical maps of a brain: outside is exactly zero, or
//! missing.

use chiaroscuro_volume::Volume;

/// Smallest share of voxels outside the known part, and inside.
const MIN_SHARE: f64 = 0.1;

/// Smallest ratio of the field's median strength at the mask's edge to that inside: a masked field is as strong at
/// the edge as elsewhere (statistical maps of brains have 0.7 and more), while a fading one is next to nothing where
/// its last digits are zero.
const MIN_EDGE_STRENGTH: f64 = 0.3;

/// Returns the number of voxels in the known part of a field; `None` if it is known everywhere, or fades out.
pub(super) fn masked_voxel_count(volume: &Volume) -> Option<usize> {
    let [nx, ny, nz] = volume.dims();
    // Complete rows, subsampled: two million voxels are enough.
    let step = volume.voxel_count().div_ceil(1 << 21).max(1);
    let strength = |voxel: usize| {
        let is_missing = volume.missing().is_some_and(|missing| missing.contains(voxel));
        let value = volume.samples().value(voxel).abs();
        (!is_missing && value > 0.0).then_some(value)
    };
    let (mut all, mut inside, mut at_end) = (0usize, Vec::new(), Vec::new());
    for row in (0..ny * nz).step_by(step) {
        let strengths: Vec<Option<f64>> = (row * nx..(row + 1) * nx).map(strength).collect();
        all += nx;
        inside.extend(strengths.iter().flatten());
        for pair in strengths.windows(2) {
            at_end.extend(match pair {
                [Some(value), None] | [None, Some(value)] => Some(value),
                _ => None,
            });
        }
    }
    let share = inside.len() as f64 / all.max(1) as f64;
    let has_end = (MIN_SHARE..=1.0 - MIN_SHARE).contains(&share);
    let is_cut = median(&mut at_end)? >= MIN_EDGE_STRENGTH * median(&mut inside)?;
    (has_end && is_cut).then_some((share * volume.voxel_count() as f64) as usize)
}

/// Returns the median; `None` of an empty slice.
fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use chiaroscuro_volume::Samples;

    fn field(value: impl Fn(DVec3) -> f64) -> Volume {
        const N: usize = 32;
        let place = |at: usize| DVec3::from([at % N, at / N % N, at / N / N].map(|c| c as f64 - 15.5));
        let samples = Samples::F32((0..N * N * N).map(|at| value(place(at)) as f32).collect());
        Volume::with_spacing("t", [N; 3], DVec3::ONE, samples).unwrap()
    }

    #[test]
    fn what_is_cut_out_is_told_from_what_fades() {
        let waves = |p: DVec3| (0.7 * p.x).sin() + (0.9 * p.y).cos() + 1e-3;
        let ball = 4.0 / 3.0 * std::f64::consts::PI * 1000.0;
        for outside in [0.0, f64::NAN] {
            let cut = field(|p| if p.length() < 10.0 { waves(p) } else { outside });
            let known = masked_voxel_count(&cut).expect("it is cut");
            assert!((known as f64 / ball - 1.0).abs() < 0.05, "{known}");
        }
        assert_eq!(masked_voxel_count(&field(waves)), None, "it is known everywhere");
        let fading = field(|p| {
            let value = waves(p) * (-0.05 * p.length_squared()).exp();
            // As if it were written with three digits.
            (value * 1000.0).round() / 1000.0
        });
        assert_eq!(masked_voxel_count(&fading), None);
    }
}
