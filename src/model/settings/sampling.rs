//! How sheets are filled and sampled.

use serde::{Deserialize, Serialize};

/// The reconstruction kernel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kernel {
    /// Cubic B-spline: an exact partition of unity, within 2 % of a Gaussian of σ = 0.6 voxel.
    BSpline,
    /// The paper's kernel, cut at two voxels and normalised.
    Gaussian {
        /// Standard deviation in voxels, 0.4 … 0.8.
        sigma: f64,
    },
    /// The volume blurred once with [1/12, 10/12, 1/12]³, then one trilinear fetch: the same
    /// variance as the B-spline at an eighth of the fetches.
    Prefiltered,
}

/// How many points per slab the kernel's integral over the slab takes (Gauss–Legendre).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quadrature {
    /// The middle of the slab.
    One,
    /// ± Δs/(2√3) from the middle.
    Two,
}

impl Quadrature {
    /// Offsets from the middle of the slab in units of its thickness; equal weights.
    pub fn offsets(self) -> &'static [f64] {
        // 1/(2√3)
        const TWO: f64 = 0.288_675_134_594_812_9;
        match self {
            Self::One => &[0.0],
            Self::Two => &[-TWO, TWO],
        }
    }
}

/// Where normals come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Gradients {
    /// Differences of the prefiltered volume around the sample: what the B-spline's slope would be, nearly.
    Volume,
    /// The slope of what the B-spline reconstructs, exactly; with other kernels, and scattered, as [`Self::Volume`].
    Kernel,
    /// Differences between neighbouring sheets and their pixels (the paper's reference 16).
    Sheets,
}

/// How sheets are filled and emptied.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Engine {
    /// Every pixel, and every voxel of a light volume, gathers what splats would bring: the same
    /// sums, quickly.
    Gather,
    /// Every voxel is splatted into the sheets, and every pixel of a light's sheets back into the
    /// grid, as the paper has it (figure 3).
    Scatter,
}

/// When the transfer function is applied.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Classification {
    /// To the sheets: sharp edges, however coarse the voxels (P §3.5).
    Post,
    /// To the voxels, whose colours and extinctions are then spread: as blurred as the kernel. Rays to
    /// lights classify afterwards all the same.
    Pre,
}

/// What the scattering engine composites for the eye.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SheetOrder {
    /// Sheets across the line of sight (the paper's references 17 and 18).
    ImageAligned,
    /// Sheets along the volume's axis that is nearest to the line of sight (the paper's reference 26):
    /// brightness pops when another axis becomes the nearest.
    VolumeAligned,
    /// Every footprint by itself, classified as a voxel (the paper's reference 25): overlaps bleed.
    EveryFootprint,
}

/// Whether all slabs are equally thick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Slabs {
    /// As thick as [`Sampling::slab`] says.
    Even,
    /// A quarter of that where a slab would make up much of what is seen along a ray: normals and light
    /// change within a voxel, which would show as a weave.
    ByNeed,
    /// As thick as [`Sampling::slab`] says, with opacity integrated through each of its [`PREINTEGRATED_STEPS`] from the
    /// densities at both ends (Engel, Kraus and Ertl, "High-quality pre-integrated volume rendering", 2001), and
    /// shaded once where that opacity lies: quick previews of thin parts without stripes.
    Preintegrated,
}

/// Steps into which a slab is divided along a ray where opacity is pre-integrated.
pub const PREINTEGRATED_STEPS: u32 = 2;

/// Parts into which a slab is divided at most, where slabs are as thin as they need to be.
pub const THIN_SLABS: u32 = 4;

/// How the eye's sheets are sampled.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Sampling {
    /// Reconstruction kernel.
    pub kernel: Kernel,
    /// Thickness of slabs, of the thickest if they are not even, in smallest voxel edges.
    pub slab: f64,
    /// Whether all are equally thick.
    pub slabs: Slabs,
    /// Points per slab.
    pub quadrature: Quadrature,
    /// Where normals come from; scattered sheets are all that there is of the volume, so there
    /// they come from sheets.
    pub gradients: Gradients,
    /// When the transfer functions are applied, to the sheets of lights too.
    pub classification: Classification,
    /// How sheets are filled, those of lights too.
    pub engine: Engine,
    /// What is composited where voxels are scattered, for comparison with earlier work.
    pub order: SheetOrder,
}

impl Default for Sampling {
    fn default() -> Self {
        Self {
            kernel: Kernel::BSpline,
            slab: 1.0,
            slabs: Slabs::Even,
            quadrature: Quadrature::One,
            gradients: Gradients::Volume,
            classification: Classification::Post,
            engine: Engine::Gather,
            order: SheetOrder::ImageAligned,
        }
    }
}
