//! Sweep frames: parallel rays in each direction of a sky's light through a grid of blocks.

use glam::{DVec2, DVec3};

use chiaroscuro_volume::math::SceneSpace;

/// Parallel rays through a grid of blocks of voxels. They cross its slices along one axis of the grid at their
/// middles, so that any position stays between the same four rays during a whole step.
///
/// Lengths are in blocks; slices are counted in the direction of the light.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepFrame {
    /// Unit vector towards the source of the light, in scene space.
    pub towards: DVec3,
    /// Grid axis across which the slices lie: the one along which the light advances fastest.
    pub axis: usize,
    /// True if light travels in the positive direction of that axis.
    pub is_ascending: bool,
    /// Number of blocks along x, y and z.
    pub dims: [usize; 3],
    /// Displacement of a ray from slice to slice, in blocks along the two axes that follow `axis` cyclically.
    pub drift: DVec2,
    /// Position at which ray (0, 0) crosses the first slice, along the two axes that follow `axis`.
    pub first: [i32; 2],
    /// Number of rays along the two axes that follow `axis`.
    pub size: [u32; 2],
    /// Length of a ray between two slices, in scene units.
    pub step: f64,
}

/// Position in the slices of a sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlicePosition {
    /// Slice coordinate, which may lie between slices and outside the grid.
    pub slice: f64,
    /// Position along the two axes that follow the axis of the slices.
    pub across: DVec2,
}

impl SweepFrame {
    /// Creates the rays from a direction through blocks of `divisor`³ voxels.
    pub fn new(scene: &SceneSpace, divisor: usize, towards: DVec3) -> Self {
        let dims = scene.dims.map(|n| n.div_ceil(divisor));
        // Blocks per scene unit along the ray, against the direction of light.
        let speed = scene.index_from_scene.transform_vector3(towards) / divisor as f64;
        let along = speed.to_array();
        let axis =
            (0..3).fold(0, |best, axis| if along[axis].abs() > along[best].abs() { axis } else { best });
        let step = 1.0 / along[axis].abs();
        let across = [(axis + 1) % 3, (axis + 2) % 3];
        let drift = across.map(|axis| -along[axis] * step);
        let last = dims[axis] as f64 - 1.0;
        // A position x in slice n has ray coordinate x − n · drift.
        let first = drift.map(|drift| (-last * drift).min(0.0).floor() as i32);
        let size = [0, 1].map(|side| {
            let end = dims[across[side]] as f64 - 1.0 + (-last * drift[side]).max(0.0);
            // One more ray to interpolate with.
            (end.ceil() as i32 - first[side] + 2) as u32
        });
        Self { towards, axis, is_ascending: along[axis] < 0.0, dims, drift: drift.into(), first, size, step }
    }

    /// Returns the number of slices.
    pub fn slices(&self) -> usize {
        self.dims[self.axis]
    }

    /// Returns the block coordinates of a position in a slice.
    pub fn block_position(&self, slice: f64, across: DVec2) -> DVec3 {
        let last = self.slices() as f64 - 1.0;
        let mut at = [0.0; 3];
        at[self.axis] = if self.is_ascending { slice } else { last - slice };
        at[(self.axis + 1) % 3] = across.x;
        at[(self.axis + 2) % 3] = across.y;
        at.into()
    }

    /// Returns the slice coordinate of a position in blocks, which may lie between slices and outside the grid, and
    /// its position across.
    pub fn slice_position(&self, block: DVec3) -> SlicePosition {
        let along = block[self.axis];
        let slice = if self.is_ascending { along } else { self.slices() as f64 - 1.0 - along };
        SlicePosition { slice, across: DVec2::new(block[(self.axis + 1) % 3], block[(self.axis + 2) % 3]) }
    }

    /// Returns the slice coordinate of a position in blocks, which may lie between slices and outside the grid, and
    /// its ray coordinates in that slice.
    pub fn ray_position(&self, block: DVec3) -> SlicePosition {
        let SlicePosition { slice, across } = self.slice_position(block);
        let first = DVec2::new(self.first[0].into(), self.first[1].into());
        SlicePosition { slice, across: across - self.drift * slice - first }
    }

    /// Returns the position at which a ray crosses a slice, along the two axes that follow `axis`.
    pub fn crossing(&self, ray: [u32; 2], slice: usize) -> DVec2 {
        let ray = DVec2::new(
            f64::from(ray[0]) + f64::from(self.first[0]),
            f64::from(ray[1]) + f64::from(self.first[1]),
        );
        ray + self.drift * slice as f64
    }
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;

    use super::*;
    use chiaroscuro_scene::sweep_directions;

    #[test]
    fn every_block_lies_between_rays_that_there_are() {
        let scene = SceneSpace::new([13, 20, 7], DAffine3::from_scale(DVec3::new(1.0, 0.7, 2.0)));
        for divisor in [1, 2, 4] {
            for towards in sweep_directions(24) {
                let frame = SweepFrame::new(&scene, divisor, towards);
                assert!(frame.drift.abs().max_element() <= 1.0 + 1e-12, "{frame:?}");
                let [nx, ny, nz] = frame.dims;
                for block in (0..nx * ny * nz).map(|at| [at % nx, at / nx % ny, at / (nx * ny)]) {
                    let wanted = DVec3::from(block.map(|at| at as f64));
                    let SlicePosition { slice, across: ray } = frame.ray_position(wanted);
                    assert!(ray.min_element() >= -1e-9, "{ray}");
                    let next = ray.floor() + 1.0;
                    assert!(next.x < f64::from(frame.size[0]) && next.y < f64::from(frame.size[1]), "{ray}");
                    // Converts back.
                    let nearest = [ray.x.floor() as u32, ray.y.floor() as u32];
                    let across = frame.crossing(nearest, slice as usize) + ray.fract();
                    let found = frame.block_position(slice, across);
                    assert!((found - wanted).length() < 1e-9, "{found} {wanted}");
                }
            }
        }
    }

    #[test]
    fn a_step_is_as_long_as_the_way_between_slices() {
        let scene = SceneSpace::new([16, 16, 16], DAffine3::IDENTITY);
        let slanting = DVec3::new(3.0, 0.0, 4.0).normalize();
        let frame = SweepFrame::new(&scene, 2, slanting);
        assert_eq!((frame.axis, frame.is_ascending), (2, false));
        // Two voxels are a quarter of half the edge.
        assert!((frame.step - 0.25 / 0.8).abs() < 1e-12, "{}", frame.step);
        assert!((frame.drift - DVec2::new(-0.75, 0.0)).length() < 1e-12, "{}", frame.drift);
    }
}
