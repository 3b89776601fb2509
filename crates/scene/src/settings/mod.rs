//! Settings: the value that holds the complete look of an image.

mod apply_corrections;
pub(super) mod camera_settings;
pub(super) mod clip_effect;
pub(super) mod clipping;
pub(super) mod floor;
pub(super) mod layer;
pub(super) mod light;
pub(super) mod quality;
pub(super) mod render_mode;
pub(super) mod sampling;
pub(super) mod sanitise;
pub(super) mod saved_entries;
pub(super) mod shadows;
pub(super) mod shape_cuts;

use serde::{Deserialize, Serialize};

use super::{
    BakedTransfer, Camera, ClassificationOrder, Clipping, FloorSettings, GradientSource, LightSettings,
    LightStorage, NearFieldRay, ReconstructionKernel, RenderEngine, RenderModeSettings, SamplingSettings,
    SavedEntry, ScatteringSettings, ShadowAlgorithm, ShadowSettings, SheetOrder, SkySettings, SlabMode,
    SlabQuadrature, VolumeLayers,
};
use chiaroscuro_volume::{BOUNDED_SIGMA, Corrections, SIGMA_TOLERANCE, ValueRange, math::SceneSpace};

/// Version of the JSON format. Files of every version are read: settings that they lack keep their defaults, and
/// unknown settings are reported.
pub const SCHEMA: u32 = 3;

/// Complete look of an image of a volume, and the corrections of its file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Version of the JSON format, [`SCHEMA`].
    pub schema: u32,
    /// Camera and its projection.
    pub camera: Camera,
    /// Lights, at most [`super::MAX_LIGHTS`].
    pub lights: Vec<LightSettings>,
    /// Layers, one for each field of the volume that is shown: range of values, labels and opacities.
    pub layers: VolumeLayers,
    /// Rule by which values along a ray become a colour.
    pub mode: RenderModeSettings,
    /// Illumination of material: Phong coefficients.
    pub shading: PhongShading,
    /// Shadow algorithm and its parameters.
    pub shadows: ShadowSettings,
    /// Ambient light from a sky or an environment map.
    pub sky: SkySettings,
    /// Multiple scattering of light inside the volume.
    pub scattering: ScatteringSettings,
    /// Clipping by a crop box, a plane, and shapes.
    pub cuts: Clipping,
    /// Floor under the volume that receives shadows.
    pub floor: FloorSettings,
    /// Sampling of the eye's sheets.
    pub sampling: SamplingSettings,
    /// Background, tone mapping and exposure.
    pub output: OutputSettings,
    /// Saved views and looks in their display order, at most [`super::MAX_SAVED_ENTRIES`]; they do not affect the
    /// image.
    pub kept: Vec<SavedEntry>,
    /// Corrections of the volume by the user, where its file is wrong. They belong to that file: looks that are meant
    /// for any volume neither contain nor change them.
    pub volume: Corrections,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            schema: SCHEMA,
            camera: Camera::default(),
            lights: vec![LightSettings::default()],
            layers: VolumeLayers::default(),
            mode: RenderModeSettings::default(),
            shading: PhongShading::default(),
            shadows: ShadowSettings::default(),
            sky: SkySettings::default(),
            scattering: ScatteringSettings::default(),
            cuts: Clipping::default(),
            floor: FloorSettings::default(),
            sampling: SamplingSettings::default(),
            output: OutputSettings::default(),
            kept: Vec::new(),
            volume: Corrections::default(),
        }
    }
}

/// Sides of a surface that receive diffuse light from lights with shadows. Lights without shadows illuminate both.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LitSides {
    /// Side to which opacity falls; highlights lie there, too.
    One,
    /// Both sides, as if light came through; highlights lie where density falls.
    Two,
}

/// Coefficients of Phong's illumination equation (P eq. 2–4).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PhongShading {
    /// Emission as a share of the material's colour (`C_e`).
    pub emission: f64,
    /// Ambient reflection coefficient `k_a`, 0 … 10.
    pub ambient: f64,
    /// Diffuse reflection coefficient `k_d`, 0 … 10.
    pub diffuse: f64,
    /// Specular reflection coefficient `k_s`, 0 … 10.
    pub specular: f64,
    /// Phong exponent `n_s`, 1 … 1000.
    pub shininess: f64,
    /// Density change per opacity unit at which a sample counts half as a surface: below it the direction of the
    /// gradient is noise, and the sample is lit evenly from all sides.
    pub surface_gradient: f64,
    /// Sides of surfaces that are lit.
    pub sides: LitSides,
}

impl PhongShading {
    /// Returns `true` if some samples are more surface than homogeneous material.
    ///
    /// A threshold of a full range per opacity unit makes even the steepest edges of volumes homogeneous.
    pub fn has_surfaces(&self) -> bool {
        self.surface_gradient < 1.0
    }
}

impl Default for PhongShading {
    fn default() -> Self {
        Self {
            emission: 0.0,
            ambient: 0.15,
            diffuse: 0.85,
            specular: 0.25,
            shininess: 32.0,
            surface_gradient: 0.02,
            sides: LitSides::One,
        }
    }
}

/// Tone mapping curve from linear light to display colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ToneMap {
    /// Identity up to 0.8, then a smooth shoulder that keeps the hue.
    Neutral,
    /// Clipping of components at 1.
    Clip,
}

/// Vertical colour gradient behind the volume.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Background {
    /// Colour at the top, sRGB, 0 … 1.
    pub top: [f32; 3],
    /// Colour at the bottom, sRGB, 0 … 1.
    pub bottom: [f32; 3],
}

/// Output stage: background, tone mapping and exposure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct OutputSettings {
    /// Background behind the volume; left out of transparent images.
    pub background: Background,
    /// Tone mapping of the volume, never applied to the background.
    pub tone_map: ToneMap,
    /// Factor for the light of the volume and of the floor before tone mapping, never for the background:
    /// [`MIN_EXPOSURE`] … [`MAX_EXPOSURE`]. Applies to linear images, too, but not to measurements of light and
    /// shadow.
    pub exposure: f64,
    /// Number of rays through each pixel at edges, one of [`ANTIALIASING_RAYS`]; 1 leaves edges jagged. Applies to
    /// exported images and to the image at rest, not to previews, and not to the scattering engine.
    pub antialiasing: u32,
}

/// Numbers of rays per pixel for which there are sets of places in a pixel.
pub const ANTIALIASING_RAYS: [u32; 4] = [1, 4, 8, 16];

/// Smallest exposure, four stops down: below it every image is black.
pub const MIN_EXPOSURE: f64 = 1.0 / 16.0;
/// Largest exposure, four stops up: above it every image is white.
pub const MAX_EXPOSURE: f64 = 16.0;

impl Default for OutputSettings {
    fn default() -> Self {
        // #14161b … #262a33: dark, but not black, so that shadows stand out from it.
        let bytes = |rgb: [u8; 3]| rgb.map(|c| f32::from(c) / 255.0);
        let background = Background { top: bytes([0x14, 0x16, 0x1b]), bottom: bytes([0x26, 0x2a, 0x33]) };
        Self { background, tone_map: ToneMap::Neutral, exposure: 1.0, antialiasing: 4 }
    }
}

impl OutputSettings {
    /// Returns the number of rays per pixel that serves for a number: the nearest of [`ANTIALIASING_RAYS`].
    pub fn nearest_antialiasing(rays: u32) -> u32 {
        ANTIALIASING_RAYS.into_iter().min_by_key(|known| known.abs_diff(rays)).unwrap_or(1)
    }
}

impl Settings {
    /// Returns the number of rays through each pixel of images at rest. The scattering engine draws whole sheets, and
    /// has one.
    pub fn rays_per_pixel(&self) -> u32 {
        let rays = OutputSettings::nearest_antialiasing(self.output.antialiasing);
        if self.uses_scattering_engine() { 1 } else { rays }
    }

    /// Returns the ambient coefficient of unattenuated light, as a share of the material's colour; 0 if there is a
    /// sky, which replaces it.
    pub fn flat_ambient(&self) -> f64 {
        if self.sky.is_on() { 0.0 } else { self.shading.ambient }
    }

    /// Returns true if material attenuates the light of a sky.
    pub fn has_sky_volume(&self) -> bool {
        self.sky.is_on() && self.sky.density_scale > 0.0 && self.shadows.algorithm.is_on()
    }

    /// Returns true if shadows are coloured: transmittance is per colour component.
    pub fn has_colored_shadows(&self) -> bool {
        self.shadows.transmission > 0.0 && self.shadows.algorithm.is_on()
    }

    /// Returns true if every sample casts rays to all points of area lights: more loop iterations than drivers that
    /// run on the processor allow (Mesa's ends all loops of an invocation after 65,536), so that light is lost there.
    pub fn casts_rays_to_all_samples(&self) -> bool {
        let has_size = |light: &LightSettings| light.on && light.resolve(&self.camera).area.is_some();
        self.shadows.algorithm == ShadowAlgorithm::Direct && self.lights.iter().any(has_size)
    }

    /// Returns true if light bounces; with shadows off, light does not interact with material.
    pub fn has_bounces(&self) -> bool {
        let ScatteringSettings { bounces, albedo, strength, .. } = self.scattering;
        bounces > 0 && albedo > 0.0 && strength > 0.0 && self.shadows.algorithm.is_on()
    }

    /// Returns the share of all light that material scatters to the eye: the albedo if light bounces, else all of it.
    pub fn scattered_share(&self) -> f64 {
        if self.has_bounces() { self.scattering.albedo } else { 1.0 }
    }

    /// Returns the share of a light's intensity that material without a surface scatters in each direction, relative
    /// to a white surface that faces the light: a quarter, E/4π of E/π, if light bounces. Without bounces all of it is
    /// shown, as if the material faced each light, which stands for the light that would bounce.
    pub fn light_amid_material(&self) -> f64 {
        if self.has_bounces() { 0.25 } else { 1.0 }
    }

    /// Returns true if voxels are splatted by the scattering engine. Rays from every sample need the volume, so with
    /// direct shadows the image is gathered with either engine, and so it is with several layers.
    pub fn uses_scattering_engine(&self) -> bool {
        self.sampling.engine == RenderEngine::Scatter
            && self.shadows.algorithm != ShadowAlgorithm::Direct
            && self.layer_composition() == crate::LayerComposition::First
    }

    /// Returns true if the diffuse light of all shadowed lights is stored in one combined volume of colours. With
    /// [`LightStorage::Auto`]: if that takes less memory than a volume per light, and loses neither highlights nor
    /// near-field rays.
    pub fn combines_lights(&self) -> bool {
        let shadowed = self.lights.iter().filter(|light| light.needs_volume()).count();
        let wanted = match self.shadows.storage {
            LightStorage::PerLight => false,
            LightStorage::Combined => true,
            // Four 16-bit components (colour and weight) against one number per light, or as many with coloured
            // shadows.
            LightStorage::Auto => {
                let alike = if self.has_colored_shadows() { 1 } else { 4 };
                self.shading.specular == 0.0
                    && self.shadows.near_field == NearFieldRay::Off
                    && shadowed > alike
            }
        };
        // Terms that depend on the view direction cannot be stored in a volume.
        let is_even = self.scattering.anisotropy == 0.0;
        wanted && is_even && shadowed > 0 && self.shadows.algorithm.has_volume()
    }

    /// Returns the near-field rays in use. They need a light volume per light to continue from: in a combined volume,
    /// its voxels' own blur would remove their detail. None either if every footprint is composited, which is shaded
    /// as in the paper.
    pub fn effective_near_field(&self) -> NearFieldRay {
        let looks_up =
            self.shadows.algorithm.has_volume() && !self.combines_lights() && !self.composites_footprints();
        if looks_up { self.shadows.near_field } else { NearFieldRay::Off }
    }

    /// Returns true if the eye's slabs have adaptive thickness, and are integrated between samples at their faces: not
    /// if gradients come from sheets, nor with two-point quadrature, whose samples are means over even slabs.
    pub fn has_adaptive_slabs(&self) -> bool {
        self.sampling.slabs == SlabMode::ByNeed && self.samples_points()
    }

    /// Returns true if opacity is pre-integrated over the eye's slabs, from the densities at both ends of their
    /// steps, under the conditions of [`Self::has_adaptive_slabs`], and if voxels are not classified before;
    /// otherwise slabs are even.
    pub fn has_preintegrated_slabs(&self) -> bool {
        self.sampling.slabs == SlabMode::Preintegrated
            && self.samples_points()
            && self.classification() == ClassificationOrder::Post
    }

    /// Returns true if point samples of density determine the image.
    fn samples_points(&self) -> bool {
        let SamplingSettings { quadrature, gradients, .. } = self.sampling;
        !self.uses_scattering_engine()
            && quadrature == SlabQuadrature::One
            && gradients != GradientSource::Sheets
    }

    /// Returns the kernel with which the eye's samples are gathered: the prefiltered one if voxels are classified
    /// first, otherwise the chosen one.
    pub fn eye_kernel(&self) -> ReconstructionKernel {
        self.gathering_kernel(self.sampling.kernel)
    }

    /// Returns the kernel with which the light pass gathers: the prefiltered one if voxels are classified first,
    /// otherwise the chosen one.
    pub fn light_kernel(&self) -> ReconstructionKernel {
        self.gathering_kernel(self.shadows.kernel)
    }

    fn gathering_kernel(&self, chosen: ReconstructionKernel) -> ReconstructionKernel {
        if self.sampling.classification.is_pre() { ReconstructionKernel::Prefiltered } else { chosen }
    }

    /// Returns the thickness of even slabs with the same look, in smallest voxel edges: adaptive slabs cost as much,
    /// and err as much, as even ones of half their largest thickness.
    pub fn equivalent_even_slab(&self) -> f64 {
        match self.sampling.slabs {
            SlabMode::Even | SlabMode::Preintegrated => self.sampling.slab,
            SlabMode::ByNeed => 0.5 * self.sampling.slab,
        }
    }

    /// Returns the thickness of the eye's thickest slabs, in smallest voxel edges.
    pub fn thickest_slab(&self) -> f64 {
        if self.has_adaptive_slabs() { self.sampling.slab } else { self.equivalent_even_slab() }
    }

    /// Returns true if the density reconstructed in a cell of 2³ voxels stays within the cell's known bounds
    /// ([`chiaroscuro_volume::CellBounds`]): not if voxels are classified before they are spread, nor with Gaussians
    /// much narrower or wider than the B-spline, nor in projections.
    pub fn cell_bounds_hold(&self) -> bool {
        let is_bounded = |kernel: ReconstructionKernel| match kernel {
            ReconstructionKernel::BSpline | ReconstructionKernel::Prefiltered => true,
            ReconstructionKernel::Gaussian { sigma } => (sigma - BOUNDED_SIGMA).abs() <= SIGMA_TOLERANCE,
        };
        // Projections interpolate linearly, which reaches further than these kernels.
        self.ray_projection().is_none()
            && self.classification() == ClassificationOrder::Post
            && is_bounded(self.sampling.kernel)
            && is_bounded(self.shadows.kernel)
    }

    /// Returns true if normals are computed from sheets.
    pub fn has_sheet_gradients(&self) -> bool {
        self.sampling.gradients == GradientSource::Sheets
    }

    /// Returns true if normals are analytic gradients of the reconstruction: not if voxels are splatted and no
    /// density is sampled, and only for the B-spline, whose gradient is continuous.
    pub fn has_kernel_gradients(&self) -> bool {
        let is_smooth = self.eye_kernel() == ReconstructionKernel::BSpline;
        self.sampling.gradients == GradientSource::Kernel && is_smooth && !self.uses_scattering_engine()
    }

    /// Returns true if voxels are composited one by one, and never summed in sheets.
    pub fn composites_footprints(&self) -> bool {
        self.uses_scattering_engine() && self.sampling.order == SheetOrder::EveryFootprint
    }

    /// Returns the eye's transfer function as a table over a value range, that of the shown volume
    /// ([`chiaroscuro_volume::Volume::table_range`]). For labels, call it on the settings [as
    /// drawn](Self::resolved_for).
    pub fn bake_eye(&self, range: ValueRange, scene: &SceneSpace) -> BakedTransfer {
        self.layer().bake_eye(range, scene)
    }

    /// Returns the lighting transfer function as a table over a value range, as [`Self::bake_eye`]. With coloured
    /// shadows, the table's colours are the shares of extinction that each colour of light meets.
    pub fn bake_lighting(&self, range: ValueRange, scene: &SceneSpace) -> BakedTransfer {
        self.bake_lighting_of(self.layer(), range, scene)
    }
}
