//! Near-field rays: shadows from material within a few voxels are traced by a short ray.

use chiaroscuro_scene::{
    Camera, LightGeometry, LightingTransfer, NearFieldRay, OpacityLength, Projection, ReconstructionKernel,
    Settings, ShadowAlgorithm, first_look,
};
use chiaroscuro_volume::synthetic::builtin;

use crate::common::{Dataset, full_precision_renderer, new_renderer, render};
use crate::compare::to_f64;
use crate::scenes::{self, axis_camera, linear_extinction, make_isotropic};
use crate::thresholds::{LIGHT_VOLUME_NEAR_A_FACE, NEAR_A_FACE, PREFILTERED_LIGHT};

/// Density integral of a perpendicular ray to the light, from `depth` voxels below the face of homogeneous material,
/// which is half a voxel from its last voxels, by the density that the cubic B-spline reconstructs.
fn depth_integral_through_face(depth: f64) -> f64 {
    let kernel = |d: f64| {
        let d = d.abs();
        if d < 1.0 {
            2.0 / 3.0 - d * d * (1.0 - d / 2.0)
        } else if d < 2.0 {
            (2.0 - d).powi(3) / 6.0
        } else {
            0.0
        }
    };
    // Voxels at 0, −1, −2 … are full; the face is at ½. Density at z is Σ kernel(z − voxel).
    let density = |z: f64| (-60..=0).map(|voxel| kernel(z - f64::from(voxel))).sum::<f64>();
    let (steps, from, to) = (4000, 0.5 - depth, 3.0);
    let width = (to - from) / f64::from(steps);
    (0..steps).map(|step| density(from + (f64::from(step) + 0.5) * width)).sum::<f64>() * width
}

/// An eye inside opaque, homogeneous material sees how much oblique light arrives just below the lit face: with
/// near-field rays the physical amount, without them that after three blurs.
#[test]
fn light_below_a_face_has_the_physical_amount() {
    let n = 48;
    let face = 8;
    let loaded = Dataset::new(scenes::block(n, |v| v.iter().all(|c| (face..n - face).contains(c))));
    let mut renderer = full_precision_renderer();
    let per_voxel = 0.7;
    let mut squares = [0.0_f64; 3];
    let depths: Vec<f64> = (0..10).map(|step| 0.25 * f64::from(step)).collect();
    for &depth in &depths {
        let z = (n - face) as f64 - 0.5 - depth;
        let height = (z + 0.5) / (n as f64 / 2.0) - 1.0;
        let mut settings = Settings {
            lights: vec![scenes::light(LightGeometry::Parallel, [1.0, 0.0, 1.0])],
            camera: Camera {
                target: [0.0, 0.2, height],
                distance: 0.3,
                fov_y_deg: 2.0,
                ..axis_camera(-90.0, 0.0)
            },
            ..Settings::default()
        }
        .with_transfer(linear_extinction(40.0))
        .with_lighting(LightingTransfer { linked: false, scale: 1.0, curve: linear_extinction(per_voxel) })
        .with_opacity_unit(OpacityLength::Voxels(1.0));
        settings.camera.projection = Projection::Perspective;
        make_isotropic(&mut settings);
        settings.sampling.slab = 0.25;
        let expected = (-per_voxel * depth_integral_through_face(depth) * 2.0_f64.sqrt()).exp();
        for (near, sum) in
            [NearFieldRay::Off, NearFieldRay::Short, NearFieldRay::Long].into_iter().zip(&mut squares)
        {
            settings.shadows.near_field = near;
            let picture = render(&mut renderer, &loaded, &settings, [9, 9]);
            let found = f64::from(picture.linear[9 * 4 + 4][0]);
            *sum += (found - expected).powi(2);
        }
    }
    let [looked_up, short, long] = squares.map(|sum| (sum / depths.len() as f64).sqrt());
    println!("below a face, RMSE: looked up {looked_up:.4}, short rays {short:.4}, long {long:.4}");
    assert!(looked_up > LIGHT_VOLUME_NEAR_A_FACE, "{looked_up}");
    assert!(short <= NEAR_A_FACE && long <= NEAR_A_FACE, "{short} {long}");
}

/// A prefiltered light pass blurs more than the B-spline, but only closer to a surface than near-field rays end.
#[test]
fn a_prefiltered_light_pass_is_as_accurate_behind_near_field_rays() {
    let loaded = Dataset::new(builtin("chair", Some(64)).expect("the chair"));
    let mut renderer = new_renderer();
    let mut settings = first_look::first_settings(loaded.volume(), loaded.histogram());
    settings.lights = vec![scenes::light(LightGeometry::Parallel, [-2.2, -1.2, 1.6])];
    let mut picture = |near, kernel, algorithm| {
        let shadows = &mut settings.shadows;
        (shadows.near_field, shadows.kernel, shadows.algorithm) = (near, kernel, algorithm);
        to_f64(&render(&mut renderer, &loaded, &settings, [160, 160]).linear.concat())
    };
    let limit = picture(NearFieldRay::Short, ReconstructionKernel::BSpline, ShadowAlgorithm::Direct);
    let mut error = |near, kernel| {
        let found = picture(near, kernel, ShadowAlgorithm::Splat);
        let squares: f64 = found.iter().zip(&limit).map(|(a, b)| (a - b).powi(2)).sum();
        (squares / limit.len() as f64).sqrt()
    };
    let without = error(NearFieldRay::Off, ReconstructionKernel::BSpline);
    let exact = error(NearFieldRay::Short, ReconstructionKernel::BSpline);
    let prefiltered = error(NearFieldRay::Short, ReconstructionKernel::Prefiltered);
    println!("from rays: {without:.5} looked up, {exact:.5} with rays nearby, {prefiltered:.5} prefiltered");
    assert!(without > 1.5 * exact, "rays nearby help: {without} {exact}");
    assert!(prefiltered <= PREFILTERED_LIGHT * exact, "{prefiltered} {exact}");
}
