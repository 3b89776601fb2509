//! Slice order of axis-aligned sheets, along the volume's own axes (the paper's references 25 and 26).

use crate::plan::SheetFrame;

/// Slices of voxels in the order in which a view traverses them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SliceOrder {
    /// Axis of index space closest to the view direction.
    pub axis: usize,
    /// Index of the first slice.
    pub first: usize,
    /// Step from slice to slice: +1 or −1.
    pub direction: i32,
    /// Number of slices along the axis.
    pub count: u32,
}

impl SliceOrder {
    /// Computes the order in which the view through the middle of a frame traverses the slices of a grid.
    pub fn new(frame: &SheetFrame, dims: [usize; 3]) -> Self {
        let [w, h] = frame.size.map(f64::from);
        let forward = frame.direction.at(w / 2.0 - 0.5, h / 2.0 - 0.5).to_array();
        let axis =
            (1..3).fold(0, |best, axis| if forward[axis].abs() > forward[best].abs() { axis } else { best });
        let count = dims[axis];
        let (first, step) = if forward[axis] < 0.0 { (count - 1, -1) } else { (0, 1) };
        Self { axis, first, direction: step, count: count as u32 }
    }

    /// Returns the index of the k-th slice in this order.
    pub fn slice(&self, k: u32) -> usize {
        (self.first as i64 + i64::from(self.direction) * i64::from(k)) as usize
    }
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;

    use super::*;
    use crate::plan::geometry::eye_frame::eye_frame;
    use chiaroscuro_scene::{Camera, Projection};
    use chiaroscuro_volume::math::SceneSpace;

    #[test]
    fn the_axis_changes_at_forty_five_degrees() {
        let scene = SceneSpace::new([20, 16, 12], DAffine3::IDENTITY);
        let order = |azimuth_deg: f64| {
            let camera = Camera {
                projection: Projection::Orthographic,
                azimuth_deg,
                elevation_deg: 0.0,
                ..Camera::default()
            };
            SliceOrder::new(&eye_frame(&camera, &scene, [32, 24], 1.0), scene.dims)
        };
        // From +x, the highest x comes first.
        assert_eq!(order(44.0), SliceOrder { axis: 0, first: 19, direction: -1, count: 20 });
        assert_eq!(order(46.0), SliceOrder { axis: 1, first: 15, direction: -1, count: 16 });
        assert_eq!(order(-91.0), SliceOrder { axis: 1, first: 0, direction: 1, count: 16 });
        assert_eq!(order(-91.0).slice(3), 3);
        assert_eq!(order(46.0).slice(3), 12);
    }
}
