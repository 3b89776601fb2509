//! Cuts by shapes one after another: what is kept between pictures changes none of them.

use chiaroscuro_render::RenderOptions;
use chiaroscuro_render::plan::RenderRequest;
use chiaroscuro_scene::{
    ClassificationOrder, CutAction, CutShape, Settings, ShapeCut, SphereCut, VolumeLayer,
};
use glam::DVec3;

use crate::common::{Dataset, new_renderer, render};
use crate::scenes;

const SIZE: [u32; 2] = [64, 56];

fn sphere(center: [f64; 3], radius: f64, action: CutAction) -> ShapeCut {
    ShapeCut { action, shape: CutShape::Sphere(SphereCut { center, radius }), ..ShapeCut::default() }
}

/// Lists of cuts, each of which changes another part of the volume.
fn steps() -> Vec<Vec<ShapeCut>> {
    let first = sphere([0.4, 0.1, 0.2], 0.3, CutAction::Hide);
    let second = sphere([-0.3, -0.2, -0.4], 0.35, CutAction::Hide);
    let moved = sphere([-0.3, -0.2, 0.1], 0.35, CutAction::Hide);
    let rest = sphere([0.0; 3], 0.5, CutAction::Keep);
    vec![
        vec![first.clone()],
        vec![first.clone(), second.clone()],
        vec![first, moved],
        vec![second, rest],
        Vec::new(),
    ]
}

fn check(dataset: &Dataset, settings: &Settings) {
    let mut renderer = new_renderer();
    let whole = render(&mut renderer, dataset, settings, SIZE).display;
    for (number, shapes) in steps().into_iter().enumerate() {
        let is_whole = shapes.is_empty();
        let mut settings = settings.clone();
        settings.cuts.shapes = shapes;
        let kept = render(&mut renderer, dataset, &settings, SIZE).display;
        let mut other = new_renderer();
        let fresh = render(&mut other, dataset, &settings, SIZE).display;
        assert!(kept == fresh, "step {number}");
        assert_eq!(kept == whole, is_whole, "step {number}");
        // A dataset that a picture has shown carries its mask, which the next picture replaces.
        let shown = other.dataset().expect("it was shown").clone();
        let mut third = new_renderer();
        let again = render(&mut third, &shown, &settings, SIZE).display;
        assert!(again == fresh, "step {number}, from what was shown");
    }
}

#[test]
fn a_series_of_cuts_shows_what_each_alone_shows() {
    let dataset = Dataset::new(scenes::creature(28, DVec3::new(1.0, 0.8, 1.3)));
    check(&dataset, &scenes::look());
    let mut classified = scenes::look();
    classified.sampling.classification = ClassificationOrder::Pre;
    check(&dataset, &classified);
    // Edits that come with a cut: another range of values, and layers.
    let mut layered = scenes::look();
    layered.layers.push(layered.layers.first().clone());
    let creature = scenes::creature(24, DVec3::ONE);
    check(&Dataset::from_volumes(creature.clone(), [creature]), &layered);
}

#[test]
fn a_picture_with_a_layer_that_is_never_cut_is_known_again() {
    let creature = scenes::creature(20, DVec3::ONE);
    let dataset = Dataset::from_volumes(creature.clone(), [creature]);
    let mut settings = scenes::look();
    settings.layers.push(VolumeLayer { ignores_cuts: true, ..settings.layers.first().clone() });
    settings.cuts.crop.on = true;
    settings.cuts.crop.high[2] = 0.5;
    let mut renderer = new_renderer();
    let options = RenderOptions::default();
    renderer.draw(&dataset, &settings, SIZE, &options).expect("a picture");
    let is_drawn = |settings: &Settings| {
        let settings = settings.clone();
        let request = RenderRequest { volume: dataset.id(), settings, size: SIZE, preview_resolution: None };
        renderer.is_drawn(&request, &options)
    };
    assert!(is_drawn(&settings), "nothing has changed");
    let mut other = settings.clone();
    other.output.background.top = [0.9; 3];
    assert!(is_drawn(&other), "the background is of the display");
    other.cuts.crop.high[2] = 0.6;
    assert!(!is_drawn(&other), "another cut");
}
