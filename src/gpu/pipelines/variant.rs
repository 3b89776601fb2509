//! What tells one pipeline of a shader from another: variants, and the override constants that follow from them.

use std::fmt::Debug;
use std::hash::Hash;

use crate::model::{Classification, Deposit, Kernel, Quadrature, Remains, Settings, Sides};

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

/// A shader that follows light, of three colours or of one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct ColorVariant {
    pub shader: &'static str,
    /// Whether all of it has one colour.
    pub one_color: bool,
}

impl Variant for ColorVariant {
    fn shader(&self) -> &'static str {
        self.shader
    }

    fn constants(&self) -> Constants {
        vec![flag("ONE_COLOR", self.one_color)]
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
    pub ends: Ends,
}

/// Where what is shown of a volume ends with its data, as far as anything there is seen; each holds for those before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Ends {
    /// Away from all of that.
    Nowhere,
    /// At the faces of the grid, of which no kernel reaches two that are opposite.
    AtFaces,
    /// At faces that lie so near to each other that a kernel may be cut by two.
    BetweenFaces,
    /// At the faces, and where voxels are missing.
    AtMissing,
}

impl Ends {
    /// `MISSING` and `FACES`.
    pub(crate) fn constants(self) -> [(&'static str, f64); 2] {
        let faces = match self {
            Self::Nowhere => 0.0,
            Self::AtFaces => 1.0,
            Self::BetweenFaces | Self::AtMissing => 2.0,
        };
        [flag("MISSING", self == Self::AtMissing), ("FACES", faces)]
    }
}

impl Reconstruction {
    /// With a kernel and its quadrature along the ray, of what ends away from the faces of a grid without missing voxels,
    /// as most objects do.
    pub(crate) fn new(kernel: Kernel, quadrature: Quadrature) -> Self {
        Self { kernel: kernel.into(), quadrature, ends: Ends::Nowhere }
    }

    /// Of what ends there.
    pub(crate) fn ending(self, ends: Ends) -> Self {
        Self { ends, ..self }
    }

    /// `KERNEL`, `SIGMA`, `QUADRATURE`, `MISSING` and `FACES`.
    pub(crate) fn constants(self) -> Constants {
        let (code, sigma) = match self.kernel {
            KernelVariant::BSpline => (0.0, 0.6),
            KernelVariant::Gaussian { sigma_bits } => (1.0, f64::from_bits(sigma_bits)),
            KernelVariant::Prefiltered => (2.0, 0.6),
        };
        let points = self.quadrature.offsets().len() as f64;
        let mut constants = vec![("KERNEL", code), ("SIGMA", sigma), ("QUADRATURE", points)];
        constants.extend(self.ends.constants());
        constants
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

/// The sky of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum SkyVariant {
    None,
    /// Nothing is in its way.
    Open,
    /// A volume says how open to it places are.
    Looked,
}

impl SkyVariant {
    /// That of a look.
    pub(crate) fn of(settings: &Settings) -> Self {
        match (settings.sky.is_on(), settings.has_sky_volume()) {
            (false, _) => Self::None,
            (true, false) => Self::Open,
            (true, true) => Self::Looked,
        }
    }

    /// `SKY`.
    pub(crate) fn constant(self) -> (&'static str, f64) {
        ("SKY", f64::from(self as u8))
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
    /// Before voxels are spread, or after.
    pub classification: Classification,
    pub sky: SkyVariant,
    /// A volume says how much light has bounced.
    pub has_bounces: bool,
    /// Matter scatters more light forward, or back.
    pub is_anisotropic: bool,
    /// What is left of each light's colours differs.
    pub has_colored_shadows: bool,
}

impl ShadingVariant {
    /// The override constants of shading.
    pub(crate) fn constants(self) -> Constants {
        let mut constants = self.lights.constants();
        constants.push(flag("CUT", self.is_cut));
        constants.push(flag("ONE_SIDED", self.sides == Sides::One));
        constants.push(flag("PRECLASSIFY", self.classification == Classification::Pre));
        if self.is_combined {
            constants.push(("COMBINED", 1.0));
        }
        constants.push(self.sky.constant());
        constants.push(flag("BOUNCES", self.has_bounces));
        constants.push(flag("ANISOTROPIC", self.is_anisotropic));
        constants.push(flag("COLORED", self.has_colored_shadows));
        constants
    }
}

/// A constant that is on or off.
pub(crate) fn flag(name: &'static str, on: bool) -> (&'static str, f64) {
    (name, f64::from(u8::from(on)))
}

/// `DEPOSIT_FRONT`.
pub(crate) fn deposit_constant(deposit: Deposit) -> (&'static str, f64) {
    flag("DEPOSIT_FRONT", deposit == Deposit::Front)
}

/// Whether anything is cut away, for `CUT`.
pub(crate) fn is_cut(remains: Remains) -> bool {
    !remains.is_everything()
}
