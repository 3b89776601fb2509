//! What a change of settings makes stale, and the geometry of the passes.
//!
//! Everything here is a pure function. Each product of the renderer is described by a key that
//! holds all it was made from; a product is stale exactly when its key differs (design: cache keys).
//! `Settings` is taken apart without `..`, so a new field does not compile until it is classified.

mod geometry;
mod probe;
#[cfg(test)]
mod tests;

pub use self::geometry::brick_set::BrickSet;
pub use self::geometry::cell_distances::{CellDistances, FARTHEST};
pub use self::geometry::cell_set::CellSet;
pub use self::geometry::eye_frame::{eye_frame, preview_slab};
pub use self::geometry::light_frame::{
    LightView, MAX_KERNEL_PIXELS, MIN_KERNEL_VOXELS, SheetPosition, light_views,
};
pub use self::geometry::march_tiles::{ReadTiles, TILE_EDGE};
pub use self::geometry::pixel_window::PixelWindow;
pub use self::geometry::reach::{
    bias_reach, lookup_reach, ray_reach, reverse_reach, reverse_reach_voxels, sample_reach, slab_reach,
    stretch_reach,
};
pub use self::geometry::sheet_frame::{MAX_STRETCH_LEVEL, PixelLinear, SheetFrame};
pub use self::geometry::slice_order::SliceOrder;
pub use probe::{Arrival, Probe, probe};

use crate::model::{
    Background, Camera, Classification, Deposit, Easing, Engine, Hood, Interpolation, Kernel, Length, Light,
    LightKind, Output, Precision, Quadrature, Remains, Resolution, Sampling, Settings, Shading,
    ShadowAlgorithm, Shadows, ToneMap, TransferFunction,
};

/// A picture to be made: of which volume, how, and how large.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// `Volume::content_id` and the geometry's fingerprint, or anything that changes with them.
    pub volume: u64,
    /// The whole look.
    pub settings: Settings,
    /// Pixels per row and column.
    pub size: [u32; 2],
    /// Previews: light volumes that are not there yet may be filled at this resolution.
    pub coarse: Option<Resolution>,
}

/// Everything that one light's attenuation volume is made from.
#[derive(Debug, Clone, PartialEq)]
pub struct LightKey {
    volume: u64,
    kind: LightKind,
    /// The position, or for a parallel light the direction: moving it outwards changes nothing.
    placed: [f64; 3],
    /// Angles of the hood, if there is one.
    hood_deg: Option<[f64; 2]>,
    density_scale: f64,
    algorithm: ShadowAlgorithm,
    classification: Classification,
    engine: Engine,
    opacity: OpacityKey,
    first_touch: bool,
    deposit: Deposit,
    kernel: Kernel,
    slab: f64,
    quadrature: Quadrature,
    resolution: Resolution,
    precision: Precision,
    shading_cut: Remains,
}

/// Everything that the opacities met by light are made from: no colours.
#[derive(Debug, Clone, PartialEq)]
struct OpacityKey {
    points: Vec<([f64; 2], Easing)>,
    interpolation: Interpolation,
    scale: f64,
    unit: Length,
}

impl LightKey {
    /// The same light volume at another resolution.
    #[must_use]
    pub fn at_resolution(&self, resolution: Resolution) -> Self {
        Self { resolution, ..self.clone() }
    }

    /// Resolution of the light volume.
    pub fn resolution(&self) -> Resolution {
        self.resolution
    }

    /// How its values are stored.
    pub fn precision(&self) -> Precision {
        self.precision
    }

    /// The key of light `index` of a request; `None` when it needs no attenuation volume.
    pub fn of(request: &Request, index: usize) -> Option<Self> {
        let Settings {
            schema: _,
            camera,
            lights,
            transfer,
            lighting,
            opacity_unit,
            shading: _,
            shadows,
            cuts,
            ground: _,
            sampling:
                Sampling { kernel: _, slab: _, quadrature: _, gradients: _, classification, engine, order: _ },
            output: _,
            views: _,
        } = &request.settings;
        let light = lights.get(index)?.in_world(camera);
        let Light {
            name: _,
            kind,
            position,
            color: _,
            intensity: _,
            on: _,
            casts_shadows: _,
            lock: _,
            hood: Hood { on: hooded, half_angle_deg, rim_deg },
            density_scale,
        } = &light;
        let hooded = *hooded && *kind == LightKind::Perspective;
        let Shadows {
            algorithm,
            strength: _,
            ambient_offset: _,
            gain: _,
            bias_voxels: _,
            balance: _,
            first_touch,
            deposit,
            kernel,
            slab,
            quadrature,
            resolution,
            precision,
            storage: _,
        } = shadows;
        let wanted = algorithm.has_volume() && light.needs_volume();
        let TransferFunction { points, interpolation, mixing: _ } =
            if lighting.linked { transfer } else { &lighting.curve };
        wanted.then(|| Self {
            volume: request.volume,
            kind: *kind,
            placed: match kind {
                LightKind::Parallel => light.direction().into(),
                LightKind::Perspective => *position,
            },
            hood_deg: hooded.then_some([*half_angle_deg, *rim_deg]),
            density_scale: *density_scale,
            algorithm: *algorithm,
            // Rays need no sheets.
            classification: if *algorithm == ShadowAlgorithm::Splat {
                *classification
            } else {
                Classification::Post
            },
            engine: if *algorithm == ShadowAlgorithm::Splat { *engine } else { Engine::Gather },
            opacity: OpacityKey {
                points: points.iter().map(|point| ([point.value, point.opacity], point.easing)).collect(),
                interpolation: *interpolation,
                scale: lighting.scale,
                unit: *opacity_unit,
            },
            first_touch: *first_touch,
            deposit: *deposit,
            kernel: *kernel,
            slab: *slab,
            quadrature: *quadrature,
            resolution: *resolution,
            precision: *precision,
            shading_cut: cuts.shading(),
        })
    }
}

/// What must run to get from one picture to the next.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Plan {
    /// Upload the volume and all that is derived from it alone.
    pub volume: bool,
    /// Bake the eye's transfer function and find the bricks that it shows.
    pub eye_table: bool,
    /// The same for the lighting transfer function.
    pub lighting_table: bool,
    /// Fill the attenuation volume of light i.
    pub lights: Vec<bool>,
    /// Draw the picture.
    pub eye: bool,
    /// Tone-map it onto its background.
    pub display: bool,
}

impl Plan {
    /// Whether nothing is to be done.
    pub fn is_empty(&self) -> bool {
        let Self { volume, eye_table, lighting_table, lights, eye, display } = self;
        !(*volume || *eye_table || *lighting_table || *eye || *display || lights.contains(&true))
    }
}

/// Compares two requests. A light that kept its attenuation volume keeps it wherever it stands in
/// the list: removing the first of three lights rebuilds nothing.
pub fn plan(previous: Option<&Request>, next: &Request) -> Plan {
    let lights: Vec<_> = (0..next.settings.lights.len()).map(|index| LightKey::of(next, index)).collect();
    let Some(previous) = previous else {
        return Plan {
            volume: true,
            eye_table: true,
            lighting_table: true,
            lights: lights.iter().map(Option::is_some).collect(),
            eye: true,
            display: true,
        };
    };
    let known: Vec<_> =
        (0..previous.settings.lights.len()).filter_map(|index| LightKey::of(previous, index)).collect();
    let Settings {
        schema: _,
        camera,
        lights: lamps,
        transfer,
        lighting,
        opacity_unit,
        shading,
        shadows,
        cuts,
        ground,
        sampling,
        output,
        views: _,
    } = &next.settings;
    let before = &previous.settings;
    let volume = previous.volume != next.volume;
    let unit = *opacity_unit != before.opacity_unit;
    let eye_table = volume || unit || *transfer != before.transfer;
    let Output { background, tone_map } = output;
    let display = *background != before.output.background || *tone_map != before.output.tone_map;
    let Background { top: _, bottom: _ } = background;
    let (ToneMap::Neutral | ToneMap::Clip) = tone_map;
    let Camera { .. } = camera;
    let Sampling { kernel: _, slab: _, quadrature: _, gradients: _, classification: _, engine: _, order: _ } =
        sampling;
    let Shading { emission: _, ambient: _, diffuse: _, specular: _, shininess: _, surface_gradient: _ } =
        shading;
    let eye = eye_table
        || lighting != &before.lighting
        || *camera != before.camera
        || lamps_differ(lamps, &before.lights)
        || *shading != before.shading
        || *shadows != before.shadows
        || *ground != before.ground
        || (cuts.seen(), cuts.shading()) != (before.cuts.seen(), before.cuts.shading())
        || *sampling != before.sampling
        || next.size != previous.size;
    Plan {
        volume,
        eye_table,
        lighting_table: eye_table || *lighting != before.lighting,
        lights: lights
            .iter()
            .map(|key| key.as_ref().is_some_and(|key| volume || !known.contains(key)))
            .collect(),
        eye,
        display: eye || display,
    }
}

/// Whether lights look different: their names do not count.
fn lamps_differ(a: &[Light], b: &[Light]) -> bool {
    let look = |light: &Light| Light { name: String::new(), ..light.clone() };
    a.len() != b.len() || a.iter().zip(b).any(|(a, b)| look(a) != look(b))
}
