//! Rows for the sampling of the light pass and the eye pass: kernel, slab and quadrature; and for the engine.

use eframe::egui::Ui;

use super::super::text::{self, Named};
use super::controls::{Number, choice};
use crate::model::{Classification, Engine, Gradients, Kernel, Quadrature, Sampling, SheetOrder, Slabs};

/// Standard deviation σ of a newly chosen Gaussian kernel, in voxels.
const SIGMA: f64 = 0.6;

const QUADRATURES: [(Quadrature, Named); 2] =
    [(Quadrature::One, text::sampling::ONE_POINT), (Quadrature::Two, text::sampling::TWO_POINTS)];

const SLABS: [(Slabs, Named); 2] =
    [(Slabs::ByNeed, text::sampling::BY_NEED), (Slabs::Even, text::sampling::EVEN)];

const CLASSIFICATIONS: [(Classification, Named); 2] = [
    (Classification::Post, text::sampling::CLASSIFIED_SHEETS),
    (Classification::Pre, text::sampling::CLASSIFIED_VOXELS),
];

const ENGINES: [(Engine, Named); 2] =
    [(Engine::Gather, text::sampling::GATHER), (Engine::Scatter, text::sampling::SCATTER)];

const ORDERS: [(SheetOrder, Named); 3] = [
    (SheetOrder::ImageAligned, text::sampling::IMAGE_ALIGNED),
    (SheetOrder::VolumeAligned, text::sampling::VOLUME_ALIGNED),
    (SheetOrder::EveryFootprint, text::sampling::EVERY_FOOTPRINT),
];

const GRADIENTS: [(Gradients, Named); 3] = [
    (Gradients::Volume, text::sampling::NORMALS_OF_VOLUME),
    (Gradients::Kernel, text::sampling::NORMALS_OF_KERNEL),
    (Gradients::Sheets, text::sampling::NORMALS_OF_SHEETS),
];

/// Kernel and slab thickness of the first look, which reset buttons restore.
#[derive(Debug, Clone, Copy)]
pub(super) struct FirstLook {
    pub kernel: Kernel,
    pub slab: f64,
}

/// Shows the rows for kernel, slab thickness and quadrature.
pub(super) fn show(
    ui: &mut Ui,
    kernel: &mut Kernel,
    slab: &mut f64,
    first: FirstLook,
    quadrature: &mut Quadrature,
) {
    let sigma = if let Kernel::Gaussian { sigma } = kernel { *sigma } else { SIGMA };
    let kernels = [
        (Kernel::BSpline, text::sampling::B_SPLINE),
        (Kernel::Gaussian { sigma }, text::sampling::GAUSSIAN),
        (Kernel::Prefiltered, text::sampling::PREFILTERED),
    ];
    choice(ui, text::sampling::KERNEL, kernel, &kernels);
    let voxels = |named, range| Number::new(named, range).unit(text::common::VOX);
    if let Kernel::Gaussian { sigma } = kernel {
        let first_sigma = if let Kernel::Gaussian { sigma } = first.kernel { sigma } else { SIGMA };
        voxels(text::sampling::SIGMA, 0.4..=0.8).show(ui, sigma, first_sigma);
    }
    voxels(text::sampling::SLAB, 0.25..=2.0).show(ui, slab, first.slab);
    choice(ui, text::sampling::QUADRATURE, quadrature, &QUADRATURES);
}

/// Shows the row that chooses between slabs by need and even slabs for the eye pass.
pub(super) fn show_slabs(ui: &mut Ui, slabs: &mut Slabs) {
    choice(ui, text::sampling::SLABS, slabs, &SLABS);
}

/// Shows the rows for classification, engine, sheet order, and the source of the normals of the eye pass.
pub(super) fn show_engine(ui: &mut Ui, sampling: &mut Sampling) {
    choice(ui, text::sampling::CLASSIFICATION, &mut sampling.classification, &CLASSIFICATIONS);
    choice(ui, text::sampling::ENGINE, &mut sampling.engine, &ENGINES);
    if sampling.engine == Engine::Scatter {
        choice(ui, text::sampling::ORDER, &mut sampling.order, &ORDERS);
    } else {
        choice(ui, text::sampling::NORMALS, &mut sampling.gradients, &GRADIENTS);
    }
}
