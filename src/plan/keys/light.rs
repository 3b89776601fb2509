//! What the attenuation volume of a light is made from.

use super::table::{OpacityKey, TransmissionKey};
use crate::model::{
    AreaShadows, Classification, Deposit, Engine, Hood, Kernel, LightArea, LightKind, Precision, Quadrature,
    Remains, Resolution, ReverseKernel, Sampling, SceneLight, Settings, ShadowAlgorithm, Shadows,
};
use crate::plan::{Request, VolumeKey};

/// Everything that one light's attenuation volume is made from.
#[derive(Debug, Clone, PartialEq)]
pub struct LightKey {
    volume: VolumeKey,
    kind: LightKind,
    /// The position, or for a parallel light the direction: moving it outwards changes nothing.
    placed: [f64; 3],
    /// Angles of the hood, if there is one.
    hood_deg: Option<[f64; 2]>,
    density_scale: f64,
    /// How large it is, and from how many points it is followed; `None` of a point.
    area: Option<(LightArea, u32)>,
    algorithm: ShadowAlgorithm,
    classification: Classification,
    engine: Engine,
    opacity: OpacityKey,
    transmission: Option<TransmissionKey>,
    first_touch: bool,
    deposit: Deposit,
    kernel: Kernel,
    /// Only what is gathered back has one of its own.
    reverse_kernel: ReverseKernel,
    slab: f64,
    quadrature: Quadrature,
    resolution: Resolution,
    precision: Precision,
    shading_cut: Remains,
}

/// Previews follow lights that have a size from so many points.
const PREVIEW_SAMPLES: u32 = 16;

impl LightKey {
    /// The key of this light's volume for a preview, at a resolution that is no finer.
    #[must_use]
    pub fn coarse(&self, resolution: Resolution) -> Self {
        let area = self.area.map(|(area, samples)| (area, samples.min(PREVIEW_SAMPLES)));
        Self { resolution: resolution.max(self.resolution), area, ..self.clone() }
    }

    /// How many point lights stand for the light.
    pub fn samples(&self) -> u32 {
        self.area.map_or(1, |(_, samples)| samples)
    }

    /// Whether there is a transmittance for each colour of light.
    pub fn has_colors(&self) -> bool {
        self.transmission.is_some()
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
            // In the key of the volume.
            range: _,
            // In those of the volume and of opacities.
            labels: _,
            // In the key of opacities.
            transfer: _,
            lighting: _,
            opacity_unit: _,
            shading: _,
            shadows,
            sky: _,
            scattering: _,
            cuts,
            floor: _,
            sampling:
                Sampling {
                    kernel: _,
                    slab: _,
                    slabs: _,
                    quadrature: _,
                    gradients: _,
                    classification: _,
                    engine,
                    order: _,
                },
            output: _,
            kept: _,
            // In the identity of the volume that it is made into.
            volume: _,
        } = &request.settings;
        let light = lights.get(index)?.in_scene(camera);
        let SceneLight {
            kind,
            position,
            color: _,
            intensity: _,
            on: _,
            casts_shadows: _,
            hood: Hood { on: hooded, half_angle_deg, rim_deg },
            density_scale,
            area,
        } = &light;
        let hooded = *hooded && *kind == LightKind::Perspective;
        let Shadows {
            algorithm,
            // In the resolution of soft light.
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
            // Where it is looked up.
            near_field: _,
            area: AreaShadows { samples, resolution: _ },
        } = shadows;
        let wanted = algorithm.has_volume() && light.needs_volume();
        wanted.then(|| Self {
            volume: request.shown_volume(),
            kind: *kind,
            placed: match kind {
                LightKind::Parallel => light.direction().into(),
                LightKind::Perspective => *position,
            },
            hood_deg: hooded.then_some([*half_angle_deg, *rim_deg]),
            density_scale: *density_scale,
            area: area.map(|area| (area, *samples)),
            algorithm: *algorithm,
            classification: request.settings.classification(),
            // Rays need no sheets.
            engine: if *algorithm == ShadowAlgorithm::Splat { *engine } else { Engine::Gather },
            opacity: OpacityKey::of(&request.settings),
            transmission: TransmissionKey::of(&request.settings),
            first_touch: *first_touch,
            deposit: *deposit,
            kernel: *kernel,
            reverse_kernel: if *algorithm == ShadowAlgorithm::Splat
                && *engine == Engine::Gather
                && !*first_touch
            {
                *reverse_kernel
            } else {
                ReverseKernel::Forward
            },
            slab: *slab,
            quadrature: *quadrature,
            // One volume for all lights has one resolution.
            resolution: if request.settings.combines_lights() {
                shadows.resolution
            } else {
                light.resolution(shadows, request.volume.dims)
            },
            precision: *precision,
            shading_cut: cuts.shading(),
        })
    }
}
