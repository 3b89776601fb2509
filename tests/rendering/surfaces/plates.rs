//! Oblique plates in parallel light: brightness, and grain, which is what changes with the place where a surface cuts
//! slabs and voxels.
//!
//! A flat plate of binary voxels has a closed form: with the angles v and l of view and light to its normal, matter
//! at the optical depth t of the eye has the depth t cos v / cos l of the light, so that the plate has the brightness
//! ambient + cos l / (1 + cos v / cos l), whatever its curve. Tilted plates have an oracle.

use chiaroscuro_render::{Renderer, plan::picture_frame};
use chiaroscuro_scene::{
    ControlPoint, DensityRange, LightGeometry, OpacityLength, Projection, QualityPreset, SceneAxis, Settings,
    TransferFunction,
};
use chiaroscuro_volume::{Dataset, Samples, Volume};
use glam::DVec3;

use super::plate_oracle::PlateOracle;
use crate::common::{damaged_renderer, new_renderer, render};
use crate::scenes::{self, axis_camera};
use crate::thresholds::{FLAT_EXACT, FLAT_STANDARD, PLATE_FINE, TILTED_EXACT, TILTED_STANDARD};

/// Size of pictures: a pixel is half a voxel wide.
const SIZE: [usize; 2] = [160, 80];

/// Part of the picture that is looked at, in pixels along x and y: rims of the plate are far away.
const WINDOW: [std::ops::Range<usize>; 2] = [55..105, 36..44];

/// Number of voxels of a plate along x and y.
const WIDTH: usize = 72;
const DEPTH: usize = 32;

/// Angle of the light to the normal of a plate.
const LIGHT_DEG: f64 = 40.0;

/// Ambient light.
const AMBIENT: f64 = 0.1;

/// Curve of a plate: control points of value and opacity, per length in voxels.
struct PlateCurve {
    name: &'static str,
    length: f64,
    points: &'static [[f64; 2]],
}

/// Curve of an isosurface, which is opaque within a fraction of a voxel, and a typical one.
const CURVES: [PlateCurve; 2] = [
    PlateCurve {
        name: "hard",
        length: 0.5,
        points: &[[0.0, 0.0], [99.45, 0.0], [155.55, 0.99], [255.0, 0.99]],
    },
    PlateCurve {
        name: "typical",
        length: 1.0,
        points: &[[0.0, 0.0], [80.0, 0.0], [130.0, 0.6], [200.0, 0.95], [255.0, 0.95]],
    },
];

impl PlateCurve {
    fn transfer(&self) -> TransferFunction {
        let points = self.points.iter().map(|&[value, opacity]| ControlPoint::new(value, [1.0; 3], opacity));
        TransferFunction { points: points.collect(), ..TransferFunction::default() }
    }

    /// Extinction per voxel of a density from 0 to 1.
    fn extinction(&self, density: f64) -> f64 {
        let value = (255.0 * density).clamp(0.0, 255.0);
        let next = self.points.iter().position(|point| point[0] >= value).unwrap_or(self.points.len() - 1);
        let [a, b] = [self.points[next.max(1) - 1], self.points[next.max(1)]];
        let opacity = a[1] + (b[1] - a[1]) * (value - a[0]) / (b[0] - a[0]);
        -(1.0 - opacity).ln() / self.length
    }
}

/// Voxels of a plate whose normal is tilted by an angle from z towards −x, 8 bits each: shares of them below the
/// surface, or binary if it is flat.
fn plate_voxels(tilt_deg: f64) -> (usize, Vec<u8>) {
    let (slope, cos) = (tilt_deg.to_radians().tan(), tilt_deg.to_radians().cos());
    let height = ((slope * WIDTH as f64) as usize + 24).max(24);
    let surface = |x: usize| height as f64 / 2.0 + 0.3 + (x as f64 - (WIDTH as f64 - 1.0) / 2.0) * slope;
    let value = |x: usize, z: usize| {
        if tilt_deg == 0.0 {
            return if z < 14 { 255 } else { 0 };
        }
        (255.0 * ((surface(x) - z as f64) * cos + 0.5).clamp(0.0, 1.0)).round() as u8
    };
    let voxels = (0..WIDTH * DEPTH * height).map(|at| value(at % WIDTH, at / (WIDTH * DEPTH))).collect();
    (height, voxels)
}

/// Plate with its curve and the angle of the view to z.
struct PlateScene<'a> {
    tilt_deg: f64,
    view_deg: f64,
    curve: &'a PlateCurve,
}

impl PlateScene<'_> {
    fn name(&self) -> String {
        let Self { tilt_deg, view_deg, curve } = self;
        format!("plate of {tilt_deg}° from {view_deg}°, {}", curve.name)
    }

    /// Unit vector towards the light, in x and z.
    fn to_light(&self) -> [f64; 2] {
        (LIGHT_DEG - self.tilt_deg).to_radians().sin_cos().into()
    }

    fn dataset(&self) -> Dataset {
        let (height, voxels) = plate_voxels(self.tilt_deg);
        let dims = [WIDTH, DEPTH, height];
        Dataset::new(Volume::with_spacing("plate", dims, DVec3::ONE, Samples::U8(voxels)).expect("a volume"))
    }

    fn settings(&self, quality: QualityPreset) -> Settings {
        let [x, z] = self.to_light();
        let light = scenes::light(LightGeometry::Parallel, [x, 0.0, z]);
        let mut settings = Settings { lights: vec![light], ..scenes::look() }
            .with_transfer(self.curve.transfer())
            .with_opacity_unit(OpacityLength::Voxels(self.curve.length))
            .with_range(DensityRange::Full);
        quality.apply(&mut settings);
        // The azimuth turns the picture of a flat plate, so that slabs are cut along both of its axes.
        settings.camera = axis_camera(if self.view_deg == 0.0 { -90.0 } else { 20.0 }, 90.0 - self.view_deg);
        settings.camera.up = SceneAxis::PlusZ;
        settings.camera.projection = Projection::Orthographic;
        settings.camera.fov_y_deg = 7.0;
        settings.shadows.keep_balanced = false;
        settings.shadows.balance = 1.0;
        let shading = &mut settings.shading;
        (shading.ambient, shading.diffuse, shading.specular) = (AMBIENT, 1.0, 0.0);
        settings
    }

    /// Brightness over opacity in the window of a picture, by rows.
    fn pictured(&self, renderer: &mut Renderer, quality: QualityPreset) -> Vec<f64> {
        let picture = render(renderer, &self.dataset(), &self.settings(quality), SIZE.map(|n| n as u32));
        let [columns, rows] = WINDOW;
        let pixels = rows.flat_map(|y| columns.clone().map(move |x| y * SIZE[0] + x));
        let brightness = |texel: [f32; 4]| {
            assert!(texel[3] > 0.99, "the plate fills the window");
            f64::from(texel[1] / texel[3])
        };
        pixels.map(|at| brightness(picture.linear[at])).collect()
    }

    /// True brightness of the window's pixels.
    fn expected(&self) -> Vec<f64> {
        let [columns, rows] = WINDOW;
        if self.tilt_deg == 0.0 {
            let [view, light] = [self.view_deg, LIGHT_DEG].map(|angle| angle.to_radians().cos());
            return vec![AMBIENT + light / (1.0 + view / light); columns.len() * rows.len()];
        }
        let (height, voxels) = plate_voxels(self.tilt_deg);
        let slice = |k: usize| &voxels[k * WIDTH * DEPTH..k * WIDTH * DEPTH + WIDTH];
        let oracle = PlateOracle {
            size: [WIDTH, height],
            densities: (0..height).flat_map(slice).map(|&value| f64::from(value) / 255.0).collect(),
            extinction: &|density| self.curve.extinction(density),
            to_light: self.to_light(),
            ambient: AMBIENT,
        };
        let frame = picture_frame(
            &self.settings(QualityPreset::Exact),
            &self.dataset().volume().scene(),
            SIZE.map(|n| n as u32),
        );
        let row: Vec<f64> = columns
            .map(|x| {
                let from = frame.point(x as f64, SIZE[1] as f64 / 2.0, frame.first_depth);
                // Starts above the grid, so that the ray is vertical and as long as the grid is high.
                oracle.ray([from.x, height as f64 + 1.0], [0.0, -1.0], height as f64 + 2.0)[0]
            })
            .collect();
        row.iter().copied().cycle().take(row.len() * rows.len()).collect()
    }
}

/// Difference of a window from the truth, relative to its mean: of the mean, root mean square of the rest, and peak
/// to peak of the rest.
fn deviation(found: &[f64], expected: &[f64]) -> [f64; 3] {
    let mean = expected.iter().sum::<f64>() / expected.len() as f64;
    let off: Vec<f64> = found.iter().zip(expected).map(|(a, b)| (a - b) / mean).collect();
    let level = off.iter().sum::<f64>() / off.len() as f64;
    let squares: f64 = off.iter().map(|d| (d - level).powi(2)).sum();
    let [least, most] =
        [off.iter().copied().fold(f64::MAX, f64::min), off.iter().copied().fold(f64::MIN, f64::max)];
    [level.abs(), (squares / off.len() as f64).sqrt(), most - least]
}

fn exceeds(found: [f64; 3], limits: [f64; 3]) -> bool {
    found.iter().zip(limits).any(|(found, limit)| *found > limit)
}

/// Flat plates from oblique views, and tilted ones from above.
fn for_all_plates(mut check: impl FnMut(&PlateScene<'_>)) {
    for curve in &CURVES {
        for view_deg in [4.3, 30.0] {
            check(&PlateScene { tilt_deg: 0.0, view_deg, curve });
        }
        for tilt_deg in [4.3, 20.0] {
            check(&PlateScene { tilt_deg, view_deg: 0.0, curve });
        }
    }
}

#[test]
fn plates_have_no_grain_and_the_right_level() {
    let mut renderer = new_renderer();
    let mut failures = Vec::new();
    for_all_plates(|scene| {
        let expected = scene.expected();
        let is_flat = scene.tilt_deg == 0.0;
        let levels = [
            (QualityPreset::Standard, if is_flat { FLAT_STANDARD } else { TILTED_STANDARD }),
            (QualityPreset::Fine, PLATE_FINE),
            (QualityPreset::Exact, if is_flat { FLAT_EXACT } else { TILTED_EXACT }),
        ];
        for (quality, limit) in levels {
            let found = deviation(&scene.pictured(&mut renderer, quality), &expected);
            let [level, rms, peak_to_peak] = found;
            println!(
                "{}, {quality:?}: level {level:.4}, rms {rms:.4}, peak to peak {peak_to_peak:.4}",
                scene.name()
            );
            if exceeds(found, limit) {
                failures.push(format!("{}, {quality:?}: {found:?} exceeds {limit:?}", scene.name()));
            }
        }
    });
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// The oracle agrees with the closed form where there is one.
#[test]
fn oracle_of_plates_agrees_with_the_closed_form() {
    for curve in &CURVES {
        let scene = PlateScene { tilt_deg: 0.0, view_deg: 0.0, curve };
        let (height, voxels) = plate_voxels(0.0);
        let oracle = PlateOracle {
            size: [WIDTH, height],
            densities: (0..height)
                .flat_map(|k| &voxels[k * WIDTH * DEPTH..k * WIDTH * DEPTH + WIDTH])
                .map(|&value| f64::from(value) / 255.0)
                .collect(),
            extinction: &|density| curve.extinction(density),
            to_light: scene.to_light(),
            ambient: AMBIENT,
        };
        let [found, _] = oracle.ray([36.2, height as f64 + 1.0], [0.0, -1.0], height as f64);
        let expected = scene.expected()[0];
        assert!((found / expected - 1.0).abs() < 1e-3, "{}: {found} and {expected}", curve.name);
    }
}

/// Light of one end of a segment for all of it, and extinction of the middle between two faces, are noticed.
#[test]
fn grain_is_noticed() {
    let mistakes = [
        ("return near * mean * depth_per_opacity;", "return far;"),
        (
            "return select((b.integral - a.integral) / select(distance, 1.0, is_near), 0.5 * (a.mean + b.mean), is_near);",
            "return extinction_of(Field(0.5 * (a.position + b.position) / f32(TABLE_SIZE - 1u)));",
        ),
    ];
    let scene = PlateScene { tilt_deg: 0.0, view_deg: 4.3, curve: &CURVES[0] };
    let expected = scene.expected();
    for (from, to) in mistakes {
        let found =
            deviation(&scene.pictured(&mut damaged_renderer(from, to), QualityPreset::Standard), &expected);
        println!("{to}: {found:?}");
        assert!(exceeds(found, FLAT_STANDARD), "{to}: {found:?}");
    }
}
