//! Every limit of the rendering tests, with its reason. Pictures are compared in linear,
//! premultiplied light before tone mapping; 1/255 is one step of an 8-bit display.

use super::compare::Limit;
use chiaroscuro::model::ShadowAlgorithm;

/// GPU against reference with the same weights: what is left are f16 sheets and light volumes
/// (2^−11 each), f32 positions and the early exit at 1/4096.
pub(crate) const SAME_WEIGHTS: Limit = Limit { max: 2.0 / 255.0, rmse: 0.25 / 255.0 };

/// GPU against literal, un-normalised footprints: the quadrature over a slab and the normalisation
/// differ by design; the largest single difference is at silhouettes and is not limited.
pub(crate) const LITERAL: Limit = Limit { max: f64::INFINITY, rmse: 1.0 / 255.0 };

/// Partition of unity with filtering hardware (8 fractional bits).
pub(crate) const UNITY: f64 = 2e-3;

/// Beer–Lambert, relative, by extinction per voxel and slab thickness: (μ, Δs, tolerance).
pub(crate) const BEER_LAMBERT: [(f64, f64, f64); 5] =
    [(0.1, 1.0, 0.005), (0.3, 1.0, 0.005), (0.7, 1.0, 0.02), (0.3, 0.25, 0.003), (0.7, 0.25, 0.003)];

/// Beer–Lambert along rays, relative: the error of the midpoint rule.
pub(crate) const RAY_BEER_LAMBERT: f64 = 1e-3;

/// Opacity of a homogeneous chord, absolute.
pub(crate) const CHORD_OPACITY: f64 = 2e-3;

/// Change of the picture's mean when slabs become four times thinner, relative.
pub(crate) const SLAB_MEAN_CHANGE: f64 = 0.005;

/// Headlight identity C = ½, at Δs = ¼ and Δs = 1, relative.
pub(crate) const HEADLIGHT_FINE: f64 = 0.02;
/// See [`HEADLIGHT_FINE`].
pub(crate) const HEADLIGHT_COARSE: f64 = 0.10;

/// Shadow of a ball on what lies behind it, RMSE beyond three voxels from its edge, and centre.
pub(crate) const BALL_SHADOW: f64 = 0.01;

/// Mean luminance over a quarter turn of the camera: peak to peak, and from frame to frame.
pub(crate) const ROTATION_RANGE: f64 = 0.005;
/// See [`ROTATION_RANGE`].
pub(crate) const ROTATION_STEP: f64 = 0.001;

/// By how much halving the slab must shrink the error: first order, and second order.
pub(crate) const ORDER_FRONT: f64 = 1.8;
/// See [`ORDER_FRONT`].
pub(crate) const ORDER_MEAN: f64 = 3.4;

/// A light volume in use against a fresh one: one step of a 16-bit float near 1.
pub(crate) const F16_STEP: f32 = 1.0 / 2048.0;

/// A point light 100 volumes away against a parallel one, RMSE.
pub(crate) const FAR_LIGHT: f64 = 0.005;

/// The chord law under oblique rays, relative.
pub(crate) const OBLIQUE_CHORD: f64 = 0.01;

/// Beer–Lambert along rays from samples, relative: as [`RAY_BEER_LAMBERT`], plus the pixel's width.
pub(crate) const DIRECT_BEER_LAMBERT: f64 = 1e-3;

/// The 10–90 % width of a shadow's edge in voxels: a binary edge, whose samples are blurred once by
/// the B-spline; then sampled at voxels and looked up with one linear fetch; then also splatted.
pub(crate) const EDGE_WIDTHS: [(ShadowAlgorithm, f64); 3] =
    [(ShadowAlgorithm::Direct, 1.31), (ShadowAlgorithm::Raycast, 1.80), (ShadowAlgorithm::Splat, 2.36)];
/// Relative: the widths depend on the phase between light pixels and voxels.
pub(crate) const EDGE_WIDTH: f64 = 0.08;
/// How far the middle of the edge may be from the geometric one, in voxels.
pub(crate) const EDGE_CENTRE: f64 = 0.25;

/// Mean luminance with splatted shadows over that with rays from every sample ("slightly darker").
pub(crate) const SELF_SHADOW: (f64, f64) = (0.88, 1.0);
/// By how much half a cure must brighten at least: more than rounding can.
pub(crate) const SELF_SHADOW_GROWS: f64 = 1.001;

/// A checkerboard with a period of four voxels under pixels at least as wide: contrast, and change of
/// a pixel from frame to frame.
pub(crate) const STRETCHED_CONTRAST: f64 = 0.05;
/// See [`STRETCHED_CONTRAST`].
pub(crate) const STRETCHED_FLICKER: f64 = 0.01;
/// Change of homogeneous fog's opacity by the stretch: the amplitude must fall as the width grows.
pub(crate) const STRETCHED_FOG: f64 = 0.005;

/// Scattering against gathering with the same weights: f16 sheets and light volumes on both sides.
pub(crate) const ENGINES: Limit = Limit { max: f64::INFINITY, rmse: 2.5e-4 };

/// Optical depth of a single voxel's footprint: what lies beyond two voxels along the ray (0.09 % of
/// 0.22 at σ = 0.6), table and 8-bit steps.
pub(crate) const FOOTPRINT: f64 = 3e-4;

/// How many times more than [`ROTATION_STEP`] sheets along the volume must pop, for the test to see it.
pub(crate) const POPPING: f64 = 10.0;

/// Opacity of a chord by round footprints that are not normalised: their sums vary by 0.7 %.
pub(crate) const ORDER_OPACITY: f64 = 4e-3;

/// Light volumes of bytes against 16-bit floats: half a step of 1/255, whose mean square is 1/12 of a
/// step's, and the floats' own half step.
pub(crate) const BYTES: Limit = Limit { max: 0.55 / 255.0 + 5e-4, rmse: 0.32 / 255.0 };

/// Collapsed lights against the sum of all, evenly lit: 16-bit colours, and cures for darkness that are
/// applied before the look-up instead of behind it (the cut at full light is no straight line).
pub(crate) const COLLAPSED: Limit = Limit { max: f64::INFINITY, rmse: 2e-3 };

/// Mean luminance of previews, exposed as at the beginning of a drag, against whole pictures: above
/// that a swap is seen.
pub(crate) const PREVIEW_BRIGHTNESS: f64 = 0.03;

/// What a crop box and a plane leave of the sum of opacities, in other orders of sheets than image-aligned:
/// single footprints are cut by whole voxels, of which faces of 32 voxels' edge have 3 % to either side.
pub(crate) const CUT_ORDERS: f64 = 0.03;

/// Collapsed light at cut faces: it is stored once per voxel, and normals turn within one there.
pub(crate) const CUT_COLLAPSED: Limit = Limit { max: f64::INFINITY, rmse: 3.0 / 255.0 };

/// Light on the floor, absolute: a 16-bit float near 1, and the error of the midpoint rule along a ray.
pub(crate) const FLOOR_SHADOW: f64 = 2e-3;

/// A picture drawn in parts, or the mean of its samples, against the whole: an eighth of an 8-bit step. Origins
/// of rays are rounded to 32 bits, the floor's light to 16, and sRGB is 13 times as steep near black.
pub(crate) const PARTS: f64 = 1.0 / 255.0 / 8.0;

/// Half as many voxels along each axis against all of them, RMSE: edges are a voxel softer.
pub(crate) const AVERAGED: f64 = 4.0 / 255.0;
/// And of the mean, relative: what is thinner than a voxel gets thinner still.
pub(crate) const AVERAGED_MEAN: f64 = 0.02;

/// What is shown against the tone map's formula, before it is rounded to bits: powers in f32, by exp2 and a log2 that
/// may be off by 2⁻²¹, whose errors a slope of up to 13 near black enlarges. 3e-7 were seen.
pub(crate) const TONE_MAP: f64 = 1.0 / (1 << 18) as f64;
