//! What linear pictures are made from: the volume as the eye sees it, and the floor under it.

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

/// Everything that the eye pass makes a linear picture from.
#[derive(Debug, Clone, PartialEq)]
pub struct EyeKey {
    volume: VolumeKey,
    window: PixelWindow,
    camera: Camera,
    curve: EyeTableKey,
    shading: Shading,
    /// The length to which gradients of surfaces refer.
    unit: Length,
    sampling: SamplingKey,
    seen: Remains,
    shading_cut: Remains,
    received: ReceivedLight,
    lights: Vec<EyeLightKey>,
    /// Diffuse light of all shadowed lights, which are not among `lights` then.
    combined: Option<CombinedKey>,
    /// The sky, and the volume that says how open to it each place is.
    sky: Option<SkyLook>,
    sky_volume: Option<SkyKey>,
    /// Light that has bounced, in a volume, and what is shown of it; and where matter scatters light on its first bounce.
    bounces: Option<(BouncesKey, f64)>,
    anisotropy: f64,
    /// What rays to lights meet, where samples cast them.
    rays: Option<RaysKey>,
    options: RenderOptions,
}

/// A light, and what attenuates it.
#[derive(Debug, Clone, PartialEq)]
struct EyeLightKey {
    look: LightLook,
    attenuation: Attenuation,
    /// The volume from which its attenuation is read, if it has one.
    volume: Option<LightKey>,
}

/// How sheets are filled.
#[derive(Debug, Clone, PartialEq)]
struct SamplingKey {
    kernel: Kernel,
    slab: f64,
    slabs: Slabs,
    quadrature: Quadrature,
    gradients: Gradients,
    classification: Classification,
    engine: Engine,
    /// Only scattering has an order.
    order: Option<SheetOrder>,
}

/// What rays from samples or from the floor to lights meet.
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
    /// The key of the picture that is made with these light volumes, one for each light of the settings that has
    /// any, or with their combination; and with these volumes of the sky and of bounced light.
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
            // In the key of the volume.
            range: _,
            // In the keys of the volume and of the tables.
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
            // In the identity of the volume that it is made into.
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

/// Options as far as they say how light is computed: not how it is shown, nor how the work is cut.
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

/// Everything that the floor pass makes the light on the floor from.
#[derive(Debug, Clone, PartialEq)]
pub struct FloorKey {
    /// What covers it, under which lights.
    eye: EyeKey,
    floor: Floor,
    rays: RaysKey,
    /// Lights may be combined for the eye, but not for the floor.
    lights: LitLights,
}

impl FloorKey {
    /// The key of the floor under a picture; `None` without floor.
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
