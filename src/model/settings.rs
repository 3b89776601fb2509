//! The one value that is the whole look of a picture.

use serde::{Deserialize, Serialize};

use super::transfer::unit_in_scene;
use super::{BakedTransfer, Camera, Length, Light, TransferFunction};
use crate::math::SceneSpace;

/// Version of the JSON form. Older files are migrated, newer ones are read as far as possible.
pub const SCHEMA: u32 = 1;

/// Everything that decides what a picture of a volume looks like.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// See [`SCHEMA`].
    pub schema: u32,
    /// Where the eye is.
    pub camera: Camera,
    /// At most [`super::MAX_LIGHTS`].
    pub lights: Vec<Light>,
    /// What the eye sees: colour and opacity of every value.
    pub transfer: TransferFunction,
    /// What the light meets.
    pub lighting: LightingTransfer,
    /// The length to which opacities refer.
    pub opacity_unit: Length,
    /// How material answers to light.
    pub shading: Shading,
    /// How light is attenuated on its way to the material.
    pub shadows: Shadows,
    /// How the eye's sheets are sampled.
    pub sampling: Sampling,
    /// What happens to the picture at the end.
    pub output: Output,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            schema: SCHEMA,
            camera: Camera::default(),
            lights: vec![Light::default()],
            transfer: TransferFunction::default(),
            lighting: LightingTransfer::default(),
            opacity_unit: Length::Voxels(1.0),
            shading: Shading::default(),
            shadows: Shadows::default(),
            sampling: Sampling::default(),
            output: Output::default(),
        }
    }
}

/// The opacity that attenuates light: the eye's, scaled, or a curve of its own (P §4: lower
/// opacities here let light faintly pass thin opaque structures).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LightingTransfer {
    /// Whether it follows the eye's opacity.
    pub linked: bool,
    /// Multiplies the extinction, linked or not.
    pub scale: f64,
    /// Used when not linked; its colours mean nothing.
    pub curve: TransferFunction,
}

impl Default for LightingTransfer {
    fn default() -> Self {
        Self { linked: true, scale: 1.0, curve: TransferFunction::default() }
    }
}

/// Phong's illumination equation (P eq. 2–4).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Shading {
    /// Light that the material gives off, as a share of its colour (`C_e`).
    pub emission: f64,
    /// `k_a`.
    pub ambient: f64,
    /// `k_d`.
    pub diffuse: f64,
    /// `k_s`.
    pub specular: f64,
    /// `n_s`, the Phong exponent.
    pub shininess: f64,
    /// The density change per opacity unit at which a sample counts half as a surface: below it
    /// the direction of the gradient is noise, and the sample is lit evenly from all sides.
    pub surface_gradient: f64,
}

impl Default for Shading {
    fn default() -> Self {
        Self {
            emission: 0.0,
            ambient: 0.15,
            diffuse: 0.85,
            specular: 0.25,
            shininess: 32.0,
            surface_gradient: 0.02,
        }
    }
}

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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Deposit {
    /// In front of the slab: P eq. 7, 8 and 10 read literally; first order in the slab's thickness.
    Front,
    /// The mean over the slab, T·(1 − e^−τ)/τ; second order.
    SlabMean,
}

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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
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

/// Resolution of the light volume per axis, relative to the data.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
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
}

impl Default for Shadows {
    fn default() -> Self {
        Self {
            algorithm: ShadowAlgorithm::Splat,
            strength: 1.0,
            ambient_offset: 0.0,
            gain: 1.0,
            bias_voxels: 0.0,
            balance: 1.0,
            first_touch: false,
            deposit: Deposit::SlabMean,
            kernel: Kernel::BSpline,
            slab: 1.0,
            quadrature: Quadrature::One,
            resolution: Resolution::Full,
            precision: Precision::Half,
        }
    }
}

impl Shadows {
    /// Distance between the samples of a ray to a light, in scene units: the slab's thickness.
    pub fn ray_step(&self, scene: &SceneSpace) -> f64 {
        self.slab * scene.smallest_edge()
    }
}
/// Where normals come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Gradients {
    /// Differences of the reconstructed volume around the sample.
    Volume,
    /// Differences between neighbouring sheets and their pixels (the paper's reference 16).
    Sheets,
}

/// How sheets are filled and emptied.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Engine {
    /// Every pixel, and every voxel of a light volume, gathers what splats would bring: the same
    /// sums, quickly.
    Gather,
    /// Every voxel is splatted into the sheets, and every pixel of a light's sheets back into the
    /// grid, as the paper has it (figure 3).
    Scatter,
}

/// What the scattering engine composites for the eye.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SheetOrder {
    /// Sheets across the line of sight (the paper's references 17 and 18).
    ImageAligned,
    /// Sheets along the volume's axis that is nearest to the line of sight (its reference 26):
    /// brightness pops when another axis becomes the nearest.
    VolumeAligned,
    /// Every footprint by itself, classified as a voxel (its reference 25): overlaps bleed.
    EveryFootprint,
}

/// How the eye's sheets are sampled.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Sampling {
    /// Reconstruction kernel.
    pub kernel: Kernel,
    /// Slab thickness in smallest voxel edges.
    pub slab: f64,
    /// Points per slab.
    pub quadrature: Quadrature,
    /// Where normals come from; scattered sheets are all that there is of the volume, so there
    /// they come from sheets.
    pub gradients: Gradients,
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
            quadrature: Quadrature::One,
            gradients: Gradients::Volume,
            engine: Engine::Gather,
            order: SheetOrder::ImageAligned,
        }
    }
}

/// How linear light becomes a display colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ToneMap {
    /// As is up to 0.8, then a smooth shoulder that keeps the hue.
    Neutral,
    /// Cut at 1.
    Clip,
}

/// A vertical gradient behind the volume.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Background {
    /// sRGB, 0 … 1.
    pub top: [f32; 3],
    /// sRGB, 0 … 1.
    pub bottom: [f32; 3],
}

/// What happens to the picture at the end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Output {
    /// Behind the volume; left out of transparent pictures.
    pub background: Background,
    /// Applied to the volume, never to the background.
    pub tone_map: ToneMap,
}

impl Default for Output {
    fn default() -> Self {
        // #14161b … #262a33: dark, but not black, so that shadows can be told from it.
        let bytes = |rgb: [u8; 3]| rgb.map(|c| f32::from(c) / 255.0);
        let background = Background { top: bytes([0x14, 0x16, 0x1b]), bottom: bytes([0x26, 0x2a, 0x33]) };
        Self { background, tone_map: ToneMap::Neutral }
    }
}

impl Settings {
    /// Whether voxels are scattered. Rays from every sample need the volume, so with them the
    /// picture is gathered whatever the engine.
    pub fn scatters(&self) -> bool {
        self.sampling.engine == Engine::Scatter && self.shadows.algorithm != ShadowAlgorithm::Direct
    }

    /// Whether normals come from sheets.
    pub fn has_sheet_gradients(&self) -> bool {
        self.scatters() || self.sampling.gradients == Gradients::Sheets
    }

    /// The eye's transfer function as a table for a volume of that value range.
    pub fn baked_eye(&self, range: (f64, f64), scene: &SceneSpace) -> BakedTransfer {
        self.transfer.bake(range, unit_in_scene(self.opacity_unit, scene), 1.0)
    }

    /// The lighting transfer function as a table for a volume of that value range.
    pub fn baked_lighting(&self, range: (f64, f64), scene: &SceneSpace) -> BakedTransfer {
        let function = if self.lighting.linked { &self.transfer } else { &self.lighting.curve };
        function.bake(range, unit_in_scene(self.opacity_unit, scene), self.lighting.scale)
    }
}
