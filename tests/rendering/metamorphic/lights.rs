//! Lights in other terms: halves of a light, lights in another order, other colours, and limits of distance and size.

use chiaroscuro_scene::{LightGeometry, LightSettings, LightShape, LightVolumeResolution, Settings};
use glam::DVec3;

use super::random_scenes::random_scene;
use super::{
    DisplayPicture, EDGE, FEW_SEEDS, MANY_SEEDS, SceneVariant, TestScene, agree, check_prepared,
    check_relation, draw, new_renderer,
};
use crate::common::render;
use crate::thresholds::{EXPOSED, FAR_OR_TINY, SAME_LIGHT};

/// Distance of a perspective light that is as good as parallel, in scene units.
const FAR: f64 = 3000.0;

/// Angular width of a disc that is as good as a point, in degrees.
const TINY_DEG: f64 = 0.05;

impl TestScene {
    /// Changes the settings.
    pub(super) fn with(&self, change: impl FnOnce(&mut Settings)) -> Self {
        let mut changed = self.clone();
        change(&mut changed.settings);
        changed
    }
}

fn halve_lights(settings: &mut Settings) {
    for light in &mut settings.lights {
        light.intensity *= 0.5;
    }
    let others = settings.lights.clone();
    settings.lights.extend(others);
}

/// Exchanges red, green and blue cyclically in every colour.
fn exchange_colors(settings: &mut Settings) {
    let turn = |color: &mut [f32; 3]| color.rotate_left(1);
    settings.lights.iter_mut().for_each(|light| turn(&mut light.color));
    let sky = &mut settings.sky;
    [&mut sky.zenith, &mut sky.horizon, &mut sky.ground].into_iter().for_each(turn);
    settings.layer_mut().transfer.points.iter_mut().for_each(|point| turn(&mut point.color));
}

fn with_exchanged_colors(picture: &DisplayPicture) -> DisplayPicture {
    picture.iter().map(|&[r, g, b, a]| [g, b, r, a]).collect()
}

fn twice_as_bright(picture: &DisplayPicture) -> DisplayPicture {
    let brighter = |value: f64| {
        let c = value / 255.0;
        let linear = 2.0 * if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
        let linear = linear.min(1.0);
        255.0 * if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
    };
    picture.iter().map(|&[r, g, b, a]| [brighter(r), brighter(g), brighter(b), a]).collect()
}

fn double_light(settings: &mut Settings) {
    settings.lights.iter_mut().for_each(|light| light.intensity *= 2.0);
    settings.sky.intensity *= 2.0;
    // Flat ambient light, in the place of a sky.
    settings.shading.ambient *= 2.0;
}

fn same_lights(scene: &TestScene) -> Vec<SceneVariant> {
    let reversed = scene.with(|settings| settings.lights.reverse());
    vec![
        SceneVariant::same("each light as two halves", scene.with(halve_lights)),
        SceneVariant::same("lights in the other order", reversed),
        SceneVariant::same("other colours", scene.with(exchange_colors)).expecting(with_exchanged_colors),
        SceneVariant::same("twice the light", scene.with(double_light)).expecting(twice_as_bright),
    ]
}

/// Puts a parallel light at a finite distance.
fn far_lamp(light: &LightSettings) -> LightSettings {
    if light.kind == LightGeometry::Perspective {
        return light.clone();
    }
    let position = DVec3::from(light.position).normalize() * FAR;
    let size = 2.0 * FAR * (0.5 * light.angle_deg).to_radians().tan();
    LightSettings { kind: LightGeometry::Perspective, position: position.into(), size, ..light.clone() }
}

fn far_lamps(scene: &TestScene) -> Vec<SceneVariant> {
    let far = scene.with(|settings| settings.lights.iter_mut().for_each(|light| *light = far_lamp(light)));
    vec![SceneVariant::same("far lamps", far)]
}

/// Makes points of all lights, which then have volumes as fine as small discs have here.
fn use_points(settings: &mut Settings) {
    settings.shadows.area.resolution = LightVolumeResolution::Full;
    settings.shadows.area.samples = 4;
    settings.lights.iter_mut().for_each(|light| light.shape = LightShape::Point);
}

fn tiny_discs(scene: &TestScene) -> Vec<SceneVariant> {
    let tiny = |light: &mut LightSettings| {
        light.shape = LightShape::Disc;
        light.angle_deg = TINY_DEG;
        light.size = 2.0 * DVec3::from(light.position).length() * (0.5 * TINY_DEG).to_radians().tan();
    };
    vec![SceneVariant::same("tiny discs", scene.with(|settings| settings.lights.iter_mut().for_each(tiny)))]
}

#[test]
fn lights_in_other_terms_look_the_same() {
    check_relation(FEW_SEEDS, SAME_LIGHT, same_lights);
}

/// Exposure belongs to the displayed picture, in bytes.
#[test]
fn twice_the_exposure_is_twice_the_light() {
    let mut renderer = new_renderer();
    for seed in FEW_SEEDS {
        let mut scene = random_scene(seed);
        let background = &mut scene.settings.output.background;
        (background.top, background.bottom) = ([0.0; 3], [0.0; 3]);
        let expected = twice_as_bright(&draw(&mut renderer, &scene));
        scene.settings.output.exposure *= 2.0;
        let picture = render(&mut renderer, &scene.dataset(), &scene.settings, [EDGE; 2]);
        // Opacity is not displayed.
        let found: DisplayPicture = std::iter::zip(picture.display.chunks(4), &expected)
            .map(|(bytes, right)| [0, 1, 2, 3].map(|c| if c < 3 { f64::from(bytes[c]) } else { right[3] }))
            .collect();
        agree(&format!("{seed}: twice the exposure"), &found, &expected, EXPOSED).expect("twice as bright");
    }
}

#[test]
fn far_lamps_and_tiny_discs_are_parallel_lights_and_points() {
    check_relation(FEW_SEEDS, FAR_OR_TINY, far_lamps);
    check_prepared(FEW_SEEDS, FAR_OR_TINY, use_points, tiny_discs);
}

#[test]
#[ignore = "long: twenty scenes more; script/test --all runs it"]
fn many_lights_in_other_terms_look_the_same() {
    check_relation(MANY_SEEDS, SAME_LIGHT, same_lights);
    check_relation(MANY_SEEDS, FAR_OR_TINY, far_lamps);
    check_prepared(MANY_SEEDS, FAR_OR_TINY, use_points, tiny_discs);
}
