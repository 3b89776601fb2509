//! Volumes of other time steps beside the one that is shown: they stay with their light within a budget, and change no
//! picture.

use chiaroscuro_render::{RenderOptions, RenderStage, Renderer, plan::RenderRequest};
use chiaroscuro_scene::Settings;
use glam::DVec3;

use super::{SIZE, three_lights};
use crate::common::{Dataset, new_renderer, render};
use crate::scenes;

/// Memory for all steps of these tests, in bytes.
const ENOUGH: u64 = 1 << 28;

/// Three time steps of one object, with the look of the first.
fn steps() -> [Dataset; 3] {
    let first = Dataset::new(scenes::creature(32, DVec3::ONE));
    let step = |edge: usize| {
        let other = scenes::creature(32, DVec3::ONE).cropped(&[0..edge, 0..32, 0..32]).expect("a part");
        first.with_step(&other, Vec::new()).expect("a step")
    };
    [first.clone(), step(20), step(26)]
}

fn request(dataset: &Dataset, settings: &Settings) -> RenderRequest {
    RenderRequest { volume: dataset.id(), settings: settings.clone(), size: SIZE, preview_resolution: None }
}

fn is_prepared(renderer: &Renderer, dataset: &Dataset, settings: &Settings) -> bool {
    renderer.is_prepared(dataset, &request(dataset, settings), &RenderOptions::default())
}

/// Fills the light volumes of a step, without drawing it.
fn prepare(renderer: &mut Renderer, dataset: &Dataset, settings: &Settings) {
    let options = RenderOptions::default();
    let mut job = renderer.begin(dataset, request(dataset, settings), &options).expect("a job");
    while !matches!(job.stage(), None | Some(RenderStage::Eye | RenderStage::Display)) {
        job.step().expect("a step of the job");
    }
}

#[test]
fn steps_that_stay_are_drawn_without_filling_light_again() {
    let (steps, settings) = (steps(), three_lights());
    let fresh = steps.each_ref().map(|step| render(&mut new_renderer(), step, &settings, SIZE));
    assert!(fresh[0] != fresh[1] && fresh[1] != fresh[2], "the steps differ");
    let mut renderer = new_renderer();
    renderer.set_spare_volume_bytes(ENOUGH);
    for (step, fresh) in steps.iter().zip(&fresh) {
        assert!(!is_prepared(&renderer, step, &settings));
        assert_eq!(render(&mut renderer, step, &settings, SIZE), *fresh);
    }
    let filled = renderer.light_rebuilds().to_vec();
    assert_eq!(filled, [3, 3, 3]);
    for at in [0, 2, 1, 0] {
        assert!(is_prepared(&renderer, &steps[at], &settings));
        assert_eq!(render(&mut renderer, &steps[at], &settings, SIZE), fresh[at], "step {at}");
        assert_eq!(renderer.report().step_counts.volume, 0, "step {at} is uploaded again");
    }
    assert_eq!(renderer.light_rebuilds(), filled);
    // A light that has moved since is filled again, for the step that is shown.
    let mut moved = settings.clone();
    moved.lights[1].position = [-1.5, 1.7, 2.0];
    assert!(!is_prepared(&renderer, &steps[2], &moved));
    let picture = render(&mut renderer, &steps[2], &moved, SIZE);
    assert_eq!(picture, render(&mut new_renderer(), &steps[2], &moved, SIZE));
    assert_eq!(renderer.light_rebuilds(), [3, 4, 3]);
}

#[test]
fn a_step_is_prepared_beside_the_one_that_is_shown() {
    let (steps, settings) = (steps(), three_lights());
    let fresh = render(&mut new_renderer(), &steps[1], &settings, SIZE);
    let mut renderer = new_renderer();
    renderer.set_spare_volume_bytes(ENOUGH);
    let shown = render(&mut renderer, &steps[0], &settings, SIZE);
    prepare(&mut renderer, &steps[1], &settings);
    assert!(is_prepared(&renderer, &steps[1], &settings) && is_prepared(&renderer, &steps[0], &settings));
    assert_eq!(renderer.read_display().expect("the picture"), shown.display, "it stays on screen");
    let filled = renderer.light_rebuilds().to_vec();
    assert_eq!(render(&mut renderer, &steps[1], &settings, SIZE), fresh);
    assert_eq!(renderer.light_rebuilds(), filled, "its light was there");
}

#[test]
fn no_more_stays_than_the_budget_allows() {
    let (steps, settings) = (steps(), three_lights());
    let mut renderer = new_renderer();
    let alone = {
        render(&mut renderer, &steps[0], &settings, SIZE);
        renderer.gpu_bytes()
    };
    render(&mut renderer, &steps[1], &settings, SIZE);
    assert!(!is_prepared(&renderer, &steps[0], &settings), "nothing stays without a budget");
    assert!(renderer.gpu_bytes() <= alone + alone / 4, "{} of {alone}", renderer.gpu_bytes());
    renderer.set_spare_volume_bytes(ENOUGH);
    for step in &steps {
        render(&mut renderer, step, &settings, SIZE);
    }
    assert!(renderer.gpu_bytes() > alone, "volumes that stay count");
    renderer.set_spare_volume_bytes(0);
    assert!(!is_prepared(&renderer, &steps[0], &settings) && is_prepared(&renderer, &steps[2], &settings));
}
