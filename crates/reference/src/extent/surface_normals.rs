//! Normals of surfaces near voxels: directions in which the opacity of blocks of voxels falls.

use glam::DVec3;
use rayon::prelude::*;

use crate::Reference;
use crate::field::trilinear;
use crate::indirect::sky::interpolate_with_zero_border;

/// Distance along each axis, in blocks, at which opacities around a block are compared.
const DISTANCE: f64 = 1.25;
/// Factor of a comparison for each axis along which it is in the middle.
const MIDDLE: f64 = 1.5;

/// Normals near blocks of voxels, with lengths of 1 on surfaces and 0 where there is none.
pub(crate) struct SurfaceNormals {
    /// Number of blocks along x, y and z.
    dims: [usize; 3],
    /// Edge of a block, in voxels.
    divisor: usize,
    /// Components of the normals in scene space, x fastest.
    components: [Vec<f64>; 3],
}

impl SurfaceNormals {
    /// Returns the interpolated normal at an index-space point.
    pub(crate) fn at(&self, point: DVec3) -> DVec3 {
        let block = (point + 0.5) / self.divisor as f64 - 0.5;
        DVec3::from(self.components.each_ref().map(|values| trilinear(self.dims, values, block)))
    }
}

impl Reference<'_> {
    /// Finds the normals near blocks of `divisor` voxels, in material with a multiple of its extinction.
    pub(crate) fn surface_normals(&self, divisor: usize, density_scale: f64) -> SurfaceNormals {
        let dims = self.scene.dims.map(|n| n.div_ceil(divisor));
        let edge = self.scene.smallest_edge();
        let opacity = |_, extinction: f64| [1.0 - (-extinction * density_scale * edge).exp()];
        let opacities: Vec<f64> = self.blocks(dims, divisor, false, opacity).into_iter().flatten().collect();
        let around: Vec<DVec3> = [-1.0, 0.0, 1.0]
            .into_iter()
            .flat_map(|x| [-1.0, 0.0, 1.0].map(|y| [-1.0, 0.0, 1.0].map(|z| DVec3::new(x, y, z))))
            .flatten()
            .collect();
        let normal = |block: usize| {
            let at = [block % dims[0], block / dims[0] % dims[1], block / (dims[0] * dims[1])];
            let at = DVec3::from(at.map(|at| at as f64));
            let pull = |way: &DVec3| {
                let middles = way.to_array().iter().filter(|part| **part == 0.0).count();
                let opacity = interpolate_with_zero_border(dims, &opacities, at + *way * DISTANCE);
                *way * (-opacity * MIDDLE.powi(middles as i32))
            };
            let falling: DVec3 = around.iter().map(pull).sum();
            let direction = self.scene.index_from_scene.matrix3.transpose() * falling;
            direction.normalize_or_zero() * falling.length().min(1.0)
        };
        let normals: Vec<DVec3> = (0..dims.iter().product()).into_par_iter().map(normal).collect();
        let components = [0, 1, 2].map(|axis| normals.iter().map(|normal| normal[axis]).collect());
        SurfaceNormals { dims, divisor, components }
    }
}
