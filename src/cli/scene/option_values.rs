//! Values of command-line options that select among alternatives.

use clap::ValueEnum;

use chiaroscuro_scene::QualityPreset;
use chiaroscuro_volume::KindName;

/// Shadow algorithm, as named on the command line.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum ShadowArg {
    /// No shadows: light is not attenuated
    Off,
    /// Light volume filled by sheet-buffer splatting
    Splat,
    /// Light volume filled by a ray from every voxel to the light
    Raycast,
    /// Ray to the light from every sample, without a light volume
    Direct,
}

/// Engine that fills the sheets, as named on the command line.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum EngineArg {
    /// Each pixel sums the splats that reach it: the same sums, faster
    Gather,
    /// Each voxel is splatted into the sheets, as in the paper
    Scatter,
}

/// Quality level of lighting, as named on the command line.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum QualityArg {
    /// Light volumes alone: soft shadows, fastest
    Fast,
    /// Light volumes, and short rays from visible material towards the lights
    Standard,
    /// Light volumes, longer rays and more accurate normals: for figures
    Fine,
    /// Rays all the way to the lights, and the thinnest slabs: slow
    Exact,
}

impl From<QualityArg> for QualityPreset {
    fn from(level: QualityArg) -> Self {
        match level {
            QualityArg::Fast => Self::Fast,
            QualityArg::Standard => Self::Standard,
            QualityArg::Fine => Self::Fine,
            QualityArg::Exact => Self::Exact,
        }
    }
}

/// Kind of data, as named on the command line.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum KindArg {
    /// Scalar field, such as density or intensity
    Scalar,
    /// Object that is darker than its background
    DarkOnBright,
    /// Computed tomography, in Hounsfield units
    Ct,
    /// Signed field: deviations above and below zero
    Signed,
    /// Binary mask: object and background
    Mask,
    /// Label map: each number is a structure
    Labels,
}

impl From<KindArg> for KindName {
    fn from(kind: KindArg) -> Self {
        match kind {
            KindArg::Scalar => Self::Scalar,
            KindArg::DarkOnBright => Self::DarkOnBright,
            KindArg::Ct => Self::HounsfieldCt,
            KindArg::Signed => Self::Signed,
            KindArg::Mask => Self::Mask,
            KindArg::Labels => Self::LabelMap,
        }
    }
}
