//! Anti-aliased voxelisation of scenes made of shapes.
//!
//! A voxel gets `value · clamp(½ − d / w, 0, 1)`, with d the distance of its centre from the surface and w its edge:
//! a ramp of one voxel, close to the share of the voxel that is inside. After M. Šrámek, A. Kaufman, "Alias-free
//! voxelization of geometric objects", IEEE TVCG 5(3), 1999.

use glam::DVec3;

use super::super::load_context::{LoadContext, LoadControl, LoadError};
use super::UnitGrid;
use super::shapes::SdfShape;

/// Shape with the value of the voxels inside it.
#[derive(Debug, Clone, Copy)]
pub(super) struct ScenePart {
    pub(super) value: u8,
    pub(super) shape: SdfShape,
}

/// Computes the voxels of a scene; where parts overlap, the largest value wins.
pub(super) fn voxelise(
    grid: UnitGrid,
    parts: &[ScenePart],
    context: LoadContext<'_>,
    control: &LoadControl,
) -> Result<Vec<u8>, LoadError> {
    let edge = grid.voxel_edge();
    grid.fill(context, control, |z, slice| {
        for part in parts {
            // The ramp ends half a voxel outside the shape, so that only its bounding box is visited.
            let bounds = part.shape.bounds();
            let (min, max) = (bounds.min - edge / 2.0, bounds.max + edge / 2.0);
            if !grid.range(min.z, max.z).contains(&z) {
                continue;
            }
            let columns = grid.range(min.x, max.x);
            for y in grid.range(min.y, max.y) {
                for x in columns.clone() {
                    let p = DVec3::new(grid.centre(x), grid.centre(y), grid.centre(z));
                    let coverage = (0.5 - part.shape.distance(p) / edge).clamp(0.0, 1.0);
                    let value = (f64::from(part.value) * coverage).round() as u8;
                    let voxel = &mut slice[y * grid.n + x];
                    *voxel = value.max(*voxel);
                }
            }
        }
    })
}
