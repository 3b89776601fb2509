//! Deliberate mistakes, each of which a relation has to notice.

use glam::DVec3;

use super::random_scenes::random_scene;
use super::{TestScene, agree, draw, new_renderer};
use crate::thresholds::{
    CROPPED, DisplayLimit, FAR_OR_TINY, PADDED, REVALUED, SAME_LIGHT, SHIFTED, SYMMETRIC,
};

/// Moves the first light across its direction by a number of voxels, seen from the middle.
fn move_light(scene: &TestScene, voxels: f64) -> TestScene {
    let voxel = voxels * scene.spacing.min_element() / scene.mm_per_unit();
    scene.with(|settings| {
        let light = &mut settings.lights[0];
        let place = DVec3::from(light.position);
        light.position = (place + place.any_orthonormal_vector() * voxel * place.length()).into();
    })
}

/// Moves everything but the voxels by half a slab along the line of sight and across it.
fn shift_by_half_a_slab(scene: &TestScene) -> TestScene {
    let half = 0.5 * scene.spacing.min_element() / scene.mm_per_unit();
    scene.with(|settings| {
        let view = settings.camera.scene_from_view();
        let target = DVec3::from(settings.camera.target) + (view.z_axis + view.x_axis) * half;
        settings.camera.target = target.into();
    })
}

#[test]
fn deliberate_mistakes_are_noticed() {
    let mut renderer = new_renderer();
    let scene = random_scene(0);
    let right = draw(&mut renderer, &scene);
    assert!(agree("the same", &draw(&mut renderer, &scene), &right, SAME_LIGHT).is_ok());
    let moved = draw(&mut renderer, &move_light(&scene, 1.0));
    let far_moved = draw(&mut renderer, &move_light(&scene, 8.0));
    let shifted = draw(&mut renderer, &shift_by_half_a_slab(&scene));
    let notices = |what: &str, found: &[[f64; 4]], limit: DisplayLimit| {
        assert!(agree(what, found, &right, limit).is_err(), "{what} is not noticed within {limit:?}");
    };
    for limit in [SYMMETRIC, REVALUED, SAME_LIGHT, FAR_OR_TINY] {
        notices("a light moved by half a block", &moved, limit);
        notices("half a slab aside", &shifted, limit);
    }
    // Relations that move slabs and blocks against the data allow for as much as that.
    for limit in [PADDED, CROPPED, SHIFTED] {
        notices("a light moved by four blocks", &far_moved, limit);
        notices("half a slab aside", &shifted, limit);
    }
    // Lights that are not mirrored with the volume.
    let forgotten = draw(&mut renderer, &scene.mirrored(1, false));
    let forgotten: Vec<_> =
        forgotten.chunks(super::EDGE as usize).flat_map(|row| row.iter().rev().copied()).collect();
    notices("one mirrored axis forgotten", &forgotten, SYMMETRIC);
    let dimmer = scene.with(|settings| settings.lights[0].intensity *= 0.99);
    notices("a light 1 % dimmer", &draw(&mut renderer, &dimmer), SAME_LIGHT);
}
