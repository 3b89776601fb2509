//! Pipeline variant of the eye pass: the parts of a look that select the code of its shader.

use crate::pipelines::pipeline_variant::{
    GridBoundaries, KernelVariant, LightCount, PipelineVariant, ReconstructionVariant, ShaderConstants,
    ShadingVariant, SkyVariant, deposit_constant, flag, is_cut,
};
use chiaroscuro_scene::{DepositMode, NearFieldRay, RayProjection, Settings, ShadowAlgorithm};

/// Pipeline variant of the eye pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct EyeVariant {
    reconstruction: ReconstructionVariant,
    /// `true` if pixels are wider than voxels somewhere.
    pub(super) is_stretched: bool,
    pub(super) sampling: SamplingVariant,
    /// Value of the ray that is shown, if slabs are not composited.
    pub(super) projection: Option<RayProjection>,
    /// `true` if a projection is shaded at the front of its material.
    is_lit_projection: bool,
    /// `true` if slabs are subdivided by need.
    has_adaptive_slabs: bool,
    /// `true` if opacity is integrated between the densities at both ends of each step.
    has_preintegrated_slabs: bool,
    /// `true` if normals are gradients of the kernel itself.
    has_kernel_gradients: bool,
    /// `true` if samples read pages of finer levels.
    is_paged: bool,
    pub(super) shading: ShadingVariant,
    /// Deposit rule of the rays that samples cast to lights; `None` if light volumes are looked up.
    ray_deposit: Option<DepositMode>,
}

/// Sources of the normals and of the near-field light at samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct SamplingVariant {
    /// `true` if normals come from neighbouring sheets.
    pub(super) has_sheet_gradients: bool,
    /// `true` if normals come from the gradient texture.
    pub(super) has_gradient_texture: bool,
    /// Number of steps of near-field rays; 0 without a near field.
    pub(super) near_steps: u32,
    /// `true` if the first step of near-field rays is halved.
    pub(super) has_near_halves: bool,
}

impl SamplingVariant {
    /// Returns the values of its override constants and conditions.
    pub(crate) fn constants(self) -> ShaderConstants {
        vec![
            flag("SHEET_GRADIENTS", self.has_sheet_gradients),
            flag("GRADIENT_TEXTURE", self.has_gradient_texture),
            ("NEAR_STEPS", f64::from(self.near_steps)),
            flag("NEAR_HALVES", self.has_near_halves),
        ]
    }
}

impl EyeVariant {
    /// Creates the variant for this number of lights, without the gradient texture; `is_stretched` tells if pixels
    /// are wider than voxels somewhere.
    pub(crate) fn from_settings(settings: &Settings, lights: LightCount, is_stretched: bool) -> Self {
        let Settings { sampling, shadows, cuts, shading, .. } = settings;
        let casts_rays = shadows.algorithm == ShadowAlgorithm::Direct;
        let near_field =
            if lights.shadowed > 0 { settings.effective_near_field() } else { NearFieldRay::Off };
        let near_steps = near_field.step_count();
        Self {
            reconstruction: ReconstructionVariant::new(settings.eye_kernel(), sampling.quadrature),
            is_stretched,
            sampling: SamplingVariant {
                has_sheet_gradients: settings.has_sheet_gradients(),
                has_gradient_texture: false,
                near_steps,
                has_near_halves: near_field.halves_first_step(),
            },
            has_kernel_gradients: settings.has_kernel_gradients(),
            is_paged: false,
            projection: settings.ray_projection(),
            is_lit_projection: settings.ray_projection().is_some() && !settings.is_unlit(),
            has_adaptive_slabs: settings.has_adaptive_slabs(),
            has_preintegrated_slabs: settings.has_preintegrated_slabs(),
            shading: ShadingVariant {
                lights,
                is_combined: false,
                // Rays to lights are part of the eye pass, so the cut of the shading applies here, too.
                is_cut: is_cut(cuts.visible_part())
                    || (casts_rays || near_steps > 0) && is_cut(cuts.shadowing_part()),
                sides: shading.sides,
                is_preclassified: settings.classification().is_pre(),
                is_tinted: settings.has_tints(),
                sky: SkyVariant::from_settings(settings),
                has_scattered_light: settings.has_bounces(),
                is_anisotropic: settings.scattering.anisotropy != 0.0,
                has_colored_shadows: settings.has_colored_shadows(),
            },
            ray_deposit: casts_rays.then_some(shadows.deposit),
        }
    }

    /// Sets if the shadowed lights are in one combined volume.
    pub(crate) fn with_combined(mut self, is_combined: bool) -> Self {
        self.shading.is_combined = is_combined;
        self
    }

    /// Sets that samples read pages of finer levels, which hold prefiltered densities alone.
    pub(crate) fn with_pages(mut self) -> Self {
        self.is_paged = true;
        self.has_kernel_gradients = false;
        self.reconstruction.kernel = KernelVariant::Prefiltered;
        self
    }

    /// Sets the grid boundaries that samples may meet.
    pub(crate) fn with_boundaries(mut self, ends: GridBoundaries) -> Self {
        self.reconstruction = self.reconstruction.with_boundaries(ends);
        self
    }

    /// Sets if normals come from the gradient texture.
    pub(crate) fn with_gradients(mut self, has_gradients: bool) -> Self {
        self.sampling.has_gradient_texture = has_gradients;
        self
    }
}

impl PipelineVariant for EyeVariant {
    fn shader(&self) -> &'static str {
        "eye/eye_pass.wgsl"
    }

    fn constants(&self) -> ShaderConstants {
        let mut constants = self.reconstruction.constants();
        constants.extend(self.shading.constants());
        let projection = match self.projection {
            None => 0.0,
            Some(RayProjection::Maximum) => 1.0,
            Some(RayProjection::Minimum) => 2.0,
            Some(RayProjection::Mean) => 3.0,
        };
        constants.extend([
            flag("STRETCH", self.is_stretched),
            flag("BY_NEED", self.has_adaptive_slabs),
            flag("PREINTEGRATED", self.has_preintegrated_slabs),
            ("PROJECTION", projection),
            flag("LIT", self.is_lit_projection),
            flag("KERNEL_GRADIENTS", self.has_kernel_gradients),
            flag("DIRECT", self.ray_deposit.is_some()),
            flag("PAGED", self.is_paged),
        ]);
        constants.extend(self.sampling.constants());
        if let Some(deposit) = self.ray_deposit {
            constants.push(deposit_constant(deposit));
        }
        constants
    }
}
