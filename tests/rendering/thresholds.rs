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

/// The opacity beside the face of a volume of one value, absolute: as that of chords, and slabs of half a voxel across
/// faces that lie along the ray.
pub(crate) const EDGE_PROFILE: f64 = 4e-3;

/// A signed wave against the negative one: the ends of a range of 16-bit numbers are not symmetrical around its middle,
/// and table entries lie beside the control points of either lobe, by 1/1023 of the range.
pub(crate) const LOBES: Limit = Limit { max: 4.0 / 255.0, rmse: 0.5 / 255.0 };

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

/// Light along a flat face against rays, at most: what slabs as thick as a voxel leave of the first and last voxel.
pub(crate) const LIGHT_ALONG_A_FACE: f64 = 0.05;

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

/// A shell a tenth of a voxel thick, in slabs by need against even slabs that are as thin: where these lie differs.
pub(crate) const PEAK: Limit = Limit { max: f64::INFINITY, rmse: 2.0 / 255.0 };
/// The same in the mean, relative.
pub(crate) const PEAK_MEAN: f64 = 0.03;

/// By how much rays nearby may be further from rays all the way where the light pass has the prefiltered kernel: the
/// other way round it is as much nearer.
pub(crate) const PREFILTERED_LIGHT: f64 = 1.05;

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

/// Combined lights against the sum of all, evenly lit: 16-bit colours, and cures for darkness that are
/// applied before the look-up instead of behind it (the cut at full light is no straight line).
pub(crate) const COMBINED: Limit = Limit { max: f64::INFINITY, rmse: 2e-3 };

/// Mean luminance of previews, exposed as at the beginning of a drag, against whole pictures: above a hundredth a swap
/// is seen, and only previews with a quarter of the pixels and of the light's resolution have more, 0.0103.
pub(crate) const PREVIEW_BRIGHTNESS: f64 = 0.011;
/// The same under light from the side, whose shadows are larger: 0.0258 for a sixteenth of the pixels, of which a chair
/// fills few; 0.0168 for all of them, with a light volume at a quarter of the resolution.
pub(crate) const PREVIEW_BRIGHTNESS_ASIDE: f64 = 0.027;

/// What a crop box and a plane leave of the sum of opacities, in other orders of sheets than image-aligned:
/// single footprints are cut by whole voxels, of which faces of 32 voxels' edge have 3 % to either side.
pub(crate) const CUT_ORDERS: f64 = 0.03;

/// Combined light at cut faces: it is stored once per voxel, and normals turn within one there.
pub(crate) const CUT_COMBINED: Limit = Limit { max: f64::INFINITY, rmse: 3.0 / 255.0 };

/// Light on the floor, absolute: a 16-bit float near 1, and the error of the midpoint rule along a ray.
pub(crate) const FLOOR_SHADOW: f64 = 2e-3;

/// A picture drawn in parts, or the mean of its samples, against the whole: an eighth of an 8-bit step. Origins
/// of rays are rounded to 32 bits, the floor's light to 16, and sRGB is 13 times as steep near black.
pub(crate) const PARTS: f64 = 1.0 / 255.0 / 8.0;

/// The same sum in another order: eight steps of a 32-bit number near 1.
pub(crate) const ADDED_OTHERWISE: Limit = Limit { max: 1e-6, rmse: 1e-7 };

/// Half as many voxels along each axis against all of them, RMSE: edges are a voxel softer.
pub(crate) const AVERAGED: f64 = 4.0 / 255.0;
/// Half as many voxels along each axis: the mean, relative. What is thinner than a voxel gets thinner still.
pub(crate) const AVERAGED_MEAN: f64 = 0.02;

/// What is shown against the tone map's formula, before it is rounded to bits: powers in f32, by exp2 and a log2 that
/// may be off by 2⁻²¹, whose errors a slope of up to 13 near black enlarges. 3e-7 were seen.
pub(crate) const TONE_MAP: f64 = 1.0 / (1 << 18) as f64;

/// Light that is worth comparing relatively: rays end at 1/4096 of it, and 16-bit floats get coarse.
pub(crate) const FAINT: f64 = 1e-3;

/// Headlight identity by the literal deposit: how much halving the slab shrinks the error, from 1 to ½ and from ½ to ¼.
/// First order is 2; the thinner the slab, the more of the error is the kernel's own ([`HEADLIGHT_FINE`]).
pub(crate) const HEADLIGHT_ORDER: (f64, f64) = (1.6, 1.4);

/// How far from the edge of a hood's light the closed form holds, in degrees: two and a half voxels, the reverse kernel's
/// reach and half a pixel, seen from the light.
pub(crate) const HOOD_EDGE_DEG: f64 = 1.8;

/// Balanced brightness against that without shadows, relative: the balance is measured in a small picture.
pub(crate) const BALANCED: f64 = 0.02;

/// Light behind cuts, absolute: the optical depth of half a voxel, by which a face is sharp, where 16 voxels halve the
/// light.
pub(crate) const CUT_LIGHT: f64 = 0.01;

/// Combined lights with normals, RMSE: that of the light is interpolated, too, which must be seen and be small.
pub(crate) const COMBINED_NORMALS: f64 = 0.02;

/// Share of the floor's pixels that may differ between algorithms: those that the volume nearly covers are not drawn.
pub(crate) const FLOOR_EDGE: f64 = 0.01;

/// A step of 8 bits, and a thousandth for f32: values whose rounding may go to either side.
pub(crate) const EIGHT_BITS: f64 = 1.001 / 255.0;

/// Half a step of 8 bits, and a thousandth of one for f32: what rounding takes.
pub(crate) const HALF_STEP: f64 = 0.501 / 255.0;

/// What rounding to 8 bits must take somewhere in a picture, if more bits have more to say.
pub(crate) const HALF_STEP_SEEN: f64 = 0.4 / 255.0;

/// A dithered gradient, mean of eight rows, in steps of 8 bits: 64 amounts are a 64th of a step apart, and eight rows of
/// a gradient are not quite as many whole patterns.
pub(crate) const DITHERED: f64 = 0.1;

/// A background from top to bottom under several samples: it is that of the pixel's middle, not their mean.
pub(crate) const SAMPLED_BACKGROUND: f64 = 5e-3;

/// Previews of flat faces against slabs of a quarter of a voxel: 3.7e-3 near by and 2.0e-3 farther away; with slabs of two
/// voxels it is 11e-3 and 4.7e-3. Single pixels of edges are not limited.
pub(crate) const PREVIEW_STRIPES: Limit = Limit { max: f64::INFINITY, rmse: 4.2e-3 };

/// Stripes along legs and posts of the chair in previews, over the mean there (root mean square): 0.020 with 64³ voxels
/// and 0.028 with 128³; with even slabs 0.134 and 0.088.
pub(crate) const LEG_STRIPES: f64 = 0.045;
/// What pre-integrated slabs leave of those of even slabs, at most: 0.15 and 0.32.
pub(crate) const LEG_STRIPES_LEFT: f64 = 0.36;

/// How much brighter a coarse preview is that is not exposed for it, at least, or the test would see nothing.
pub(crate) const PREVIEW_UNEXPOSED: f64 = 1.2;

/// Mean of a picture whose light volume was spoiled, at most, over that of the right one.
pub(crate) const SPOILED: f64 = 0.9;
/// Mean of a picture whose light was moved by a hair and filled again, at least, over that before.
pub(crate) const REFILLED: f64 = 0.95;

/// How far from a step of 1/255 a value of bytes may be, in steps: f32.
pub(crate) const BYTE_STEP: f32 = 1e-3;

/// A picture against that of the mirrored values under the mirrored curve: entries of the table lie at other places
/// among the values, and densities are rounded to 16 bits.
pub(crate) const MIRRORED: Limit = Limit { max: 4.0 / 255.0, rmse: 0.25 / 255.0 };

/// One head whose file counts other axes first and in other directions: a step of a picture of 8 bits. What remains is
/// that passes add the same numbers in another order.
pub(crate) const SAME_HEAD: Limit = Limit { max: 1.0 / 255.0, rmse: 0.1 / 255.0 };

/// Light just below a lit face with rays nearby, RMSE: steps of ½ to 1½ voxels through densities that are prefiltered at
/// voxels and interpolated between them; where τ is about 1, a tenth of a voxel is 0.02.
pub(crate) const NEAR_A_FACE: f64 = 0.015;
/// That of a light volume alone, at least, which is blurred three times: by more than twice as much.
pub(crate) const LOOKED_UP_BELOW_A_FACE: f64 = 0.03;

/// Means of pictures beside a path tracer's, whose own are certain to 0.22 %: rays in thin slabs leave out nothing else.
pub(crate) const TRACED_EXACT: f64 = 0.007;
/// The default's: light volumes are a voxel coarse, and so is what is left of their blur behind rays nearby.
pub(crate) const TRACED_STANDARD: f64 = 0.04;

/// Two limits whose slabs differ by a factor of two, in steps of 8 bits: no more than rounding to them hides.
pub(crate) const LIMITS_AGREE: f64 = 0.1;
/// *Exact* against the limit, likewise: its slabs are a quarter of a voxel, and its numbers have 16 and 32 bits.
pub(crate) const EXACT_OF_LIMIT: f64 = 0.3;

/// A floor under a sky: its map has a texel for 0.03 scene units, where light of one direction ends within two voxels.
pub(crate) const FLOOR_UNDER_A_SKY: Limit = Limit { max: 0.01, rmse: 5e-4 };

/// Openness to the sky from 64 directions at full resolution, absolute: what so many directions and blocks of a voxel
/// leave of integrals over all of them.
pub(crate) const OPENNESS: f64 = 0.01;
/// The same beside a wall, whose edge the directions cross one by one: each is 1/64 of the sky.
pub(crate) const OPENNESS_BESIDE_A_WALL: f64 = 0.03;
/// Moments of the GPU beside those of the reference: sums over directions of numbers with 11 bits, and stored in such.
pub(crate) const SAME_OPENNESS: Limit = Limit { max: 2e-3, rmse: 3e-4 };

/// Light that has bounced on the GPU beside that of the reference, whose lights are about 1: numbers with 11 bits at every
/// bounce, of which the last is told from the two before.
pub(crate) const SAME_BOUNCED: Limit = Limit { max: 1.5e-3, rmse: 2e-4 };
/// All light within matter beside random walks, the root mean square of the difference over the mean: what blocks of a voxel
/// and 64 directions leave, and walks, of which so many are within 1 %.
pub(crate) const LIGHT_BY_WALKS: f64 = 0.02;
/// Pictures with everything on beside a path tracer's, the root mean square of the difference over the mean. At full resolution
/// and in slabs of a quarter of a voxel up to 0.008 were found of surfaces, 0.013 of clouds and 0.018 of a scan, at the
/// defaults 0.013, 0.024 and 0.017. Chance is 0.002.
pub(crate) const ALL_LIGHT: f64 = 0.02;
pub(crate) const ALL_LIGHT_DEFAULTS: f64 = 0.03;
/// How far all light in a white furnace is from 1: what twelve bounces and their ratio leave of infinitely many.
pub(crate) const FURNACE: f64 = 0.01;
/// What a half space gives back of light, relative: 26 directions, and blocks of 0.6 of an optical depth.
pub(crate) const HALF_SPACE: f64 = 0.03;

/// Worst error of what is left of a disc beside a half-plane, 8 to 64 voxels behind it: steps of 64 points.
pub(crate) const PENUMBRA: f64 = 0.02;

/// How much wider than twice a penumbra is at twice the distance, as a share: that of a walk at random is a quarter.
pub(crate) const PENUMBRA_WIDTH: f64 = 0.03;

/// What a light that has a size loses behind something small against what a point loses, as a share of what is open.
pub(crate) const PENUMBRA_ENERGY: f64 = 0.005;

/// Where light ends on a ball, the mean difference from the mean of pictures lit by each point of a light alone, over that
/// mean: rays nearby, which are one for all points, and surfaces that are a voxel soft.
pub(crate) const TERMINATOR: f64 = 0.15;

/// What of lights that have a size gets to the floor, on a map whose texels are as wide as half a voxel here, from sheets
/// whose pixels are a voxel wide: rays find edges a little sharper.
pub(crate) const FLOOR_PENUMBRA: Limit = Limit { max: 0.02, rmse: 1.6e-3 };
