//! Tolerances of the rendering tests, each with its derivation. Pictures are compared in linear, premultiplied light
//! before tone mapping; 1/255 is one step of an 8-bit display.

pub(crate) mod pages;
use super::compare::ErrorLimit;
use chiaroscuro_scene::ShadowAlgorithm;

/// GPU against reference with the same weights: the rest are f16 sheets and light volumes (2^−11 each), f32 positions
/// and early ray termination at 1/4096.
pub(crate) const SAME_WEIGHTS: ErrorLimit = ErrorLimit { max: 2.0 / 255.0, rmse: 0.25 / 255.0 };

/// GPU against literal, un-normalised footprints: the quadrature over a slab and the normalisation differ by design;
/// the largest single difference is at silhouettes and is not limited.
pub(crate) const LITERAL: ErrorLimit = ErrorLimit { max: f64::INFINITY, rmse: 1.0 / 255.0 };

/// Partition of unity with filtering hardware (8 fractional bits).
pub(crate) const UNITY: f64 = 2e-3;
/// Beer–Lambert, relative, by extinction per voxel and slab thickness: (μ, Δs, tolerance).
pub(crate) const BEER_LAMBERT: [(f64, f64, f64); 5] =
    [(0.1, 1.0, 0.005), (0.3, 1.0, 0.005), (0.7, 1.0, 0.02), (0.3, 0.25, 0.003), (0.7, 0.25, 0.003)];

/// Beer–Lambert along rays, relative: the error of the midpoint rule.
pub(crate) const RAY_BEER_LAMBERT: f64 = 1e-3;

/// Opacity of a homogeneous chord, absolute.
pub(crate) const CHORD_OPACITY: f64 = 2e-3;

/// Matter of layers along a chord, absolute: a third of a step of 8 bits.
pub(crate) const LAYER_MATTER: f64 = 0.3 / 255.0;

/// Opacity beside a face that is parallel to the ray, absolute: like that of chords, with slabs of half a voxel.
pub(crate) const EDGE_PROFILE: f64 = 4e-3;

/// A signed wave against its negative: the ends of a 16-bit range are not symmetrical around its middle, and table
/// entries lie beside the control points of either lobe, by 1/1023 of the range.
pub(crate) const LOBES: ErrorLimit = ErrorLimit { max: 4.0 / 255.0, rmse: 0.5 / 255.0 };

/// Change of the picture's mean when slabs become four times thinner, relative.
pub(crate) const SLAB_MEAN_CHANGE: f64 = 0.005;

/// Headlight identity C = ½, relative, at Δs = ¼ and 1.
pub(crate) const HEADLIGHT_FINE: f64 = 0.02;
pub(crate) const HEADLIGHT_COARSE: f64 = 0.10;

/// Shadow of a ball on the voxels behind it, RMSE beyond three voxels from its edge, and centre.
pub(crate) const BALL_SHADOW: f64 = 0.01;

/// Mean luminance over a quarter turn of the camera, relative: peak to peak, and from frame to frame.
pub(crate) const ROTATION_RANGE: f64 = 0.005;
pub(crate) const ROTATION_STEP: f64 = 0.001;

/// Largest error of light along a flat face against rays, absolute: the error that slabs as thick as a voxel leave at
/// the first and last voxel.
pub(crate) const LIGHT_ALONG_A_FACE: f64 = 0.05;

/// Smallest factor by which halving the slab reduces the error, for the literal deposit (first order).
pub(crate) const ORDER_FRONT: f64 = 1.8;
/// Smallest factor by which halving the slab reduces the error, for the slab mean (second order).
pub(crate) const ORDER_MEAN: f64 = 3.4;

/// A reused light volume against a fresh one: one step of a 16-bit float near 1.
pub(crate) const F16_STEP: f32 = 1.0 / 2048.0;
/// A point light at a distance of 100 volumes against a parallel one, RMSE.
pub(crate) const FAR_LIGHT: f64 = 0.005;
/// Projections against a plain walk in steps of a hundredth of a voxel: 16-bit densities, the table of the curve, and
/// weights of texture filtering with 8 fractional bits.
pub(crate) const PROJECTION: ErrorLimit = ErrorLimit { max: 1.0 / 255.0, rmse: 0.25 / 255.0 };

/// Chord law under oblique rays, relative.
pub(crate) const OBLIQUE_CHORD: f64 = 0.01;
/// Beer–Lambert along rays from samples, relative: as [`RAY_BEER_LAMBERT`], plus the pixel's width.
pub(crate) const DIRECT_BEER_LAMBERT: f64 = 1e-3;

/// The 10–90 % width of a shadow's edge in voxels: a binary edge, whose samples are blurred once by the B-spline;
/// then sampled at voxels and looked up with one linear fetch; then also splatted.
pub(crate) const EDGE_WIDTHS: [(ShadowAlgorithm, f64); 3] =
    [(ShadowAlgorithm::Direct, 1.31), (ShadowAlgorithm::Raycast, 1.80), (ShadowAlgorithm::Splat, 2.36)];
/// Tolerance of the edge widths, relative: they depend on the phase between light pixels and voxels.
pub(crate) const EDGE_WIDTH: f64 = 0.08;
/// Largest distance of the edge's centre from the geometric edge, in voxels.
pub(crate) const EDGE_CENTRE: f64 = 0.25;

/// Range of the mean luminance with splatted shadows over that with rays from every sample ("slightly darker").
pub(crate) const SELF_SHADOW: (f64, f64) = (0.88, 1.0);
/// Smallest factor by which half a remedy must brighten: more than rounding can.
pub(crate) const SELF_SHADOW_GROWS: f64 = 1.001;

/// A checkerboard with a period of four voxels under pixels at least as wide: contrast.
pub(crate) const STRETCHED_CONTRAST: f64 = 0.05;
/// A checkerboard with a period of four voxels under pixels at least as wide: change of a pixel between frames, as
/// the standard deviation over the mean.
pub(crate) const STRETCHED_FLICKER: f64 = 0.01;
/// Change of homogeneous fog's opacity by the stretch: the amplitude must fall as the width grows.
pub(crate) const STRETCHED_FOG: f64 = 0.005;

/// Scattering against gathering with the same weights: f16 sheets and light volumes on both sides.
pub(crate) const ENGINES: ErrorLimit = ErrorLimit { max: f64::INFINITY, rmse: 2.5e-4 };
/// Engines by default, of which gathering alone sees the first end of near-field rays with the eye's kernel: 4.3e-4.
pub(crate) const ENGINES_BY_DEFAULT: ErrorLimit = ErrorLimit { max: f64::INFINITY, rmse: 6e-4 };

/// A shell a tenth of a voxel thick, in adaptive slabs against such of a sixteenth of a voxel: densities that are linear
/// within a quarter of a voxel place the shell beside it where it is seen from the side.
pub(crate) const PEAK: ErrorLimit = ErrorLimit { max: f64::INFINITY, rmse: 4.5 / 255.0 };
/// Mean of the thin shell in slabs by need against even slabs, relative.
pub(crate) const PEAK_MEAN: f64 = 0.03;
/// Largest ratio of the error of near-field rays against full rays, with a prefiltered light pass to that with a
/// B-spline one; in other cases it was smaller by as much.
pub(crate) const PREFILTERED_LIGHT: f64 = 1.05;

/// Optical depth of a single voxel's footprint: the part beyond two voxels along the ray (0.09 % of 0.22 at σ = 0.6),
/// table and 8-bit steps.
pub(crate) const FOOTPRINT: f64 = 3e-4;

/// Smallest multiple of [`ROTATION_STEP`] by which volume-aligned sheets must pop, for the test to be meaningful.
pub(crate) const POPPING: f64 = 10.0;

/// Opacity of a chord by round footprints that are not normalised: their sums vary by 0.7 %.
pub(crate) const ORDER_OPACITY: f64 = 4e-3;

/// Light volumes of bytes against 16-bit floats: half a step of 1/255, whose mean square is 1/12 of a step's, and the
/// floats' own half step.
pub(crate) const BYTES: ErrorLimit = ErrorLimit { max: 0.55 / 255.0 + 5e-4, rmse: 0.32 / 255.0 };

/// Combined lights against the sum of all, evenly lit: 16-bit colours, and remedies for darkness that are applied
/// before the look-up instead of after it (the clipping at full light is not linear).
pub(crate) const COMBINED: ErrorLimit = ErrorLimit { max: f64::INFINITY, rmse: 2e-3 };

/// Mean luminance of previews, exposed as at the beginning of a drag, against full pictures: above 1 % a swap is
/// visible, and only previews with a quarter of the light's resolution exceed it: by up to 0.3 % were seen.
pub(crate) const PREVIEW_BRIGHTNESS: f64 = 0.016;
/// Mean luminance of previews under light from the side, whose shadows are larger: 0.0258 with a sixteenth of the
/// pixels, of which a chair fills few; 0.0168 with all of them, and a light volume at a quarter of the resolution.
pub(crate) const PREVIEW_BRIGHTNESS_SIDE_LIT: f64 = 0.027;

/// Difference in the uncut share of the sum of opacities between other sheet orders and image-aligned ones: single
/// footprints are cut at whole voxels, and of an edge of 32 voxels one is 3 %.
pub(crate) const CUT_ORDERS: f64 = 0.03;

/// Combined light at cut faces: it is stored once per voxel, and normals turn within one there.
pub(crate) const CUT_COMBINED: ErrorLimit = ErrorLimit { max: f64::INFINITY, rmse: 3.0 / 255.0 };

/// Light on the floor, absolute: a 16-bit float near 1, and the error of the midpoint rule along a ray.
pub(crate) const FLOOR_SHADOW: f64 = 2e-3;

/// A picture drawn in parts, or the mean of its samples, against the whole: an eighth of an 8-bit step. Ray origins
/// are rounded to 32 bits, the floor's light to 16, and sRGB is 13 times as steep near black.
pub(crate) const TILES: f64 = 1.0 / 255.0 / 8.0;

/// One sum in two orders of addition: eight steps of a 32-bit number near 1.
pub(crate) const SUMMATION_ORDER: ErrorLimit = ErrorLimit { max: 1e-6, rmse: 1e-7 };

/// Half as many voxels along each axis against all of them, RMSE: edges are a voxel softer.
pub(crate) const AVERAGED: f64 = 4.0 / 255.0;
/// Half as many voxels along each axis: the mean, relative. Parts thinner than a voxel get thinner still.
pub(crate) const AVERAGED_MEAN: f64 = 0.02;

/// Displayed values against the tone map's formula, before rounding to bits: powers in f32, by exp2 and a log2 with
/// an error of up to 2⁻²¹, which a slope of up to 13 near black enlarges. 3e-7 were seen.
pub(crate) const TONE_MAP: f64 = 1.0 / (1 << 18) as f64;

/// Smallest light that is compared relatively: rays end at 1/4096 of it, and 16-bit floats get coarse.
pub(crate) const MIN_COMPARED_LIGHT: f64 = 1e-3;

/// Headlight identity by the literal deposit: factor by which halving the slab reduces the error, from 1 to ½ and
/// from ½ to ¼. First order is 2; the thinner the slab, the more of the error is the kernel's own
/// ([`HEADLIGHT_FINE`]).
pub(crate) const HEADLIGHT_ORDER: (f64, f64) = (1.6, 1.4);

/// Distance from the rim of a spotlight beyond which the closed form holds, in degrees: two and a half voxels, the
/// reverse kernel's radius and half a pixel, seen from the light.
pub(crate) const SPOTLIGHT_RIM_DEG: f64 = 1.8;

/// Balanced brightness against that without shadows, relative: the balance is measured in a small picture.
pub(crate) const BALANCED: f64 = 0.02;

/// Light behind cuts, absolute: the optical depth of half a voxel, the sharpness of a face, where 16 voxels halve the
/// light.
pub(crate) const CUT_LIGHT: f64 = 0.01;

/// Combined lights with normals, RMSE: the light's direction is interpolated as well, which must be measurable and
/// small.
pub(crate) const COMBINED_NORMALS: f64 = 0.02;

/// Share of the floor's pixels that may differ between algorithms: those that the volume nearly covers are not drawn.
pub(crate) const FLOOR_EDGE: f64 = 0.01;

/// A step of 8 bits, plus a thousandth for f32: values whose rounding may go to either side.
pub(crate) const EIGHT_BITS: f64 = 1.001 / 255.0;

/// Half a step of 8 bits, plus a thousandth of one for f32: the error of rounding.
pub(crate) const HALF_STEP: f64 = 0.501 / 255.0;

/// Smallest rounding error to 8 bits that must occur somewhere in a picture, if more bits carry more information.
pub(crate) const MIN_ROUNDING: f64 = 0.4 / 255.0;

/// A dithered gradient, mean of eight rows, in steps of 8 bits: 64 thresholds are a 64th of a step apart, and eight
/// rows of a gradient are not quite a whole number of patterns.
pub(crate) const DITHERED: f64 = 0.1;

/// A vertical background gradient under several samples: it is evaluated at the pixel's centre, not averaged.
pub(crate) const SAMPLED_BACKGROUND: f64 = 5e-3;

/// Previews of flat faces against slabs of a quarter of a voxel: 3.7e-3 close up and 2.0e-3 farther away; with slabs
/// of two voxels it is 11e-3 and 4.7e-3. Single pixels at edges are not limited.
pub(crate) const PREVIEW_STRIPES: ErrorLimit = ErrorLimit { max: f64::INFINITY, rmse: 4.2e-3 };

/// Stripes along legs and posts of the chair in previews, over the mean there (root mean square): 0.020 with 64³
/// voxels and 0.028 with 128³; with even slabs 0.134 and 0.088.
pub(crate) const LEG_STRIPES: f64 = 0.045;
/// Largest ratio of the stripes of pre-integrated slabs to those of even slabs: 0.15 and 0.32 were measured.
pub(crate) const LEG_STRIPES_RATIO: f64 = 0.36;

/// Smallest brightening of a coarse preview without exposure correction, or the test would be meaningless.
pub(crate) const PREVIEW_UNEXPOSED: f64 = 1.2;

/// Largest mean of a picture whose light volume was spoiled, over that of the right one.
pub(crate) const SPOILED: f64 = 0.9;
/// Smallest mean of a picture whose light was moved slightly and filled again, over that before.
pub(crate) const REFILLED: f64 = 0.95;

/// Largest distance of a byte's value from a step of 1/255, in steps: f32.
pub(crate) const BYTE_STEP: f32 = 1e-3;

/// A picture against that of the mirrored values under the mirrored curve: entries of the table lie at other
/// positions among the values, and densities are rounded to 16 bits.
pub(crate) const MIRRORED: ErrorLimit = ErrorLimit { max: 4.0 / 255.0, rmse: 0.25 / 255.0 };

/// One head in files with other axis orders and directions: a step of an 8-bit picture. The remaining difference is
/// that passes add the same numbers in another order.
pub(crate) const PHANTOM: ErrorLimit = ErrorLimit { max: 1.0 / 255.0, rmse: 0.1 / 255.0 };

/// Light just below a lit face with near-field rays, RMSE: steps of ½ to 1 voxel through densities that are
/// prefiltered at voxels and interpolated between them; where τ is about 1, a tenth of a voxel is 0.02. Short rays
/// (0.017) take the bend of their first step from differences of prefiltered densities, long ones (0.011) do not.
pub(crate) const NEAR_A_FACE: f64 = 0.018;
/// Smallest RMSE just below a lit face of a light volume alone, which is blurred three times: more than twice as
/// much.
pub(crate) const LIGHT_VOLUME_NEAR_A_FACE: f64 = 0.03;

/// Means of *Exact* pictures against those of a path tracer, whose own uncertainty is 0.22 %: rays in thin slabs have
/// no other error.
pub(crate) const TRACED_EXACT: f64 = 0.007;
/// Means of *Standard* pictures against those of a path tracer: light volumes are a voxel coarse, as is the rest of
/// their blur behind near-field rays.
pub(crate) const TRACED_STANDARD: f64 = 0.04;

/// Two limit pictures whose slabs differ by a factor of two, in steps of 8 bits: no more than rounding hides.
pub(crate) const LIMITS_AGREE: f64 = 0.1;
/// *Exact* against the limit picture, in steps of 8 bits: its slabs are a quarter of a voxel, and its numbers have 16
/// and 32 bits.
pub(crate) const EXACT_OF_LIMIT: f64 = 0.3;

/// A floor under a sky: its map has a texel per 0.03 scene units, where light of one direction is absorbed within two
/// voxels.
pub(crate) const FLOOR_UNDER_A_SKY: ErrorLimit = ErrorLimit { max: 0.01, rmse: 5e-4 };

/// Sky visibility from 48 directions at full resolution, absolute: the error of that many directions and blocks of a
/// voxel against integrals over all directions.
pub(crate) const SKY_VISIBILITY: f64 = 0.01;
/// Sky visibility beside a wall along an axis, whose edge the directions of a symmetric set cross two by two: each is
/// 1/48 of the sky.
pub(crate) const SKY_VISIBILITY_AT_WALL: f64 = 0.03;
/// Open plates under a white sky, against 1: low directions, with 2 % of the light, can meet the plate beside the place
/// (up to 0.018 were found, at full resolution).
pub(crate) const OPEN_PLATE_UNDER_SKY: f64 = 0.025;
/// Mean and deviation of convex bodies under a white sky, whose blocks all store 1: the same loss of low directions.
pub(crate) const CONVEX_BODY_UNDER_SKY: f64 = 0.015;
/// Single pixels of a box under a white sky: the same errors, and samples at edges whose normals turn within a block.
pub(crate) const BOX_UNDER_SKY: f64 = 0.04;
/// Light of the sky in a groove at half resolution and at full, relative: directions cross its rim one by one, each
/// with up to 4 % of the light, and the grid ends. Up to 0.057 and 0.091 were found.
pub(crate) const GROOVE_UNDER_SKY: [f64; 2] = [0.06, 0.1];
/// Mean of a picture under a sky at half of the resolution, relative to that at full resolution: opaque bodies reach
/// up to a block farther for rays that pass along them.
pub(crate) const SKY_AT_HALF_OF_FULL: f64 = 0.03;
/// Light of the sky at the floor of a well of 24³ voxels at half resolution and at full, relative: it sees a tenth of
/// all directions, whose shadows have edges between rays that are a block apart. Up to 0.049 and 0.052 were found.
pub(crate) const WELL_UNDER_SKY: [f64; 2] = [0.055, 0.06];
/// Mean of wells that lie differently in the grid, relative: the edges of shadows are then between rays everywhere, and
/// what is left is the rounding of rims.
pub(crate) const WELLS_UNDER_SKY: f64 = 0.03;
/// Moments of sky visibility on the GPU against those of the reference: sums over directions with 11 bits, stored
/// with as many.
pub(crate) const SKY_MOMENTS: ErrorLimit = ErrorLimit { max: 2e-3, rmse: 3e-4 };
/// Moments of sky visibility as in [`SKY_MOMENTS`], for blocks of surfaces: their normals and distances come from
/// extinction with 11 bits, and of two surfaces that are nearly as near, single blocks find the other one (up to 0.028).
/// At a quarter of the resolution there are only 216 blocks (1.3e-3).
pub(crate) const SKY_MOMENTS_AT_SURFACES: ErrorLimit = ErrorLimit { max: 0.05, rmse: 2e-3 };

/// Multiply scattered light on the GPU against that of the reference, with lights of about 1: numbers with 11 bits at
/// every bounce, and what diffusion makes of their differences.
pub(crate) const SCATTERED_LIGHT: ErrorLimit = ErrorLimit { max: 1.5e-3, rmse: 2e-4 };
/// All light within material against random walks, root mean square of the difference over the mean: the error of
/// blocks of a voxel and 48 directions, and of the walks, whose number gives 1 %.
pub(crate) const LIGHT_BY_WALKS: f64 = 0.02;
/// Pictures with all light at full resolution and in slabs of a quarter of a voxel against a path tracer's, root mean
/// square of the difference over the mean: up to 0.008 were found of surfaces, 0.013 of clouds and 0.018 of a scan.
/// The noise is 0.002.
pub(crate) const ALL_LIGHT: f64 = 0.02;
/// Pictures with all light at the default settings against a path tracer's, root mean square of the difference over
/// the mean: 0.013, 0.024 and 0.017 were found of surfaces, clouds and a scan.
pub(crate) const ALL_LIGHT_DEFAULTS: f64 = 0.03;
/// Largest deviation of all light in a white furnace from 1, with twelve bounces.
pub(crate) const FURNACE: f64 = 0.01;
/// Largest deviation of a picture's light from 1 where nothing absorbs any, under a white sky, with 4 bounces or more:
/// three sweeps, each of which leaves a fifth of the error at most, after a diffusion estimate that is right to a tenth.
pub(crate) const PICTURED_FURNACE: f64 = 0.02;
/// Deviation as in [`PICTURED_FURNACE`], with the most bounces: directions and numbers of 11 bits.
pub(crate) const PICTURED_FURNACE_CONVERGED: f64 = 0.01;
/// Mean of a picture against another renderer's, relative: 48 directions, slabs, and 0.2 % of noise.
pub(crate) const OUTSIDE_MEAN: f64 = 0.03;
/// Means of sixteen squares of a picture against another renderer's, root mean square of the difference over the mean.
pub(crate) const OUTSIDE_SQUARES: f64 = 0.04;
/// Both differences for a slab with an optical depth of 1 in each voxel and edges as hard as voxels can be: in the sun,
/// whose light falls within two of the smallest blocks, 2.9 and 4.3 % were found.
pub(crate) const OUTSIDE_HARD: [f64; 2] = [0.03, 0.05];
/// Mean of a path tracer's picture against another renderer's, relative: noise of both.
pub(crate) const OUTSIDE_TRACED: f64 = 0.01;
/// Reflectance of a half space, relative: 24 directions, and blocks of an optical depth of 0.6.
pub(crate) const HALF_SPACE: f64 = 0.03;

/// Worst error of the visible part of a disc beside a half-plane, 8 to 64 voxels behind it: steps of 64 points.
pub(crate) const PENUMBRA: f64 = 0.02;

/// Deviation of a penumbra's width at twice the distance from twice its width, as a share: that of a random walk is a
/// quarter.
pub(crate) const PENUMBRA_WIDTH: f64 = 0.03;

/// Distance, in voxels, of the middle of a wide light's penumbra from the closed form, 27 voxels behind the edge: half
/// of what 64 points, normals of blocks of four voxels and a light volume at half the resolution allow for.
pub(crate) const PENUMBRA_MIDDLE: f64 = 0.5;

/// Difference in the loss of light behind a small occluder between an area light and a point light, as a share of the
/// unoccluded light.
pub(crate) const PENUMBRA_ENERGY: f64 = 0.005;

/// Mean difference at the terminator of a ball from the mean of pictures lit by each point of a light alone, over
/// that mean: near-field rays, which are shared by all points, and surfaces that are a voxel soft.
pub(crate) const TERMINATOR: f64 = 0.15;

/// Light of area lights on the floor, on a map with texels of half a voxel: rays find edges a little sharper.
pub(crate) const FLOOR_PENUMBRA: ErrorLimit = ErrorLimit { max: 0.02, rmse: 1.6e-3 };

/// Upper limits for the difference of two pictures in display values, 0 … 255.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DisplayLimit {
    /// Root mean square over the pixels that show something.
    pub(crate) rms: f64,
    /// Largest difference of a colour or of opacity.
    pub(crate) worst: f64,
    /// Difference of the mean colours.
    pub(crate) mean: f64,
}

/// Turned and mirrored scenes: rounding, since directions of the sky, points of lights and pixels of their sheets turn
/// with the scene. Of 120 pictures the worst pixel differs by 0.04.
pub(crate) const SYMMETRIC: DisplayLimit = DisplayLimit { rms: 0.01, worst: 0.1, mean: 0.003 };
/// Empty voxels around a volume, which move slabs and blocks against the data: without a sky 0.13 in the root mean
/// square and 0.09 in the mean are found; with one, surfaces depend on where they cut their blocks, and it is 2.1
/// and 1.5.
pub(crate) const PADDED: DisplayLimit = DisplayLimit { rms: 2.5, worst: 15.0, mean: 2.0 };
/// Removal of empty space by whole blocks: slabs move against the data, by a part of their thickness.
pub(crate) const CROPPED: DisplayLimit = DisplayLimit { rms: 1.0, worst: 15.0, mean: 0.3 };
/// Volumes that are shifted by parts of blocks and slabs: 1.1 in the root mean square is found, and 9 in single pixels
/// of silhouettes.
pub(crate) const SHIFTED: DisplayLimit = DisplayLimit { rms: 1.6, worst: 15.0, mean: 0.3 };
/// Values in other number formats and units: densities have 16 bits, and slabs of single pixels are divided or not.
pub(crate) const REVALUED: DisplayLimit = DisplayLimit { rms: 0.06, worst: 5.0, mean: 0.02 };
/// Same light in other terms: the same sums in another order.
pub(crate) const SAME_LIGHT: DisplayLimit = DisplayLimit { rms: 0.01, worst: 0.1, mean: 0.005 };
/// Pictures in bytes, of twice the exposure: rounding by half a step, and dither.
pub(crate) const EXPOSED: DisplayLimit = DisplayLimit { rms: 0.7, worst: 1.1, mean: 0.1 };
/// Lamps 3000 units away, and discs of a twentieth of a degree, which set behind a surface a little later than points.
pub(crate) const FAR_OR_TINY: DisplayLimit = DisplayLimit { rms: 0.05, worst: 2.0, mean: 0.02 };

/// Flat plates with *Standard*: error of the mean, and root mean square and peak to peak of the rest, over the mean.
/// Slabs of half a voxel are halved where they show an eighth.
pub(crate) const FLAT_STANDARD: [f64; 3] = [0.01, 0.003, 0.01];
/// Tilted plates with *Standard*: differences over two voxels turn the normals of sharp voxels by up to two degrees, and
/// slabs ripple where they meet voxels.
pub(crate) const TILTED_STANDARD: [f64; 3] = [0.03, 0.02, 0.07];
/// Flat and tilted plates with *Fine*: slabs of a quarter, halved where they show a thirty-second.
pub(crate) const PLATE_FINE: [f64; 3] = [0.009, 0.0027, 0.01];
/// Flat plates with *Exact*: steps of a fifth of a voxel.
pub(crate) const FLAT_EXACT: [f64; 3] = [0.002, 0.002, 0.007];
/// Tilted plates with *Exact*: thinner slabs change nothing; texture filters have weights of 8 bits, and those of the
/// oracle are exact.
pub(crate) const TILTED_EXACT: [f64; 3] = [0.0025, 0.0035, 0.012];
/// Opacity of peaks of ± 4 of 255, and of ± 0.2 % of the range, which is four entries of the table wide; relative.
pub(crate) const NARROW_PEAKS: [f64; 2] = [0.01, 0.03];
/// Coverage of pixels beside an edge, and coverages that count as one: the transmittance behind ten voxels of an
/// opacity of 0.99 is none, and a fortieth of a voxel at the edge is not hard.
pub(crate) const COVERAGE_ROUNDING: f64 = 0.01;
/// Antialiased pictures with four and with sixteen rays against pictures of 16 samples, relative to those with one
/// ray: 0.38 and 0.35 are found, with a floor, whose light is that of the middle of pixels, 0.53 and 0.51.
pub(crate) const EDGES_OF_MANY_SAMPLES: [f64; 2] = [0.6, 0.6];
/// Grain of an oblique plate with four phases of its slabs, relative to one: the strongest wave of the grain cancels.
pub(crate) const GRAIN_OF_SHIFTED_SLABS: f64 = 0.6;
/// Pixels partly covered by a crisp outline of labels, relative to a wide one: its ramp is half as wide.
pub(crate) const MAX_CRISP_EDGE_SHARE: f64 = 0.6;
