//! Probe of the picture at a point: value, opacity and arriving light, computed on the CPU by single rays.

mod arriving_light;
mod layers;
mod rays;

use glam::DVec3;

use self::arriving_light::ArrivingLight;
use self::rays::VolumeRays;
use chiaroscuro_scene::{LitSides, RayProjection, Settings};
use chiaroscuro_volume::Volume;

pub use self::arriving_light::LightArrival;
pub use self::layers::probe_layers;

/// Probe result at a position of the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    /// Index of the layer whose material is seen.
    pub layer: usize,
    /// Position in scene space.
    pub point: DVec3,
    /// Normal of the surface at the position, in scene space; zero where there is no surface.
    pub normal: DVec3,
    /// Position in index space.
    pub index: DVec3,
    /// Position in world space, in millimetres.
    pub world_mm: DVec3,
    /// Value of the volume, in data units.
    pub value: f64,
    /// Opacity per opacity unit of the eye's transfer function.
    pub opacity: f64,
    /// Light that arrives, for every light of the settings.
    pub lights: Vec<LightArrival>,
    /// Sky visibility, if there is a sky: 1 for a position or a surface with nothing in the way.
    pub sky: Option<f64>,
}

/// Traces a ray (in scene space) and returns the probe at the first visible position, in projections at the largest or
/// smallest value; `None` if nothing is visible.
pub fn probe(volume: &Volume, settings: &Settings, origin: DVec3, direction: DVec3) -> Option<Probe> {
    let volume = &volume.with_density_mapping(settings.shown_content(&volume.ranges()));
    let (settings, range) = (&*settings.resolved_for(volume), volume.table_range());
    let rays = VolumeRays::new(volume);
    let (scene, is_by_label) = (&rays.scene, rays.is_by_label);
    let eye = settings.bake_eye(range, scene);
    let seen = settings.cuts.visible_part().region(scene);
    let point = match settings.ray_projection() {
        None | Some(RayProjection::Mean) => rays.first_visible(&eye, &seen, origin, direction),
        Some(RayProjection::Maximum) => rays.extreme(1.0, &eye, &seen, origin, direction),
        Some(RayProjection::Minimum) => rays.extreme(-1.0, &eye, &seen, origin, direction),
    }?;
    let index = scene.index_from_scene.transform_point3(point);
    // Not clamped to the shown range.
    let value = rays.value(index, &eye);
    let is_one_sided = settings.shading.sides == LitSides::One;
    // True if opacity falls towards high densities; never for solid labels, in which it rises.
    let falls = is_one_sided && !is_by_label && eye.slope_sign(rays.field(index, &eye).value) < 0.0;
    let turned = if falls { -1.0 } else { 1.0 };
    let normal = rays.gradient(point, &seen, turned, &eye).normalize_or_zero() * -turned;
    let ArrivingLight { lights, sky } = ArrivingLight::new(&rays, settings, point, normal);
    Some(Probe {
        layer: 0,
        point,
        normal,
        index,
        world_mm: volume.world_from_index().transform_point3(index),
        value,
        opacity: settings.layer().transfer.opacity_at(range.value_at(volume.density_of(value))),
        lights,
        sky,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_scene::{
        ControlPoint, LightSettings, LightShape, OpacityLength, ShadowAlgorithm, SkyMode, TransferFunction,
    };
    use chiaroscuro_volume::Samples;

    /// Makes a slab at z = 10 … 13 over a block at z = 0 … 5.
    fn slab_over_block() -> (Volume, Settings) {
        let n = 16;
        let values = (0..n * n * n)
            .map(|at| match at / (n * n) {
                0..=5 => 1.0,
                10..=13 => 0.5,
                _ => 0.0_f32,
            })
            .collect();
        let volume = Volume::with_spacing("layers", [n; 3], DVec3::ONE, Samples::F32(values)).unwrap();
        let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
        let transfer = TransferFunction {
            points: vec![point(0.4, 0.0), point(0.5, 0.3), point(1.0, 0.9)],
            ..TransferFunction::default()
        };
        let settings = Settings {
            lights: vec![
                LightSettings { position: [0.0, 0.0, 3.0], ..LightSettings::default() },
                LightSettings { position: [3.0, 0.0, 0.0], casts_shadows: false, ..LightSettings::default() },
            ],
            ..Settings::default()
        }
        .with_transfer(transfer)
        .with_opacity_unit(OpacityLength::Voxels(1.0));
        (volume, settings)
    }

    #[test]
    fn covered_surfaces_see_less_sky() {
        let (volume, mut settings) = slab_over_block();
        let top = DVec3::new(0.0, 0.0, -0.3);
        let open = |settings: &Settings, from: DVec3| {
            probe(&volume, settings, from, (top - from).normalize()).unwrap().sky
        };
        assert_eq!(open(&settings, DVec3::new(0.0, 0.0, 3.0)), None);
        settings.sky.mode = SkyMode::White;
        // The top of the block, seen from the side, with and without the slab above it.
        let aside = DVec3::new(-3.0, 0.0, 0.4);
        let below = open(&settings, aside).unwrap();
        let mut bare = settings.clone();
        bare.layer_mut().transfer.points[1].opacity = 0.0;
        let free = open(&bare, aside).unwrap();
        assert!(below > 0.1 && below < free - 0.15 && free <= 1.0, "{below} {free}");
        settings.shadows.algorithm = ShadowAlgorithm::Off;
        assert_eq!(open(&settings, aside), Some(1.0));
    }

    #[test]
    fn the_first_visible_surface_is_probed() {
        let (volume, settings) = slab_over_block();
        let from_below = probe(&volume, &settings, DVec3::new(0.0, 0.0, -3.0), DVec3::Z).unwrap();
        assert!((from_below.index.z - 0.0).abs() < 1.0, "{from_below:?}");
        assert!((from_below.value - 1.0).abs() < 1e-6);
        let from_above = probe(&volume, &settings, DVec3::new(0.0, 0.0, 3.0), DVec3::NEG_Z).unwrap();
        assert!((9.0..14.5).contains(&from_above.index.z), "{from_above:?}");
        assert_eq!(probe(&volume, &settings, DVec3::new(0.0, 3.0, -3.0), DVec3::Z), None, "beside it");
        assert_eq!(
            probe(&volume, &settings, DVec3::new(-3.0, 0.0, 0.0), DVec3::X).map(|seen| seen.index.z > 5.0),
            None,
            "between the layers there is nothing"
        );
    }

    /// Tests that voxels declared as padding, with a value that the curve shows, are neither visible nor attenuating.
    #[test]
    fn missing_voxels_are_invisible() {
        let (volume, mut settings) = slab_over_block();
        // Opaque, so that the probe hits a face and not the middle of the layer.
        settings.layer_mut().transfer.points[1].opacity = 0.99;
        let look = |volume: &Volume| probe(volume, &settings, DVec3::new(0.0, 0.0, 3.0), DVec3::NEG_Z);
        let without_slab = volume.clone().with_padding(0.5).expect("the block");
        let [whole, block] = [&volume, &without_slab].map(|volume| look(volume).expect("something"));
        assert!(whole.index.z > 9.0 && block.index.z < 6.5, "{block:?}");
        // The block's side, below the slab.
        let [below, uncovered] = [&volume, &without_slab].map(|volume| {
            let seen = probe(volume, &settings, DVec3::new(-3.0, 0.0, -0.375), DVec3::X);
            seen.expect("the block's side").lights[0].transmittance
        });
        assert!(uncovered > 2.0 * below, "{uncovered} {below}");
        // Beside missing voxels, the value is that of present ones, and the surface faces the missing ones.
        let layers = look(&volume.with_padding(0.0).expect("the layers")).expect("the slab");
        assert!((layers.value - 0.5).abs() < 1e-6, "{layers:?}");
        assert!(layers.lights[0].facing.is_some_and(|facing| facing > 0.9), "{layers:?}");
    }

    #[test]
    fn cut_material_is_invisible() {
        use chiaroscuro_scene::{ClipEffect, ClipPlane};
        let (volume, mut settings) = slab_over_block();
        let look = |settings: &Settings| {
            probe(&volume, settings, DVec3::new(0.0, 0.0, 3.0), DVec3::NEG_Z).expect("something")
        };
        let whole = look(&settings);
        // The plane between the layers cuts away the upper one.
        settings.cuts.plane =
            ClipPlane { on: true, normal: [0.0, 0.0, 1.0], offset: 0.1, ..ClipPlane::default() };
        let below = look(&settings);
        assert!(below.index.z < 7.0 && whole.index.z > 9.0, "{below:?}");
        settings.cuts.plane.effect = ClipEffect::Hidden;
        let shaded = look(&settings);
        assert_eq!(shaded.index, below.index);
        assert!(shaded.lights[0].transmittance < 0.4 * below.lights[0].transmittance, "{shaded:?} {below:?}");
        settings.cuts.plane.effect = ClipEffect::Shadowless;
        assert_eq!(look(&settings).index, whole.index);
        // A plane through the block: its face has the plane's normal.
        settings.cuts.plane =
            ClipPlane { on: true, normal: [0.0, 0.6, 0.8], offset: -0.5, ..ClipPlane::default() };
        let facing = look(&settings).lights[0].facing.expect("a face");
        assert!((facing - 0.8).abs() < 0.2, "{facing}");
    }

    /// Tests that layers with inverted values, under an inverted curve, face the same way.
    #[test]
    fn surfaces_face_where_opacity_falls() {
        let (volume, mut settings) = slab_over_block();
        // Opaque, so that the probe hits the slab's face and not its middle.
        settings.layer_mut().transfer.points[1].opacity = 0.99;
        let from_above = |volume: &Volume, settings: &Settings| {
            let seen = probe(volume, settings, DVec3::new(0.0, 0.0, 3.0), DVec3::NEG_Z);
            seen.expect("the slab").lights[0].facing.expect("a surface")
        };
        let rising = from_above(&volume, &settings);
        assert!(rising > 0.9, "{rising}");
        let n = volume.dims()[0];
        let values = (0..n * n * n).map(|at| 1.0 - volume.value(at % n, at / n % n, at / (n * n)) as f32);
        let samples = Samples::F32(values.collect());
        let turned = Volume::with_spacing("turned", volume.dims(), DVec3::ONE, samples).unwrap();
        settings.layer_mut().transfer.points.reverse();
        for point in &mut settings.layer_mut().transfer.points {
            point.value = 1.0 - point.value;
        }
        assert!((from_above(&turned, &settings) - rising).abs() < 1e-6);
        // Lit from below, the surface faces away, unless both sides are lit.
        settings.lights[0].position = [0.0, 0.0, -3.0];
        assert!(from_above(&turned, &settings) < -0.9);
        settings.shading.sides = LitSides::Two;
        assert!(from_above(&turned, &settings) > 0.9);
    }

    #[test]
    fn labels_are_not_interpolated() {
        use chiaroscuro_scene::LabelLook;
        let n = 16;
        // A box of label 9 inside a box of label 3, with nothing around.
        let value = |at: usize| {
            let [x, y, z] = [at % n, at / n % n, at / n / n].map(|c| c.abs_diff(8).max(c.abs_diff(7)));
            match x.max(y).max(z) {
                0..=3 => 9,
                4..=6 => 3,
                _ => 0,
            }
        };
        let samples = Samples::U8((0..n * n * n).map(value).collect());
        let volume = Volume::with_spacing("boxes", [n; 3], DVec3::ONE, samples).unwrap();
        let mut settings = Settings { lights: vec![LightSettings::default()], ..Settings::default() };
        let look = |visible| LabelLook { opacity: 0.95, visible, ..LabelLook::default_for(9) };
        settings.layer_mut().labels = [(3, look(true)), (9, look(true))].into_iter().collect();
        let found = |settings: &Settings| {
            let rows = (0..20).flat_map(|x| (0..20).map(move |y| [x, y].map(|c| f64::from(c) / 12.0 - 0.8)));
            rows.filter_map(|[x, y]| probe(&volume, settings, DVec3::new(x, y, 3.0), DVec3::NEG_Z))
                .map(|seen| seen.value)
                .collect::<Vec<_>>()
        };
        let values = found(&settings);
        assert!(values.len() > 100 && values.iter().all(|&value| value == 3.0), "{values:?}");
        settings.layer_mut().labels.entry_mut(3).visible = false;
        let values = found(&settings);
        assert!(values.len() > 30 && values.iter().all(|&value| value == 9.0), "{values:?}");
        let seen = probe(&volume, &settings, DVec3::new(0.0, 0.0, 3.0), DVec3::NEG_Z).unwrap();
        assert!((seen.opacity - 0.95).abs() < 1e-9, "{seen:?}");
        assert!(seen.index.z > 8.0 && seen.index.z < 12.5, "{seen:?}");
    }

    #[test]
    fn blocked_ranges_are_reported() {
        let (volume, settings) = slab_over_block();
        // The top of the block at z = 5.5, below the slab at 9.5 … 13.5: eight voxels are one scene unit.
        let from = DVec3::new(-3.0, 0.0, 0.4);
        let towards = (DVec3::new(0.0, 0.0, -0.3) - from).normalize();
        let seen = probe(&volume, &settings, from, towards).expect("the block's top");
        let [near, far] = seen.lights[0].blocked.expect("the slab");
        assert!((0.4..0.8).contains(&near) && (0.7..1.2).contains(&far) && near < far, "{near} … {far}");
        let mut bare = settings;
        bare.layer_mut().transfer.points[1].opacity = 0.0;
        let seen = probe(&volume, &bare, from, towards).expect("the block's top");
        assert!(seen.lights[0].blocked.is_none_or(|[near, _]| near < 0.3), "nothing is above it");
    }

    #[test]
    fn area_lights_arrive_as_a_mean() {
        let (volume, mut settings) = slab_over_block();
        // The block's side, below the slab: a light straight above is hidden; part of an area light as wide as its
        // distance is visible beside the slab.
        let arriving = |settings: &Settings| {
            let seen = probe(&volume, settings, DVec3::new(-3.0, 0.0, -0.375), DVec3::X);
            seen.expect("the block's side").lights[0].transmittance
        };
        let point = arriving(&settings);
        (settings.lights[0].shape, settings.lights[0].angle_deg) = (LightShape::Disc, 90.0);
        let disc = arriving(&settings);
        assert!(disc > point + 0.1 && disc < 0.9, "{point} {disc}");
        settings.lights[0].angle_deg = 0.0;
        assert_eq!(arriving(&settings), point);
    }

    #[test]
    fn light_is_attenuated_by_what_lies_between() {
        let (volume, settings) = slab_over_block();
        let seen = probe(&volume, &settings, DVec3::new(-3.0, 0.0, -0.375), DVec3::X);
        let seen = seen.expect("the block's side");
        // Four voxels of opacity 0.3 above: 0.7⁴, and the ramps of linear interpolation at both ends.
        let wanted = 0.7_f64.powi(4);
        let [above, beside] = seen.lights[..] else { panic!("two lights") };
        assert!(above.transmittance < wanted && above.transmittance > 0.0, "{above:?}, less than {wanted}");
        assert_eq!((beside.transmittance, beside.blocked), (1.0, None), "it casts no shadows");
        assert_eq!(above.hood, 1.0);
    }
}
