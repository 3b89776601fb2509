//! How light is attenuated on its way.

use serde::{Deserialize, Serialize};

/// The largest light bias: the radius of the kernel.
pub const MAX_BIAS_VOXELS: f64 = 2.0;

use crate::math::SceneSpace;
use crate::model::{Kernel, Quadrature};

/// Where attenuated light comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ShadowAlgorithm {
    /// Light reaches everything.
    Off,
    /// A light volume filled by sheet-buffer splatting (P §3.5, the paper's variant 3).
    Splat,
    /// A light volume filled by a ray from every voxel to the light (P §3.4, eq. 8, variant 2).
    Raycast,
    /// No light volume: a ray to the light from every sample (P §3.3, eq. 7, variant 1).
    Direct,
}

impl ShadowAlgorithm {
    /// Whether light is attenuated on its way.
    pub fn is_on(self) -> bool {
        self != Self::Off
    }

    /// Whether attenuation is kept in a light volume.
    pub fn has_volume(self) -> bool {
        matches!(self, Self::Splat | Self::Raycast)
    }
}

/// Which transmittance of a slab counts: in a sheet what it deposits in the light volume, on a ray
/// to the light where the first slab lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Deposit {
    /// In front of the slab: P eq. 7, 8 and 10 read literally; first order in the slab's thickness.
    Front,
    /// The mean over the slab, T·(1 − e^−τ)/τ; second order.
    SlabMean,
}

/// Resolution of the light volume per axis, relative to the data, from the finest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Resolution {
    /// One light voxel per voxel.
    Full,
    /// ½ per axis: an eighth of the memory and time.
    Half,
    /// ¼ per axis.
    Quarter,
}

impl Resolution {
    /// This, or as much finer as a volume of so many voxels needs to have that many blocks along its longest edge.
    #[must_use]
    pub fn with_blocks(self, dims: [usize; 3], least: u32) -> Self {
        let longest = dims.into_iter().max().unwrap_or(1);
        let has_enough = |resolution: Self| longest.div_ceil(resolution.divisor()) >= least as usize;
        match self {
            Self::Quarter if has_enough(Self::Quarter) => Self::Quarter,
            Self::Quarter | Self::Half if has_enough(Self::Half) => Self::Half,
            _ => Self::Full,
        }
    }

    /// Data voxels per light voxel along an axis.
    pub fn divisor(self) -> usize {
        match self {
            Self::Full => 1,
            Self::Half => 2,
            Self::Quarter => 4,
        }
    }
}

/// How the values of a light volume are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Precision {
    /// 16-bit floats: 11 bits at full light, and as many in the dark.
    Half,
    /// A byte per voxel, as the paper has it: half the memory, 256 steps.
    Byte,
}

/// What is kept of several lights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LightStorage {
    /// Whichever takes less memory and loses nothing.
    Auto,
    /// An attenuation volume for each light: highlights, and colours that can be changed at once.
    PerLight,
    /// One volume of the diffuse light of all (P §4): no highlights from lights that cast shadows, and
    /// every change of one fills the volumes of all again.
    Combined,
}

/// The kernel with which sheets are splatted back into a light volume that is gathered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ReverseKernel {
    /// A tent, one voxel to either side: as narrow as the look-up allows.
    Tent,
    /// That of the light pass (P §3.5).
    Forward,
}

/// The last voxels before a sample, where a ray finds its light and not the light volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NearField {
    /// The light volume alone (P §3.5).
    Off,
    /// Three voxels.
    Short,
    /// Eight.
    Long,
}

impl NearField {
    /// How many steps the ray has; the widths are ½ ½ 1 1 1½ 1½ 2 smallest edges of voxels, and the last is longer by
    /// half a voxel of the light volume. What lies nearest to a sample shades it most, and is blurred least.
    pub fn steps(self) -> u32 {
        match self {
            Self::Off => 0,
            Self::Short => 4,
            Self::Long => 7,
        }
    }

    /// How many of the steps lead no farther than that, in smallest edges of voxels; but two at least, for what lies within
    /// a voxel no light volume knows.
    pub fn steps_within(self, length_voxels: f64) -> u32 {
        let within = |&steps: &u32| Self::length_voxels(steps) <= length_voxels;
        (2..=self.steps()).rev().find(within).unwrap_or(2).min(self.steps())
    }

    /// How long so many steps are, in smallest edges of voxels, but for what the last has more.
    pub fn length_voxels(steps: u32) -> f64 {
        (0..steps).map(Self::width_voxels).sum()
    }

    /// Width of a step, in smallest edges of voxels, but for what the last has more.
    pub fn width_voxels(step: u32) -> f64 {
        0.5 * f64::from(1 + step / 2)
    }
}

/// As many points of a light as are followed at most.
pub const MAX_LIGHT_SAMPLES: u32 = 64;

/// How lights that have a size are followed: as so many point lights, in one light volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct AreaShadows {
    /// From how many points of each.
    pub samples: u32,
    /// How finely, at most: penumbrae have no fine detail.
    pub resolution: Resolution,
}

impl Default for AreaShadows {
    fn default() -> Self {
        Self { samples: MAX_LIGHT_SAMPLES, resolution: Resolution::Half }
    }
}

/// How light is attenuated on its way, and the cures for darkness (P §4).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Shadows {
    /// Off, or how the light volume is filled.
    pub algorithm: ShadowAlgorithm,
    /// 0: no shadows, 1: full ones.
    pub strength: f64,
    /// Added to the attenuated light everywhere.
    pub ambient_offset: f64,
    /// Multiplies the attenuated light, which is then cut at 1.
    pub gain: f64,
    /// Moves the lookup towards the light, in voxels, 0 … 2 (the kernel's radius).
    pub bias_voxels: f64,
    /// Multiplies the lights while shadows are on, so that the picture is as bright as without.
    pub balance: f64,
    /// Coloured shadows: how much of the light of their own hue pure colours of the lighting transfer function let through,
    /// 0 (none: shadows are grey) … 1.
    pub transmission: f64,
    /// Whether the window measures the balance anew after changes that light depends on. No picture depends on it:
    /// what is found stands in `balance`.
    pub keep_balanced: bool,
    /// Each voxel takes the light of the first sheet that touches it (the paper's mode without
    /// weight volume).
    pub first_touch: bool,
    /// Which transmittance a sheet deposits.
    pub deposit: Deposit,
    /// Kernel of the light pass.
    pub kernel: Kernel,
    /// Slab thickness of the light pass, in smallest edges of the light volume's voxels.
    pub slab: f64,
    /// Quadrature of the light pass.
    pub quadrature: Quadrature,
    /// Resolution of the light volumes.
    pub resolution: Resolution,
    /// How they are stored.
    pub precision: Precision,
    /// One for each light, or one for all.
    pub storage: LightStorage,
    /// Kernel of the way back from sheets to voxels.
    pub reverse_kernel: ReverseKernel,
    /// Where rays say how much light arrives, and not the light volume. The bias has no effect then.
    pub near_field: NearField,
    /// Lights that have a size.
    pub area: AreaShadows,
    /// In how many blocks along the volume's longest edge soft light is found at least, as far as there are voxels: that of
    /// lights that have a size, of the sky, and light that bounces. What is small in voxels is as large in the picture as
    /// anything else.
    pub least_blocks: u32,
}

/// As many can be asked for, whatever the resolution.
pub const MAX_LEAST_BLOCKS: u32 = 256;

impl Default for Shadows {
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
            deposit: Deposit::SlabMean,
            kernel: Kernel::BSpline,
            slab: 1.0,
            quadrature: Quadrature::One,
            resolution: Resolution::Full,
            precision: Precision::Half,
            storage: LightStorage::Auto,
            reverse_kernel: ReverseKernel::Tent,
            near_field: NearField::Short,
            area: AreaShadows::default(),
            // What a volume of 128³ voxels has at a quarter.
            least_blocks: 32,
        }
    }
}

impl Shadows {
    /// The resolution of soft light in a volume of so many voxels, for which another is set.
    pub fn soft(&self, resolution: Resolution, dims: [usize; 3]) -> Resolution {
        resolution.with_blocks(dims, self.least_blocks)
    }

    /// Distance between the samples of a ray to a light, in scene units: the slab's thickness.
    pub fn ray_step(&self, scene: &SceneSpace) -> f64 {
        self.slab * scene.smallest_edge()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_volumes_have_as_many_blocks_as_large_ones() {
        let of = |longest: usize, resolution: Resolution, least| {
            resolution.with_blocks([longest / 2, longest, 1], least)
        };
        assert_eq!(of(128, Resolution::Quarter, 32), Resolution::Quarter);
        assert_eq!(of(124, Resolution::Quarter, 32), Resolution::Half);
        assert_eq!(of(24, Resolution::Quarter, 32), Resolution::Full);
        assert_eq!(of(24, Resolution::Quarter, 1), Resolution::Quarter);
        assert_eq!(of(512, Resolution::Half, 32), Resolution::Half);
        assert_eq!(of(512, Resolution::Full, 32), Resolution::Full);
    }
}
