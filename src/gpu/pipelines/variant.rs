//! What tells one pipeline of a shader from another: variants, and the override constants that follow from them.

use std::fmt::Debug;
use std::hash::Hash;

use crate::model::{Classification, Deposit, Kernel, Quadrature, Remains, Sides};

/// Override constants of a shader, by name.
pub(crate) type Constants = Vec<(&'static str, f64)>;

/// Everything that tells one pipeline of a shader from another.
pub(crate) trait Variant: Hash + Eq + Debug {
    /// The shader's file below `shaders/`.
    fn shader(&self) -> &'static str;

    /// The shader's override constants; the order does not count.
    fn constants(&self) -> Constants;
}

/// A shader of which there is one pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Only(pub &'static str);

impl Variant for Only {
    fn shader(&self) -> &'static str {
        self.0
    }

    fn constants(&self) -> Constants {
        Vec::new()
    }
}

/// A reconstruction kernel, as pipelines tell them apart (`shaders/density/kernel.wgsl`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum KernelVariant {
    BSpline,
    /// The bits of its standard deviation, in voxels.
    Gaussian {
        sigma_bits: u64,
    },
    Prefiltered,
}

impl From<Kernel> for KernelVariant {
    fn from(kernel: Kernel) -> Self {
        match kernel {
            Kernel::BSpline => Self::BSpline,
            Kernel::Gaussian { sigma } => Self::Gaussian { sigma_bits: sigma.to_bits() },
            Kernel::Prefiltered => Self::Prefiltered,
        }
    }
}

/// How density is reconstructed at a point: kernel and quadrature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Reconstruction {
    pub kernel: KernelVariant,
    pub quadrature: Quadrature,
    /// Voxels are missing.
    pub has_missing: bool,
}

impl Reconstruction {
    /// With a kernel and its quadrature along the ray, of a volume whose voxels are all there.
    pub(crate) fn new(kernel: Kernel, quadrature: Quadrature) -> Self {
        Self { kernel: kernel.into(), quadrature, has_missing: false }
    }

    /// Of a volume in which voxels are missing, or are not.
    pub(crate) fn with_missing(self, has_missing: bool) -> Self {
        Self { has_missing, ..self }
    }

    /// `KERNEL`, `SIGMA`, `QUADRATURE` and `MISSING`.
    pub(crate) fn constants(self) -> Constants {
        let (code, sigma) = match self.kernel {
            KernelVariant::BSpline => (0.0, 0.6),
            KernelVariant::Gaussian { sigma_bits } => (1.0, f64::from_bits(sigma_bits)),
            KernelVariant::Prefiltered => (2.0, 0.6),
        };
        vec![
            ("KERNEL", code),
            ("SIGMA", sigma),
            ("QUADRATURE", self.quadrature.offsets().len() as f64),
            flag("MISSING", self.has_missing),
        ]
    }
}

/// How many lights a picture has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct LightCount {
    pub all: u32,
    /// Those that material attenuates.
    pub shadowed: u32,
}

impl LightCount {
    /// `LIGHTS` and `SHADOWED`.
    pub(crate) fn constants(self) -> Constants {
        vec![("LIGHTS", f64::from(self.all)), ("SHADOWED", f64::from(self.shadowed))]
    }
}

/// What tells pipelines apart of passes that shade.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct ShadingVariant {
    pub lights: LightCount,
    /// The diffuse light of shadowed lights is in one volume.
    pub is_combined: bool,
    pub is_cut: bool,
    pub sides: Sides,
}

impl ShadingVariant {
    /// The override constants of shading.
    pub(crate) fn constants(self) -> Constants {
        let mut constants = self.lights.constants();
        constants.push(flag("CUT", self.is_cut));
        constants.push(flag("ONE_SIDED", self.sides == Sides::One));
        if self.is_combined {
            constants.push(("COMBINED", 1.0));
        }
        constants
    }
}

/// A constant that is on or off.
pub(crate) fn flag(name: &'static str, on: bool) -> (&'static str, f64) {
    (name, f64::from(u8::from(on)))
}

/// `PRECLASSIFY`.
pub(crate) fn classification_constant(classification: Classification) -> (&'static str, f64) {
    flag("PRECLASSIFY", classification == Classification::Pre)
}

/// `DEPOSIT_FRONT`.
pub(crate) fn deposit_constant(deposit: Deposit) -> (&'static str, f64) {
    flag("DEPOSIT_FRONT", deposit == Deposit::Front)
}

/// Whether anything is cut away, for `CUT`.
pub(crate) fn is_cut(remains: Remains) -> bool {
    !remains.is_everything()
}
