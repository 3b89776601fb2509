//! Small scenes for comparisons: a volume with shells, rods and soft parts, and looks for it.

use chiaroscuro_scene::{
    Camera, ControlPoint, LightGeometry, LightSettings, LightingRig, LitSides, NearFieldRay,
    OpacityInterpolation, OpacityLength, Projection, ReverseKernel, Settings, ShadowSettings, SkyMode,
    TransferFunction, first_look,
};
use chiaroscuro_volume::{Histogram, Samples, Volume};
use glam::DVec3;

/// Asymmetric volume with thin and thick, hard and soft parts.
pub(crate) fn creature(n: usize, spacing_mm: DVec3) -> Volume {
    let half = n as f64 / 2.0;
    let soft = 1.5 / half;
    let values = (0..n * n * n)
        .map(|at| {
            let p = DVec3::new((at % n) as f64, (at / n % n) as f64, (at / n / n) as f64);
            let p = (p + 0.5) / half - 1.0;
            let ball = |c: DVec3, r: f64| (p - c).length() - r;
            let rod = |a: DVec3, b: DVec3, r: f64| {
                let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
                (p - a - (b - a) * t).length() - r
            };
            let plate = ((p.z + 0.62).abs() - 0.08).max(p.x.abs() - 0.78).max(p.y.abs() - 0.74);
            let parts = [
                (ball(DVec3::new(0.1, -0.1, 0.05), 0.38).abs() - 0.09, 170.0),
                (ball(DVec3::new(0.15, -0.05, 0.0), 0.15), 90.0),
                (rod(DVec3::new(-0.6, 0.3, 0.6), DVec3::new(0.5, 0.5, 0.3), 0.09), 220.0),
                (rod(DVec3::new(0.5, -0.6, -0.4), DVec3::new(0.4, -0.5, 0.7), 0.11), 250.0),
                (plate, 120.0),
            ];
            let solid =
                parts.iter().map(|(d, v)| v * (0.5 - d / (2.0 * soft)).clamp(0.0, 1.0)).fold(0.0, f64::max);
            let haze = 40.0 * (1.0 - (p - DVec3::new(-0.4, -0.3, 0.2)).length_squared() / 0.15).max(0.0);
            solid.max(haze).round() as u8
        })
        .collect();
    Volume::with_spacing("creature", [n; 3], spacing_mm, Samples::U8(values)).expect("a valid volume")
}

/// Transfer function with opacities from thin haze to nearly solid.
pub(crate) fn transfer() -> TransferFunction {
    let point = |value, color, opacity| ControlPoint::new(value, color, opacity);
    TransferFunction {
        points: vec![
            point(8.0, [0.3, 0.3, 0.5], 0.0),
            point(60.0, [0.55, 0.35, 0.25], 0.04),
            point(110.0, [0.8, 0.5, 0.35], 0.3),
            point(170.0, [0.75, 0.75, 0.7], 0.5),
            point(250.0, [1.0, 0.9, 0.6], 0.8),
        ],
        interpolation: OpacityInterpolation::Opacity,
        ..TransferFunction::default()
    }
}

/// Look with one light and a rotated camera. Soft light has the requested resolution, however small the volume.
pub(crate) fn look() -> Settings {
    Settings {
        shadows: ShadowSettings { least_blocks: 1, ..ShadowSettings::default() },
        camera: Camera {
            azimuth_deg: 37.0,
            elevation_deg: 24.0,
            roll_deg: 8.0,
            distance: 4.4,
            ..Camera::default()
        },
        lights: vec![light(LightGeometry::Parallel, [1.3, -0.8, 1.7])],
        ..Settings::default()
    }
    .with_transfer(transfer())
    .with_opacity_unit(OpacityLength::Voxels(1.0))
}

/// White light that casts shadows.
pub(crate) fn light(kind: LightGeometry, position: [f64; 3]) -> LightSettings {
    LightSettings { kind, position, ..LightSettings::default() }
}

/// Homogeneous block: `inside` returns true for the full voxels.
pub(crate) fn block(n: usize, inside: impl Fn([usize; 3]) -> bool) -> Volume {
    let values =
        (0..n * n * n).map(|at| if inside([at % n, at / n % n, at / n / n]) { 255 } else { 0 }).collect();
    Volume::with_spacing("block", [n; 3], DVec3::ONE, Samples::U8(values)).expect("a valid volume")
}

/// Homogeneous ball with a soft edge one voxel wide.
pub(crate) fn ball(n: usize, centre: DVec3, radius: f64) -> Volume {
    let values = (0..n * n * n)
        .map(|at| {
            let p = DVec3::new((at % n) as f64, (at / n % n) as f64, (at / n / n) as f64);
            (255.0 * (radius - (p - centre).length() + 0.5).clamp(0.0, 1.0)).round() as u8
        })
        .collect();
    Volume::with_spacing("ball", [n; 3], DVec3::ONE, Samples::U8(values)).expect("a valid volume")
}

/// Transfer function with extinction proportional to density: `per_voxel` at full density.
pub(crate) fn linear_extinction(per_voxel: f64) -> TransferFunction {
    let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
    TransferFunction {
        points: vec![point(0.0, 0.0), point(255.0, 1.0 - (-per_voxel).exp())],
        interpolation: OpacityInterpolation::Extinction,
        ..TransferFunction::default()
    }
}

/// Cloud of blobs of all densities, reproducible by its seed.
pub(crate) fn noise(n: usize, seed: u64) -> Volume {
    let wave = |phase: u64, at: usize| (0.9 * at as f64 + (seed * phase) as f64).sin();
    let of = |[x, y, z]: [usize; 3]| wave(3, x) * wave(5, y) + wave(7, z) * wave(11, x + y) + wave(13, y + z);
    let values = (0..n * n * n)
        .map(|at| (255.0 * (0.5 + 0.4 * of([at % n, at / n % n, at / n / n])).clamp(0.0, 1.0)) as u8)
        .collect();
    Volume::with_spacing("noise", [n; 3], DVec3::ONE, Samples::U8(values)).expect("a valid volume")
}

/// Orthographic camera that looks along an axis of the volume from outside.
pub(crate) fn axis_camera(azimuth_deg: f64, elevation_deg: f64) -> Camera {
    Camera {
        projection: Projection::Orthographic,
        azimuth_deg,
        elevation_deg,
        distance: 4.0,
        ..Camera::default()
    }
}

/// Sets the light of first looks in earlier versions, a key and a fill light without sizes and no sky, and surfaces as
/// wide as in the data.
pub(crate) fn use_hard_light(settings: &mut Settings, volume: &Volume) {
    settings.lights = LightingRig::KeyAndFill.lights(&settings.camera);
    settings.sky.mode = SkyMode::Off;
    settings.layer_mut().transfer =
        first_look::transfer_for_kind(volume, &Histogram::from_volume(volume), None);
}

/// Sets the camera of first looks in earlier versions, and the key light 40° from the line of sight, as much to the
/// left as up.
pub(crate) fn use_earlier_first_look(settings: &mut Settings) {
    (settings.camera.azimuth_deg, settings.camera.elevation_deg) = (-60.0, 28.0);
    let side = 40f64.to_radians().sin() / std::f64::consts::SQRT_2;
    let place = DVec3::new(-side, side, 40f64.to_radians().cos());
    let distance = DVec3::from(settings.lights[0].position).length();
    settings.lights[0].position = (settings.camera.scene_from_view() * place * distance).into();
}

/// Sets the shadows of the paper: the light volume alone, back-projected with the kernel of the light pass.
pub(crate) fn use_paper_shadows(settings: &mut Settings) {
    settings.shading.sides = LitSides::Two;
    settings.shadows.reverse_kernel = ReverseKernel::Forward;
    settings.shadows.near_field = NearFieldRay::Off;
}

/// Sets a material that reflects light equally from all directions: no normals, no ambient light.
pub(crate) fn make_isotropic(settings: &mut Settings) {
    settings.shading.ambient = 0.0;
    settings.shading.diffuse = 1.0;
    settings.shading.specular = 0.0;
    // Above the largest gradient that a volume can have.
    settings.shading.surface_gradient = 10.0;
}
