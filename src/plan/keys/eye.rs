//! Keys of linear pictures: the volume as seen by the eye, and the floor below it.

use super::bounces::BouncesKey;
use super::light::LightKey;
use super::lit_lights::{Attenuation, LitLights};
use super::received::{LightLook, ReceivedLight};
use super::sky::{SkyKey, SkyLook};
use super::table::{EyeTableKey, OpacityKey, TransmissionKey};
use crate::model::{
    Camera, Classification, Depth, Engine, Floor, Gradients, Kernel, Length, Quadrature, Remains, Sampling,
    Settings, Shading, ShadowAlgorithm, Shadows, SheetOrder, Slabs,
};
use crate::plan::{CombinedKey, PixelWindow, RenderOptions, Request, VolumeKey};

/// Inputs of the linear picture of the eye pass.
#[derive(Debug, Clone, PartialEq)]
pub struct EyeKey {
    volume: VolumeKey,
    window: PixelWindow,
    camera: Camera,
    curve: EyeTableKey,
    shading: Shading,
    /// Length to which gradients of surfaces refer.
    unit: Length,
    sampling: SamplingKey,
    seen: Remains,
    shading_cut: Remains,
    received: ReceivedLight,
    lights: Vec<EyeLightKey>,
    /// Combined diffuse light of all shadowed lights, which are then absent from `lights`.
    combined: Option<CombinedKey>,
    /// Sky, and the volume of its visibility.
    sky: Option<SkyLook>,
    sky_volume: Option<SkyKey>,
    /// Volume of bounced light with the factor of its display, and the anisotropy of the first scattering.
    bounces: Option<(BouncesKey, f64)>,
    anisotropy: f64,
    /// Inputs of shadow rays, if samples cast any.
    rays: Option<RaysKey>,
    options: RenderOptions,
}

/// Look of a light, and its attenuation.
#[derive(Debug, Clone, PartialEq)]
struct EyeLightKey {
    look: LightLook,
    attenuation: Attenuation,
    /// Key of its attenuation volume, if it has one.
    volume: Option<LightKey>,
}

/// Inputs of the sampling of sheets.
#[derive(Debug, Clone, PartialEq)]
struct SamplingKey {
    kernel: Kernel,
    slab: f64,
    slabs: Slabs,
    quadrature: Quadrature,
    gradients: Gradients,
    classification: Classification,
    engine: Engine,
    /// Sheet order, if the scattering engine is used.
    order: Option<SheetOrder>,
}

/// Inputs of shadow rays from samples or from the floor to lights.
#[derive(Debug, Clone, PartialEq)]
struct RaysKey {
    opacity: OpacityKey,
    transmission: Option<TransmissionKey>,
    classification: Classification,
    shadows: Shadows,
}

impl SamplingKey {
    fn of(settings: &Settings) -> Self {
        let Sampling { kernel, slab, slabs, quadrature, gradients, classification: _, engine, order } =
            settings.sampling;
        let classification = settings.classification();
        let order = settings.scatters().then_some(order);
        Self { kernel, slab, slabs, quadrature, gradients, classification, engine, order }
    }
}

impl RaysKey {
    fn of(settings: &Settings) -> Self {
        Self {
            opacity: OpacityKey::of(settings),
            transmission: TransmissionKey::of(settings),
            classification: settings.sampling.classification,
            shadows: settings.shadows.clone(),
        }
    }
}

impl EyeKey {
    /// Creates the key of the picture that is made with these light volumes, one for each light of the settings that
    /// has any, or with their combination; and with these volumes of sky visibility and of bounced light.
    pub fn of(
        request: &Request,
        options: &RenderOptions,
        volumes: &[Option<LightKey>],
        combined: Option<&CombinedKey>,
        (sky_volume, bounces): (Option<&SkyKey>, Option<&BouncesKey>),
    ) -> Self {
        let Request { volume: _, settings, size: _, coarse: _ } = request;
        let Settings {
            schema: _,
            camera,
            lights: _,
            // Part of the volume's key.
            range: _,
            // Parts of the keys of the volume and of the tables.
            labels: _,
            transfer: _,
            lighting: _,
            opacity_unit,
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
        let lit = LitLights::of(settings);
        let own = if combined.is_some() { lit.unshadowed() } else { lit.all() };
        let lights = own.iter().map(|lit| EyeLightKey {
            look: LightLook::of(&lit.light),
            attenuation: lit.attenuation,
            volume: volumes.get(lit.index).cloned().flatten(),
        });
        let casts_rays = shadows.algorithm == ShadowAlgorithm::Direct;
        Self {
            volume: request.shown_volume(),
            window: options.window(request),
            camera: camera.clone(),
            curve: EyeTableKey::of(settings),
            shading: shading.clone(),
            unit: *opacity_unit,
            sampling: SamplingKey::of(settings),
            seen: cuts.seen(),
            shading_cut: cuts.shading(),
            received: ReceivedLight::of(settings),
            lights: lights.collect(),
            combined: combined.cloned(),
            sky: SkyLook::of(settings),
            sky_volume: sky_volume.cloned(),
            bounces: bounces.map(|key| (key.clone(), scattering.strength * scattering.albedo)),
            anisotropy: scattering.anisotropy,
            rays: casts_rays.then(|| RaysKey::of(settings)),
            options: computing(options),
        }
    }
}

/// Returns the options that affect the computation of light, with those of display and scheduling reset.
fn computing(options: &RenderOptions) -> RenderOptions {
    RenderOptions {
        transparent: false,
        exposure: 1.0,
        timed: false,
        light_parts: 1,
        depth: Depth::Eight,
        ..options.clone()
    }
}

/// Inputs of the light on the floor.
#[derive(Debug, Clone, PartialEq)]
pub struct FloorKey {
    /// Volume in front of the floor, and its lights.
    eye: EyeKey,
    floor: Floor,
    rays: RaysKey,
    /// Lights may be combined for the eye, but not for the floor.
    lights: LitLights,
}

impl FloorKey {
    /// Creates the key of the floor under a picture; `None` if there is no floor.
    pub fn of(request: &Request, eye: &EyeKey) -> Option<Self> {
        let settings = &request.settings;
        settings.floor.on.then(|| Self {
            eye: eye.clone(),
            floor: settings.floor.clone(),
            rays: RaysKey::of(settings),
            lights: LitLights::of(settings),
        })
    }
}
