//! Shadow settings: algorithm, light volumes, near field, area lights and remedies against dark images.

use serde::{Deserialize, Serialize};

/// Largest light bias, in voxels: the radius of the kernel.
pub const MAX_BIAS_VOXELS: f64 = 2.0;

use crate::{ReconstructionKernel, SlabQuadrature};
use chiaroscuro_volume::math::SceneSpace;

/// Algorithm that computes the attenuated light at a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ShadowAlgorithm {
    /// Shadows off: light is not attenuated.
    Off,
    /// Light volume filled by sheet-buffer splatting (P §3.5, the paper's variant 3).
    Splat,
    /// Light volume filled by a ray from every voxel to the light (P §3.4, eq. 8, variant 2).
    Raycast,
    /// Direct rays to the light from every sample, without a light volume (P §3.3, eq. 7, variant 1).
    Direct,
}

impl ShadowAlgorithm {
    /// Returns true if shadows are enabled.
    pub fn is_on(self) -> bool {
        self != Self::Off
    }

    /// Returns true if the algorithm stores attenuation in a light volume.
    pub fn has_volume(self) -> bool {
        matches!(self, Self::Splat | Self::Raycast)
    }
}

/// Choice of a slab's transmittance: the value that a sheet deposits in the light volume, or the position of the
/// first slab on a ray to the light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DepositMode {
    /// Transmittance in front of the slab: P eq. 7, 8 and 10 read literally; first order in the slab's thickness.
    Front,
    /// Mean transmittance over the slab, T·(1 − e^−τ)/τ; second order.
    SlabMean,
}

/// Resolution of a light volume per axis relative to the data, from the finest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LightVolumeResolution {
    /// Full resolution: one light voxel per data voxel.
    Full,
    /// Half resolution per axis: an eighth of the memory and time.
    Half,
    /// Quarter resolution per axis: a 64th of the memory.
    Quarter,
}

impl LightVolumeResolution {
    /// Returns this resolution, or a finer one if a volume of `dims` voxels needs it for `least` blocks along its
    /// longest edge.
    #[must_use]
    pub fn with_min_blocks(self, dims: [usize; 3], least: u32) -> Self {
        let longest = dims.into_iter().max().unwrap_or(1);
        let has_enough = |resolution: Self| longest.div_ceil(resolution.divisor()) >= least as usize;
        match self {
            Self::Quarter if has_enough(Self::Quarter) => Self::Quarter,
            Self::Quarter | Self::Half if has_enough(Self::Half) => Self::Half,
            _ => Self::Full,
        }
    }

    /// Returns the number of data voxels per light voxel along an axis.
    pub fn divisor(self) -> usize {
        match self {
            Self::Full => 1,
            Self::Half => 2,
            Self::Quarter => 4,
        }
    }
}

/// Number format of a light volume's values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LightVolumePrecision {
    /// 16-bit floats: 11 significant bits, at full light as in deep shadow.
    Half,
    /// 8 bits per voxel, as in the paper: half the memory, 256 levels.
    Byte,
}

/// Storage of several lights: separate volumes or a combined one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LightStorage {
    /// Automatic choice: the one that takes less memory and loses nothing.
    Auto,
    /// Attenuation volume for each light: with highlights, and colours that can be changed at once.
    PerLight,
    /// Combined volume of the diffuse light of all (P §4): no highlights from lights with shadows, and every change
    /// of one light recomputes all.
    Combined,
}

/// Kernel of the back-projection from sheets into a gathered light volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ReverseKernel {
    /// Tent of one voxel to either side: as narrow as the look-up allows.
    Tent,
    /// Kernel of the light pass (P §3.5).
    Forward,
}

/// Length of the near-field ray: the last voxels before a sample, where a ray replaces the light volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NearFieldRay {
    /// Light volume only, without a ray (P §3.5).
    Off,
    /// Short ray of four steps, three voxels long.
    Short,
    /// Long ray of seven steps, six voxels long.
    Long,
}

impl NearFieldRay {
    /// Returns the number of steps of the ray; their widths are ½ ½ 1 1 1 1 1 smallest voxel edges, and the last is
    /// longer by half a voxel of the light volume. Material close to a sample shades it most, and is blurred least.
    pub fn step_count(self) -> u32 {
        match self {
            Self::Off => 0,
            Self::Short => 4,
            Self::Long => 7,
        }
    }

    /// Returns true if the first step is divided into two, which resolves what lies within half a voxel.
    pub fn halves_first_step(self) -> bool {
        self == Self::Long
    }

    /// Returns the number of steps that lead no farther than `length_voxels` smallest voxel edges; at least two,
    /// because a light volume does not resolve what lies within one voxel.
    pub fn steps_within(self, length_voxels: f64) -> u32 {
        let within = |&steps: &u32| Self::length_voxels(steps) <= length_voxels;
        (2..=self.step_count()).rev().find(within).unwrap_or(2).min(self.step_count())
    }

    /// Returns the length of the first `steps` steps in smallest voxel edges, without the extension of the last.
    pub fn length_voxels(steps: u32) -> f64 {
        (0..steps).map(Self::width_voxels).sum()
    }

    /// Returns the width of a step in smallest voxel edges, without the extension of the last.
    pub fn width_voxels(step: u32) -> f64 {
        // Longer steps pass sheets that are three voxels thick, between whose ends density is taken as linear.
        if step < 2 { 0.5 } else { 1.0 }
    }
}

/// Largest number of sample points per area light.
pub const MAX_LIGHT_SAMPLES: u32 = 64;

/// Sampling of area lights: each is replaced by point lights that share one light volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct AreaLightSampling {
    /// Number of sample points per light of 40° or more; narrower ones have fewer
    /// ([`crate::SceneLight::sample_count`]).
    pub samples: u32,
    /// Finest resolution of the light volume: penumbrae have no fine detail.
    pub resolution: LightVolumeResolution,
}

impl Default for AreaLightSampling {
    fn default() -> Self {
        Self { samples: MAX_LIGHT_SAMPLES, resolution: LightVolumeResolution::Half }
    }
}

/// Shadow settings, including the remedies against dark images (P §4).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ShadowSettings {
    /// Algorithm that fills the light volume, or off.
    pub algorithm: ShadowAlgorithm,
    /// Shadow strength: 0 for no shadows, 1 for full ones.
    pub strength: f64,
    /// Offset added to the attenuated light everywhere.
    pub ambient_offset: f64,
    /// Factor for the attenuated light, which is then clamped to 1.
    pub gain: f64,
    /// Offset of the look-up towards the light, in voxels, 0 … 2 (the kernel's radius).
    pub bias_voxels: f64,
    /// Exposure compensation: factor for the lights while shadows are on, so that the image is as bright as without.
    pub balance: f64,
    /// Coloured shadows: share of light of their own hue that pure colours of the lighting transfer function let
    /// through, 0 (grey shadows) … 1.
    pub transmission: f64,
    /// Re-measures the balance automatically after changes of the light, in the window only. It does not affect the
    /// image itself: the measured value is stored in `balance`.
    pub keep_balanced: bool,
    /// First touch: each voxel takes the light of the first sheet that touches it (the paper's mode without weight
    /// volume).
    pub first_touch: bool,
    /// Transmittance of a slab that a sheet deposits.
    pub deposit: DepositMode,
    /// Kernel of the light pass.
    pub kernel: ReconstructionKernel,
    /// Slab thickness of the light pass, in smallest edges of the light volume's voxels.
    pub slab: f64,
    /// Quadrature of the light pass.
    pub quadrature: SlabQuadrature,
    /// Resolution of the light volumes.
    pub resolution: LightVolumeResolution,
    /// Number format of the light volumes.
    pub precision: LightVolumePrecision,
    /// Storage: one volume for each light, or one for all.
    pub storage: LightStorage,
    /// Kernel of the back-projection from sheets to voxels.
    pub reverse_kernel: ReverseKernel,
    /// Near-field ray that replaces the light volume close to a sample. The bias has no effect then.
    pub near_field: NearFieldRay,
    /// Sampling of area lights.
    pub area: AreaLightSampling,
    /// Minimum number of blocks along the volume's longest edge for soft light, if the volume has as many voxels:
    /// light of area lights, of the sky, and bounced light. A volume of few voxels fills the image as much as a large
    /// one.
    pub least_blocks: u32,
}

/// Largest minimum number of blocks, at any resolution.
pub const MAX_MIN_BLOCKS: u32 = 256;

impl Default for ShadowSettings {
    fn default() -> Self {
        Self {
            algorithm: ShadowAlgorithm::Splat,
            strength: 1.0,
            ambient_offset: 0.0,
            gain: 1.0,
            bias_voxels: 0.0,
            balance: 1.0,
            transmission: 0.0,
            keep_balanced: false,
            first_touch: false,
            deposit: DepositMode::SlabMean,
            kernel: ReconstructionKernel::BSpline,
            slab: 1.0,
            quadrature: SlabQuadrature::One,
            resolution: LightVolumeResolution::Full,
            precision: LightVolumePrecision::Half,
            storage: LightStorage::Auto,
            reverse_kernel: ReverseKernel::Tent,
            near_field: NearFieldRay::Short,
            area: AreaLightSampling::default(),
            // Number of blocks of a volume of 128³ voxels at quarter resolution.
            least_blocks: 32,
        }
    }
}

impl ShadowSettings {
    /// Returns the resolution of soft light in a volume of `dims` voxels, if `resolution` is set.
    pub fn soft_resolution(
        &self,
        resolution: LightVolumeResolution,
        dims: [usize; 3],
    ) -> LightVolumeResolution {
        resolution.with_min_blocks(dims, self.least_blocks)
    }

    /// Returns the sampling distance of a ray to a light, in scene units: the slab's thickness.
    pub fn ray_step(&self, scene: &SceneSpace) -> f64 {
        self.slab * scene.smallest_edge()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_volumes_have_as_many_blocks_as_large_ones() {
        let of = |longest: usize, resolution: LightVolumeResolution, least| {
            resolution.with_min_blocks([longest / 2, longest, 1], least)
        };
        assert_eq!(of(128, LightVolumeResolution::Quarter, 32), LightVolumeResolution::Quarter);
        assert_eq!(of(124, LightVolumeResolution::Quarter, 32), LightVolumeResolution::Half);
        assert_eq!(of(24, LightVolumeResolution::Quarter, 32), LightVolumeResolution::Full);
        assert_eq!(of(24, LightVolumeResolution::Quarter, 1), LightVolumeResolution::Quarter);
        assert_eq!(of(512, LightVolumeResolution::Half, 32), LightVolumeResolution::Half);
        assert_eq!(of(512, LightVolumeResolution::Full, 32), LightVolumeResolution::Full);
    }
}
