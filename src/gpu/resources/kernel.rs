//! How a kernel is said to a shader: override constants of `density/kernel.wgsl`,
//! `density/volume.wgsl`, `density/classify.wgsl` and `density/cut.wgsl`.

use crate::model::{Classification, Kernel, Quadrature, Remains};

/// `KERNEL` and `SIGMA`.
pub(crate) fn kernel_constants(kernel: Kernel) -> [(&'static str, f64); 2] {
    let (code, sigma) = match kernel {
        Kernel::BSpline => (0.0, 0.6),
        Kernel::Gaussian { sigma } => (1.0, sigma),
        Kernel::Prefiltered => (2.0, 0.6),
    };
    [("KERNEL", code), ("SIGMA", sigma)]
}

/// `QUADRATURE`.
pub(crate) fn quadrature_constant(quadrature: Quadrature) -> (&'static str, f64) {
    ("QUADRATURE", quadrature.offsets().len() as f64)
}

/// `PRECLASSIFY`.
pub(crate) fn classification_constant(classification: Classification) -> (&'static str, f64) {
    ("PRECLASSIFY", f64::from(u8::from(classification == Classification::Pre)))
}

/// `CUT`.
pub(crate) fn cut_constant(remains: Remains) -> (&'static str, f64) {
    ("CUT", f64::from(u8::from(!remains.is_everything())))
}
