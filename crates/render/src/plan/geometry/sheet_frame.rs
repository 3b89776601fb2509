//! Sheet frame: the rays of a stack of sheet buffers, for the eye and for lights alike.
//!
//! A sheet is a plane across the axis of projection. Depth runs along that axis, in scene units, and is measured from
//! an anchor near the middle of the volume, so that distant eyes and lights lose no precision. Pixel (i, j) sees, at
//! depth z, the index-space point `origin(i, j) + z · direction(i, j)`; both are linear in i and j. A parallel
//! projection is one whose `inverse_distance` is zero.

use std::ops::Range;

use glam::{DMat3, DVec2, DVec3};

use chiaroscuro_volume::math::SceneSpace;

/// Coarsest level of the pyramid: kernels are stretched up to 4 times. A picture with still larger pixels is smaller
/// than a quarter of the volume's voxels across.
pub const MAX_STRETCH_LEVEL: f64 = 2.0;

/// Value that is linear in the pixel position: `base + i·per_i + j·per_j`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PixelLinear<V> {
    /// Value at the centre of pixel (0, 0).
    pub base: V,
    /// Change per pixel to the right.
    pub per_i: V,
    /// Change per pixel down.
    pub per_j: V,
}

impl PixelLinear<DVec3> {
    /// Returns the value at a pixel position.
    pub fn at(&self, i: f64, j: f64) -> DVec3 {
        self.base + self.per_i * i + self.per_j * j
    }
}

impl PixelLinear<DVec2> {
    /// Returns the value at a pixel position.
    pub fn at(&self, i: f64, j: f64) -> DVec2 {
        self.base + self.per_i * i + self.per_j * j
    }
}

/// Stack of sheets, divided into slabs of equal thickness, and the rays through their pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct SheetFrame {
    /// Pixels per row and column.
    pub size: [u32; 2],
    /// Intersection of each pixel's ray with the anchor plane (depth 0), in index space.
    pub origin: PixelLinear<DVec3>,
    /// Displacement of each ray in index space per scene unit of depth.
    pub direction: PixelLinear<DVec3>,
    /// Tangents of the angles between the ray and the axis.
    pub slope: PixelLinear<DVec2>,
    /// Depth of the near face of slab 0, in scene units.
    pub first_depth: f64,
    /// Slab thickness Δs in scene units.
    pub slab: f64,
    /// Number of slabs in the stack.
    pub slab_count: u32,
    /// Distance between pixel centres on the anchor plane, in scene units.
    pub pitch: f64,
    /// 1 / (distance from the centre of projection to the anchor plane); 0 for a parallel projection.
    pub inverse_distance: f64,
    /// ∛(voxel volume) in scene units: the pitch at which kernels begin to stretch.
    pub voxel_edge: f64,
    /// Coarsest level of the pyramid to which kernels are stretched.
    pub coarsest_level: f64,
}

/// Placement of a projection in the scene: the parameters of [`SheetFrame::new`].
pub(crate) struct ProjectionPlacement {
    /// Columns: right, down and forward (away from eye or light), unit vectors in scene space.
    pub axes: DMat3,
    /// Point on the axis, on the anchor plane, in scene space.
    pub anchor: DVec3,
    /// Reciprocal anchor distance, see [`SheetFrame::inverse_distance`].
    pub inverse_distance: f64,
    /// Pixel pitch, see [`SheetFrame::pitch`].
    pub pitch: f64,
    /// Position of pixel (0, 0)'s centre on the anchor plane, in pixels right and down of the axis.
    pub first_pixel: DVec2,
    /// Pixels per row and column.
    pub size: [u32; 2],
    /// Slab thickness in scene units.
    pub slab: f64,
    /// Nearest depth that is sampled at all.
    pub near: f64,
}

/// Distances to either side over which gradients from sheets are differenced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GradientSteps {
    /// Number of pixels within a sheet.
    pub pixels: u32,
    /// Number of slabs across the sheets.
    pub slabs: u32,
}

impl SheetFrame {
    /// Computes the rays, and covers all material of the scene with slabs. Slab faces lie at whole multiples of the
    /// thickness from the anchor, so that moving the eye does not shift their phase.
    pub(crate) fn new(scene: &SceneSpace, place: &ProjectionPlacement) -> Self {
        let to_index = &scene.index_from_scene;
        let [right, down, forward] = [place.axes.x_axis, place.axes.y_axis, place.axes.z_axis];
        let step = |axis: DVec3| to_index.transform_vector3(axis * place.pitch);
        let first = (right * place.first_pixel.x + down * place.first_pixel.y) * place.pitch;
        let spread = place.inverse_distance;
        let slope_step = place.pitch * spread;
        let depths = scene.support_corners().map(|corner| (corner - place.anchor).dot(forward));
        let nearest = depths.iter().copied().fold(f64::INFINITY, f64::min).max(place.near);
        let farthest = depths.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let first_slab = (nearest / place.slab).floor();
        let slab_count = ((farthest / place.slab).ceil() - first_slab).max(0.0) as u32;
        Self {
            size: place.size,
            origin: PixelLinear {
                base: to_index.transform_point3(place.anchor + first),
                per_i: step(right),
                per_j: step(down),
            },
            direction: PixelLinear {
                base: to_index.transform_vector3(forward + first * spread),
                per_i: step(right) * spread,
                per_j: step(down) * spread,
            },
            slope: PixelLinear {
                base: place.first_pixel * slope_step,
                per_i: DVec2::new(slope_step, 0.0),
                per_j: DVec2::new(0.0, slope_step),
            },
            first_depth: first_slab * place.slab,
            slab: place.slab,
            slab_count,
            pitch: place.pitch,
            inverse_distance: spread,
            voxel_edge: scene.mean_edge(),
            coarsest_level: MAX_STRETCH_LEVEL,
        }
    }

    /// Returns the stack with each slab divided into `parts` slabs.
    pub(crate) fn with_divided_slabs(self, parts: u32) -> Self {
        Self { slab: self.slab / f64::from(parts), slab_count: self.slab_count * parts, ..self }
    }

    /// Returns the depth of the middle of slab `k`.
    pub fn depth_of(&self, k: f64) -> f64 {
        self.first_depth + (k + 0.5) * self.slab
    }

    /// Returns the index-space point that pixel (i, j) sees at a depth.
    pub fn point(&self, i: f64, j: f64, depth: f64) -> DVec3 {
        self.origin.at(i, j) + self.direction.at(i, j) * depth
    }

    /// Returns the length of pixel (i, j)'s ray per unit of depth: 1 / cos θ.
    pub fn obliquity(&self, i: f64, j: f64) -> f64 {
        (1.0 + self.slope.at(i, j).length_squared()).sqrt()
    }

    /// Returns the distance between pixel centres at a depth, in scene units.
    pub fn pitch_at(&self, depth: f64) -> f64 {
        self.pitch * (1.0 + depth * self.inverse_distance)
    }

    /// Returns the stretch of kernels at a depth, as a pyramid level: log₂(pitch / voxel), from 0 (pixels no wider
    /// than voxels, P §4) to the coarsest.
    pub fn stretch_level(&self, depth: f64) -> f64 {
        (self.pitch_at(depth) / self.voxel_edge).max(1e-9).log2().clamp(0.0, self.coarsest_level)
    }

    /// Returns the number of pixels and of slabs to either side over which gradients from sheets are differenced:
    /// about a voxel, as for gradients from the volume.
    pub fn gradient_steps(&self) -> GradientSteps {
        let steps = |step: f64| (self.voxel_edge / step).round().max(1.0) as u32;
        GradientSteps { pixels: steps(self.pitch), slabs: steps(self.slab) }
    }

    /// Returns the factor by which kernels at slab `k` are wider than in index space.
    pub fn stretch_at(&self, k: f64) -> f64 {
        (self.pitch_at(self.depth_of(k)) / self.voxel_edge).max(1.0)
    }

    /// Returns the maximum of [`Self::stretch_at`] over the stack.
    pub fn widest_stretch(&self) -> f64 {
        self.stretch_at(f64::from(self.slab_count)).max(self.stretch_at(0.0))
    }

    /// Returns the maximum [`Self::stretch_level`] of all slabs.
    pub fn max_stretch_level(&self) -> f64 {
        self.max_stretch_level_of(0..self.slab_count)
    }

    /// Returns the maximum [`Self::stretch_level`] of a range of slabs, from their front to their back.
    pub fn max_stretch_level_of(&self, slabs: Range<u32>) -> f64 {
        let depth = |slab: u32| self.first_depth + f64::from(slab) * self.slab;
        self.stretch_level(depth(slabs.start)).max(self.stretch_level(depth(slabs.end)))
    }
}
