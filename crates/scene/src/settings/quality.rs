//! Quality levels: presets of slab thickness, shadow algorithm, kernels and near field.

use crate::{
    FINE_UNDIVIDED_SHARE, GradientSource, NearFieldRay, ReconstructionKernel, ReverseKernel,
    STANDARD_UNDIVIDED_SHARE, SamplingSettings, Settings, ShadowAlgorithm, ShadowSettings, SlabMode,
};

impl Settings {
    /// Returns this look, rendered at the quality of another: with its slabs, kernels, normals and light volumes, and
    /// with its shadow algorithm if both have shadows. Classification, finer levels, and the remedies against dark
    /// images, stay those of this look.
    #[must_use]
    pub fn with_quality_of(self, other: &Self) -> Self {
        let ShadowSettings {
            algorithm,
            deposit,
            kernel,
            slab,
            quadrature,
            resolution,
            precision,
            storage,
            reverse_kernel,
            near_field,
            area,
            least_blocks,
            strength: _,
            ambient_offset: _,
            gain: _,
            bias_voxels: _,
            balance: _,
            transmission: _,
            keep_balanced: _,
            first_touch: _,
        } = other.shadows;
        let own = self.shadows.algorithm;
        let algorithm = if own.is_on() && algorithm.is_on() { algorithm } else { own };
        let shadows = ShadowSettings {
            algorithm,
            deposit,
            kernel,
            slab,
            quadrature,
            resolution,
            precision,
            storage,
            reverse_kernel,
            near_field,
            area,
            least_blocks,
            ..self.shadows
        };
        let SamplingSettings { classification, finer_levels, .. } = self.sampling;
        let sampling = SamplingSettings { classification, finer_levels, ..other.sampling.clone() };
        Self { shadows, sampling, ..self }
    }
}

/// Quality level. Settings store the individual values, not the level, so that they can be changed after it was
/// chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum QualityPreset {
    /// Light volumes, without near-field rays.
    Fast,
    /// Light volumes, and short near-field rays.
    Standard,
    /// Light volumes, and longer near-field rays.
    Fine,
    /// Rays from every sample to the light, and the thinnest slabs.
    Exact,
}

/// Settings that a quality level sets.
struct QualitySettings {
    algorithm: ShadowAlgorithm,
    near_field: NearFieldRay,
    /// Thickness of the eye's slabs, in smallest voxel edges; the largest if they are adaptive.
    slab: f64,
    slabs: SlabMode,
    max_undivided_share: f64,
    /// Slab thickness of the light pass or step of shadow rays, in smallest voxel edges.
    shadow_slab: f64,
    /// Kernel of the light pass or of shadow rays.
    shadow_kernel: ReconstructionKernel,
    gradients: GradientSource,
}

impl QualityPreset {
    /// All levels, from the fastest to the most accurate.
    pub const ALL: [Self; 4] = [Self::Fast, Self::Standard, Self::Fine, Self::Exact];

    /// Returns the name of the level, as in code and on the command line.
    pub const fn key(self) -> &'static str {
        match self {
            Self::Fast => "fast",
            Self::Standard => "standard",
            Self::Fine => "fine",
            Self::Exact => "exact",
        }
    }

    fn settings(self) -> QualitySettings {
        let splat = |near_field, slabs, slab| QualitySettings {
            algorithm: ShadowAlgorithm::Splat,
            near_field,
            slab,
            slabs,
            max_undivided_share: STANDARD_UNDIVIDED_SHARE,
            shadow_slab: 1.0,
            // Its blur beyond the B-spline's is less than that of a light volume, at a sixth of the fetches.
            shadow_kernel: ReconstructionKernel::Prefiltered,
            gradients: GradientSource::Volume,
        };
        match self {
            Self::Fast => splat(NearFieldRay::Off, SlabMode::Even, 0.5),
            // Even slabs of this thickness show as wood grain on steep surfaces.
            Self::Standard => splat(NearFieldRay::Short, SlabMode::ByNeed, 1.0),
            Self::Fine => QualitySettings {
                max_undivided_share: FINE_UNDIVIDED_SHARE,
                gradients: GradientSource::Kernel,
                // With slabs of a voxel, surfaces that cross the voxels at 20° ripple by 0.7 % instead of 0.2 %.
                ..splat(NearFieldRay::Long, SlabMode::ByNeed, 0.5)
            },
            Self::Exact => QualitySettings {
                algorithm: ShadowAlgorithm::Direct,
                near_field: NearFieldRay::Short,
                // Every slab is halved, and shaded by itself: light in steps of a fifth of a voxel. With a quarter the
                // difference from the limit is 0.4 steps of 8 bits where details are a voxel wide.
                slab: 0.4,
                slabs: SlabMode::ByNeed,
                max_undivided_share: 0.0,
                shadow_slab: 0.25,
                shadow_kernel: ReconstructionKernel::BSpline,
                gradients: GradientSource::Kernel,
            },
        }
    }

    /// Applies all settings of the level. Disabled shadows stay disabled.
    pub fn apply(self, settings: &mut Settings) {
        let level = self.settings();
        let algorithm = level.algorithm;
        let sampling = &mut settings.sampling;
        (sampling.slab, sampling.slabs) = (level.slab, level.slabs);
        sampling.max_undivided_share = level.max_undivided_share;
        sampling.gradients = level.gradients;
        let shadows = &mut settings.shadows;
        (shadows.slab, shadows.kernel) = (level.shadow_slab, level.shadow_kernel);
        shadows.near_field = level.near_field;
        shadows.reverse_kernel = ReverseKernel::Tent;
        if shadows.algorithm.is_on() {
            shadows.algorithm = algorithm;
        }
    }

    /// Returns the level that the settings match, if any.
    pub fn from_settings(settings: &Settings) -> Option<Self> {
        Self::ALL.into_iter().find(|level| {
            let mut applied = settings.clone();
            level.apply(&mut applied);
            applied == *settings
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_at_the_level_that_was_applied() {
        let mut settings = Settings::default();
        for level in QualityPreset::ALL {
            level.apply(&mut settings);
            assert_eq!(QualityPreset::from_settings(&settings), Some(level));
        }
        settings.sampling.slab = 0.7;
        assert_eq!(QualityPreset::from_settings(&settings), None);
    }

    #[test]
    fn looks_are_drawn_as_truly_as_others_and_stay_what_they_are() {
        let mut exact = Settings::default();
        QualityPreset::Exact.apply(&mut exact);
        (exact.shadows.gain, exact.shadows.balance, exact.shading.ambient) = (2.0, 3.0, 0.9);
        let mut look = Settings::default();
        look.shadows.balance = 1.7;
        look.sampling.classification = crate::ClassificationOrder::Pre;
        let drawn = look.clone().with_quality_of(&exact);
        assert_eq!(QualityPreset::from_settings(&drawn), Some(QualityPreset::Exact));
        assert_eq!((drawn.shadows.gain, drawn.shadows.balance), (1.0, 1.7));
        assert_eq!(drawn.sampling.classification, look.sampling.classification);
        assert_eq!(drawn.shading, look.shading);
        exact.shadows.algorithm = ShadowAlgorithm::Off;
        assert_eq!(
            look.with_quality_of(&exact).shadows.algorithm,
            ShadowAlgorithm::Splat,
            "a look has shadows"
        );
    }

    #[test]
    fn shadows_that_are_off_stay_off() {
        let mut settings = Settings::default();
        settings.shadows.algorithm = ShadowAlgorithm::Off;
        QualityPreset::Exact.apply(&mut settings);
        assert_eq!(settings.shadows.algorithm, ShadowAlgorithm::Off);
    }
}
