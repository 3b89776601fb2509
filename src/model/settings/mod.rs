//! The one value that is the whole look of a picture.

mod corrected;
pub(super) mod cut;
pub(super) mod eye;
pub(super) mod floor;
pub(super) mod kept;
pub(super) mod labels;
pub(super) mod length;
pub(super) mod light;
pub(super) mod quality;
pub(super) mod range;
pub(super) mod sampling;
pub(super) mod sanitise;
pub(super) mod shadows;

use serde::{Deserialize, Serialize};

use super::{
    BakedTransfer, Camera, Classification, Cuts, DensityRange, Engine, Floor, Gradients, Kept, Kernel,
    LabelTable, Length, Light, LightStorage, NearField, Quadrature, Sampling, Scattering, ShadowAlgorithm,
    Shadows, SheetOrder, Sky, Slabs, TransferFunction,
};
use crate::data::{BOUNDED_SIGMA, Corrections, SIGMA_TOLERANCE, ValueRange};
use crate::math::SceneSpace;

/// Version of the JSON form. Files of every version are read as far as possible: what they lack keeps its
/// default, and what is not known here is reported.
pub const SCHEMA: u32 = 2;

/// Everything that decides what a picture of a volume looks like, and what of its file is corrected.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// See [`SCHEMA`].
    pub schema: u32,
    /// Where the eye is.
    pub camera: Camera,
    /// At most [`super::MAX_LIGHTS`].
    pub lights: Vec<Light>,
    /// The values that densities are spent on.
    pub range: DensityRange,
    /// What labels look like, by number. With it volumes of whole numbers are shown by their labels, and the transfer
    /// functions wait until it is empty.
    pub labels: LabelTable,
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
    /// Light from all around.
    pub sky: Sky,
    /// Light that bounces inside the volume.
    pub scattering: Scattering,
    /// What of the volume is left out.
    pub cuts: Cuts,
    /// The floor under the volume.
    pub floor: Floor,
    /// How the eye's sheets are sampled.
    pub sampling: Sampling,
    /// What happens to the picture at the end.
    pub output: Output,
    /// Views and looks that are kept, in the order in which they are shown; they are no part of the picture. At most
    /// [`super::MAX_KEPT`].
    pub kept: Vec<Kept>,
    /// What somebody knows better than the file of the volume. It belongs to that file: looks for any volume neither have
    /// nor change it.
    pub volume: Corrections,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            schema: SCHEMA,
            camera: Camera::default(),
            lights: vec![Light::default()],
            range: DensityRange::Robust,
            labels: LabelTable::default(),
            transfer: TransferFunction::default(),
            lighting: LightingTransfer::default(),
            opacity_unit: Length::Voxels(1.0),
            shading: Shading::default(),
            shadows: Shadows::default(),
            sky: Sky::default(),
            scattering: Scattering::default(),
            cuts: Cuts::default(),
            floor: Floor::default(),
            sampling: Sampling::default(),
            output: Output::default(),
            kept: Vec::new(),
            volume: Corrections::default(),
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

/// Which side of a surface takes the diffuse light of a light that casts shadows. What casts none lights both.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sides {
    /// The one to which opacity falls; highlights lie there, too.
    One,
    /// Both, as if light came through; highlights lie where density falls.
    Two,
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
    /// Which sides of surfaces are lit.
    pub sides: Sides,
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
            sides: Sides::One,
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
    /// Multiplies the light of the volume and of the floor before the tone map, never the background:
    /// [`MIN_EXPOSURE`] … [`MAX_EXPOSURE`]. Linear pictures have it, too; what lights and shadows are measured by does
    /// not.
    pub exposure: f64,
}

/// Four stops down and four up: beyond them a picture is black, or white, whatever it shows.
pub const MIN_EXPOSURE: f64 = 1.0 / 16.0;
/// See [`MIN_EXPOSURE`].
pub const MAX_EXPOSURE: f64 = 16.0;

impl Default for Output {
    fn default() -> Self {
        // #14161b … #262a33: dark, but not black, so that shadows can be told from it.
        let bytes = |rgb: [u8; 3]| rgb.map(|c| f32::from(c) / 255.0);
        let background = Background { top: bytes([0x14, 0x16, 0x1b]), bottom: bytes([0x26, 0x2a, 0x33]) };
        Self { background, tone_map: ToneMap::Neutral, exposure: 1.0 }
    }
}

impl Settings {
    /// Light from everywhere that nothing attenuates, as a share of the colour of what it meets: where there is a sky,
    /// none but its.
    pub fn flat_ambient(&self) -> f64 {
        if self.sky.is_on() { 0.0 } else { self.shading.ambient }
    }

    /// Whether material attenuates the light of a sky.
    pub fn has_sky_volume(&self) -> bool {
        self.sky.is_on() && self.shadows.algorithm.is_on()
    }

    /// Whether shadows are coloured: light has a transmittance for each of its colours.
    pub fn has_colored_shadows(&self) -> bool {
        self.shadows.transmission > 0.0 && self.shadows.algorithm.is_on()
    }

    /// Whether every sample casts rays to all points of lights that have a size: more turns of loops than drivers that draw
    /// with the processor take (Mesa's ends all loops of an invocation after 65,536), so that light is lost there.
    pub fn casts_rays_to_all_points(&self) -> bool {
        let has_size = |light: &Light| light.on && light.in_scene(&self.camera).area.is_some();
        self.shadows.algorithm == ShadowAlgorithm::Direct && self.lights.iter().any(has_size)
    }

    /// Whether light bounces: where shadows are off nothing meets light.
    pub fn has_bounces(&self) -> bool {
        let Scattering { bounces, albedo, strength, .. } = self.scattering;
        bounces > 0 && albedo > 0.0 && strength > 0.0 && self.shadows.algorithm.is_on()
    }

    /// Whether voxels are scattered. Rays from every sample need the volume, so with them the
    /// picture is gathered whatever the engine.
    pub fn scatters(&self) -> bool {
        self.sampling.engine == Engine::Scatter && self.shadows.algorithm != ShadowAlgorithm::Direct
    }

    /// Whether all light that material has attenuated is kept in one volume of colours. Left to
    /// itself: when that takes less memory than a volume for each light, and neither highlights nor rays nearby
    /// would be lost.
    pub fn combines_lights(&self) -> bool {
        let shadowed = self.lights.iter().filter(|light| light.needs_volume()).count();
        let wanted = match self.shadows.storage {
            LightStorage::PerLight => false,
            LightStorage::Combined => true,
            // Four 16-bit colours and weights against one number for each light, or as many.
            LightStorage::Auto => {
                let alike = if self.has_colored_shadows() { 1 } else { 4 };
                self.shading.specular == 0.0 && self.shadows.near_field == NearField::Off && shadowed > alike
            }
        };
        // What depends on the eye is in no volume.
        let is_even = self.scattering.anisotropy == 0.0;
        wanted && is_even && shadowed > 0 && self.shadows.algorithm.has_volume()
    }

    /// Where rays from samples say how much light arrives. Only where light volumes of their own do from there on: in a
    /// combined volume of light its own voxels blur what rays would tell. Nor where every footprint is composited, which
    /// are shaded as the paper has it.
    pub fn near_field(&self) -> NearField {
        let looks_up =
            self.shadows.algorithm.has_volume() && !self.combines_lights() && !self.composites_footprints();
        if looks_up { self.shadows.near_field } else { NearField::Off }
    }

    /// Whether the eye's slabs are as thin as they need to be. A slab is divided where the gradient says that it
    /// holds much: not where gradients come from sheets, or voxels are classified; and where a slab is a mean of two
    /// points it need not be.
    pub fn has_slabs_by_need(&self) -> bool {
        self.sampling.slabs == Slabs::ByNeed && self.can_divide_slabs()
    }

    /// Whether opacity is integrated through the eye's slabs from the densities at both ends of their steps: under the
    /// conditions of [`Self::has_slabs_by_need`]; else slabs are even.
    pub fn has_preintegrated_slabs(&self) -> bool {
        self.sampling.slabs == Slabs::Preintegrated && self.can_divide_slabs()
    }

    /// Whether densities at single points of the volume say what is seen of it.
    fn can_divide_slabs(&self) -> bool {
        let Sampling { quadrature, gradients, .. } = self.sampling;
        !self.scatters()
            && quadrature == Quadrature::One
            && gradients != Gradients::Sheets
            && self.classification() == Classification::Post
    }

    /// The kernel of what the eye gathers: voxels that are classified first are spread by the prefiltered one, whichever
    /// is chosen.
    pub fn eye_kernel(&self) -> Kernel {
        self.kernel_of_gathered(self.sampling.kernel)
    }

    /// The same of what light gathers on its way.
    pub fn light_kernel(&self) -> Kernel {
        self.kernel_of_gathered(self.shadows.kernel)
    }

    fn kernel_of_gathered(&self, chosen: Kernel) -> Kernel {
        match self.sampling.classification {
            Classification::Post => chosen,
            Classification::Pre => Kernel::Prefiltered,
        }
    }

    /// How thick slabs are that look like those of the settings and are even, in smallest voxel edges: slabs by need
    /// cost, and err, as halves of the thickest do.
    pub fn mean_slab(&self) -> f64 {
        match self.sampling.slabs {
            Slabs::Even | Slabs::Preintegrated => self.sampling.slab,
            Slabs::ByNeed => 0.5 * self.sampling.slab,
        }
    }

    /// Thickness of the eye's thickest slabs, in smallest voxel edges.
    pub fn thickest_slab(&self) -> f64 {
        if self.has_slabs_by_need() { self.sampling.slab } else { self.mean_slab() }
    }

    /// Whether what is reconstructed in a cell of 2³ voxels stays within the bounds that are known of it
    /// ([`crate::data::CellBounds`]): not where voxels are classified before they are spread, nor with
    /// Gaussians that are much narrower or wider than the B-spline.
    pub fn cells_are_bounds(&self) -> bool {
        let is_bounded = |kernel: Kernel| match kernel {
            Kernel::BSpline | Kernel::Prefiltered => true,
            Kernel::Gaussian { sigma } => (sigma - BOUNDED_SIGMA).abs() <= SIGMA_TOLERANCE,
        };
        self.classification() == Classification::Post
            && is_bounded(self.sampling.kernel)
            && is_bounded(self.shadows.kernel)
    }

    /// Whether normals come from sheets.
    pub fn has_sheet_gradients(&self) -> bool {
        self.sampling.gradients == Gradients::Sheets
    }

    /// Whether normals are those of what the kernel reconstructs: not where voxels are splatted and no density is
    /// sampled, and only of the B-spline, whose slope is continuous.
    pub fn has_kernel_gradients(&self) -> bool {
        let is_smooth = self.eye_kernel() == Kernel::BSpline;
        self.sampling.gradients == Gradients::Kernel && is_smooth && !self.scatters()
    }

    /// Whether voxels are composited one by one, and never summed in sheets.
    pub fn composites_footprints(&self) -> bool {
        self.scatters() && self.sampling.order == SheetOrder::EveryFootprint
    }

    /// The opacity unit in scene units, safe to divide by.
    fn unit_in_scene(&self, scene: &SceneSpace) -> f64 {
        self.opacity_unit.in_scene(scene).max(1e-9)
    }

    /// The eye's transfer function as a table over a range, which is that of what a volume shows
    /// ([`crate::data::Volume::table_range`]). Of labels, that of settings [as drawn](Self::as_drawn).
    pub fn baked_eye(&self, range: ValueRange, scene: &SceneSpace) -> BakedTransfer {
        self.transfer.bake(range, self.unit_in_scene(scene), 1.0)
    }

    /// The lighting transfer function as a table over a range: see [`Self::baked_eye`]. Where shadows are coloured, shares of
    /// the extinction that each colour of light meets stand in place of colours.
    pub fn baked_lighting(&self, range: ValueRange, scene: &SceneSpace) -> BakedTransfer {
        let function = if self.lighting.linked { &self.transfer } else { &self.lighting.curve };
        let baked = function.bake(range, self.unit_in_scene(scene), self.lighting.scale);
        if self.has_colored_shadows() { baked.transmitting(self.shadows.transmission) } else { baked }
    }
}
