//! What a change of settings makes stale, and the geometry of the passes.
//!
//! Everything here is a pure function. Each product of the renderer is described by a key that
//! holds all it was made from; a product is stale exactly when its key differs (design: cache keys).
//! `Settings` is taken apart without `..`, so a new field does not compile until it is classified.

mod eye_frame;
mod light_frame;
mod occupancy;
mod sheet_frame;

pub use eye_frame::eye_frame;
pub use light_frame::{LightView, MAX_KERNEL_PIXELS, SheetPosition, light_views};
pub use occupancy::BrickSet;
pub use sheet_frame::{MAX_STRETCH_LEVEL, PixelLinear, SheetFrame};

use crate::model::{
    Background, Camera, Deposit, Interpolation, Kernel, Length, Light, LightKind, Output, Quadrature,
    Resolution, Sampling, Settings, Shading, ShadowAlgorithm, Shadows, ToneMap, TransferFunction,
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
    opacity: OpacityKey,
    first_touch: bool,
    deposit: Deposit,
    kernel: Kernel,
    slab: f64,
    quadrature: Quadrature,
    resolution: Resolution,
}

/// Everything that the opacities met by light are made from: no colours.
#[derive(Debug, Clone, PartialEq)]
struct OpacityKey {
    points: Vec<[f64; 2]>,
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

    /// The key of light `index` of a request; `None` when it needs no attenuation volume.
    pub fn of(request: &Request, index: usize) -> Option<Self> {
        let Settings {
            schema: _,
            camera: _,
            lights,
            transfer,
            lighting,
            opacity_unit,
            shading: _,
            shadows,
            sampling: _,
            output: _,
        } = &request.settings;
        let light = lights.get(index)?;
        let Light { name: _, kind, position, color: _, intensity: _, on: _, casts_shadows: _ } = light;
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
        } = shadows;
        let wanted = *algorithm == ShadowAlgorithm::Splat && light.needs_volume();
        let TransferFunction { points, interpolation } =
            if lighting.linked { transfer } else { &lighting.curve };
        wanted.then(|| Self {
            volume: request.volume,
            kind: *kind,
            placed: match kind {
                LightKind::Parallel => light.direction().into(),
                LightKind::Perspective => *position,
            },
            opacity: OpacityKey {
                points: points.iter().map(|point| [point.value, point.opacity]).collect(),
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
        sampling,
        output,
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
    let Sampling { kernel: _, slab: _, quadrature: _ } = sampling;
    let Shading { emission: _, ambient: _, diffuse: _, specular: _, shininess: _, surface_gradient: _ } =
        shading;
    let eye = eye_table
        || lighting != &before.lighting
        || *camera != before.camera
        || lamps_differ(lamps, &before.lights)
        || *shading != before.shading
        || *shadows != before.shadows
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{ControlPoint, apply_path, to_json};
    use serde_json::Value;

    fn request() -> Request {
        let point = |value, opacity| ControlPoint { value, color: [1.0; 3], opacity };
        let settings = Settings {
            lights: vec![
                Light::default(),
                Light { position: [0.0, 3.0, 0.0], ..Light::default() },
                Light { kind: LightKind::Perspective, ..Light::default() },
            ],
            transfer: TransferFunction {
                points: vec![point(0.0, 0.0), point(1.0, 0.5)],
                ..Default::default()
            },
            ..Settings::default()
        };
        Request { volume: 1, settings, size: [100, 80], coarse: None }
    }

    fn changed(path: &str, value: &str) -> Plan {
        let before = request();
        let settings = apply_path(&before.settings, path, value).unwrap();
        plan(Some(&before), &Request { settings, ..before.clone() })
    }

    /// What a change is expected to cause.
    #[derive(Debug, PartialEq)]
    enum Effect {
        Nothing,
        Display,
        Eye,
        OneLight,
        AllLights,
    }

    fn effect(plan: &Plan) -> Effect {
        match plan.lights.iter().filter(|&&rebuild| rebuild).count() {
            1 => Effect::OneLight,
            n if n > 1 => Effect::AllLights,
            _ if plan.eye => Effect::Eye,
            _ if plan.display => Effect::Display,
            _ => Effect::Nothing,
        }
    }

    #[test]
    fn every_setting_causes_what_the_design_says() {
        let table = [
            ("camera.azimuth_deg", "10", Effect::Eye),
            ("camera.elevation_deg", "10", Effect::Eye),
            ("camera.roll_deg", "10", Effect::Eye),
            ("camera.target", "[0.1,0,0]", Effect::Eye),
            ("camera.distance", "2", Effect::Eye),
            ("camera.fov_y_deg", "40", Effect::Eye),
            ("camera.projection", "orthographic", Effect::Eye),
            ("lights.1.name", "Fill", Effect::Nothing),
            ("lights.1.color", "[1,0,0]", Effect::Eye),
            ("lights.1.intensity", "2", Effect::Eye),
            ("lights.1.on", "false", Effect::Eye),
            ("lights.1.casts_shadows", "false", Effect::Eye),
            ("lights.1.position", "[0,6,0]", Effect::Eye),
            ("lights.1.position", "[0,6,1]", Effect::OneLight),
            ("lights.2.position", "[4,-4,5]", Effect::OneLight),
            ("lights.1.kind", "perspective", Effect::OneLight),
            ("transfer.points.0.color", "[1,0,0]", Effect::Eye),
            ("transfer.points.1.opacity", "0.4", Effect::AllLights),
            ("transfer.points.1.value", "0.9", Effect::AllLights),
            ("transfer.interpolation", "extinction", Effect::AllLights),
            ("lighting.scale", "0.5", Effect::AllLights),
            ("lighting.linked", "false", Effect::AllLights),
            ("lighting.curve.interpolation", "extinction", Effect::Eye),
            ("opacity_unit", r#"{"mm": 3}"#, Effect::AllLights),
            ("shading.emission", "0.1", Effect::Eye),
            ("shading.ambient", "0.1", Effect::Eye),
            ("shading.diffuse", "0.1", Effect::Eye),
            ("shading.specular", "0.1", Effect::Eye),
            ("shading.shininess", "10", Effect::Eye),
            ("shading.surface_gradient", "0.1", Effect::Eye),
            ("shadows.algorithm", "off", Effect::Eye),
            ("shadows.strength", "0.5", Effect::Eye),
            ("shadows.ambient_offset", "0.1", Effect::Eye),
            ("shadows.gain", "2", Effect::Eye),
            ("shadows.bias_voxels", "1", Effect::Eye),
            ("shadows.balance", "1.5", Effect::Eye),
            ("shadows.first_touch", "true", Effect::AllLights),
            ("shadows.deposit", "front", Effect::AllLights),
            ("shadows.kernel", "prefiltered", Effect::AllLights),
            ("shadows.slab", "0.5", Effect::AllLights),
            ("shadows.quadrature", "two", Effect::AllLights),
            ("shadows.resolution", "half", Effect::AllLights),
            ("sampling.kernel", "prefiltered", Effect::Eye),
            ("sampling.slab", "0.5", Effect::Eye),
            ("sampling.quadrature", "two", Effect::Eye),
            ("output.background.top", "[0,0,0]", Effect::Display),
            ("output.background.bottom", "[0,0,0]", Effect::Display),
            ("output.tone_map", "clip", Effect::Display),
        ];
        for (path, value, expected) in &table {
            assert_eq!(&effect(&changed(path, value)), expected, "{path} = {value}");
        }
        // The table is complete: every leaf of the settings is named, or lies below a name.
        let tree: Value = serde_json::from_str(&to_json(&request().settings)).unwrap();
        let mut leaves = Vec::new();
        collect(&tree, String::new(), &mut leaves);
        for leaf in leaves {
            let general = leaf.replace("lights.0", "lights.1").replace("lights.2", "lights.1");
            let covered = |path: &str| general == path || general.starts_with(&format!("{path}."));
            let listed = table
                .iter()
                .any(|(path, ..)| covered(path) || covered(&path.replace("points.1", "points.0")));
            let exempt =
                ["schema", "lighting.curve.points", "transfer.points"].iter().any(|path| covered(path));
            assert!(listed || exempt, "{leaf} is not classified");
        }
    }

    fn collect(tree: &Value, path: String, leaves: &mut Vec<String>) {
        let join = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
        match tree {
            Value::Object(fields) => fields.iter().for_each(|(key, value)| collect(value, join(key), leaves)),
            Value::Array(items) if items.iter().any(Value::is_object) => {
                items.iter().enumerate().for_each(|(i, value)| collect(value, join(&i.to_string()), leaves));
            }
            _ => leaves.push(path),
        }
    }

    #[test]
    fn the_same_request_needs_nothing_and_the_first_needs_all() {
        assert!(plan(Some(&request()), &request()).is_empty());
        let first = plan(None, &request());
        assert!(first.volume && first.eye_table && first.eye && first.lights == [true; 3]);
    }

    #[test]
    fn removing_a_light_rebuilds_nothing() {
        let mut next = request();
        next.settings.lights.remove(0);
        assert_eq!(effect(&plan(Some(&request()), &next)), Effect::Eye);
    }

    #[test]
    fn an_unlinked_lighting_curve_frees_the_eye() {
        let mut before = request();
        before.settings.lighting.linked = false;
        let settings = apply_path(&before.settings, "transfer.points.1.opacity", "0.4").unwrap();
        let next = Request { settings, ..before.clone() };
        assert_eq!(effect(&plan(Some(&before), &next)), Effect::Eye);
    }

    #[test]
    fn another_volume_rebuilds_everything() {
        let next = Request { volume: 2, ..request() };
        let plan = plan(Some(&request()), &next);
        assert!(plan.volume && plan.eye_table && plan.eye && plan.lights == [true; 3]);
    }
}
