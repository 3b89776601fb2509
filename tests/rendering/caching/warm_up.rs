//! Test of the pipeline warm-up: the pipelines compiled ahead of time are those of the first picture.

use chiaroscuro_render::{RenderOptions, Renderer, ShaderLibrary};
use chiaroscuro_scene::{Settings, first_look};
use chiaroscuro_volume::{CancelToken, Dataset, synthetic::builtin};

use crate::common::context;

/// Number of pipelines that a picture compiles after the warm-up.
fn pipelines_after_warm_up(change: impl Fn(&mut Settings)) -> usize {
    let context = context();
    let shaders = ShaderLibrary::new(&context);
    shaders.warm_up(&CancelToken::new()).expect("the warm-up");
    let before = shaders.pipeline_count();
    assert!(before > 10, "the warm-up makes pipelines: {before}");
    let mut renderer = Renderer::with_shaders(&context, shaders.clone()).expect("a renderer");
    // With an empty border wider than a kernel, as most objects have: material at the faces of the grid needs other
    // pipelines.
    let dataset = Dataset::new(builtin("chair", Some(128)).expect("the chair"));
    let mut settings = first_look::first_settings(dataset.volume(), dataset.histogram());
    change(&mut settings);
    renderer.draw(&dataset, &settings, [400, 300], &RenderOptions::default()).expect("a picture");
    shaders.pipeline_count() - before
}

#[test]
fn the_first_picture_after_the_warm_up_compiles_nothing() {
    assert_eq!(pipelines_after_warm_up(|_| ()), 0);
}

#[test]
fn pipelines_without_warm_up_are_counted() {
    assert_eq!(pipelines_after_warm_up(|settings| settings.floor.on = true), 7, "the floor and its maps");
}
