//! Texts of the sampling settings of the light pass and the eye pass.

use crate::app::text::{ControlText, control_text};

pub(crate) const KERNEL: ControlText = control_text("Kernel", "How a voxel is spread over the sheets");
pub(crate) const B_SPLINE: ControlText =
    control_text("B-spline", "The default: smooth, an exact partition of unity");
pub(crate) const GAUSSIAN: ControlText =
    control_text("Gaussian", "Of a width of your choice: narrower is sharper and lets more light pass");
pub(crate) const PREFILTERED: ControlText =
    control_text("Quick", "The volume blurred once, then one look-up: several times faster, nearly the same");

pub(crate) const SIGMA: ControlText =
    control_text("Sigma", "Width of the Gaussian; smaller ones are sharper and brighten dark interiors");
pub(crate) const SLAB: ControlText = control_text(
    "Slab",
    "Thickness of a sheet in edges of the smallest voxel; thinner is slower and more exact",
);

pub(crate) const SLABS: ControlText =
    control_text("Slabs", "Whether all slabs of the picture are equally thick");
pub(crate) const ADAPTIVE_SLABS: ControlText =
    control_text("By need", "A quarter as thick where material is dense: steep surfaces show no weave");
pub(crate) const UNIFORM_SLABS: ControlText = control_text("Even", "All as thick as set");

pub(crate) const QUADRATURE: ControlText = control_text("Quadrature", "Samples per slab along the ray");
pub(crate) const ONE_POINT: ControlText = control_text("1 point", "The middle of every slab: fast");
pub(crate) const TWO_POINTS: ControlText =
    control_text("2 points", "Twice the work; for export and comparison");

pub(crate) const CLASSIFICATION: ControlText =
    control_text("Classify", "When the transfer functions are applied, for the eye and for lights");
pub(crate) const CLASSIFIED_SHEETS: ControlText =
    control_text("Sheets", "The default: what is reconstructed is classified, and edges stay sharp");
pub(crate) const CLASSIFIED_VOXELS: ControlText = control_text(
    "Voxels",
    "What voxels mean is blurred, not their numbers: labels stay apart. Gathered with the quick kernel",
);

pub(crate) const ENGINE: ControlText =
    control_text("Sheets", "How sheets are filled, for the eye and for lights");
pub(crate) const GATHER: ControlText =
    control_text("Gather", "Pixels gather what voxels would splat: the same sums, many times faster");
pub(crate) const SCATTER: ControlText = control_text(
    "Scatter",
    "Every voxel is splatted, as in the paper; for comparison and teaching. Has no effect on shadows per sample",
);

pub(crate) const ORDER: ControlText = control_text("Order", "What is composited, for the eye");
pub(crate) const IMAGE_ALIGNED: ControlText =
    control_text("Image", "Sheets across the line of sight: nothing pops or bleeds");
pub(crate) const VOLUME_ALIGNED: ControlText = control_text(
    "Volume",
    "Sheets along the grid's nearest axis (1990): brightness pops as the camera turns past 45°",
);
pub(crate) const EVERY_FOOTPRINT: ControlText = control_text(
    "Splats",
    "Every footprint by itself (1991): blurred, and colours bleed where footprints overlap",
);

pub(crate) const NORMALS: ControlText = control_text("Normals", "Where the surface's direction comes from");
pub(crate) const NORMALS_OF_VOLUME: ControlText =
    control_text("Volume", "Differences around the sample: the same from every side");
pub(crate) const NORMALS_OF_KERNEL: ControlText =
    control_text("Kernel", "The slope of the reconstruction itself: the sharpest relief, and slower");
pub(crate) const NORMALS_OF_SHEETS: ControlText =
    control_text("Sheets", "Differences between neighbouring sheets and pixels: as splatting has them");
