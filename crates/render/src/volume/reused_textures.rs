//! Textures of an earlier picture of the same volume that hold for the next one.

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use super::presence::PresenceTextures;
use super::pyramid::density_pyramid::DensityPyramid;
use chiaroscuro_volume::{Observer, Volume, VoxelMask};

/// Textures that are kept where a picture shows the same voxels in another way.
#[derive(Debug, Default)]
pub(crate) struct ReusedTextures {
    /// Densities with their pyramid, if they represent the same quantity.
    pub density: Option<(wgpu::Texture, Option<DensityPyramid>)>,
    /// Presence, with the mask for which it was uploaded.
    pub presence: Option<(PresenceTextures, Option<Arc<VoxelMask>>)>,
}

/// Returns the box of voxels in which two masks of a volume differ for an observer; `None` if they are equal.
pub(crate) fn changed_box(
    volume: &Volume,
    observer: Observer,
    before: Option<&VoxelMask>,
    after: Option<&VoxelMask>,
) -> Option<[Range<usize>; 3]> {
    let [nx, ny, nz] = volume.dims();
    let all_visible = vec![0; nx];
    let changes = (0..ny * nz).into_par_iter().filter_map(|row| {
        let [old, new] = [before, after].map(|mask| {
            mask.map_or(&all_visible[..], |mask| &mask.hidden_from(observer)[row * nx..(row + 1) * nx])
        });
        if old == new {
            return None;
        }
        let differs = |x: &usize| old[*x] != new[*x];
        let (first, last) = ((0..nx).find(differs)?, (0..nx).rev().find(differs)?);
        let (y, z) = (row % ny, row / ny);
        Some([first..last + 1, y..y + 1, z..z + 1])
    });
    changes.reduce_with(|a, b| {
        [0, 1, 2].map(|axis| a[axis].start.min(b[axis].start)..a[axis].end.max(b[axis].end))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_volume::Samples;
    use glam::DVec3;

    #[test]
    fn the_box_holds_all_changes() {
        let samples = Samples::U8((0..60).collect());
        let volume = Volume::with_spacing("t", [4, 3, 5], DVec3::ONE, samples).unwrap();
        let mask = |hidden: &[usize]| {
            let shares = (0..60).map(|voxel| u8::from(hidden.contains(&voxel))).collect();
            VoxelMask::from_hidden_shares([4, 3, 5], shares)
        };
        let changed = |before: &[usize], after: &[usize]| {
            changed_box(&volume, Observer::Eye, mask(before).as_ref(), mask(after).as_ref())
        };
        assert_eq!(changed(&[], &[]), None);
        // Voxel 13 is (1, 0, 1), and voxel 59 is the last.
        assert_eq!(changed(&[], &[13]), Some([1..2, 0..1, 1..2]));
        assert_eq!(changed(&[13, 59], &[13]), Some([3..4, 2..3, 4..5]));
        assert_eq!(changed(&[13, 59], &[14]), Some([1..4, 0..3, 1..5]));
    }
}
