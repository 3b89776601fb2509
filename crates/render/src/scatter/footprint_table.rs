//! Tables of pre-integrated footprints, looked up by `scatter/footprint.wgsl`.

use chiaroscuro_scene::ReconstructionKernel;

/// Number of entries in a table, as in the shader.
const FOOTPRINT_SIZE: usize = 512;

/// Radius of the kernels, in voxels.
pub(crate) const RADIUS: f64 = 2.0;

/// Tabulates a Gaussian kernel of radius two voxels: its profile by the squared distance from the ray, and its
/// integral along the ray. Zeros for other kernels.
pub(crate) fn footprint_table(kernel: ReconstructionKernel) -> Vec<[f32; 2]> {
    let ReconstructionKernel::Gaussian { sigma } = kernel else { return vec![[0.0; 2]; FOOTPRINT_SIZE] };
    let variance = sigma * sigma;
    let across = |squared: f64| (-squared / (2.0 * variance)).exp() / (std::f64::consts::TAU * variance);
    let along = |t: f64| (-t * t / (2.0 * variance)).exp() / (std::f64::consts::TAU * variance).sqrt();
    let step = 2.0 * RADIUS / (FOOTPRINT_SIZE - 1) as f64;
    let mut integral = 0.0;
    (0..FOOTPRINT_SIZE)
        .map(|at| {
            let t = at as f64 * step - RADIUS;
            if at > 0 {
                // Simpson's rule; at a step of 1/128 voxel it is exact to 32 bits.
                integral += step / 6.0 * (along(t - step) + 4.0 * along(t - step / 2.0) + along(t));
            }
            let squared = at as f64 / (FOOTPRINT_SIZE - 1) as f64 * RADIUS * RADIUS;
            [across(squared) as f32, integral as f32]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pre_integrated_footprint_has_volume_one() {
        for sigma in [0.4, 0.6] {
            let table = footprint_table(ReconstructionKernel::Gaussian { sigma });
            // ∫ 2πr · across dr = ∫ π · across d(r²).
            let step = RADIUS * RADIUS / (FOOTPRINT_SIZE - 1) as f64;
            let disc: f64 =
                table.iter().map(|[across, _]| std::f64::consts::PI * f64::from(*across) * step).sum::<f64>()
                    - 0.5 * std::f64::consts::PI * step * f64::from(table[0][0]);
            let cut = (-RADIUS * RADIUS / (2.0 * sigma * sigma)).exp();
            assert!((disc - (1.0 - cut)).abs() < 1e-4, "σ {sigma}: {disc}");
            // A Gaussian of this width has some weight beyond two voxels.
            let length = f64::from(table[FOOTPRINT_SIZE - 1][1]);
            assert!((0.9990..1.0).contains(&length), "σ {sigma}: {length}");
        }
    }
}
