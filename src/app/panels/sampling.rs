//! Rows for the sampling of the light pass and the eye pass: kernel, slab and quadrature; and for the engine.

use eframe::egui::Ui;

use super::super::text::{self, ControlText};
use super::controls::{NumberRow, choice_row};
use chiaroscuro_scene::{
    ClassificationOrder, GradientSource, ReconstructionKernel, RenderEngine, SamplingSettings, SheetOrder,
    SlabMode, SlabQuadrature,
};

/// Standard deviation σ of a newly chosen Gaussian kernel, in voxels.
const DEFAULT_SIGMA: f64 = 0.6;

const QUADRATURES: [(SlabQuadrature, ControlText); 2] =
    [(SlabQuadrature::One, text::sampling::ONE_POINT), (SlabQuadrature::Two, text::sampling::TWO_POINTS)];

const SLABS: [(SlabMode, ControlText); 2] =
    [(SlabMode::ByNeed, text::sampling::ADAPTIVE_SLABS), (SlabMode::Even, text::sampling::UNIFORM_SLABS)];

const CLASSIFICATIONS: [(ClassificationOrder, ControlText); 3] = [
    (ClassificationOrder::Post, text::sampling::CLASSIFIED_SHEETS),
    (ClassificationOrder::Pre, text::sampling::CLASSIFIED_VOXELS),
    (ClassificationOrder::PreCrisp, text::sampling::CLASSIFIED_CRISP_VOXELS),
];

const ENGINES: [(RenderEngine, ControlText); 2] =
    [(RenderEngine::Gather, text::sampling::GATHER), (RenderEngine::Scatter, text::sampling::SCATTER)];

const ORDERS: [(SheetOrder, ControlText); 3] = [
    (SheetOrder::ImageAligned, text::sampling::IMAGE_ALIGNED),
    (SheetOrder::VolumeAligned, text::sampling::VOLUME_ALIGNED),
    (SheetOrder::EveryFootprint, text::sampling::EVERY_FOOTPRINT),
];

const GRADIENTS: [(GradientSource, ControlText); 3] = [
    (GradientSource::Volume, text::sampling::NORMALS_OF_VOLUME),
    (GradientSource::Kernel, text::sampling::NORMALS_OF_KERNEL),
    (GradientSource::Sheets, text::sampling::NORMALS_OF_SHEETS),
];

/// Kernel and slab thickness of the first look, which reset buttons restore.
#[derive(Debug, Clone, Copy)]
pub(super) struct SamplingDefaults {
    pub kernel: ReconstructionKernel,
    pub slab: f64,
}

/// Shows the rows for kernel, slab thickness and quadrature.
pub(super) fn show_kernel_and_slab(
    ui: &mut Ui,
    kernel: &mut ReconstructionKernel,
    slab: &mut f64,
    first: SamplingDefaults,
    quadrature: &mut SlabQuadrature,
) {
    let sigma = if let ReconstructionKernel::Gaussian { sigma } = kernel { *sigma } else { DEFAULT_SIGMA };
    let kernels = [
        (ReconstructionKernel::BSpline, text::sampling::B_SPLINE),
        (ReconstructionKernel::Gaussian { sigma }, text::sampling::GAUSSIAN),
        (ReconstructionKernel::Prefiltered, text::sampling::PREFILTERED),
    ];
    choice_row(ui, text::sampling::KERNEL, kernel, &kernels);
    let voxels = |named, range| NumberRow::new(named, range).unit(text::common::VOXELS_SUFFIX);
    if let ReconstructionKernel::Gaussian { sigma } = kernel {
        let first_sigma =
            if let ReconstructionKernel::Gaussian { sigma } = first.kernel { sigma } else { DEFAULT_SIGMA };
        voxels(text::sampling::SIGMA, 0.4..=0.8).show(ui, sigma, first_sigma);
    }
    voxels(text::sampling::SLAB, 0.25..=2.0).show(ui, slab, first.slab);
    choice_row(ui, text::sampling::QUADRATURE, quadrature, &QUADRATURES);
}

/// Shows the row that chooses between slabs by need and even slabs for the eye pass.
pub(super) fn show_slabs(ui: &mut Ui, slabs: &mut SlabMode) {
    choice_row(ui, text::sampling::SLABS, slabs, &SLABS);
}

/// Shows the rows for classification, engine, sheet order, and the source of the normals of the eye pass.
pub(super) fn show_engine(ui: &mut Ui, sampling: &mut SamplingSettings) {
    choice_row(ui, text::sampling::CLASSIFICATION, &mut sampling.classification, &CLASSIFICATIONS);
    choice_row(ui, text::sampling::ENGINE, &mut sampling.engine, &ENGINES);
    if sampling.engine == RenderEngine::Scatter {
        choice_row(ui, text::sampling::ORDER, &mut sampling.order, &ORDERS);
    } else {
        choice_row(ui, text::sampling::NORMALS, &mut sampling.gradients, &GRADIENTS);
    }
}
