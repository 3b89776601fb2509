//! Probe of several layers: the first visible position in any of them, and the light that all of them let through.

use glam::DVec3;

use super::arriving_light::ArrivingLight;
use super::rays::VolumeRays;
use super::{Probe, probe};
use chiaroscuro_scene::{Clipping, LayerBlend, LayerVisibility, RenderMode, Settings};
use chiaroscuro_volume::Dataset;

/// Traces a ray (in scene space) through the layers that add material, and returns the probe at what is seen first.
///
/// Returns `None` if nothing is visible. Layers that tint or gate are not regarded, and in other render modes than
/// *Matter* none but the first.
pub fn probe_layers(
    dataset: &Dataset,
    settings: &Settings,
    origin: DVec3,
    direction: DVec3,
) -> Option<Probe> {
    let count = settings.layers.count().min(dataset.fields().len());
    if count < 2 || settings.mode.kind != RenderMode::Matter {
        return probe(dataset.volume(), settings, origin, direction);
    }
    let adding = (0..count).filter(|&index| {
        let layer = settings.layer_at(index);
        (index == 0 || layer.blend == LayerBlend::Add) && layer.visibility != LayerVisibility::Hidden
    });
    let never_cut = settings.layers_never_cut();
    let looks = adding.map(|index| {
        let mut look = settings.clone().with_first_exchanged(index);
        if never_cut >> index & 1 == 1 {
            look.cuts = Clipping::default();
        }
        (index, look)
    });
    let looks: Vec<_> = looks.collect();
    let seen = looks.iter().filter(|(index, _)| settings.layer_at(*index).is_seen());
    let found = seen.filter_map(|(index, look)| {
        let found = probe(dataset.fields()[*index].volume(), look, origin, direction)?;
        Some(Probe { layer: *index, ..found })
    });
    let mut found = found.min_by(|a, b| a.point.distance(origin).total_cmp(&b.point.distance(origin)))?;
    let mut light = ArrivingLight { lights: found.lights, sky: found.sky };
    for (index, look) in looks.iter().filter(|(index, _)| *index != found.layer) {
        let volume = dataset.fields()[*index].volume();
        let volume = &volume.with_density_mapping(look.shown_content(&volume.ranges()));
        let rays = VolumeRays::new(volume);
        light.dim_by(&ArrivingLight::new(&rays, &look.resolved_for(volume), found.point, found.normal));
    }
    (found.lights, found.sky) = (light.lights, light.sky);
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_scene::{
        ControlPoint, DensityRange, LightSettings, OpacityLength, SkyMode, TransferFunction, VolumeLayer,
    };
    use chiaroscuro_volume::{Samples, ValueRange, Volume};

    const EDGE: usize = 16;

    /// Makes a volume with material from one slice to another.
    fn slab(from: usize, to: usize) -> Volume {
        let values = (0..EDGE.pow(3))
            .map(|at| if (from..to).contains(&(at / EDGE.pow(2))) { 1.0 } else { 0.0_f32 })
            .collect();
        Volume::with_spacing("slab", [EDGE; 3], DVec3::ONE, Samples::F32(values)).expect("a volume")
    }

    fn layer(opacity: f64) -> VolumeLayer {
        let points = [(0.4, 0.0), (1.0, opacity)]
            .map(|(value, opacity)| ControlPoint::new(value, [1.0; 3], opacity))
            .to_vec();
        VolumeLayer {
            range: DensityRange::Typed(ValueRange::new(0.0, 1.0)),
            transfer: TransferFunction { points, ..TransferFunction::default() },
            opacity_unit: OpacityLength::Voxels(1.0),
            ..VolumeLayer::default()
        }
    }

    /// Makes a block below a slab of another volume, under a light from above.
    fn slab_over_block() -> (Dataset, Settings) {
        let dataset = Dataset::new(slab(0, 6)).with_field(&slab(10, 14), "slab").expect("two fields");
        let mut settings = Settings {
            lights: vec![LightSettings { position: [0.0, 0.0, 3.0], ..LightSettings::default() }],
            ..Settings::default()
        };
        settings.sky.mode = SkyMode::White;
        *settings.layer_mut() = layer(0.9);
        settings.layers.push(layer(0.3));
        (dataset, settings)
    }

    #[test]
    fn the_first_layer_on_the_way_is_probed() {
        let (dataset, mut settings) = slab_over_block();
        let look = |settings: &Settings, from: f64| {
            probe_layers(&dataset, settings, DVec3::Z * from, DVec3::Z * -from.signum()).expect("something")
        };
        assert_eq!((look(&settings, 3.0).layer, look(&settings, -3.0).layer), (1, 0));
        settings.layers.iter_mut().nth(1).expect("a layer").visibility = LayerVisibility::CastsShadows;
        assert_eq!(look(&settings, 3.0).layer, 0, "the slab is not seen");
        settings.layer_mut().visibility = LayerVisibility::Hidden;
        let nothing = probe_layers(&dataset, &settings, DVec3::Z * 3.0, DVec3::NEG_Z);
        assert_eq!(nothing, None);
    }

    #[test]
    fn all_layers_are_in_the_way_of_light() {
        let (dataset, mut settings) = slab_over_block();
        // The block's side, below the slab.
        let (from, towards) = (DVec3::new(-3.0, 0.0, -0.375), DVec3::X);
        let light = |settings: &Settings| probe_layers(&dataset, settings, from, towards).expect("the block");
        let (alone, below) =
            (probe(dataset.volume(), &settings, from, towards).expect("it"), light(&settings));
        // Four voxels of 0.3 leave 0.7⁴; their edges lie between voxels.
        let ratio = below.lights[0].transmittance / alone.lights[0].transmittance;
        assert!((ratio - 0.7_f64.powi(4)).abs() < 0.06, "{ratio}");
        assert!(below.sky.zip(alone.sky).is_some_and(|(below, alone)| below < alone - 0.02));
        settings.layers.iter_mut().nth(1).expect("a layer").visibility = LayerVisibility::Hidden;
        assert_eq!(light(&settings).lights, alone.lights);
    }
}
