//! Light as received by samples: the look of a light, and the cures for darkness.

use chiaroscuro_scene::{
    LightArea, LightGeometry, NearFieldRay, SceneLight, Settings, ShadowAlgorithm, ShadowSettings, Spotlight,
};

/// Look of a light from samples; for a parallel light, only the direction of its position counts.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LightAppearance {
    kind: LightGeometry,
    /// Position, or for a parallel light the direction.
    position_or_direction: [f64; 3],
    color: [f32; 3],
    intensity: f64,
    hood: Option<Spotlight>,
    density_scale: f64,
    /// True if it casts shadows, which also decides whether it lights one side of a surface or both.
    casts_shadows: bool,
    /// Area of the light, which affects shadows and highlights.
    area: Option<LightArea>,
}

impl LightAppearance {
    /// Extracts the look of a light.
    pub(super) fn new(light: &SceneLight) -> Self {
        let SceneLight { kind, position, color, intensity, on: _, casts_shadows, hood, density_scale, area } =
            *light;
        let placed = match kind {
            LightGeometry::Parallel => light.direction().into(),
            LightGeometry::Perspective => position,
        };
        let hood = (hood.on && kind == LightGeometry::Perspective).then_some(hood);
        Self {
            kind,
            position_or_direction: placed,
            color,
            intensity,
            hood,
            density_scale,
            casts_shadows,
            area,
        }
    }
}

/// Parameters of light lookups: the cures for darkness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LightLookupKey {
    algorithm: ShadowAlgorithm,
    strength: f64,
    ambient_offset: f64,
    gain: f64,
    bias_voxels: f64,
    balance: f64,
    near_field: NearFieldRay,
}

impl LightLookupKey {
    /// Extracts the parameters of shadows that apply where light is looked up.
    pub(super) fn new(settings: &Settings) -> Self {
        let ShadowSettings {
            algorithm,
            strength,
            ambient_offset,
            gain,
            bias_voxels,
            balance,
            // Without effect on the picture.
            keep_balanced: _,
            // Parts of the keys of light volumes and of rays.
            transmission: _,
            first_touch: _,
            deposit: _,
            kernel: _,
            slab: _,
            quadrature: _,
            resolution: _,
            precision: _,
            storage: _,
            reverse_kernel: _,
            near_field: _,
            area: _,
            least_blocks: _,
        } = settings.shadows;
        let near_field = settings.effective_near_field();
        // Near-field rays replace the bias.
        let bias_voxels = if near_field == NearFieldRay::Off { bias_voxels } else { 0.0 };
        Self { algorithm, strength, ambient_offset, gain, bias_voxels, balance, near_field }
    }
}
