//! Tests of the GPU in scenes with a closed-form solution.

use chiaroscuro::gpu::Renderer;
use chiaroscuro::model::{Engine, Length, LightKind, Settings};

use crate::common::context;
use crate::scenes::{self, isotropic, linear_extinction, paper, straight};

mod absorption;
mod all_light;
mod area_lights;
mod bounces;
mod brightness;
mod colored_shadows;
mod kernels;
mod labels;
mod lights;
mod path_tracer;
mod presence;
mod sky;

pub(crate) fn renderer() -> Renderer {
    Renderer::new(&context().with_full_precision()).expect("a renderer")
}

pub(crate) fn base(engine: Engine, per_voxel: f64) -> Settings {
    let mut settings = Settings {
        transfer: linear_extinction(per_voxel),
        opacity_unit: Length::Voxels(1.0),
        lights: vec![scenes::light(LightKind::Parallel, [0.0, 0.0, 1.0])],
        camera: straight(-90.0, 0.0),
        ..Settings::default()
    };
    isotropic(&mut settings);
    paper(&mut settings);
    settings.sampling.engine = engine;
    settings
}

/// Generates a test of each check for each of the two engines.
macro_rules! with_both_engines {
    ($($check:ident)+) => {
        mod gathered {
            $(#[test]
            fn $check() {
                super::$check(chiaroscuro::model::Engine::Gather);
            })+
        }
        mod scattered {
            $(#[test]
            fn $check() {
                super::$check(chiaroscuro::model::Engine::Scatter);
            })+
        }
    };
}

pub(crate) use with_both_engines;
