//! Fields that fill their box: they are as strong on its faces as within, and go on outside.

use chiaroscuro_volume::Volume;

/// Smallest ratio of the deviations on the faces of a volume to those within at which a field fills its box: layers
/// of rock and crystals have about 1, noise around two strong lobes 0.62, molecules within their box hardly more than
/// 0.
const MIN_FACE_STRENGTH: f64 = 0.75;

/// Returns true if a field deviates from its background as strongly on the faces of the volume as within, by root
/// mean squares: it has no margin, and goes on outside.
pub(super) fn fills_box(volume: &Volume, background: f64) -> bool {
    let dims = volume.dims();
    let step = volume.voxel_count().div_ceil(1 << 21).max(1);
    let matters = volume.ranges().robust;
    let (mut all, mut faces) = (MeanSquare::default(), MeanSquare::default());
    for voxel in (0..volume.voxel_count()).step_by(step) {
        let value = volume.samples().value(voxel);
        let is_missing = volume.missing().is_some_and(|missing| missing.contains(voxel));
        if is_missing || !matters.contains(value) {
            continue;
        }
        let place = [voxel % dims[0], voxel / dims[0] % dims[1], voxel / (dims[0] * dims[1])];
        all.add(value - background);
        if (0..3).any(|axis| place[axis] == 0 || place[axis] + 1 == dims[axis]) {
            faces.add(value - background);
        }
    }
    faces.root() >= MIN_FACE_STRENGTH * all.root()
}

/// Sum and count for a mean of squares.
#[derive(Default)]
struct MeanSquare {
    sum: f64,
    count: f64,
}

impl MeanSquare {
    fn add(&mut self, value: f64) {
        (self.sum, self.count) = (self.sum + value * value, self.count + 1.0);
    }

    fn root(&self) -> f64 {
        if self.count > 0.0 { (self.sum / self.count).sqrt() } else { 0.0 }
    }
}

/// Smallest share of the neighbours of strong values that are at least half as strong, of the same sign, in a field of
/// lobes or layers. Lobes have 0.9 and more; layers of one voxel, with four of six neighbours alike, two thirds; white
/// noise 0.2, and noise whose sign is smooth half.
const MIN_COHERENCE: f64 = 0.65;

/// Returns true if strong values, which are at least `strong` from zero, have strong neighbours: they are no noise.
pub(super) fn is_coherent(volume: &Volume, strong: f64) -> bool {
    let [nx, ny, nz] = volume.dims();
    let step = volume.voxel_count().div_ceil(1 << 20).max(1);
    let value = |voxel: usize| volume.samples().value(voxel);
    let (mut all, mut alike) = (0usize, 0usize);
    for voxel in (0..volume.voxel_count()).step_by(step) {
        let here = value(voxel);
        if here.abs() < strong {
            continue;
        }
        let [x, y, z] = [voxel % nx, voxel / nx % ny, voxel / (nx * ny)];
        let beside = [(x + 1 < nx, 1), (y + 1 < ny, nx), (z + 1 < nz, nx * ny)];
        for (_, offset) in beside.into_iter().filter(|(is_inside, _)| *is_inside) {
            let other = value(voxel + offset);
            all += 1;
            alike += usize::from(other * here > 0.0 && other.abs() >= strong / 2.0);
        }
    }
    alike as f64 >= MIN_COHERENCE * all as f64
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::sample_values;
    use super::*;
    use crate::first_look::first_settings;
    use chiaroscuro_volume::{Histogram, Samples};

    fn field(value: impl Fn(DVec3, usize) -> f64) -> Volume {
        const N: usize = 32;
        let place = |at: usize| DVec3::from([at % N, at / N % N, at / N / N].map(|c| c as f64 - 15.5));
        let samples = Samples::F32((0..N * N * N).map(|at| value(place(at), at) as f32).collect());
        Volume::with_spacing("t", [N; 3], DVec3::ONE, samples).unwrap()
    }

    /// Returns noise between −1 and 1.
    fn noise(at: usize) -> f64 {
        ((at as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40) as f64 / f64::from(1 << 23) - 1.0
    }

    /// Returns layers of two voxels, as rough across as noise, and smooth along.
    fn layers(p: DVec3, at: usize) -> f64 {
        let layer = ((p.z + 17.5 + 2.0 * (0.1 * p.x).sin()) / 2.0).floor() as usize;
        noise(layer * 31 + 7).powi(3) + 0.02 * noise(at)
    }

    #[test]
    fn what_goes_on_outside_is_told_from_what_has_a_margin() {
        let waves = |p: DVec3| (0.7 * p.x).sin() + (0.9 * p.y).cos();
        let ball = |p: DVec3| if p.length() < 10.0 { waves(p) } else { 0.0 };
        for mean in [0.0, 5.0] {
            assert!(fills_box(&field(|p, _| mean + waves(p)), mean));
            assert!(!fills_box(&field(|p, _| mean + ball(p)), mean));
            assert!(!fills_box(&field(|p, _| mean + waves(p) * (-0.03 * p.length_squared()).exp()), mean));
        }
    }

    #[test]
    fn layers_are_coherent_and_noise_is_not() {
        assert!(is_coherent(&field(layers), 0.5));
        assert!(is_coherent(&field(|p, _| (0.7 * p.x).sin()), 0.9));
        assert!(!is_coherent(&field(|_, at| noise(at)), 0.9));
    }

    #[test]
    fn a_tenth_of_layers_is_shown_without_glass_around_them() {
        // A tenth of zeros within, which are no background.
        let volume = field(|p, at| if p.z.abs() < 2.0 { 0.0 } else { layers(p, at) });
        let settings = first_settings(&volume, &Histogram::from_volume(&volume));
        let transfer = &settings.layer().transfer;
        let values = sample_values(&volume, |value| (value != 0.0).then_some(value));
        let shown = values.iter().filter(|&&value| transfer.opacity_at(value) > 0.0).count();
        let share = shown as f64 / values.len() as f64;
        assert!(share > 0.08, "{share}");
        let weakest = transfer.points.iter().map(|point| point.value.abs()).fold(f64::INFINITY, f64::min);
        assert!(weakest > 0.01 && transfer.opacity_at(0.01) == 0.0, "no glass: {weakest}");
    }
}
