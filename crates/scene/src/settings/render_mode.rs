//! Render modes: rules by which the values along a ray become a colour.
//!
//! Only projections have shaders of their own. A surface is material with a steep curve, and a projection without light
//! is one of material that glows, so both are other settings ([`Settings::resolved_mode`]).

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::{
    ClassificationOrder, FloorSettings, GradientSource, MAX_OPACITY, OpacityLength, PhongShading,
    RenderEngine, SamplingSettings, Settings, ShadowAlgorithm, SkyMode, SlabMode, SlabQuadrature, ToneMap,
    TransferFunction,
};

/// Length of material that is opaque in a surface. Half of its light comes from a tenth of that, which is crisp; more
/// opaque ones have dots in previews, whose light volumes are coarser.
const SURFACE_UNIT: OpacityLength = OpacityLength::Voxels(1.0);

/// Surface gradient for that length, a hundredth of the range in 2.5 voxels: isosurfaces of smooth data are shaded as
/// surfaces, too.
const SURFACE_GRADIENT: f64 = 0.004;

/// Largest strength of shadows on a maximum: material in front of it, which is not shown, would make it black.
const MAX_SHADOW_STRENGTH: f64 = 0.6;

/// Number of steps in which a curve is searched for an opacity; 1/256 of its range is less than the noise of most data.
const OPACITY_SEARCH_STEPS: u32 = 256;

/// Rule by which the values along a ray become a colour.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RenderMode {
    /// Material: opacities of the curve attenuate the light of what lies behind.
    #[default]
    Matter,
    /// Opaque surface where values reach the isovalue.
    Surface,
    /// Largest value along the ray.
    Maximum,
    /// Smallest value along the ray.
    Minimum,
    /// Mean of the values along the ray.
    Mean,
}

/// Value of a ray that a projection shows with the colour and opacity of the curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RayProjection {
    /// Largest value along the ray.
    Maximum,
    /// Smallest value along the ray.
    Minimum,
    /// Mean of the values over the length of the ray.
    Mean,
}

/// Render mode and its parameters.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct RenderModeSettings {
    /// Rule in use; volumes that are shown by labels are always material.
    pub kind: RenderMode,
    /// Value of a surface, in data units; `None` for the value at which the curve reaches half of its largest opacity.
    pub isovalue: Option<f64>,
    /// Shades a maximum, with shadows, at the front of the material that it belongs to; otherwise the colours of the
    /// curve are shown as they are.
    pub lit: bool,
}

impl RenderMode {
    /// All modes, in the order in which the window offers them.
    pub const ALL: [Self; 5] = [Self::Matter, Self::Surface, Self::Maximum, Self::Minimum, Self::Mean];

    /// Returns the mode after this one; the first one follows the last.
    #[must_use]
    pub fn next(self) -> Self {
        let at = Self::ALL.iter().position(|mode| *mode == self).unwrap_or(0);
        Self::ALL[(at + 1) % Self::ALL.len()]
    }
}

impl TransferFunction {
    /// Returns true if high values are at least as opaque as low ones.
    fn is_rising(&self) -> bool {
        let opacity = |point: Option<&crate::ControlPoint>| point.map_or(0.0, |point| point.opacity);
        opacity(self.points.last()) >= opacity(self.points.first())
    }

    /// Returns the first value, from the transparent end, at which opacity reaches a share of its maximum; 0 without
    /// points.
    pub(super) fn value_at_opacity_share(&self, share_of_largest: f64) -> f64 {
        let (Some(first), Some(last)) = (self.points.first(), self.points.last()) else { return 0.0 };
        let largest = self.points.iter().map(|point| point.opacity).fold(0.0, f64::max);
        let ends = if self.is_rising() { [first.value, last.value] } else { [last.value, first.value] };
        let steps = (0..=OPACITY_SEARCH_STEPS).map(|step| f64::from(step) / f64::from(OPACITY_SEARCH_STEPS));
        let mut values = steps.map(|share| ends[0] + (ends[1] - ends[0]) * share);
        values.find(|value| self.opacity_at(*value) >= share_of_largest * largest).unwrap_or(ends[0])
    }

    /// Returns the function with these colours that is opaque on one side of a value, that of high values for a rising
    /// curve, and transparent on the other.
    fn step_at(&self, isovalue: f64) -> Self {
        let mut step = self.clone();
        for _ in 0..2 {
            step.split_at(isovalue);
        }
        let (low, high) = if self.is_rising() { (0.0, MAX_OPACITY) } else { (MAX_OPACITY, 0.0) };
        let jump = step.points.partition_point(|point| point.value < isovalue);
        for (at, point) in step.points.iter_mut().enumerate() {
            point.opacity = if at <= jump { low } else { high };
        }
        step
    }
}

impl Settings {
    /// Returns the mode in effect: labels have no order, and are always shown as material.
    pub fn render_mode(&self) -> RenderMode {
        if self.layer().labels.is_empty() { self.mode.kind } else { RenderMode::Matter }
    }

    /// Returns the projection in effect, if there is one.
    pub fn ray_projection(&self) -> Option<RayProjection> {
        match self.render_mode() {
            RenderMode::Matter | RenderMode::Surface => None,
            RenderMode::Maximum => Some(RayProjection::Maximum),
            RenderMode::Minimum => Some(RayProjection::Minimum),
            RenderMode::Mean => Some(RayProjection::Mean),
        }
    }

    /// Returns true if material is shown, and neither a surface nor a projection.
    pub fn shows_matter(&self) -> bool {
        self.render_mode() == RenderMode::Matter
    }

    /// Returns true if the colours of the curve are shown as they are: light, exposure and tone map have no effect.
    pub fn is_unlit(&self) -> bool {
        match self.ray_projection() {
            Some(RayProjection::Maximum) => !self.mode.lit,
            Some(RayProjection::Minimum | RayProjection::Mean) => true,
            None => false,
        }
    }

    /// Returns the isovalue of surfaces: the chosen one, or that of the curve.
    pub fn isovalue(&self) -> f64 {
        self.mode.isovalue.unwrap_or_else(|| self.layer().transfer.value_at_opacity_share(0.5))
    }

    /// Returns the isovalue if a surface is shown.
    pub fn shown_isovalue(&self) -> Option<f64> {
        (self.render_mode() == RenderMode::Surface).then(|| self.isovalue())
    }

    /// Returns the settings whose material is what the mode shows, so that passes and keys need only know of
    /// projections. The result is resolved to itself.
    #[must_use]
    pub fn resolved_mode(&self) -> Cow<'_, Self> {
        match self.render_mode() {
            RenderMode::Matter => Cow::Borrowed(self),
            RenderMode::Surface => Cow::Owned(self.as_surface()),
            RenderMode::Maximum | RenderMode::Minimum | RenderMode::Mean => Cow::Owned(self.as_projection()),
        }
    }

    /// Returns the settings for measuring light: those of material where a projection shows none.
    #[must_use]
    pub fn as_lit(&self) -> Cow<'_, Self> {
        if self.is_unlit() {
            let mut lit = self.clone();
            lit.mode.kind = RenderMode::Matter;
            Cow::Owned(lit)
        } else {
            Cow::Borrowed(self)
        }
    }

    fn as_surface(&self) -> Self {
        let mut drawn = self.clone();
        drawn.mode.kind = RenderMode::Matter;
        drawn.shading.surface_gradient = SURFACE_GRADIENT;
        let transfer = self.layer().transfer.step_at(self.isovalue());
        let layer = drawn.layer_mut();
        (layer.transfer, layer.opacity_unit, layer.lighting.linked) = (transfer, SURFACE_UNIT, true);
        drawn
    }

    fn as_projection(&self) -> Self {
        let mut drawn = self.clone();
        drawn.sampling = SamplingSettings {
            engine: RenderEngine::Gather,
            classification: ClassificationOrder::Post,
            gradients: match self.sampling.gradients {
                GradientSource::Sheets => GradientSource::Volume,
                other => other,
            },
            quadrature: SlabQuadrature::One,
            slabs: SlabMode::Even,
            slab: self.equivalent_even_slab(),
            ..self.sampling.clone()
        };
        if self.is_unlit() {
            drawn.lights.clear();
            drawn.shadows.algorithm = ShadowAlgorithm::Off;
            drawn.sky.mode = SkyMode::Off;
            drawn.scattering.bounces = 0;
            drawn.floor = FloorSettings { on: false, ..self.floor.clone() };
            drawn.shading = PhongShading {
                emission: 1.0,
                ambient: 0.0,
                diffuse: 0.0,
                specular: 0.0,
                ..self.shading.clone()
            };
            (drawn.output.exposure, drawn.output.tone_map) = (1.0, ToneMap::Clip);
        } else {
            drawn.shadows.strength = self.shadows.strength.min(MAX_SHADOW_STRENGTH);
        }
        drawn
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ControlPoint, Easing, LabelLook};
    use chiaroscuro_volume::{ValueRange, ValueRanges};

    fn curve(points: &[(f64, f64)]) -> TransferFunction {
        let point =
            |&(value, opacity): &(f64, f64)| ControlPoint::new(value, [value as f32, 0.5, 0.25], opacity);
        TransferFunction { points: points.iter().map(point).collect(), ..TransferFunction::default() }
    }

    fn with_mode(kind: RenderMode) -> Settings {
        let mut settings = Settings::default().with_transfer(curve(&[(0.2, 0.0), (0.6, 0.8), (1.0, 0.8)]));
        settings.mode.kind = kind;
        settings
    }

    #[test]
    fn modes_follow_each_other_in_a_circle() {
        let mut mode = RenderMode::default();
        for expected in [1, 2, 3, 4, 0] {
            mode = mode.next();
            assert_eq!(mode, RenderMode::ALL[expected]);
        }
    }

    #[test]
    fn material_is_drawn_as_it_is() {
        let settings = with_mode(RenderMode::Matter);
        assert!(matches!(settings.resolved_mode(), Cow::Borrowed(_)));
        assert!(!settings.is_unlit());
        // Labels are material in every mode.
        let labels = [(1, LabelLook::default_for(1))].into_iter().collect();
        let settings = with_mode(RenderMode::Maximum).with_labels(labels);
        assert_eq!((settings.render_mode(), settings.is_unlit()), (RenderMode::Matter, false));
        assert!(matches!(settings.resolved_mode(), Cow::Borrowed(_)));
    }

    #[test]
    fn surfaces_are_opaque_beyond_their_value() {
        let mut settings = with_mode(RenderMode::Surface);
        // The opacity of 0.4 is reached halfway from 0.2 to 0.6.
        assert!((settings.isovalue() - 0.4).abs() < 0.8 / 256.0);
        for isovalue in [0.1, 0.2, 0.5, 0.6, 1.3] {
            settings.mode.isovalue = Some(isovalue);
            let drawn = settings.resolved_mode().into_owned();
            let step = &drawn.layer().transfer;
            for value in [-0.5, isovalue - 1e-6, isovalue, isovalue + 1e-6, 2.0] {
                let expected = if value < isovalue { 0.0 } else { MAX_OPACITY };
                assert!((step.opacity_at(value) - expected).abs() < 1e-9, "{value} at {isovalue}");
                let [before, after] =
                    [&settings, &drawn].map(|look| look.layer().transfer.sample(value).color);
                assert!(before.iter().zip(after).all(|(a, b)| (a - b).abs() < 1e-4), "{value} at {isovalue}");
            }
            assert_eq!(drawn.resolved_mode().into_owned(), drawn);
        }
    }

    #[test]
    fn surfaces_of_falling_curves_are_opaque_below_their_value() {
        let mut settings = with_mode(RenderMode::Surface).with_transfer(curve(&[(0.2, 0.8), (0.6, 0.0)]));
        assert!((settings.isovalue() - 0.4).abs() < 0.4 / 256.0 + 1e-9);
        settings.mode.isovalue = Some(0.3);
        let drawn = settings.resolved_mode();
        let opacities = [0.0, 0.299, 0.301, 1.0].map(|value| drawn.layer().transfer.opacity_at(value));
        assert!(
            opacities[1] > 0.999 && opacities[0] > 0.999 && opacities[2..] == [0.0, 0.0],
            "{opacities:?}"
        );
    }

    #[test]
    fn curves_of_every_shape_have_a_surface() {
        let stepped = {
            let mut curve = curve(&[(0.0, 0.0), (0.5, 0.6), (1.0, 0.6)]);
            curve.points.iter_mut().for_each(|point| point.easing = Easing::Step);
            curve
        };
        let peak = curve(&[(0.2, 0.0), (0.5, 0.9), (0.8, 0.0)]);
        for (curve, expected) in [(stepped, 0.5), (peak, 0.35), (TransferFunction::default(), 0.0)] {
            let settings = with_mode(RenderMode::Surface).with_transfer(curve);
            assert!((settings.isovalue() - expected).abs() < 0.01, "{expected}: {}", settings.isovalue());
            assert!(settings.resolved_mode().layer().transfer.opacity_at(expected + 0.02) > 0.999);
        }
    }

    #[test]
    fn the_range_of_densities_holds_the_isovalue() {
        let ranges = ValueRanges { all: ValueRange::new(-9.0, 9.0), robust: ValueRange::UNIT };
        let mut settings = with_mode(RenderMode::Surface);
        settings.mode.isovalue = Some(3.0);
        assert!(settings.shown_range(&ranges).high >= 3.0);
        assert_eq!(settings.shown_range(&ranges), settings.resolved_mode().shown_range(&ranges));
        // A lighting curve of its own has no effect on a surface.
        let lighting = &mut settings.layer_mut().lighting;
        (lighting.linked, lighting.curve) = (false, curve(&[(-5.0, 0.0), (8.0, 1.0)]));
        assert_eq!(settings.shown_range(&ranges), settings.resolved_mode().shown_range(&ranges));
    }

    #[test]
    fn projections_without_light_show_the_colours_of_the_curve() {
        for kind in [RenderMode::Maximum, RenderMode::Minimum, RenderMode::Mean] {
            let mut settings = with_mode(kind);
            (settings.output.exposure, settings.floor.on, settings.sky.mode) = (2.0, true, SkyMode::White);
            assert!(settings.is_unlit());
            let drawn = settings.resolved_mode().into_owned();
            assert!(drawn.lights.is_empty() && !drawn.floor.on && !drawn.has_sky_volume());
            assert_eq!(
                (drawn.output.exposure, drawn.shading.emission, drawn.flat_ambient()),
                (1.0, 1.0, 0.0)
            );
            assert_eq!(drawn.ray_projection(), settings.ray_projection());
            assert_eq!(drawn.resolved_mode().into_owned(), drawn);
            assert_eq!(settings.as_lit().mode.kind, RenderMode::Matter);
        }
    }

    #[test]
    fn a_maximum_may_be_lit() {
        let mut settings = with_mode(RenderMode::Maximum);
        settings.mode.lit = true;
        assert!(!settings.is_unlit());
        let drawn = settings.resolved_mode().into_owned();
        assert_eq!((&drawn.lights, &drawn.shading), (&settings.lights, &settings.shading));
        assert!(drawn.shadows.strength <= MAX_SHADOW_STRENGTH);
        assert!(!drawn.has_adaptive_slabs() && !drawn.has_preintegrated_slabs());
        assert_eq!(drawn.resolved_mode().into_owned(), drawn);
        settings.mode.kind = RenderMode::Mean;
        assert!(settings.is_unlit(), "means have no place that could be lit");
    }
}
