//! Random scenes: volumes of soft and hard shapes, lights, skies and cuts, reproducible by a seed.

use chiaroscuro_scene::{
    Camera, ClipEffect, CropBox, DensityRange, FloorSettings, LightGeometry, LightSettings, LightShape,
    LightVolumeResolution, OutputSettings, Projection, QualityPreset, ScatteringSettings, Settings, SkyMode,
    SkySettings, ToneMap,
};
use chiaroscuro_volume::ValueRange;
use glam::DVec3;

use super::TestScene;
use crate::scenes;

/// Numbers of a seed, by the generator `SplitMix64`.
struct SeededNumbers(u64);

impl SeededNumbers {
    fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x2026_1127)
    }

    /// Returns the next number, 0 … 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn chance(&mut self, share: f64) -> bool {
        self.next() < share
    }

    fn color(&mut self) -> [f32; 3] {
        [(); 3].map(|()| self.between(0.4, 1.0) as f32)
    }

    fn direction(&mut self) -> DVec3 {
        let (height, turn) = (self.between(-0.3, 1.0), self.between(0.0, std::f64::consts::TAU));
        let across = (1.0 - height * height).sqrt();
        DVec3::new(across * turn.cos(), across * turn.sin(), height)
    }
}

/// Empty voxels around the shapes, on every side.
pub(super) const EMPTY_MARGIN: usize = 4;

/// Returns the scene of a seed.
///
/// Dimensions are multiples of four, so that blocks of a volume at a quarter of the resolution lie alike in the
/// mirrored one.
pub(super) fn random_scene(seed: u64) -> TestScene {
    let mut numbers = SeededNumbers::new(seed);
    let dims = [(); 3].map(|()| 4 * numbers.between(7.0, 10.0) as usize);
    let spacing = match seed % 3 {
        0 => DVec3::ONE,
        1 => DVec3::new(1.0, 1.0, 1.6),
        _ => DVec3::new(1.2, 0.8, 1.0),
    };
    let values = shapes(&mut numbers, dims);
    let settings = random_look(&mut numbers, seed);
    TestScene { dims, spacing, values, settings }
}

/// Returns voxels with balls, shells and rods of random sizes, hard and soft, in empty space.
fn shapes(numbers: &mut SeededNumbers, dims: [usize; 3]) -> Vec<u8> {
    let size = DVec3::from(dims.map(|n| n as f64));
    let smallest = size.min_element();
    let inner = smallest / 2.0 - EMPTY_MARGIN as f64 - 1.0;
    let mut place = || {
        let at =
            DVec3::new(numbers.between(-1.0, 1.0), numbers.between(-1.0, 1.0), numbers.between(-1.0, 1.0));
        let more = [numbers.between(0.15, 0.4), numbers.between(0.5, 3.0), numbers.between(70.0, 255.0)];
        (at, more)
    };
    let places: Vec<_> = (0..7).map(|_| place()).collect();
    let value_at = |p: DVec3| {
        let mut value = 0.0_f64;
        for (index, pair) in places.windows(2).enumerate() {
            let [(a, [radius, softness, full]), (b, _)] = pair else { continue };
            let (radius, a, b) = (radius * inner, *a * inner * 0.6, *b * inner * 0.6);
            let along = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            let away = match index % 3 {
                0 => (p - a).length() - radius,
                1 => ((p - a).length() - radius).abs() - 1.5,
                _ => (p - a - (b - a) * along).length() - 0.35 * radius,
            };
            value = value.max(full * (0.5 - away / softness).clamp(0.0, 1.0));
        }
        // A plate below, for shadows.
        let plate = (p.z + 0.8 * inner).abs().max(p.x.abs() - inner + 1.5).max(p.y.abs() - inner + 1.5) - 1.0;
        value.max(180.0 * (0.5 - plate).clamp(0.0, 1.0))
    };
    let [nx, ny, nz] = dims;
    let mut values = Vec::with_capacity(nx * ny * nz);
    for z in 0..nz {
        for y in 0..ny {
            for x in 0..nx {
                let at = [x, y, z];
                let margin = |axis: usize| at[axis].min(dims[axis] - 1 - at[axis]);
                let is_empty = (0..3).any(|axis| margin(axis) < EMPTY_MARGIN);
                let p = DVec3::from(at.map(|c| c as f64)) - (size - 1.0) / 2.0;
                values.push(if is_empty { 0 } else { value_at(p).round() as u8 });
            }
        }
    }
    values
}

fn random_look(numbers: &mut SeededNumbers, seed: u64) -> Settings {
    let mut settings = scenes::look().with_range(DensityRange::Typed(ValueRange { low: 0.0, high: 255.0 }));
    let quality = if seed % 4 == 3 { QualityPreset::Fast } else { QualityPreset::Standard };
    quality.apply(&mut settings);
    let is_orthographic = seed % 2 == 1;
    settings.camera = Camera {
        projection: if is_orthographic { Projection::Orthographic } else { Projection::Perspective },
        azimuth_deg: numbers.between(-180.0, 180.0),
        elevation_deg: numbers.between(5.0, 60.0),
        roll_deg: numbers.between(-20.0, 20.0),
        target: [(); 3].map(|()| numbers.between(-0.1, 0.1)),
        distance: numbers.between(4.0, 6.0),
        ..Camera::default()
    };
    let count = 1 + usize::from(numbers.chance(0.5));
    settings.lights = (0..count).map(|index| random_light(numbers, seed as usize + index)).collect();
    settings.sky = random_sky(numbers, seed);
    if seed % 3 == 1 {
        settings.scattering = ScatteringSettings { bounces: 2, albedo: 0.8, ..settings.scattering };
    }
    if seed % 3 == 2 {
        settings.shadows.transmission = 0.7;
    }
    if numbers.chance(0.5) {
        let shadows = &mut settings.shadows;
        (shadows.strength, shadows.gain, shadows.ambient_offset) = (0.9, 1.2, 0.05);
    }
    if seed % 5 == 1 {
        settings.cuts.crop =
            CropBox { on: true, low: [0.0, 0.25, 0.0], high: [1.0, 1.0, 0.7], effect: ClipEffect::Removed };
    }
    settings.floor = FloorSettings { on: false, ..settings.floor };
    settings.output = OutputSettings { tone_map: ToneMap::Clip, ..settings.output };
    settings.shadows.area.samples = 16;
    settings
}

fn random_light(numbers: &mut SeededNumbers, index: usize) -> LightSettings {
    let is_far = index.is_multiple_of(2);
    let shape = [LightShape::Disc, LightShape::Point, LightShape::Rectangle, LightShape::Ball]
        [(index + index / 4) % 4];
    let distance = if is_far { 2.0 } else { numbers.between(5.0, 7.0) };
    LightSettings {
        kind: if is_far { LightGeometry::Parallel } else { LightGeometry::Perspective },
        position: (numbers.direction() * distance).into(),
        color: numbers.color(),
        intensity: numbers.between(0.5, 0.9),
        shape,
        size: numbers.between(1.0, 2.0),
        angle_deg: numbers.between(10.0, 30.0),
        aspect: 1.5,
        turn_deg: numbers.between(0.0, 40.0),
        ..LightSettings::default()
    }
}

fn random_sky(numbers: &mut SeededNumbers, seed: u64) -> SkySettings {
    SkySettings {
        mode: [SkyMode::Gradient, SkyMode::Off, SkyMode::White][seed as usize % 3],
        intensity: numbers.between(0.2, 0.4),
        zenith: numbers.color(),
        horizon: numbers.color(),
        ground: numbers.color(),
        tilt_deg: numbers.between(0.0, 60.0),
        turn_deg: numbers.between(-180.0, 180.0),
        directions: 48,
        resolution: LightVolumeResolution::Half,
        ..SkySettings::default()
    }
}
