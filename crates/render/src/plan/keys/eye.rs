//! Keys of linear pictures: the volume as seen by the eye, and the floor below it.

use super::bounces::BouncesKey;
use super::light::LightKey;
use super::light_lookup::{LightAppearance, LightLookupKey};
use super::lit_lights::{ActiveLights, AttenuationMethod};
use super::sky::{SkyAppearance, SkyKey};
use super::table::{EyeTableKey, OpacityKey, TransmissionKey};
use crate::plan::{
    CombinedKey, PictureOptions, PixelWindow, RenderOptions, RenderRequest, VolumeKey, WorkOptions,
};
use chiaroscuro_scene::{
    Camera, ClassificationOrder, ClippedPart, FloorSettings, GradientSource, OpacityLength, PhongShading,
    PixelFormat, RayProjection, ReconstructionKernel, RenderEngine, SamplingSettings, Settings,
    ShadowAlgorithm, ShadowSettings, SheetOrder, SlabMode, SlabQuadrature, VolumeLayer,
};
use chiaroscuro_volume::PagesId;

/// Inputs of the linear picture of the eye pass.
#[derive(Debug, Clone, PartialEq)]
pub struct EyeKey {
    volume: VolumeKey,
    /// Pages of levels that are finer than the volume in memory.
    pages: PagesId,
    window: PixelWindow,
    camera: Camera,
    curve: EyeTableKey,
    shading: PhongShading,
    /// Length to which gradients of surfaces refer.
    unit: OpacityLength,
    sampling: SamplingKey,
    seen: ClippedPart,
    shading_cut: ClippedPart,
    received: LightLookupKey,
    lights: Vec<EyeLightKey>,
    /// Combined diffuse light of all shadowed lights, which are then absent from `lights`.
    combined: Option<CombinedKey>,
    /// Sky, and the volume of its visibility.
    sky: Option<SkyAppearance>,
    sky_volume: Option<SkyKey>,
    /// Volume of bounced light with the factor of its display, and the anisotropy of the first scattering.
    bounces: Option<(BouncesKey, f64)>,
    anisotropy: f64,
    /// Inputs of shadow rays, if samples cast any.
    rays: Option<ShadowRaysKey>,
    options: RenderOptions,
}

/// Look of a light, and its attenuation.
#[derive(Debug, Clone, PartialEq)]
struct EyeLightKey {
    look: LightAppearance,
    attenuation: AttenuationMethod,
    /// Key of its attenuation volume, if it has one.
    volume: Option<LightKey>,
}

/// Inputs of the sampling of sheets.
#[derive(Debug, Clone, PartialEq)]
struct SamplingKey {
    projection: Option<RayProjection>,
    kernel: ReconstructionKernel,
    slab: f64,
    slabs: SlabMode,
    /// Share above which adaptive slabs are halved, if slabs are adaptive.
    max_undivided_share: Option<f64>,
    quadrature: SlabQuadrature,
    gradients: GradientSource,
    classification: ClassificationOrder,
    engine: RenderEngine,
    /// Sheet order, if the scattering engine is used.
    order: Option<SheetOrder>,
}

/// Inputs of shadow rays from samples or from the floor to lights.
#[derive(Debug, Clone, PartialEq)]
struct ShadowRaysKey {
    opacity: OpacityKey,
    transmission: Option<TransmissionKey>,
    classification: ClassificationOrder,
    shadows: ShadowSettings,
}

impl SamplingKey {
    fn new(settings: &Settings) -> Self {
        let SamplingSettings {
            kernel,
            slab,
            slabs,
            max_undivided_share,
            quadrature,
            gradients,
            classification: _,
            engine,
            order,
            // Part of the identity of the pages.
            finer_levels: _,
        } = settings.sampling;
        let max_undivided_share = settings.has_adaptive_slabs().then_some(max_undivided_share);
        let classification = settings.classification();
        let order = settings.uses_scattering_engine().then_some(order);
        Self {
            projection: settings.ray_projection(),
            kernel,
            slab,
            slabs,
            max_undivided_share,
            quadrature,
            gradients,
            classification,
            engine,
            order,
        }
    }
}

impl ShadowRaysKey {
    fn new(settings: &Settings) -> Self {
        Self {
            opacity: OpacityKey::new(settings),
            transmission: TransmissionKey::new(settings),
            classification: settings.classification(),
            shadows: settings.shadows.clone(),
        }
    }
}

impl EyeKey {
    /// Returns true if the picture may read pages of finer levels.
    pub fn has_pages(&self) -> bool {
        self.pages != PagesId::default()
    }

    /// Creates the key of the picture that is made with these light volumes, one for each light of the settings that
    /// has any, or with their combination; and with these volumes of sky visibility and of bounced light.
    pub fn new(
        request: &RenderRequest,
        options: &RenderOptions,
        volumes: &[Option<LightKey>],
        combined: Option<&CombinedKey>,
        sky_volume: Option<&SkyKey>,
        bounces: Option<&BouncesKey>,
    ) -> Self {
        let RenderRequest { volume: _, settings, size: _, preview_resolution: _ } = request;
        let Settings {
            schema: _,
            camera,
            lights: _,
            layers,
            // Part of the key of the sampling; the rest is resolved.
            mode: _,
            shading,
            shadows,
            sky: _,
            scattering,
            cuts,
            floor: _,
            sampling: _,
            output: _,
            kept: _,
            // Part of the identity of the corrected volume.
            volume: _,
        } = settings;
        let VolumeLayer {
            // Part of the volume's key.
            range: _,
            // Parts of the keys of the volume and of the tables.
            labels: _,
            transfer: _,
            lighting: _,
            opacity_unit,
            visibility: _,
            blend: _,
            edges: _,
            materials: _,
            // Part of the key of the volume, whose mask it changes.
            ignores_cuts: _,
        } = layers.first();
        let lit = ActiveLights::from_settings(settings);
        let own = if combined.is_some() { lit.unshadowed() } else { lit.all() };
        let lights = own.iter().map(|lit| EyeLightKey {
            look: LightAppearance::new(&lit.light),
            attenuation: lit.attenuation,
            volume: volumes.get(lit.index).cloned().flatten(),
        });
        let casts_rays = shadows.algorithm == ShadowAlgorithm::Direct;
        Self {
            volume: request.volume_key(),
            pages: request.shown_pages(),
            window: options.sample_window(request),
            camera: camera.clone(),
            curve: EyeTableKey::new(settings),
            shading: shading.clone(),
            unit: *opacity_unit,
            sampling: SamplingKey::new(settings),
            seen: cuts.visible_part(),
            shading_cut: cuts.shadowing_part(),
            received: LightLookupKey::new(settings),
            lights: lights.collect(),
            combined: combined.cloned(),
            sky: SkyAppearance::new(settings),
            sky_volume: sky_volume.cloned(),
            bounces: bounces.map(|key| (key.clone(), scattering.strength * scattering.albedo)),
            anisotropy: scattering.anisotropy,
            rays: casts_rays.then(|| ShadowRaysKey::new(settings)),
            options: without_display_options(options),
        }
    }
}

/// Returns the options that affect the computation of light, with those of display and scheduling reset.
fn without_display_options(options: &RenderOptions) -> RenderOptions {
    let RenderOptions { picture, work, switches } = options.clone();
    RenderOptions {
        picture: PictureOptions {
            transparent: false,
            exposure: 1.0,
            rays: 1,
            depth: PixelFormat::Eight,
            ..picture
        },
        work: WorkOptions { timed: false, light_parts: 1, ..work },
        switches,
    }
}

/// Inputs of a picture with several rays through each sample at edges.
#[derive(Debug, Clone, PartialEq)]
pub struct AntialiasedKey {
    eye: EyeKey,
    rays_per_sample: u32,
}

impl AntialiasedKey {
    /// Creates the key of the antialiased picture; `None` if it has one ray through each sample.
    pub fn new(request: &RenderRequest, options: &RenderOptions, eye: &EyeKey) -> Option<Self> {
        let rays_per_sample = options.rays_per_sample(request);
        (rays_per_sample > 1).then(|| Self { eye: eye.clone(), rays_per_sample })
    }
}

/// Inputs of the light on the floor.
#[derive(Debug, Clone, PartialEq)]
pub struct FloorKey {
    /// Volume in front of the floor, and its lights.
    eye: EyeKey,
    /// Number of rays through each sample of the volume: edges that cover a pixel in part let the floor through.
    rays_per_sample: u32,
    floor: FloorSettings,
    rays: ShadowRaysKey,
    /// Lights may be combined for the eye, but not for the floor.
    lights: ActiveLights,
}

impl FloorKey {
    /// Creates the key of the floor under a picture; `None` if there is no floor.
    pub fn new(request: &RenderRequest, options: &RenderOptions, eye: &EyeKey) -> Option<Self> {
        let settings = &request.settings;
        settings.floor.on.then(|| Self {
            eye: eye.clone(),
            rays_per_sample: options.rays_per_sample(request),
            floor: settings.floor.clone(),
            rays: ShadowRaysKey::new(settings),
            lights: ActiveLights::from_settings(settings),
        })
    }
}
