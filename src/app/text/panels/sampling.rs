//! Texts of the sampling settings of the light pass and the eye pass.

use crate::app::text::{Named, named};

pub(crate) const KERNEL: Named = named("Kernel", "How a voxel is spread over the sheets");
pub(crate) const B_SPLINE: Named = named("B-spline", "The default: smooth, an exact partition of unity");
pub(crate) const GAUSSIAN: Named =
    named("Gaussian", "Of a width of your choice: narrower is sharper and lets more light pass");
pub(crate) const PREFILTERED: Named =
    named("Quick", "The volume blurred once, then one look-up: several times faster, nearly the same");

pub(crate) const SIGMA: Named =
    named("Sigma", "Width of the Gaussian; smaller ones are sharper and brighten dark interiors");
pub(crate) const SLAB: Named =
    named("Slab", "Thickness of a sheet in edges of the smallest voxel; thinner is slower and more exact");

pub(crate) const SLABS: Named = named("Slabs", "Whether all slabs of the picture are equally thick");
pub(crate) const BY_NEED: Named =
    named("By need", "A quarter as thick where material is dense: steep surfaces show no weave");
pub(crate) const EVEN: Named = named("Even", "All as thick as set");

pub(crate) const QUADRATURE: Named = named("Quadrature", "Samples per slab along the ray");
pub(crate) const ONE_POINT: Named = named("1 point", "The middle of every slab: fast");
pub(crate) const TWO_POINTS: Named = named("2 points", "Twice the work; for export and comparison");

pub(crate) const CLASSIFICATION: Named =
    named("Classify", "When the transfer functions are applied, for the eye and for lights");
pub(crate) const CLASSIFIED_SHEETS: Named =
    named("Sheets", "The default: what is reconstructed is classified, and edges stay sharp");
pub(crate) const CLASSIFIED_VOXELS: Named = named(
    "Voxels",
    "What voxels mean is blurred, not their numbers: labels stay apart. Gathered with the quick kernel",
);

pub(crate) const ENGINE: Named = named("Sheets", "How sheets are filled, for the eye and for lights");
pub(crate) const GATHER: Named =
    named("Gather", "Pixels gather what voxels would splat: the same sums, many times faster");
pub(crate) const SCATTER: Named = named(
    "Scatter",
    "Every voxel is splatted, as in the paper; for comparison and teaching. Has no effect on shadows per sample",
);

pub(crate) const ORDER: Named = named("Order", "What is composited, for the eye");
pub(crate) const IMAGE_ALIGNED: Named =
    named("Image", "Sheets across the line of sight: nothing pops or bleeds");
pub(crate) const VOLUME_ALIGNED: Named = named(
    "Volume",
    "Sheets along the grid's nearest axis (1990): brightness pops as the camera turns past 45°",
);
pub(crate) const EVERY_FOOTPRINT: Named =
    named("Splats", "Every footprint by itself (1991): blurred, and colours bleed where footprints overlap");

pub(crate) const NORMALS: Named = named("Normals", "Where the surface's direction comes from");
pub(crate) const NORMALS_OF_VOLUME: Named =
    named("Volume", "Differences around the sample: the same from every side");
pub(crate) const NORMALS_OF_KERNEL: Named =
    named("Kernel", "The slope of the reconstruction itself: the sharpest relief, and slower");
pub(crate) const NORMALS_OF_SHEETS: Named =
    named("Sheets", "Differences between neighbouring sheets and pixels: as splatting has them");
