//! Tests of the GPU in scenes with a closed-form solution.

use chiaroscuro_render::Renderer;
use chiaroscuro_scene::{LightGeometry, OpacityLength, RenderEngine, Settings};

use crate::common::full_precision_renderer;
use crate::scenes::{self, axis_camera, linear_extinction, make_isotropic, use_paper_shadows};

mod absorption;
mod all_light;
mod area_lights;
mod brightness;
mod colored_shadows;
mod kernels;
mod labels;
mod lights;
mod multiple_scattering;
mod outside_renderer;
mod path_tracer;
mod presence;
mod sky;
mod sky_on_surfaces;

pub(crate) fn renderer() -> Renderer {
    full_precision_renderer()
}

pub(crate) fn base(engine: RenderEngine, per_voxel: f64) -> Settings {
    let mut settings = Settings {
        lights: vec![scenes::light(LightGeometry::Parallel, [0.0, 0.0, 1.0])],
        camera: axis_camera(-90.0, 0.0),
        ..Settings::default()
    }
    .with_transfer(linear_extinction(per_voxel))
    .with_opacity_unit(OpacityLength::Voxels(1.0));
    make_isotropic(&mut settings);
    use_paper_shadows(&mut settings);
    settings.sampling.engine = engine;
    settings
}

/// Generates a test of each check for each of the two engines.
macro_rules! with_both_engines {
    ($($check:ident)+) => {
        mod gathered {
            $(#[test]
            fn $check() {
                super::$check(chiaroscuro_scene::RenderEngine::Gather);
            })+
        }
        mod scattered {
            $(#[test]
            fn $check() {
                super::$check(chiaroscuro_scene::RenderEngine::Scatter);
            })+
        }
    };
}

pub(crate) use with_both_engines;
