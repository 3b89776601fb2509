//! Kernel, slab and quadrature: the same rows for the light's and for the eye's pass; and what fills the
//! sheets.

use eframe::egui::Ui;

use super::controls::{Number, choice};
use crate::model::{Classification, Engine, Gradients, Kernel, Quadrature, Sampling, SheetOrder};

/// σ where a Gaussian is chosen anew.
const SIGMA: f64 = 0.6;

/// Shows the three rows. `default_slab`: what the reset button puts back.
pub(super) fn show(
    ui: &mut Ui,
    kernel: &mut Kernel,
    (slab, default_slab): (&mut f64, f64),
    quadrature: &mut Quadrature,
) {
    let sigma = if let Kernel::Gaussian { sigma } = kernel { *sigma } else { SIGMA };
    let kernels = [
        (Kernel::BSpline, "B-spline", "The default: smooth, an exact partition of unity"),
        (
            Kernel::Gaussian { sigma },
            "Gaussian",
            "Of a width of your choice: narrower is sharper and lets more light pass",
        ),
        (
            Kernel::Prefiltered,
            "Quick",
            "The volume blurred once, then one look-up: several times faster, nearly the same",
        ),
    ];
    choice(ui, "Kernel", "How a voxel is spread over the sheets", kernel, &kernels);
    if let Kernel::Gaussian { sigma } = kernel {
        let tip = "Width of the Gaussian; smaller ones are sharper and brighten dark interiors";
        Number::new("Sigma", 0.4..=0.8, tip).unit(" vox").show(ui, sigma, SIGMA);
    }
    let tip = "Thickness of a sheet in edges of the smallest voxel; thinner is slower and more exact";
    Number::new("Slab", 0.25..=2.0, tip).unit(" vox").show(ui, slab, default_slab);
    let quadratures = [
        (Quadrature::One, "1 point", "The middle of every slab: fast"),
        (Quadrature::Two, "2 points", "Twice the work; for export and comparison"),
    ];
    choice(ui, "Quadrature", "Samples per slab along the ray", quadrature, &quadratures);
}

/// Shows what fills the sheets of both passes, and where the eye's normals come from.
pub(super) fn show_engine(ui: &mut Ui, sampling: &mut Sampling) {
    let engines = [
        (Engine::Gather, "Gather", "Pixels gather what voxels would splat: the same sums, many times faster"),
        (
            Engine::Scatter,
            "Scatter",
            "Every voxel is splatted, as in the paper; for comparison and teaching. Has no effect on direct shadows",
        ),
    ];
    let classifications = [
        (
            Classification::Post,
            "Sheets",
            "The default: what is reconstructed is classified, and edges stay sharp",
        ),
        (
            Classification::Pre,
            "Voxels",
            "Voxels are classified and their colours blurred: for comparison; slower",
        ),
    ];
    let tip = "When the transfer functions are applied, also for lights that are splatted";
    choice(ui, "Classify", tip, &mut sampling.classification, &classifications);
    choice(ui, "Sheets", "How sheets are filled, for the eye and for lights", &mut sampling.engine, &engines);
    if sampling.engine == Engine::Scatter {
        let orders = [
            (SheetOrder::ImageAligned, "Image", "Sheets across the line of sight: nothing pops or bleeds"),
            (
                SheetOrder::VolumeAligned,
                "Volume",
                "Sheets along the grid's nearest axis (1990): brightness pops as the camera turns past 45°",
            ),
            (
                SheetOrder::EveryFootprint,
                "Splats",
                "Every footprint by itself (1991): blurred, and colours bleed where footprints overlap",
            ),
        ];
        choice(ui, "Order", "What is composited, for the eye", &mut sampling.order, &orders);
    } else {
        let gradients = [
            (Gradients::Volume, "Volume", "Differences around the sample: the same from every side"),
            (
                Gradients::Sheets,
                "Sheets",
                "Differences between neighbouring sheets and pixels: as splatting has them",
            ),
        ];
        choice(
            ui,
            "Normals",
            "Where the surface's direction comes from",
            &mut sampling.gradients,
            &gradients,
        );
    }
}
