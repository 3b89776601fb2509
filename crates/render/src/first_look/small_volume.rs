//! Downsampled volume for trying many settings in a short time.

use super::balance::{MEASURED_SIZE, with_fast_shadows};
use crate::GpuError;
use crate::plan::preview_slab;
use chiaroscuro_scene::{
    LightVolumeResolution, OpacityLength, ReconstructionKernel, RenderEngine, Settings, SlabMode,
};
use chiaroscuro_volume::{Dataset, Volume, block_counts};

/// Maximum number of voxels: 96³, for which a software adapter fills a light volume in a few hundredths of a second.
const MAX_VOXELS: usize = 96 * 96 * 96;

/// Returns the volume itself if it is small, else one with averaged blocks that are about as long along every axis.
///
/// # Errors
/// Returns an error if the averaged voxels do not form a valid volume.
pub fn downsampled_volume(dataset: &Dataset) -> Result<Dataset, GpuError> {
    let volume = dataset.volume();
    let block = smallest_sufficient_block(volume.dims(), volume.spacing_mm().into());
    if block == [1; 3] {
        return Ok(dataset.clone());
    }
    let small = volume.to_block_averaged(block)?;
    let further = dataset.fields()[1..].iter().map(|field| field.volume().to_block_averaged(block));
    Ok(Dataset::from_volumes(small, further.collect::<Result<Vec<_>, _>>()?))
}

/// Returns the smallest block size, in voxels, with at most `MAX_VOXELS` blocks.
fn smallest_sufficient_block(dims: [usize; 3], spacing_mm: [f64; 3]) -> [usize; 3] {
    let shortest = spacing_mm.into_iter().fold(f64::INFINITY, f64::min);
    let mut edge = 1.0;
    loop {
        let block = [0, 1, 2].map(|axis| {
            let count = (edge * shortest / spacing_mm[axis]).round() as usize;
            count.clamp(1, dims[axis].max(1))
        });
        let left: usize = block_counts(dims, block).iter().product();
        if left <= MAX_VOXELS {
            return block;
        }
        // At least one axis that is not fully averaged gets longer blocks; spacings may differ by many orders of
        // magnitude.
        let longer = (0..3).filter(|&axis| block[axis] < dims[axis]);
        let next = longer.map(|axis| (block[axis] as f64 + 0.5) * spacing_mm[axis] / shortest);
        edge = next.fold(f64::INFINITY, f64::min).max(edge + 1.0);
    }
}

/// Returns the settings for a downsampled volume, with the fast kernels and slabs of previews.
pub(super) fn fast_settings(settings: &Settings, whole: &Volume, small: &Volume) -> Settings {
    let mut quick = with_fast_shadows(settings);
    // Opacities keep their reference length, although voxels are larger.
    let scene = whole.scene();
    for layer in quick.layers.iter_mut() {
        if let OpacityLength::Voxels(_) = layer.opacity_unit {
            layer.opacity_unit =
                OpacityLength::Mm(layer.opacity_unit.scene_units(&scene) * scene.mm_per_unit);
        }
    }
    quick.shadows.resolution = LightVolumeResolution::Full;
    (quick.shadows.kernel, quick.sampling.kernel) =
        (ReconstructionKernel::Prefiltered, ReconstructionKernel::Prefiltered);
    quick.sampling.engine = RenderEngine::Gather;
    let slab = quick.equivalent_even_slab();
    quick.sampling.slabs = SlabMode::Even;
    quick.sampling.slab = preview_slab(&quick.camera, &small.scene(), MEASURED_SIZE, slab);
    quick
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_cubes_of_the_world() {
        for (dims, spacing_mm, expected) in [
            ([96; 3], [1.0; 3], [1; 3]),
            ([128; 3], [1.0; 3], [2; 3]),
            ([512; 3], [0.3; 3], [6; 3]),
            ([301, 324, 56], [1.0, 1.0, 1.4], [3, 3, 2]),
            ([512, 512, 40], [0.5, 0.5, 5.0], [4, 4, 1]),
            ([1 << 20, 1, 1], [1.0; 3], [2, 1, 1]),
            ([512; 3], [1.0, 1.0, 1e-9], [1, 1, 171]),
            ([2048, 2048, 2], [1.0, 1.0, 1e-9], [3, 3, 2]),
        ] {
            assert_eq!(smallest_sufficient_block(dims, spacing_mm), expected, "{dims:?} {spacing_mm:?}");
        }
    }

    #[test]
    fn every_volume_becomes_small() {
        for n in [1usize, 7, 100, 333, 1024, 4096] {
            for flat in [1usize, 30, n] {
                for thick in [0.01, 1.0, 100.0] {
                    let dims = [n, n, flat];
                    let block = smallest_sufficient_block(dims, [1.0, 1.0, thick]);
                    assert!(block_counts(dims, block).iter().product::<usize>() <= MAX_VOXELS, "{dims:?}");
                }
            }
        }
    }
}
