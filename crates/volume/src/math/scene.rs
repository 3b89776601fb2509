//! Scene space: the space in which cameras and lights are placed.
//!
//! World space is in millimetres, as the file says. Scene space is world space translated and uniformly scaled (never
//! rotated or sheared) so that the centre of the volume's box is the origin and its longest edge runs from −1 to 1. A
//! camera or a light then means the same for a snail and for a skull, and a preset fits both.

use glam::{DAffine3, DMat3, DVec3};

use super::Aabb;

/// Transforms between a volume's index space and scene space, with voxel sizes in scene units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneSpace {
    /// Number of voxels along each index axis.
    pub dims: [usize; 3],
    /// Transform from index space (voxel centres at integers) to scene space.
    pub scene_from_index: DAffine3,
    /// Transform from scene space to index space.
    pub index_from_scene: DAffine3,
    /// Length of one scene unit in millimetres.
    pub mm_per_unit: f64,
    /// Lengths of a voxel's edges along the index axes, in scene units.
    pub voxel_edges: DVec3,
}

impl SceneSpace {
    /// Creates the scene space of a grid of `dims` voxels with `world_from_index` in millimetres.
    ///
    /// `world_from_index` must be invertible; `Volume` guarantees that.
    pub fn new(dims: [usize; 3], world_from_index: DAffine3) -> Self {
        let axes = world_from_index.matrix3;
        let edges_mm = DVec3::new(axes.x_axis.length(), axes.y_axis.length(), axes.z_axis.length());
        let counts = DVec3::new(dims[0] as f64, dims[1] as f64, dims[2] as f64);
        let mm_per_unit = (edges_mm * counts).max_element() / 2.0;
        let centre_mm = world_from_index.transform_point3((counts - 1.0) / 2.0);
        let scene_from_world = DAffine3 {
            matrix3: DMat3::from_diagonal(DVec3::splat(1.0 / mm_per_unit)),
            translation: -centre_mm / mm_per_unit,
        };
        let scene_from_index = scene_from_world * world_from_index;
        Self {
            dims,
            scene_from_index,
            index_from_scene: scene_from_index.inverse(),
            mm_per_unit,
            voxel_edges: edges_mm / mm_per_unit,
        }
    }

    /// Returns the shortest voxel edge in scene units: the unit of slab thickness and of the pixel size in the light
    /// pass.
    pub fn smallest_edge(&self) -> f64 {
        self.voxel_edges.min_element()
    }

    /// Returns the cube root of the voxel volume, in scene units: the edge of a cube with a voxel's volume.
    pub fn mean_edge(&self) -> f64 {
        self.scene_from_index.matrix3.determinant().abs().cbrt()
    }

    /// Returns the box that can hold material: the grid grown by the kernel's radius of two voxels, in index space.
    pub fn support_in_index(&self) -> Aabb {
        // Voxel centres end at 0 and n − 1; a kernel of radius 2 reaches two voxels beyond them.
        Aabb::of_grid(self.dims, 1.5)
    }

    /// Returns the corners of [`Self::support_in_index`] in scene space.
    pub fn support_corners(&self) -> [DVec3; 8] {
        self.support_in_index().corners().map(|corner| self.scene_from_index.transform_point3(corner))
    }

    /// Returns the radius of the sphere around the origin that holds all material, in scene units.
    pub fn support_radius(&self) -> f64 {
        self.support_corners().iter().map(|corner| corner.length()).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_edge_spans_two_units() {
        let spacing = DAffine3::from_scale(DVec3::new(0.5, 0.5, 3.0));
        let scene = SceneSpace::new([100, 60, 20], spacing);
        assert!((scene.mm_per_unit - 30.0).abs() < 1e-12, "20 slices of 3 mm are the longest edge");
        let middle = scene.scene_from_index.transform_point3(DVec3::new(49.5, 29.5, 9.5));
        assert!(middle.length() < 1e-12);
        assert!((scene.smallest_edge() - 0.5 / 30.0).abs() < 1e-12);
        assert!((scene.mean_edge() - 0.75f64.cbrt() / 30.0).abs() < 1e-12);
    }
}
