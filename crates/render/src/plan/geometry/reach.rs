//! Reach of samples and lookups beyond their own cell, in cells of 2³ voxels.

use crate::plan::{LightView, SheetFrame};
use chiaroscuro_scene::{ShadowSettings, SlabQuadrature};
use chiaroscuro_volume::{BRICK_EDGE, math::SceneSpace};

/// Edge of a cell, in voxels.
const CELL_EDGE: f64 = 2.0;

/// Returns the reach of samples whose kernel is stretched to at most a level of the pyramid.
///
/// A texel of level 1 is made of voxels up to 1.5 from its centre, one of level 2 of voxels up to 4.5; a fetch
/// between texels sees those whose centres are less than 2 or 4 voxels away. Up to 3.5 voxels are two cells, up to
/// 8.5 five.
pub fn stretch_reach(level: f64) -> u8 {
    match level {
        level if level <= 0.0 => 0,
        level if level <= 1.0 => 2,
        _ => 5,
    }
}

/// Returns the reach of a stretched kernel in previews, which may omit its tails: beyond three quarters of a
/// stretched B-spline's radius of 2 texels is 1/1000 of its weight along an axis.
pub(crate) fn preview_stretch_reach(level: f64) -> u8 {
    if level <= 0.0 { 0 } else { in_cells(1.5 * level.exp2()) }
}

/// Returns the reach of samples that are means over a slab of `slab` scene units: the distance of the quadrature
/// points from its middle.
pub fn slab_reach(scene: &SceneSpace, slab: f64, obliquity: f64, quadrature: SlabQuadrature) -> u8 {
    let farthest = quadrature.offsets().iter().fold(0.0_f64, |far, offset| far.max(offset.abs()));
    in_cells(farthest * slab * obliquity / scene.smallest_edge())
}

/// Returns the reach of a frame's samples, in a preview or a full picture.
pub fn sample_reach(frame: &SheetFrame, scene: &SceneSpace, quadrature: SlabQuadrature, preview: bool) -> u8 {
    let [width, height] = frame.size.map(f64::from);
    let corners = [(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)];
    let obliquity = corners.map(|(i, j)| frame.obliquity(i, j)).into_iter().fold(1.0, f64::max);
    let level = frame.max_stretch_level();
    let stretch = if preview { preview_stretch_reach(level) } else { stretch_reach(level) };
    stretch.saturating_add(slab_reach(scene, frame.slab, obliquity, quadrature))
}

/// Returns the reach of samples along rays to lights, whose kernels are not stretched.
pub fn ray_reach(shadows: &ShadowSettings, scene: &SceneSpace) -> u8 {
    slab_reach(scene, shadows.ray_step(scene), 1.0, shadows.quadrature)
}

/// Returns the reach of fetches from a light volume with voxels of `divisor` data voxels: the texels around a point
/// are less than a light voxel away.
pub fn lookup_reach(divisor: usize) -> u8 {
    in_cells(divisor as f64)
}

/// Returns the reach of lookups at a distance of `bias_voxels` from the sample.
pub fn bias_reach(bias_voxels: f64) -> u8 {
    in_cells(bias_voxels)
}

/// Returns the reach of the reverse kernel around the voxels of a light volume.
///
/// It has radius two, and linear fetches between sheet pixels see a voxel more. A cell of a light volume holds
/// `divisor`³ data cells, only one of which may be needed.
pub fn reverse_reach(views: &[LightView], scene: &SceneSpace, divisor: usize) -> u8 {
    in_cells(reverse_reach_voxels(views, scene)).saturating_add(divisor as u8 - 1)
}

/// Returns the radius of the reverse kernel around the voxels of a light volume, linear fetches included, in voxels.
pub fn reverse_reach_voxels(views: &[LightView], scene: &SceneSpace) -> f64 {
    let widest = views
        .iter()
        .map(|view| {
            let last = view.frame.first_depth + f64::from(view.frame.slab_count) * view.frame.slab;
            view.frame.pitch_at(last).max(view.kernel_edge)
        })
        .fold(0.0, f64::max);
    2.0 * widest / scene.smallest_edge() + 1.0
}

/// Returns the reach, in bricks, of samples of scattered sheets with stretched kernels: brick ranges already cover
/// three voxels beyond the brick.
pub fn scatter_reach_bricks(frame: &SheetFrame) -> i32 {
    let widest = frame.widest_stretch();
    ((2.0 * std::f64::consts::SQRT_2 * widest - 3.0).max(0.0) / BRICK_EDGE as f64).ceil() as i32
}

/// Returns the maximum number of cells between two points that are `voxels` apart.
fn in_cells(voxels: f64) -> u8 {
    (voxels / CELL_EDGE).ceil() as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DAffine3;

    #[test]
    fn reaches_are_rounded_outwards() {
        assert_eq!([0.0, 0.3, 1.0, 1.1, 2.0].map(stretch_reach), [0, 2, 2, 5, 5]);
        assert_eq!([0.0, 0.3, 1.0, 1.1, 2.0].map(preview_stretch_reach), [0, 1, 2, 2, 3]);
        assert_eq!([1, 2, 4].map(lookup_reach), [1, 1, 2]);
        assert_eq!([0.0, 0.1, 2.0, 2.1].map(bias_reach), [0, 1, 1, 2]);
        let scene = SceneSpace::new([9; 3], DAffine3::IDENTITY);
        let slab = 8.0 * scene.smallest_edge();
        assert_eq!(slab_reach(&scene, slab, 1.0, SlabQuadrature::One), 0);
        // ± 0.289 × 8 voxels are 2.3 voxels.
        assert_eq!(slab_reach(&scene, slab, 1.0, SlabQuadrature::Two), 2);
    }
}
