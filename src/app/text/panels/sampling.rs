//! Texts of the sampling settings of the light pass and the eye pass.

use crate::app::text::{ControlText, control_text};

pub(crate) const KERNEL: ControlText =
    control_text("Kernel", "Reconstruction kernel, which spreads each voxel over the sheets");
pub(crate) const B_SPLINE: ControlText =
    control_text("B-spline", "The default: smooth, an exact partition of unity");
pub(crate) const GAUSSIAN: ControlText =
    control_text("Gaussian", "Adjustable width: narrower is sharper and lets more light pass");
pub(crate) const PREFILTERED: ControlText = control_text(
    "Quick",
    "Blurs the volume once, then needs one look-up per sample: several times faster, nearly the same \
     picture",
);

pub(crate) const SIGMA: ControlText =
    control_text("Sigma", "Width of the Gaussian; smaller ones are sharper and brighten dark interiors");
pub(crate) const SLAB: ControlText = control_text(
    "Slab",
    "Thickness of a slab, in units of the smallest voxel edge; thinner is slower and more accurate",
);

pub(crate) const SLABS: ControlText =
    control_text("Slabs", "Whether slabs are thinner where that is needed, or all equally thick");
pub(crate) const ADAPTIVE_SLABS: ControlText = control_text(
    "Adaptive",
    "A quarter as thick where material is dense: steep surfaces show no weave pattern",
);
pub(crate) const UNIFORM_SLABS: ControlText = control_text("Uniform", "All slabs as thick as set");

pub(crate) const QUADRATURE: ControlText = control_text("Quadrature", "Samples per slab along the ray");
pub(crate) const ONE_POINT: ControlText = control_text("1 point", "The middle of every slab: fast");
pub(crate) const TWO_POINTS: ControlText =
    control_text("2 points", "Twice the work; for export and comparison");

pub(crate) const CLASSIFICATION: ControlText = control_text(
    "Classify",
    "Whether transfer functions are applied after or before reconstruction, for the eye and for lights",
);
pub(crate) const CLASSIFIED_SHEETS: ControlText = control_text(
    "Sheets",
    "The default, post-classification: reconstructed values are classified, and edges stay sharp",
);
pub(crate) const CLASSIFIED_VOXELS: ControlText = control_text(
    "Voxels",
    "Pre-classification: colours and opacities are blurred, not values, so that labels stay apart. \
     Gathered with the quick kernel",
);
pub(crate) const CLASSIFIED_CRISP_VOXELS: ControlText = control_text(
    "Crisp",
    "As Voxels, with narrow edges: outlines of labels stay crisp where voxels are larger than pixels. \
     Coloured shadows and the scattering engine keep wide edges",
);

pub(crate) const ENGINE: ControlText =
    control_text("Sheets", "How sheets are filled, for the eye and for lights");
pub(crate) const GATHER: ControlText =
    control_text("Gather", "Pixels gather what voxels would splat: the same sums, many times faster");
pub(crate) const SCATTER: ControlText = control_text(
    "Scatter",
    "Every voxel is splatted, as in the paper; for comparison and teaching. Has no effect on shadows per sample",
);

pub(crate) const ORDER: ControlText =
    control_text("Order", "Whether the eye pass composites sheets or single splats");
pub(crate) const IMAGE_ALIGNED: ControlText =
    control_text("Image", "Sheets perpendicular to the line of sight: nothing pops or bleeds");
pub(crate) const VOLUME_ALIGNED: ControlText = control_text(
    "Volume",
    "Sheets along the grid's nearest axis (1990): brightness pops as the camera turns past 45°",
);
pub(crate) const EVERY_FOOTPRINT: ControlText = control_text(
    "Splats",
    "Each footprint separately (1991): blurred, and colours bleed where footprints overlap",
);

pub(crate) const NORMALS: ControlText = control_text("Normals", "Source of the surface normals");
pub(crate) const NORMALS_OF_VOLUME: ControlText =
    control_text("Volume", "Differences of values around the sample: the same from every side");
pub(crate) const NORMALS_OF_KERNEL: ControlText =
    control_text("Kernel", "The gradient of the reconstruction itself: the sharpest relief, and slower");
pub(crate) const NORMALS_OF_SHEETS: ControlText =
    control_text("Sheets", "Differences between neighbouring sheets and pixels, as in splatting");
