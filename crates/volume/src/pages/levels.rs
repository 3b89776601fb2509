//! Levels of an image that are finer than the volume in memory, and the addresses of their pages.

use glam::{DAffine3, DMat3, DVec3};

use crate::math::SceneSpace;

/// Edge of a page, in voxels.
pub const PAGE_EDGE: usize = 64;

/// Level of an image that is finer than the volume in memory.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FinerLevel {
    /// Number of voxels along x, y and z.
    pub dims: [usize; 3],
    /// Number of its voxels along each edge of a voxel in memory.
    pub per_voxel: [usize; 3],
    /// Name of the level, as in [`crate::VolumeOffer::key`].
    pub key: String,
}

/// Levels of an image that are finer than the volume in memory, finest first.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FinerLevels(pub Vec<FinerLevel>);

/// Place of a page: its level, as an index into [`FinerLevels`], and its position along x, y and z, in pages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PageAddress {
    /// Index of the level, 0 for the finest.
    pub level: usize,
    /// Position along x, y and z, in pages.
    pub at: [usize; 3],
}

impl FinerLevel {
    /// Returns the number of pages along x, y and z.
    pub fn page_dims(&self) -> [usize; 3] {
        self.dims.map(|n| n.div_ceil(PAGE_EDGE))
    }

    /// Returns the scene space of the level's own grid, in which the scene is that of the volume in memory.
    pub fn scene(&self, volume: &SceneSpace) -> SceneSpace {
        let per = DVec3::from(self.per_voxel.map(|n| n as f64));
        // Both grids begin at the same corner, half a voxel before the centre of the first.
        let volume_from_level =
            DAffine3 { matrix3: DMat3::from_diagonal(1.0 / per), translation: 0.5 / per - 0.5 };
        let scene_from_index = volume.scene_from_index * volume_from_level;
        SceneSpace {
            dims: self.dims,
            scene_from_index,
            index_from_scene: scene_from_index.inverse(),
            mm_per_unit: volume.mm_per_unit,
            voxel_edges: volume.voxel_edges / per,
        }
    }
}

impl FinerLevels {
    /// Creates the levels that lie on the grid of a volume in memory of `dims` voxels, among levels that are given by
    /// their dimensions and keys, finest first: each has half the voxels of the one before it along the axes that it
    /// divides. Levels with other ratios of edges are left out, and so are those that are finer than a level which is absent.
    pub fn of_volume(dims: [usize; 3], levels: impl IntoIterator<Item = ([usize; 3], String)>) -> Self {
        let on_grid = levels.into_iter().filter_map(|(fine, key)| {
            let per_voxel =
                [0, 1, 2].map(|axis| ((fine[axis] as f64 / dims[axis] as f64).round() as usize).max(1));
            let fits = (0..3).all(|axis| {
                per_voxel[axis].is_power_of_two()
                    && fine[axis].abs_diff(per_voxel[axis] * dims[axis]) < per_voxel[axis]
            });
            (fits && per_voxel != [1; 3]).then_some(FinerLevel { dims: fine, per_voxel, key })
        });
        let mut coarse_first: Vec<FinerLevel> = on_grid.collect();
        coarse_first.reverse();
        // Kernels that are twice as wide read the next level (shaders/volume/pages.wgsl).
        let is_next =
            |(index, level): &(usize, FinerLevel)| level.per_voxel.into_iter().max() == Some(2 << index);
        let mut levels: Vec<_> = coarse_first.into_iter().enumerate().take_while(is_next).collect();
        levels.reverse();
        Self(levels.into_iter().map(|(_, level)| level).collect())
    }

    /// Returns true if there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_lie_on_the_grid_of_the_volume() {
        let offers =
            [([201, 200, 50], "0"), ([150, 150, 50], "odd"), ([101, 100, 50], "1"), ([51, 50, 50], "2")];
        let levels = FinerLevels::of_volume([51, 50, 50], offers.map(|(dims, key)| (dims, key.to_owned())));
        let found: Vec<_> = levels.0.iter().map(|level| (level.key.as_str(), level.per_voxel)).collect();
        assert_eq!(found, [("0", [4, 4, 1]), ("1", [2, 2, 1])]);
        assert_eq!(levels.0[0].page_dims(), [4, 4, 1]);
    }

    #[test]
    fn levels_beyond_a_gap_are_left_out() {
        let of = |edges: &[usize]| {
            let offers = edges.iter().map(|&edge| ([edge; 3], edge.to_string()));
            let levels = FinerLevels::of_volume([32; 3], offers);
            levels.0.into_iter().map(|level| level.key).collect::<Vec<_>>()
        };
        assert_eq!(of(&[128, 64, 32]), ["128", "64"]);
        assert_eq!(of(&[256, 64, 32]), ["64"]);
        assert_eq!(of(&[128, 32]), [""; 0]);
    }

    #[test]
    fn a_corner_of_the_grid_is_one_place_on_all_levels() {
        let volume = SceneSpace::new([20, 10, 8], DAffine3::from_scale(DVec3::new(2.0, 2.0, 1.0)));
        let level = FinerLevel { dims: [40, 20, 8], per_voxel: [2, 2, 1], key: String::new() };
        let scene = level.scene(&volume);
        let corner = |scene: &SceneSpace| scene.scene_from_index.transform_point3(DVec3::splat(-0.5));
        assert!((corner(&volume) - corner(&scene)).length() < 1e-12);
        assert!((scene.voxel_edges * DVec3::new(2.0, 2.0, 1.0) - volume.voxel_edges).length() < 1e-12);
    }
}
