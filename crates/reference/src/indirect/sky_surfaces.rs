//! Surfaces of dense material near blocks of voxels, which the sky lights from in front of them.

use glam::{DMat3, DVec2, DVec3, DVec4};
use rayon::prelude::*;

use super::sky::interpolate_with_zero_border;
use crate::Reference;
use chiaroscuro_render::plan::SweepFrame;

/// Optical depth per shortest edge of a voxel up to which material is fog.
const FOG: f64 = 0.5;
/// Optical depth per shortest edge of a voxel from which material has a surface.
const SOLID: f64 = 1.5;
/// Largest optical depth per shortest edge of a voxel that a position in a block counts for.
const MOST: f64 = 3.0;
/// Share of the excess of the largest extinction around a block that is subtracted from that of the block.
const SURROUNDING_SHARE: f64 = 0.6;
/// Opacity per shortest edge of a voxel all around a block that no light reaches.
const BURIED: f64 = 0.9;
/// Places along the normal, in halves of a block from the block's centre.
const PLACES: std::ops::RangeInclusive<i32> = -5..=3;
/// Maximum number of slices between a surface and the start of a ray.
const FARTHEST_START: f64 = 2.0;
/// Maximum distance between a block and a start, in blocks along an axis.
const FARTHEST_AWAY: f64 = 2.5;

/// Surface near a block of voxels; lengths and angles are those of block coordinates unless said otherwise.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearbySurface {
    /// Unit vector out of the material.
    normal: DVec3,
    /// Unit vector out of the material, in scene space.
    scene_normal: DVec3,
    /// Height of the block above the surface.
    height: f64,
    /// Degree to which the block belongs to the surface rather than to fog.
    share: f64,
    /// Factors of V₀ and of the light that make both 1 on an open surface.
    scale: DVec2,
    /// `true` for a block that no light reaches.
    is_buried: bool,
}

impl NearbySurface {
    /// Returns the start of a ray from the surface to the sky: where the ray is clear of the surface's own blocks.
    pub(super) fn ray_start(&self, block: DVec3, frame: &SweepFrame) -> DVec3 {
        let origin = frame.block_position(1.0, glam::DVec2::ZERO);
        let per_slice = frame.block_position(0.0, -frame.drift) - origin;
        let clear = self.normal.abs().element_sum();
        let rise = self.normal.dot(per_slice);
        if rise <= 0.0 {
            return block;
        }
        let slices = (clear / rise).min(FARTHEST_START);
        let along = per_slice * slices;
        let way = along + self.normal * (clear - self.normal.dot(along) - self.height);
        block + way.clamp(DVec3::splat(-FARTHEST_AWAY), DVec3::splat(FARTHEST_AWAY)) * self.share
    }

    /// Returns the factors of transmittance in V₁ and, in the last component, V₀.
    ///
    /// On a surface they yield the irradiance 4 ⟨T cos θ⟩ = V₀ + 2 n · V₁.
    pub(super) fn moment_weights(&self, towards: DVec3) -> DVec4 {
        if self.is_buried {
            return DVec4::ZERO;
        }
        let cosine = self.scene_normal.dot(towards).max(0.0);
        let across = towards - self.scene_normal * cosine;
        let mean = self.scale.x * 12.0 * cosine * (1.0 - cosine);
        let light = self.scale.y * 4.0;
        let first = across * (light * cosine) + self.scene_normal * ((light * cosine - mean) / 2.0);
        let of_surface = first.extend(mean);
        towards.extend(1.0).lerp(of_surface, self.share)
    }
}

impl Reference<'_> {
    /// Returns the largest extinction that a position in a block counts for.
    pub(super) fn largest_sky_extinction(&self) -> f64 {
        if self.settings.shading.has_surfaces() { MOST / self.scene.smallest_edge() } else { f64::INFINITY }
    }

    /// Sharpens the extinction of all blocks at the surfaces of dense material: it becomes negative where it is less
    /// than 3/8 of the largest among the blocks around.
    pub(super) fn sharpened(&self, dims: [usize; 3], extinction: &[f64]) -> Vec<f64> {
        if !self.settings.shading.has_surfaces() {
            return extinction.to_vec();
        }
        let at = |[x, y, z]: [usize; 3]| extinction[(z * dims[1] + y) * dims[0] + x];
        let of_block = |block: usize| {
            let place = [block % dims[0], block / dims[0] % dims[1], block / (dims[0] * dims[1])];
            let near = |axis: usize| place[axis].saturating_sub(1)..(place[axis] + 2).min(dims[axis]);
            let around = near(2).flat_map(|z| near(1).flat_map(move |y| near(0).map(move |x| [x, y, z])));
            let most = around.map(at).fold(0.0, f64::max);
            let own = at(place);
            own - SURROUNDING_SHARE * solidity(most * self.scene.smallest_edge()) * (most - own)
        };
        (0..extinction.len()).into_par_iter().map(of_block).collect()
    }

    /// Finds the surface near each block in the extinction of all blocks, under light from the given directions; `None`
    /// for fog.
    pub(super) fn surfaces_of_blocks(
        &self,
        dims: [usize; 3],
        divisor: usize,
        extinction: &[f64],
        directions: &[DVec3],
    ) -> Vec<Option<NearbySurface>> {
        let count = dims.iter().product();
        if !self.settings.shading.has_surfaces() {
            return vec![None; count];
        }
        let edge = self.scene.smallest_edge();
        let scene_from_gradient = self.scene.index_from_scene.matrix3.transpose() / divisor as f64;
        let depth = |at: DVec3| edge * interpolate_with_zero_border(dims, extinction, at);
        let of_block = |block: usize| {
            let at = [block % dims[0], block / dims[0] % dims[1], block / (dims[0] * dims[1])];
            let block = DVec3::from(at.map(|at| at as f64));
            let mut surface = nearest_surface(block, scene_from_gradient, depth)?;
            let open = directions.iter().map(|way| {
                let cosine = way.dot(surface.scene_normal).max(0.0);
                DVec2::new(12.0 * cosine * (1.0 - cosine), 4.0 * cosine)
            });
            surface.scale = directions.len() as f64 / open.sum::<DVec2>();
            Some(surface)
        };
        (0..count).into_par_iter().map(of_block).collect()
    }
}

/// Returns the degree to which material of an optical depth per shortest edge of a voxel has a surface.
fn solidity(depth: f64) -> f64 {
    let share = ((depth - FOG) / (SOLID - FOG)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// Finds the surface near a block, from optical depths per edge at positions in blocks.
fn nearest_surface(
    block: DVec3,
    scene_from_gradient: DMat3,
    depth: impl Fn(DVec3) -> f64,
) -> Option<NearbySurface> {
    let opacity = |way: DVec3| 1.0 - (-depth(block + way)).exp();
    let signs = [-1.0, 1.0];
    let corners = signs.iter().flat_map(|x| signs.iter().flat_map(move |y| signs.map(|z| [*x, *y, z])));
    let corners = corners.map(|corner| (DVec3::from(corner) / 2.0, DVec3::from(corner) / 2.0));
    let ends = DVec3::AXES.into_iter().flat_map(|axis| signs.map(|side| (side * axis, 1.5 * side * axis)));
    let around: Vec<_> = corners.chain(ends).map(|(side, way)| (side, opacity(way))).collect();
    if around.iter().all(|(_, opacity)| *opacity > BURIED) {
        let normal = DVec3::Z;
        return Some(NearbySurface {
            normal,
            scene_normal: normal,
            height: 0.0,
            share: 0.0,
            scale: DVec2::ONE,
            is_buried: true,
        });
    }
    let falling: DVec3 = around.iter().map(|(side, opacity)| -*side * *opacity).sum();
    let clarity = (20.0 * falling.length()).min(1.0);
    if clarity <= 0.01 {
        return None;
    }
    let normal = falling.normalize();
    let depths: Vec<f64> = PLACES.map(|at| depth(block + normal * (f64::from(at) / 2.0))).collect();
    let most = depths.iter().copied().fold(0.0, f64::max);
    let falls = depths.windows(2).zip(PLACES).filter_map(|(pair, at)| {
        let [inner, outer] = [pair[0] - most / 2.0, pair[1] - most / 2.0];
        (inner >= 0.0 && outer < 0.0).then(|| 0.5 * (f64::from(at) + inner / (inner - outer)))
    });
    let surface = falls.min_by(|a, b| a.abs().total_cmp(&b.abs()))?;
    let [first, last] = [PLACES.start(), PLACES.end()].map(|at| f64::from(*at) / 2.0);
    let nearness = (2.0 * (surface - first).min(last - surface)).min(1.0);
    let share = solidity(most) * nearness * clarity;
    (share > 0.0).then(|| NearbySurface {
        normal,
        scene_normal: (scene_from_gradient * normal).normalize(),
        height: -surface,
        share,
        scale: DVec2::ONE,
        is_buried: false,
    })
}
