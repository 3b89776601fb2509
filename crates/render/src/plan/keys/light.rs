//! Key of a light's attenuation volume.

use super::table::{OpacityKey, TransmissionKey};
use crate::plan::{RenderRequest, VolumeKey};
use chiaroscuro_scene::{
    AreaLightSampling, ClassificationOrder, ClippedPart, DepositMode, LightArea, LightGeometry,
    LightVolumePrecision, LightVolumeResolution, ReconstructionKernel, RenderEngine, ReverseKernel,
    SamplingSettings, SceneLight, Settings, ShadowAlgorithm, ShadowSettings, SlabQuadrature, Spotlight,
    VolumeLayer,
};

/// Inputs of the attenuation volume of one light.
#[derive(Debug, Clone, PartialEq)]
pub struct LightKey {
    volume: VolumeKey,
    light: LightShapeKey,
    pass: LightPassKey,
    classification: ClassificationOrder,
    opacity: OpacityKey,
    transmission: Option<TransmissionKey>,
    resolution: LightVolumeResolution,
    shading_cut: ClippedPart,
    /// `true` if points on the light are weighted by their cosines to surfaces.
    has_weighted_points: bool,
}

/// Position and extent of a light, without its colour.
#[derive(Debug, Clone, PartialEq)]
struct LightShapeKey {
    kind: LightGeometry,
    /// Position, or for a parallel light the direction, so that moving it outwards changes nothing.
    position_or_direction: [f64; 3],
    /// Angles of the hood in degrees, if there is one.
    hood_deg: Option<[f64; 2]>,
    density_scale: f64,
    /// Area of the light, and the number of points on it; `None` for a point light.
    area: Option<(LightArea, u32)>,
}

/// Parameters of the light pass that fills an attenuation volume.
#[derive(Debug, Clone, PartialEq)]
struct LightPassKey {
    algorithm: ShadowAlgorithm,
    engine: RenderEngine,
    first_touch: bool,
    deposit: DepositMode,
    kernel: ReconstructionKernel,
    /// Reverse kernel, which only the gathering engine has.
    reverse_kernel: ReverseKernel,
    slab: f64,
    quadrature: SlabQuadrature,
    precision: LightVolumePrecision,
}

/// Maximum number of points on an area light in previews.
const PREVIEW_SAMPLES: u32 = 16;

impl LightKey {
    /// Returns the key of this light's volume for a preview, at a resolution that is no finer.
    #[must_use]
    pub fn for_preview(&self, resolution: LightVolumeResolution) -> Self {
        let area = self.light.area.map(|(area, samples)| (area, samples.min(PREVIEW_SAMPLES)));
        let light = LightShapeKey { area, ..self.light.clone() };
        Self { resolution: resolution.max(self.resolution), light, ..self.clone() }
    }

    /// Returns the number of point lights that represent the light.
    pub fn samples(&self) -> u32 {
        self.light.area.map_or(1, |(_, samples)| samples)
    }

    /// Returns true if points on the light are weighted by their cosines to surfaces.
    pub fn has_weighted_points(&self) -> bool {
        self.has_weighted_points
    }

    /// Returns true if there is a transmittance for each colour channel.
    pub fn has_colors(&self) -> bool {
        self.transmission.is_some()
    }

    /// Returns the resolution of the light volume.
    pub fn resolution(&self) -> LightVolumeResolution {
        self.resolution
    }

    /// Returns the storage format of transmittances.
    pub fn precision(&self) -> LightVolumePrecision {
        self.pass.precision
    }

    /// Creates the key of light `index` of a request; `None` if it needs no attenuation volume.
    pub fn new(request: &RenderRequest, index: usize) -> Option<Self> {
        let Settings {
            schema: _,
            camera,
            lights,
            layers,
            // Resolved before.
            mode: _,
            shading,
            shadows,
            sky: _,
            scattering: _,
            cuts,
            floor: _,
            sampling:
                SamplingSettings {
                    kernel: _,
                    slab: _,
                    slabs: _,
                    max_undivided_share: _,
                    quadrature: _,
                    gradients: _,
                    classification: _,
                    engine,
                    order: _,
                    finer_levels: _,
                },
            output: _,
            kept: _,
            // Part of the identity of the corrected volume.
            volume: _,
        } = &request.settings;
        let VolumeLayer {
            // Part of the volume's key.
            range: _,
            // Parts of the keys of the volume and of opacities.
            labels: _,
            // Parts of the key of opacities.
            transfer: _,
            lighting: _,
            opacity_unit: _,
            visibility: _,
            blend: _,
            edges: _,
            materials: _,
            // Part of the key of the volume, whose mask it changes.
            ignores_cuts: _,
        } = layers.first();
        let light = lights.get(index)?.resolve(camera);
        let wanted = shadows.algorithm.has_volume() && light.needs_volume();
        wanted.then(|| Self {
            volume: request.volume_key(),
            light: LightShapeKey::new(&light, shadows.area),
            pass: LightPassKey::new(shadows, *engine),
            classification: request.settings.classification(),
            opacity: OpacityKey::new(&request.settings),
            transmission: TransmissionKey::new(&request.settings),
            // A combined volume has one resolution for all lights.
            resolution: if request.settings.combines_lights() {
                shadows.resolution
            } else {
                light.volume_resolution(shadows, request.volume.dims)
            },
            shading_cut: cuts.shadowing_part(),
            has_weighted_points: shading.has_surfaces() && light.has_weighted_points(),
        })
    }
}

impl LightShapeKey {
    fn new(light: &SceneLight, sampling: AreaLightSampling) -> Self {
        let SceneLight {
            kind,
            position,
            color: _,
            intensity: _,
            on: _,
            casts_shadows: _,
            hood: Spotlight { on: hooded, half_angle_deg, rim_deg },
            density_scale,
            area,
        } = *light;
        let AreaLightSampling { samples, resolution: _ } = sampling;
        let hooded = hooded && kind == LightGeometry::Perspective;
        Self {
            kind,
            position_or_direction: match kind {
                LightGeometry::Parallel => light.direction().into(),
                LightGeometry::Perspective => position,
            },
            hood_deg: hooded.then_some([half_angle_deg, rim_deg]),
            density_scale,
            area: area.map(|area| (area, light.sample_count(samples))),
        }
    }
}

impl LightPassKey {
    fn new(shadows: &ShadowSettings, engine: RenderEngine) -> Self {
        let ShadowSettings {
            algorithm,
            // Part of the resolution of soft light.
            least_blocks: _,
            strength: _,
            ambient_offset: _,
            gain: _,
            bias_voxels: _,
            balance: _,
            transmission: _,
            keep_balanced: _,
            first_touch,
            deposit,
            kernel,
            slab,
            quadrature,
            resolution: _,
            precision,
            storage: _,
            reverse_kernel,
            // Applied where light is looked up.
            near_field: _,
            // Part of the light's shape.
            area: _,
        } = *shadows;
        let splats = algorithm == ShadowAlgorithm::Splat;
        let has_reverse_kernel = splats && engine == RenderEngine::Gather && !first_touch;
        Self {
            algorithm,
            // Rays need no sheets.
            engine: if splats { engine } else { RenderEngine::Gather },
            first_touch,
            deposit,
            kernel,
            reverse_kernel: if has_reverse_kernel { reverse_kernel } else { ReverseKernel::Forward },
            slab,
            quadrature,
            precision,
        }
    }
}
