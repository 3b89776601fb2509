//! The scattering engine: against the reference with the same weights, against the gathering engine, and against the
//! footprint itself.

use super::check_against;
use crate::common::{Dataset, full_precision_renderer, new_renderer, render};
use crate::compare::{channels_f32, compare, to_f64};
use crate::scenes::{self, axis_camera, linear_extinction, make_isotropic, use_paper_shadows};
use crate::thresholds::{ENGINES, ENGINES_BY_DEFAULT, FOOTPRINT, ORDER_OPACITY, POPPING, ROTATION_STEP};
use chiaroscuro_render::SHADERS;
use chiaroscuro_scene::{
    Camera, ClassificationOrder, ControlPoint, DepositMode, GradientSource, LightGeometry, LightLock,
    LightSettings, LightVolumeResolution, OpacityInterpolation, OpacityLength, ReconstructionKernel,
    RenderEngine, Settings, SheetOrder, SlabMode, SlabQuadrature, TransferFunction, first_look,
};
use chiaroscuro_volume::{Samples, Volume, synthetic::builtin};
use glam::DVec3;

fn scattering_look() -> Settings {
    let mut settings = scenes::look();
    settings.sampling.engine = RenderEngine::Scatter;
    settings
}

/// Compares with the reference. Densities are stored as 16-bit normalised values, which is exact for 8-bit data.
fn check(name: &str, spacing_mm: DVec3, settings: &Settings) {
    check_against(name, 32, spacing_mm, settings, None);
}

#[test]
fn b_spline_parallel() {
    check("scattered", DVec3::ONE, &scattering_look());
}

#[test]
fn gaussian_tables_perspective_anisotropic() {
    let mut settings = scattering_look();
    let kernel = ReconstructionKernel::Gaussian { sigma: 0.55 };
    settings.sampling.kernel = kernel;
    settings.shadows.kernel = kernel;
    settings.shadows.deposit = DepositMode::Front;
    settings.lights = vec![scenes::light(LightGeometry::Perspective, [1.9, -1.4, 2.0])];
    check("scattered Gaussian", DVec3::new(1.0, 1.2, 1.6), &settings);
}

#[test]
fn two_points_thin_slabs_half_resolution() {
    let mut settings = scattering_look();
    settings.sampling.quadrature = SlabQuadrature::Two;
    settings.shadows.quadrature = SlabQuadrature::Two;
    settings.sampling.slab = 0.5;
    settings.shadows.kernel = ReconstructionKernel::Prefiltered;
    settings.shadows.resolution = LightVolumeResolution::Half;
    check("scattered, half", DVec3::ONE, &settings);
}

#[test]
fn a_light_inside_and_first_touch() {
    let mut settings = scattering_look();
    settings.lights = vec![scenes::light(LightGeometry::Perspective, [0.3, -0.2, 0.5])];
    check("scattered, light inside", DVec3::ONE, &settings);
    settings.lights = scenes::look().lights;
    settings.shadows.first_touch = true;
    check("scattered, first touch", DVec3::ONE, &settings);
}

/// Voxels are classified before they are splatted.
#[test]
fn pre_classified() {
    let mut settings = scattering_look();
    settings.sampling.classification = ClassificationOrder::Pre;
    settings.lights[0].density_scale = 0.6;
    check("scattered, pre-classified", DVec3::new(1.0, 1.2, 1.6), &settings);
}

/// The lowest density may be visible: then pixels without splats are visible, too.
#[test]
fn visible_lowest_density() {
    let mut settings = scattering_look();
    settings.layer_mut().transfer.points[0].opacity = 0.02;
    settings.layer_mut().transfer.points[0].value = 0.0;
    check("scattered, nothing shows", DVec3::ONE, &settings);
    settings.sampling.classification = ClassificationOrder::Pre;
    check("scattered, nothing shows, pre-classified", DVec3::ONE, &settings);
}

/// No. 16: Both engines compute the same sums in another order.
#[test]
fn both_engines_make_the_same_picture() {
    let loaded = Dataset::new(scenes::creature(48, DVec3::ONE));
    let mut renderer = new_renderer();
    let mut settings = scenes::look();
    // The scattering engine implements the paper only.
    use_paper_shadows(&mut settings);
    settings.sampling.gradients = GradientSource::Sheets;
    // Pixels no wider than voxels: the engines stretch kernels differently.
    settings.camera.distance = 2.6;
    let gathered = render(&mut renderer, &loaded, &settings, [128, 96]);
    assert_eq!(renderer.splat_count().expect("nothing to count"), 0);
    settings.sampling.engine = RenderEngine::Scatter;
    let scattered = render(&mut renderer, &loaded, &settings, [128, 96]);
    let splats = renderer.splat_count().expect("they are counted");
    let voxels =
        (0..48).flat_map(|z| loaded.volume().slice_densities(z)).filter(|&density| density > 0.0).count();
    println!("{splats} footprints of {voxels} voxels");
    // The eye's B-spline is four voxels long, so it meets four or more of the slabs; so does the light's.
    assert!(splats as usize > 4 * voxels, "{splats} footprints of {voxels} voxels");
    compare("engines", &channels_f32(&scattered.linear), &to_f64(&gathered.linear.concat()), ENGINES)
        .unwrap_or_else(|err| panic!("{err}"));
    let again = render(&mut renderer, &loaded, &settings, [128, 96]);
    assert_eq!(again.linear, scattered.linear, "integers do not mind the order");
}

/// Both engines with default settings, except those that only one of them supports: their back-projections differ,
/// and near-field rays mostly hide the blur of it.
#[test]
fn both_engines_make_nearly_the_same_picture_by_default() {
    let loaded = Dataset::new(builtin("cloud", Some(64)).expect("the cloud"));
    let mut renderer = new_renderer();
    let mut settings = first_look::first_settings(loaded.volume(), loaded.histogram());
    scenes::use_hard_light(&mut settings, loaded.volume());
    settings.camera.distance = 2.6;
    settings.sampling.slabs = SlabMode::Even;
    settings.sampling.slab = 0.5;
    let gathered = render(&mut renderer, &loaded, &settings, [128, 96]);
    settings.sampling.engine = RenderEngine::Scatter;
    let scattered = render(&mut renderer, &loaded, &settings, [128, 96]);
    compare(
        "engines by default",
        &channels_f32(&scattered.linear),
        &to_f64(&gathered.linear.concat()),
        ENGINES_BY_DEFAULT,
    )
    .unwrap_or_else(|err| panic!("{err}"));
}

/// One voxel under twenty sub-pixel shifts of the camera: the sheets together contain its footprint, the Gaussian
/// integrated along each ray, up to the table's radius of two voxels.
#[test]
fn single_voxels_reproduce_the_footprint() {
    let n = 16;
    let sigma = 0.6;
    let mut values = vec![0u8; n * n * n];
    values[7 + n * (8 + n * 9)] = 255;
    let volume = Volume::with_spacing("impulse", [n; 3], DVec3::ONE, Samples::U8(values)).expect("a volume");
    let loaded = Dataset::new(volume);
    let mut renderer = new_renderer();
    // Thin, and linear in density: alpha is 1 − e^−τ with τ proportional to the footprint.
    let per_voxel = 0.5;
    let mut worst = 0.0f64;
    for phase in 0..20 {
        let size = [40, 40];
        // At 2.5 pixels per voxel, with the whole volume in the picture.
        let camera = Camera {
            target: [f64::from(phase) * 0.0137, f64::from(phase) * 0.0071, f64::from(phase) * 0.0113],
            distance: 1.0,
            fov_y_deg: 90.0,
            ..axis_camera(-57.0, 31.0)
        };
        let mut settings = Settings { camera, ..Settings::default() }
            .with_transfer(linear_extinction(per_voxel))
            .with_opacity_unit(OpacityLength::Voxels(1.0));
        make_isotropic(&mut settings);
        settings.lights[0].casts_shadows = false;
        settings.sampling.kernel = ReconstructionKernel::Gaussian { sigma };
        settings.sampling.engine = RenderEngine::Scatter;
        let picture = render(&mut renderer, &loaded, &settings, size);
        let voxel = loaded.volume().scene().scene_from_index.transform_point3(DVec3::new(7.0, 8.0, 9.0));
        let edge = loaded.volume().scene().smallest_edge();
        for (at, texel) in picture.linear.iter().enumerate() {
            let (i, j) = ((at % 40) as f64 + 0.5, (at / 40) as f64 + 0.5);
            let (origin, direction) = settings.camera.ray_through(i, j, 40.0, 40.0);
            let miss = (voxel - origin).reject_from(direction).length() / edge;
            let across =
                (-miss * miss / (2.0 * sigma * sigma)).exp() / (std::f64::consts::TAU * sigma * sigma);
            let expected = if miss < 2.0 { per_voxel * across } else { 0.0 };
            // The edge of the table is a jump of 0.2 %.
            if (miss - 2.0).abs() > 1e-3 {
                worst = worst.max((-(1.0 - f64::from(texel[3])).ln() - expected).abs());
            }
        }
    }
    println!("footprint: within {worst:.2e}");
    assert!(worst <= FOOTPRINT, "{worst}");
}

/// The scattering engine samples no density texture: the values that it classifies are in the sheets. The eye pass
/// takes normals and near-field rays from the prefiltered pyramid; light and footprints read only the presence of
/// voxels.
#[test]
fn scattering_samples_no_density() {
    let shaders =
        chiaroscuro_render::shader_bindings(wgpu::TextureFormat::R16Float, wgpu::TextureFormat::R16Float);
    for name in ["splat", "eye", "light", "reverse", "normalise", "footprints"] {
        let name = format!("scatter/{name}.wgsl");
        let (_, groups) = shaders.iter().find(|(known, _)| *known == name).expect("the shader is there");
        let binds = |texture: &str| groups.iter().flatten().any(|(binding, _)| *binding == texture);
        assert!(!binds("density_texture"), "{name} has densities");
        if binds("pyramid_texture") {
            assert!(binds("presence_texture"), "{name} has the pyramid");
            let (_, text) = SHADERS.iter().find(|(known, _)| *known == name).expect("its text is there");
            for density in [
                "pyramid_density(",
                "pyramid_field(",
                "field_at(",
                "slab_field(",
                "density_by_kernel(",
                "preclassified_at(",
            ] {
                assert!(!text.contains(density), "{name} reads the pyramid by {density}");
            }
        }
    }
}

/// Mean brightness of a ball while the camera turns together with the light, which is on its right: only the grid's
/// orientation changes.
fn brightness_while_turning(order: SheetOrder) -> Vec<f64> {
    let loaded = Dataset::new(scenes::ball(32, DVec3::splat(15.5), 11.0));
    let mut renderer = full_precision_renderer();
    let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
    let mut settings = Settings {
        lights: vec![LightSettings {
            lock: LightLock::Camera,
            casts_shadows: false,
            ..scenes::light(LightGeometry::Parallel, [2.0, 0.3, 1.0])
        }],
        ..Settings::default()
    }
    // A hard surface: small differences between sums of sheets show different parts of it.
    .with_transfer(TransferFunction {
        points: vec![point(0.0, 0.0), point(110.0, 0.0), point(150.0, 0.8), point(255.0, 0.8)],
        interpolation: OpacityInterpolation::Opacity,
        ..TransferFunction::default()
    })
    .with_opacity_unit(OpacityLength::Voxels(1.0));
    settings.shading.ambient = 0.0;
    settings.sampling.engine = RenderEngine::Scatter;
    settings.sampling.order = order;
    // As in the paper.
    settings.sampling.gradients = GradientSource::Sheets;
    (35..=55)
        .map(|degree| {
            settings.camera = axis_camera(f64::from(degree), 0.0);
            let picture = render(&mut renderer, &loaded, &settings, [64, 64]);
            picture.linear.iter().map(|texel| f64::from(texel[1])).sum::<f64>()
        })
        .collect()
}

/// No. 7: Volume-aligned sheets pop when the camera passes 45 degrees; image-aligned ones do not.
#[test]
fn volume_aligned_sheets_pop_and_image_aligned_ones_do_not() {
    let largest_step = |order| {
        let means = brightness_while_turning(order);
        let mean = means.iter().sum::<f64>() / means.len() as f64;
        let steps: Vec<f64> = means.windows(2).map(|pair| (pair[1] - pair[0]).abs() / mean).collect();
        println!("{order:?}: {steps:.5?}");
        steps.into_iter().fold(0.0, f64::max)
    };
    assert!(largest_step(SheetOrder::ImageAligned) <= ROTATION_STEP);
    assert!(largest_step(SheetOrder::VolumeAligned) > POPPING * ROTATION_STEP);
}

/// No. 3 for the historical orders: a block along the view is as opaque as its chord; single footprints add up to the
/// same optical depth.
#[test]
fn every_order_has_the_opacity_of_the_chord() {
    let n = 24;
    let loaded = Dataset::new(scenes::block(n, |[x, y, z]| [x, y, z].iter().all(|c| (6..18).contains(c))));
    let mut renderer = full_precision_renderer();
    for order in [SheetOrder::ImageAligned, SheetOrder::VolumeAligned, SheetOrder::EveryFootprint] {
        for azimuth_deg in [-90.0, 0.0, 180.0] {
            let mut settings = Settings { camera: axis_camera(azimuth_deg, 0.0), ..Settings::default() }
                .with_transfer(linear_extinction(0.08))
                .with_opacity_unit(OpacityLength::Voxels(1.0));
            make_isotropic(&mut settings);
            settings.camera.distance = 2.0;
            settings.lights[0].casts_shadows = false;
            settings.sampling.engine = RenderEngine::Scatter;
            settings.sampling.order = order;
            let picture = render(&mut renderer, &loaded, &settings, [32, 32]);
            let found = f64::from(picture.linear[16 * 32 + 16][3]);
            let expected = 1.0 - (-0.08f64 * 12.0).exp();
            println!("{order:?} from {azimuth_deg}: {found:.5}, chord {expected:.5}");
            assert!((found - expected).abs() <= ORDER_OPACITY, "{order:?}: {found} not {expected}");
        }
    }
}
