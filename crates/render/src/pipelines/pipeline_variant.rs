//! Pipeline variants of shaders, and the override constants that follow from them.

use std::fmt::Debug;
use std::hash::Hash;

use chiaroscuro_scene::{ClippedPart, DepositMode, LitSides, ReconstructionKernel, Settings, SlabQuadrature};

/// Override constants and conditions of a shader, by name.
pub(crate) type ShaderConstants = Vec<(&'static str, f64)>;

/// Parameters of a shader that select one of its pipelines.
pub(crate) trait PipelineVariant: Hash + Eq + Debug {
    /// Returns the path of the shader below `shaders/`.
    fn shader(&self) -> &'static str;

    /// Returns the override constants of the shader, in any order.
    fn constants(&self) -> ShaderConstants;
}

/// Variant of a shader that has a single pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct SingleVariant(pub &'static str);

impl PipelineVariant for SingleVariant {
    fn shader(&self) -> &'static str {
        self.0
    }

    fn constants(&self) -> ShaderConstants {
        Vec::new()
    }
}

/// Variant of a shader that follows light of one colour or of three.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct ColorVariant {
    pub shader: &'static str,
    /// `true` if all light has the same colour.
    pub one_color: bool,
}

impl PipelineVariant for ColorVariant {
    fn shader(&self) -> &'static str {
        self.shader
    }

    fn constants(&self) -> ShaderConstants {
        vec![flag("ONE_COLOR", self.one_color)]
    }
}

/// Reconstruction kernel, in a form that can be hashed (`shaders/density/kernel.wgsl`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum KernelVariant {
    BSpline,
    /// Gaussian; its standard deviation, in voxels, is stored as the bits of an `f64`.
    Gaussian {
        sigma_bits: u64,
    },
    Prefiltered,
}

impl From<ReconstructionKernel> for KernelVariant {
    fn from(kernel: ReconstructionKernel) -> Self {
        match kernel {
            ReconstructionKernel::BSpline => Self::BSpline,
            ReconstructionKernel::Gaussian { sigma } => Self::Gaussian { sigma_bits: sigma.to_bits() },
            ReconstructionKernel::Prefiltered => Self::Prefiltered,
        }
    }
}

/// Reconstruction of density at a point: kernel, quadrature and grid boundaries.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct ReconstructionVariant {
    pub kernel: KernelVariant,
    pub quadrature: SlabQuadrature,
    pub boundaries: GridBoundaries,
}

/// Grid boundaries that can be visible; decides which boundary tests are compiled into the shader. Ordered: each
/// variant includes the checks of those before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum GridBoundaries {
    /// No boundary within the reach of any kernel.
    None,
    /// Faces of the grid; no kernel reaches two opposite ones.
    Faces,
    /// Faces of a grid so thin that one kernel may reach two opposite ones.
    OppositeFaces,
    /// Faces of the grid and missing voxels.
    MissingVoxels,
}

impl GridBoundaries {
    /// Returns the conditions `MISSING` and `FACES`.
    pub(crate) fn constants(self) -> [(&'static str, f64); 2] {
        let faces = match self {
            Self::None => 0.0,
            Self::Faces => 1.0,
            Self::OppositeFaces | Self::MissingVoxels => 2.0,
        };
        [flag("MISSING", self == Self::MissingVoxels), ("FACES", faces)]
    }
}

impl ReconstructionVariant {
    /// Creates a reconstruction without grid boundaries, as for most objects: a kernel and its quadrature along the
    /// ray.
    pub(crate) fn new(kernel: ReconstructionKernel, quadrature: SlabQuadrature) -> Self {
        Self { kernel: kernel.into(), quadrature, boundaries: GridBoundaries::None }
    }

    /// Returns the reconstruction with these grid boundaries.
    pub(crate) fn with_boundaries(self, ends: GridBoundaries) -> Self {
        Self { boundaries: ends, ..self }
    }

    /// Returns the constants `KERNEL`, `SIGMA`, `QUADRATURE`, `MISSING` and `FACES`.
    pub(crate) fn constants(self) -> ShaderConstants {
        let (code, sigma) = match self.kernel {
            KernelVariant::BSpline => (0.0, 0.6),
            KernelVariant::Gaussian { sigma_bits } => (1.0, f64::from_bits(sigma_bits)),
            KernelVariant::Prefiltered => (2.0, 0.6),
        };
        let points = self.quadrature.offsets().len() as f64;
        let mut constants = vec![("KERNEL", code), ("SIGMA", sigma), ("QUADRATURE", points)];
        constants.extend(self.boundaries.constants());
        constants
    }
}

/// Number of lights in a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct LightCount {
    pub all: u32,
    /// Number of lights that cast shadows.
    pub shadowed: u32,
}

impl LightCount {
    /// Returns the constants `LIGHTS` and `SHADOWED`.
    pub(crate) fn constants(self) -> ShaderConstants {
        vec![("LIGHTS", f64::from(self.all)), ("SHADOWED", f64::from(self.shadowed))]
    }
}

/// Treatment of the sky in a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum SkyVariant {
    None,
    /// The sky is not occluded; no volume is looked up.
    Unoccluded,
    /// Sky visibility is looked up in a volume.
    Volume,
}

impl SkyVariant {
    /// Returns the variant that the settings ask for.
    pub(crate) fn from_settings(settings: &Settings) -> Self {
        match (settings.sky.is_on(), settings.has_sky_volume()) {
            (false, _) => Self::None,
            (true, false) => Self::Unoccluded,
            (true, true) => Self::Volume,
        }
    }

    /// Returns the condition `SKY`.
    pub(crate) fn constant(self) -> (&'static str, f64) {
        ("SKY", f64::from(self as u8))
    }
}

/// Variant of the shading code, shared by all passes that shade.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct ShadingVariant {
    pub lights: LightCount,
    /// `true` if the diffuse light of shadowed lights is in one combined volume.
    pub is_combined: bool,
    pub is_cut: bool,
    pub sides: LitSides,
    /// `true` if voxels are classified before reconstruction.
    pub is_preclassified: bool,
    /// `true` if further layers tint the material.
    pub is_tinted: bool,
    pub sky: SkyVariant,
    /// `true` if scattered light is looked up in a volume.
    pub has_scattered_light: bool,
    /// `true` if the phase function is anisotropic: more light is scattered forward, or back.
    pub is_anisotropic: bool,
    /// `true` if transmittance differs between red, green and blue light.
    pub has_colored_shadows: bool,
}

impl ShadingVariant {
    /// Returns the override constants and conditions of the shading code.
    pub(crate) fn constants(self) -> ShaderConstants {
        let mut constants = self.lights.constants();
        constants.push(flag("CUT", self.is_cut));
        constants.push(flag("ONE_SIDED", self.sides == LitSides::One));
        constants.push(flag("PRECLASSIFY", self.is_preclassified));
        constants.push(flag("TINTED", self.is_tinted));
        if self.is_combined {
            constants.push(("COMBINED", 1.0));
        }
        constants.push(self.sky.constant());
        constants.push(flag("BOUNCES", self.has_scattered_light));
        constants.push(flag("ANISOTROPIC", self.is_anisotropic));
        constants.push(flag("COLORED", self.has_colored_shadows));
        constants
    }
}

/// Returns a constant with the value 1 if `on`, else 0.
pub(crate) fn flag(name: &'static str, on: bool) -> (&'static str, f64) {
    (name, f64::from(u8::from(on)))
}

/// Returns the constant `DEPOSIT_FRONT`.
pub(crate) fn deposit_constant(deposit: DepositMode) -> (&'static str, f64) {
    flag("DEPOSIT_FRONT", deposit == DepositMode::Front)
}

/// Returns the value of `CUT`: true if the crop box or the clip plane removes anything.
pub(crate) fn is_cut(remains: ClippedPart) -> bool {
    !remains.is_unclipped()
}
