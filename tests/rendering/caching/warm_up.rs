//! Tests of pipelines that are compiled ahead of time or by another thread.

use chiaroscuro_render::plan::RenderRequest;
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

#[test]
fn threads_share_the_pipelines_that_one_of_them_compiles() {
    let context = context();
    let dataset = Dataset::new(builtin("sphere", Some(24)).expect("the sphere"));
    let settings = first_look::first_settings(dataset.volume(), dataset.histogram());
    let draw = |shaders: &ShaderLibrary| {
        let mut renderer = Renderer::with_shaders(&context, shaders.clone()).expect("a renderer");
        let options = RenderOptions::default();
        renderer.render(&dataset, &settings, [64, 48], &options).expect("a picture").linear
    };
    let alone = ShaderLibrary::new(&context);
    let expected = draw(&alone);
    let shared = ShaderLibrary::new(&context);
    let pictures: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..3).map(|_| scope.spawn(|| draw(&shared))).collect();
        threads.into_iter().map(|thread| thread.join().expect("no panic")).collect()
    });
    assert!(pictures.iter().all(|picture| *picture == expected));
    assert_eq!(shared.pipeline_count(), alone.pipeline_count());
}

#[test]
fn a_picture_that_is_given_up_while_its_pipeline_is_compiled_harms_nothing() {
    let context = context();
    let dataset = Dataset::new(builtin("sphere", Some(24)).expect("the sphere"));
    let settings = first_look::first_settings(dataset.volume(), dataset.histogram());
    let mut renderer = Renderer::new(&context).expect("a renderer");
    let request = RenderRequest { volume: dataset.id(), settings, size: [64, 48], preview_resolution: None };
    drop(renderer.begin(&dataset, request.clone(), &RenderOptions::default()).expect("a job"));
    let mut job = renderer.begin(&dataset, request, &RenderOptions::default()).expect("a job");
    while job.step().expect("a step") {}
    assert!(job.is_done());
}
