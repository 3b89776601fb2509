//! Clusters of voxels: connected components of the few voxels of a class, by 26-connectivity.

use std::collections::HashSet;

use rayon::prelude::*;

use chiaroscuro_volume::Volume;

/// Largest number of voxels of a cluster that is tiny: a cube of two voxels' edge.
const MAX_TINY_VOXELS: usize = 8;

/// Largest number of voxels of classes whose clusters are counted: more would take seconds.
const MAX_VOXELS: usize = 1 << 19;

/// Clusters of a class of voxels.
#[derive(Debug, Clone)]
pub(super) struct VoxelClusters {
    /// Voxels of the tiny clusters, a list for each.
    pub tiny: Vec<Vec<usize>>,
    /// Number of voxels in other clusters.
    pub other_voxels: usize,
}

impl VoxelClusters {
    /// Largest share of the volume's voxels in classes whose clusters are counted: more of them are no spots.
    pub(super) const MAX_SHARE: f64 = 0.01;

    /// Finds the clusters of the voxels whose value is in a class; `None` if they are too many for spots, or none.
    pub(super) fn find(volume: &Volume, is_in_class: impl Fn(f64) -> bool + Sync) -> Option<Self> {
        let most = ((volume.voxel_count() as f64 * Self::MAX_SHARE) as usize).clamp(1, MAX_VOXELS);
        let (samples, missing) = (volume.samples(), volume.missing());
        let is_there = |voxel: usize| missing.is_none_or(|missing| !missing.contains(voxel));
        let slice = volume.dims()[0] * volume.dims()[1];
        let found: Vec<usize> = (0..volume.dims()[2])
            .into_par_iter()
            .flat_map_iter(|z| {
                let voxels = z * slice..(z + 1) * slice;
                let of_class = voxels.filter(|&voxel| is_in_class(samples.value(voxel)) && is_there(voxel));
                // One more than allowed is enough to know.
                of_class.take(most + 1).collect::<Vec<_>>()
            })
            .collect();
        if found.is_empty() || found.len() > most {
            return None;
        }
        let mut left: HashSet<usize> = found.iter().copied().collect();
        let mut clusters = Self { tiny: Vec::new(), other_voxels: 0 };
        for start in found {
            if !left.remove(&start) {
                continue;
            }
            let (mut cluster, mut at) = (vec![start], 0);
            while let Some(&voxel) = cluster.get(at) {
                at += 1;
                for_each_neighbour(volume.dims(), voxel, |next| {
                    if left.remove(&next) {
                        cluster.push(next);
                    }
                });
            }
            if cluster.len() <= MAX_TINY_VOXELS {
                clusters.tiny.push(cluster);
            } else {
                clusters.other_voxels += cluster.len();
            }
        }
        Some(clusters)
    }

    /// Returns the share of the voxels in tiny clusters.
    pub(super) fn tiny_share(&self) -> f64 {
        let tiny: usize = self.tiny.iter().map(Vec::len).sum();
        tiny as f64 / (tiny + self.other_voxels).max(1) as f64
    }

    /// Returns the value of the material around each tiny cluster: the one that four of six places beside it reach, for
    /// surfaces and neighbouring clusters may take the others. Minus infinity at the border of the grid.
    pub(super) fn surroundings(&self, volume: &Volume) -> Vec<f64> {
        let [nx, ny, nz] = volume.dims();
        let around = |cluster: &Vec<usize>| {
            let place = [cluster[0] % nx, cluster[0] / nx % ny, cluster[0] / (nx * ny)];
            let sides = (0..3).flat_map(|axis| [-1isize, 1].map(|side| (axis, side)));
            let mut values: Vec<f64> = sides
                .map(|(axis, side)| {
                    let mut beside = place;
                    // A voxel is left out on either side of a cube of two, as a surface may be blurred.
                    beside[axis] = place[axis].wrapping_add_signed(if side > 0 { 3 } else { -2 });
                    let is_in_grid = beside[0] < nx && beside[1] < ny && beside[2] < nz;
                    if is_in_grid { volume.value(beside[0], beside[1], beside[2]) } else { f64::NEG_INFINITY }
                })
                .collect();
            values.sort_unstable_by(|a, b| b.total_cmp(a));
            values[3]
        };
        self.tiny.iter().map(around).collect()
    }

    /// Returns the highest values of the tiny clusters, sorted.
    pub(super) fn peaks(&self, volume: &Volume) -> Vec<f64> {
        let highest = |cluster: &Vec<usize>| {
            let values = cluster.iter().map(|&voxel| volume.samples().value(voxel));
            values.fold(f64::NEG_INFINITY, f64::max)
        };
        let mut peaks: Vec<f64> = self.tiny.iter().map(highest).collect();
        peaks.sort_unstable_by(f64::total_cmp);
        peaks
    }
}

/// Calls a function with each of the 26 neighbours of a voxel that lie in the grid.
fn for_each_neighbour([nx, ny, nz]: [usize; 3], voxel: usize, mut call: impl FnMut(usize)) {
    let [x, y, z] = [voxel % nx, voxel / nx % ny, voxel / (nx * ny)];
    let near = |at: usize, count: usize| at.saturating_sub(1)..=(at + 1).min(count - 1);
    for z in near(z, nz) {
        for y in near(y, ny) {
            for x in near(x, nx) {
                let next = (z * ny + y) * nx + x;
                if next != voxel {
                    call(next);
                }
            }
        }
    }
}
