//! Values of command-line options that select among alternatives.

use clap::ValueEnum;

use crate::data::KindName;
use crate::model::QualityPreset;

/// Shadow algorithm, as named on the command line.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum ShadowArg {
    /// Light reaches everything
    Off,
    /// A light volume filled by sheet-buffer splatting
    Splat,
    /// A light volume filled by a ray from every voxel
    Raycast,
    /// A ray to the light from every sample
    Direct,
}

/// Engine that fills the sheets, as named on the command line.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum EngineArg {
    /// Pixels gather what voxels would splat: the same sums, quickly
    Gather,
    /// Voxels are splatted, as the paper has it
    Scatter,
}

/// Quality level of lighting, as named on the command line.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum QualityArg {
    /// Light volumes alone: soft shadows, quickest
    Fast,
    /// Light volumes, and short rays near what is seen
    Standard,
    /// Light volumes, and longer rays: for figures
    Fine,
    /// Rays all the way and the thinnest slabs: slow
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
    /// More is more of something
    Scalar,
    /// An object that is darker than what is around it
    DarkOnBright,
    /// Computed tomography, in Hounsfield units
    Ct,
    /// Deviations to both sides of zero
    Signed,
    /// Something or nothing
    Mask,
    /// Numbers of what is there
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
