//! Sampling settings: reconstruction kernel, slabs, gradients and rendering engine.

use serde::{Deserialize, Serialize};

use crate::Settings;

/// Reconstruction kernel with which voxels are spread over space.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ReconstructionKernel {
    /// Cubic B-spline: an exact partition of unity, within 2 % of a Gaussian of σ = 0.6 voxel.
    BSpline,
    /// Gaussian of the paper, truncated at two voxels and normalised.
    Gaussian {
        /// Standard deviation in voxels, 0.4 … 0.8.
        sigma: f64,
    },
    /// Volume filtered once with [1/12, 10/12, 1/12]³, then one trilinear fetch: the same variance as the B-spline at
    /// an eighth of the fetches.
    Prefiltered,
}

/// Number of points for the kernel's integral over a slab (Gauss–Legendre).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SlabQuadrature {
    /// One point in the middle of the slab.
    One,
    /// Two points, ± Δs/(2√3) from the middle.
    Two,
}

impl SlabQuadrature {
    /// Returns the offsets from the middle of the slab, in units of its thickness; weights are equal.
    pub fn offsets(self) -> &'static [f64] {
        // 1/(2√3)
        const TWO: f64 = 0.288_675_134_594_812_9;
        match self {
            Self::One => &[0.0],
            Self::Two => &[-TWO, TWO],
        }
    }
}

/// Source of surface normals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GradientSource {
    /// Central differences of the prefiltered volume around the sample: nearly the gradient of the B-spline.
    Volume,
    /// Exact gradient of the B-spline reconstruction; with other kernels, and with the scattering engine, as
    /// [`Self::Volume`].
    Kernel,
    /// Differences between neighbouring sheets and their pixels (the paper's reference 16).
    Sheets,
}

/// Rendering engine: fills sheets by gathering or by scattering.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RenderEngine {
    /// Gathering: every pixel, and every voxel of a light volume, sums the splats that reach it. The same sums as
    /// splatting, but faster.
    Gather,
    /// Scattering: every voxel is splatted into the sheets, and every pixel of a light's sheets back into the grid,
    /// as in the paper (figure 3).
    Scatter,
}

/// Order of classification by the transfer function and interpolation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ClassificationOrder {
    /// Post-classification, of the sheets: sharp edges even with coarse voxels (P §3.5).
    Post,
    /// Pre-classification, of the voxels, whose colours and extinctions are then spread: as blurred as the kernel.
    /// Rays to lights are still post-classified.
    Pre,
    /// Pre-classification whose blurred edges are made steep again, for labels: outlines stay crisp where voxels are
    /// larger than pixels ([`crate::BakedTransfer::crisp_ramp`]).
    PreCrisp,
}

impl ClassificationOrder {
    /// Returns true if voxels are classified before kernels spread them.
    pub fn is_pre(self) -> bool {
        match self {
            Self::Post => false,
            Self::Pre | Self::PreCrisp => true,
        }
    }

    /// Returns true if edges of voxels that are classified first are made steep.
    pub fn has_crisp_edges(self) -> bool {
        self == Self::PreCrisp
    }
}

impl Settings {
    /// Returns the order of classification and interpolation. Labels and layers are always classified first: numbers
    /// between two labels mean nothing, and layers are composed voxel by voxel. Edges are made steep only by gathering and for light of one colour: colours
    /// attenuate by shares of extinction that a curve would change.
    pub fn classification(&self) -> ClassificationOrder {
        if let Some(order) = self.layered_classification() {
            return order;
        }
        let can_be_crisp = !self.uses_scattering_engine() && !self.has_colored_shadows();
        match self.sampling.classification {
            ClassificationOrder::PreCrisp if can_be_crisp => ClassificationOrder::PreCrisp,
            ClassificationOrder::Post if self.layer().labels.is_empty() => ClassificationOrder::Post,
            _ => ClassificationOrder::Pre,
        }
    }
}

/// Compositing order of the scattering engine's eye pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SheetOrder {
    /// Sheets perpendicular to the line of sight (the paper's references 17 and 18).
    ImageAligned,
    /// Sheets along the volume axis nearest to the line of sight (the paper's reference 26): brightness pops when
    /// another axis becomes the nearest.
    VolumeAligned,
    /// Individual footprints, classified per voxel (the paper's reference 25): overlaps bleed.
    EveryFootprint,
}

/// Slab thickness: uniform, adaptive or pre-integrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SlabMode {
    /// Uniform slabs of thickness [`SamplingSettings::slab`].
    Even,
    /// Adaptive slabs: half of that, and a quarter where a slab would contribute more to the ray than
    /// [`SamplingSettings::max_undivided_share`]; integrated between samples at their faces. Samples in the middle of
    /// even slabs show as wood grain on steep surfaces.
    ByNeed,
    /// Uniform slabs of thickness [`SamplingSettings::slab`], with opacity integrated through each of its
    /// [`PREINTEGRATED_STEPS`] steps from the densities at both ends (Engel, Kraus and Ertl, "High-quality
    /// pre-integrated volume rendering", 2001), and shaded once where that opacity lies: fast previews of thin parts
    /// without banding.
    Preintegrated,
}

/// Number of steps per slab along a ray with pre-integrated opacity.
pub const PREINTEGRATED_STEPS: u32 = 2;

/// Share of a ray's light above which adaptive slabs are halved at the quality *Standard*.
///
/// Halving itself shows as a ripple of 0.2 % of the light, and of 0.1 % at [`FINE_UNDIVIDED_SHARE`], which takes 1.05
/// times the samples.
pub const STANDARD_UNDIVIDED_SHARE: f64 = 1.0 / 8.0;

/// Share of a ray's light above which adaptive slabs are halved at the quality *Fine*.
pub const FINE_UNDIVIDED_SHARE: f64 = 1.0 / 32.0;

/// Number of thinnest adaptive slabs in a thickness of [`SamplingSettings::slab`].
pub const MAX_SLAB_PARTS: u32 = 4;

/// Sampling of the eye's sheets, and the rendering engine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SamplingSettings {
    /// Reconstruction kernel of the eye pass.
    pub kernel: ReconstructionKernel,
    /// Thickness of slabs in smallest voxel edges; adaptive ones are a half or a quarter of it.
    pub slab: f64,
    /// Uniform, adaptive or pre-integrated slabs.
    pub slabs: SlabMode,
    /// Share of a ray's light above which an adaptive slab is halved: where it may contribute more, 0 … 1.
    pub max_undivided_share: f64,
    /// Number of quadrature points per slab.
    pub quadrature: SlabQuadrature,
    /// Source of normals; with the scattering engine, sheets are all that there is of the volume, so there normals
    /// come from sheets.
    pub gradients: GradientSource,
    /// Order of classification and interpolation, for the sheets of lights, too.
    pub classification: ClassificationOrder,
    /// Engine that fills the sheets, those of lights, too.
    pub engine: RenderEngine,
    /// Compositing order of the scattering engine, for comparison with earlier work.
    pub order: SheetOrder,
    /// Reads resolution levels that are finer than the one in memory where pixels are finer than its voxels.
    pub finer_levels: bool,
}

impl Default for SamplingSettings {
    fn default() -> Self {
        Self {
            kernel: ReconstructionKernel::BSpline,
            slab: 1.0,
            slabs: SlabMode::Even,
            max_undivided_share: STANDARD_UNDIVIDED_SHARE,
            quadrature: SlabQuadrature::One,
            gradients: GradientSource::Volume,
            classification: ClassificationOrder::Post,
            engine: RenderEngine::Gather,
            order: SheetOrder::ImageAligned,
            finer_levels: true,
        }
    }
}
