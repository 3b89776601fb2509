//! Random volumes, transfer functions, cameras and lights, and a renderer for them.

use chiaroscuro_render::{GpuContext, RenderOptions, RenderedPicture, Renderer};
use chiaroscuro_scene::{
    ControlPoint, LightGeometry, LightSettings, Projection, QualityPreset, Settings, ShadowAlgorithm,
    SkyMode, first_look,
};
use chiaroscuro_volume::{Dataset, Samples, Volume};
use glam::{DAffine3, DMat3, DVec3};

use crate::random::Random;

pub(super) const SIZE: [u32; 2] = [32, 24];

/// Noise volume that is smooth enough to have surfaces, with a look.
pub(super) struct RandomScene {
    pub(super) dims: [usize; 3],
    pub(super) voxels: Vec<u8>,
    pub(super) settings: Settings,
}

pub(super) fn random_scene(seed: u64) -> RandomScene {
    let mut random = Random::new(seed);
    let dims = [(); 3].map(|()| 8 + random.below(10));
    let waves = [(); 6].map(|()| {
        let direction =
            DVec3::new(random_share(&mut random), random_share(&mut random), random_share(&mut random)) - 0.5;
        (direction * 2.0, random_share(&mut random) * std::f64::consts::TAU)
    });
    let value = |at: usize| {
        let place = [at % dims[0], at / dims[0] % dims[1], at / dims[0] / dims[1]].map(|n| n as f64);
        let sum: f64 = waves.iter().map(|(wave, phase)| (wave.dot(DVec3::from(place)) + phase).sin()).sum();
        (127.5 + 40.0 * sum).clamp(0.0, 255.0) as u8
    };
    let voxels: Vec<u8> = (0..dims.iter().product()).map(value).collect();
    let dataset = dataset(dims, Samples::U8(voxels.clone()), 1.0);
    let mut settings = first_look::first_settings(dataset.volume(), dataset.histogram());
    let quality = [QualityPreset::Fast, QualityPreset::Standard, QualityPreset::Fine][random.below(3)];
    quality.apply(&mut settings);
    settings.shadows.algorithm = [ShadowAlgorithm::Splat, ShadowAlgorithm::Raycast][random.below(2)];
    settings.shadows.first_touch = random.below(4) == 0;
    // Light that is clipped at 1 is not linear.
    (settings.shadows.gain, settings.shadows.balance) = (1.0, 1.0);
    (settings.shading.emission, settings.shading.ambient) = (0.0, 0.0);
    settings.sky.mode = SkyMode::Off;
    settings.camera.azimuth_deg = random_share(&mut random) * 360.0;
    settings.camera.elevation_deg = random_share(&mut random) * 180.0 - 90.0;
    settings.camera.projection = [Projection::Perspective, Projection::Orthographic][random.below(2)];
    settings.layer_mut().transfer.points = (0..3 + random.below(4))
        .map(|at| {
            let color = [(); 3].map(|()| random_share(&mut random) as f32);
            ControlPoint::new(
                at as f64 * 40.0 + random_share(&mut random) * 39.0,
                color,
                random_share(&mut random),
            )
        })
        .collect();
    settings.lights = (0..2)
        .map(|_| LightSettings {
            kind: [LightGeometry::Parallel, LightGeometry::Perspective][random.below(2)],
            position: [(); 3].map(|()| 6.0 * random_share(&mut random) - 3.0),
            color: [(); 3].map(|()| random_share(&mut random) as f32),
            intensity: 0.2 + random_share(&mut random),
            ..LightSettings::default()
        })
        .collect();
    settings.sanitise();
    RandomScene { dims, voxels, settings }
}

/// Random number from 0 to 1.
pub(super) fn random_share(random: &mut Random) -> f64 {
    random.below(1 << 20) as f64 / f64::from(1 << 20)
}

pub(super) fn dataset(dims: [usize; 3], samples: Samples, spacing_mm: f64) -> Dataset {
    dataset_with_affine(dims, samples, DAffine3::from_mat3(DMat3::from_diagonal(DVec3::splat(spacing_mm))))
}

/// Dataset of voxels with any index-to-world affine.
pub(super) fn dataset_with_affine(dims: [usize; 3], samples: Samples, world_from_index: DAffine3) -> Dataset {
    Dataset::new(Volume::new("noise", dims, world_from_index, samples).expect("a volume"))
}

/// Renderer that draws one scene after another.
pub(super) struct SceneRenderer(Renderer);

impl SceneRenderer {
    pub(super) fn open() -> Self {
        Self(Renderer::new(&GpuContext::headless().expect("an adapter")).expect("a renderer"))
    }

    pub(super) fn draw(&mut self, dataset: &Dataset, settings: &Settings) -> RenderedPicture {
        self.draw_as(dataset, settings, SIZE, &RenderOptions::default())
    }

    pub(super) fn draw_as(
        &mut self,
        dataset: &Dataset,
        settings: &Settings,
        size: [u32; 2],
        options: &RenderOptions,
    ) -> RenderedPicture {
        self.0.render(dataset, settings, size, options).expect("a picture")
    }
}

pub(super) fn largest_color(light: &[[f32; 4]]) -> f32 {
    light.iter().flatten().copied().fold(0.0, f32::max)
}

/// Largest difference between the colours of two pictures, as a share of the largest colour.
pub(super) fn relative_difference(left: &[[f32; 4]], right: &[[f32; 4]]) -> f32 {
    let apart = left.iter().zip(right).flat_map(|(a, b)| [0, 1, 2].map(|c| (a[c] - b[c]).abs()));
    apart.fold(0.0, f32::max) / largest_color(right).max(1e-6)
}
