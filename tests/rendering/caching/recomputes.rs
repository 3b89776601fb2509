//! Cost of changes, counted by the renderer: every setting recomputes only the products that depend on it.

use chiaroscuro_render::{
    GpuContext, PictureOptions, RenderOptions, Renderer, ShaderLibrary, StepCounts, WorkOptions,
};
use chiaroscuro_scene::{
    ControlPoint, LightGeometry, LightSettings, Settings, ShadowSettings, SkyMode, TransferFunction,
    apply_path,
};
use chiaroscuro_volume::Dataset;
use glam::DVec3;

use crate::common::{context, new_renderer};
use crate::scenes;

const SIZE: [u32; 2] = [24, 18];

/// Expected cost of a change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RecomputeCost {
    Nothing,
    Display,
    /// The floor, and the display pass.
    Floor,
    /// The picture, but no light volume.
    Eye,
    /// Sky visibility, and the picture.
    Sky,
    /// Scattered light, and the picture.
    Bounces,
    /// A number of light volumes, and the picture.
    Lights(u32),
    /// Everything, from the upload of the volume on.
    Volume,
}

fn recompute_cost(runs: StepCounts) -> RecomputeCost {
    match runs {
        StepCounts { volume: 1.., tables: 2, light_volumes: 3, eye: 1.., .. } => RecomputeCost::Volume,
        StepCounts { volume: 1.., .. } => panic!("the volume is there: {runs:?}"),
        StepCounts { light_volumes, eye: 1.., .. } if light_volumes > 0 => {
            RecomputeCost::Lights(light_volumes)
        }
        StepCounts { light_volumes: 0, sky: 1, eye: 1.., .. } => RecomputeCost::Sky,
        StepCounts { light_volumes: 0, sky: 0, bounces: 1, eye: 1.., .. } => RecomputeCost::Bounces,
        StepCounts { light_volumes: 0, sky: 0, bounces: 0, eye: 1.., .. } => RecomputeCost::Eye,
        StepCounts { light_volumes: 0, eye: 0, floor: 1.., display: 1, .. } => RecomputeCost::Floor,
        StepCounts { light_volumes: 0, eye: 0, floor: 0, display: 1, tables: 0, .. } => {
            RecomputeCost::Display
        }
        runs if runs == StepCounts::default() => RecomputeCost::Nothing,
        runs => panic!("work that shows nowhere: {runs:?}"),
    }
}

/// Look with three lights that cast shadows, one of them near.
fn base_settings() -> Settings {
    let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
    Settings {
        lights: vec![
            LightSettings::default(),
            LightSettings { position: [0.0, 3.0, 0.0], ..LightSettings::default() },
            LightSettings { kind: LightGeometry::Perspective, ..LightSettings::default() },
        ],
        // At the requested resolution, however small the volume.
        shadows: ShadowSettings { least_blocks: 1, ..ShadowSettings::default() },
        ..Settings::default()
    }
    .with_transfer(TransferFunction { points: vec![point(0.1, 0.0), point(1.0, 0.5)], ..Default::default() })
}

/// Renderer of two looks in sequence, which counts the passes of the second.
struct RecomputeCounter {
    context: GpuContext,
    shaders: ShaderLibrary,
    dataset: Dataset,
}

impl RecomputeCounter {
    fn new() -> Self {
        let context = context();
        let shaders = ShaderLibrary::new(&context);
        Self { context, shaders, dataset: Dataset::new(scenes::creature(12, DVec3::ONE)) }
    }

    /// Passes that the second look runs after the first, with given options.
    fn runs(&self, first: &Settings, second: &Settings, options: &RenderOptions) -> StepCounts {
        let mut renderer = Renderer::with_shaders(&self.context, self.shaders.clone()).expect("a renderer");
        let usual = RenderOptions::default();
        renderer.draw(&self.dataset, first, SIZE, &usual).expect("the first picture");
        renderer.draw(&self.dataset, second, SIZE, options).expect("the second picture");
        renderer.report().step_counts
    }

    fn cost_of(&self, path: &str, value: &str) -> RecomputeCost {
        let changed = apply_path(&base_settings(), path, value).expect("a setting");
        recompute_cost(self.runs(&base_settings(), &changed, &RenderOptions::default()))
    }
}

/// Rows for the settings that users change most; `crates/render/src/plan/keys/tests/` checks that every setting is classified.
#[test]
fn every_setting_costs_what_it_should() {
    let table = [
        ("camera.azimuth_deg", "10", RecomputeCost::Eye),
        ("camera.target", "[0.1,0,0]", RecomputeCost::Eye),
        ("camera.fov_y_deg", "40", RecomputeCost::Eye),
        ("camera.fit", "frame", RecomputeCost::Eye),
        ("camera.projection", "orthographic", RecomputeCost::Eye),
        ("lights.1.name", "Fill", RecomputeCost::Nothing),
        ("lights.1.color", "[1,0,0]", RecomputeCost::Eye),
        ("lights.1.intensity", "2", RecomputeCost::Eye),
        ("lights.1.on", "false", RecomputeCost::Eye),
        ("lights.1.casts_shadows", "false", RecomputeCost::Eye),
        ("lights.1.position", "[0,6,0]", RecomputeCost::Nothing),
        ("lights.1.position", "[0,6,1]", RecomputeCost::Lights(1)),
        ("lights.2.position", "[4,-4,5]", RecomputeCost::Lights(1)),
        ("lights.1.kind", "perspective", RecomputeCost::Lights(1)),
        ("lights.1.lock", "camera", RecomputeCost::Lights(1)),
        ("lights.1.hood", r#"{"on": true}"#, RecomputeCost::Nothing),
        ("lights.2.hood", r#"{"on": true}"#, RecomputeCost::Lights(1)),
        ("lights.1.density_scale", "0.5", RecomputeCost::Lights(1)),
        ("range", r#"{"typed": [0, 2]}"#, RecomputeCost::Volume),
        ("transfer.points.0.color", "[1,0,0]", RecomputeCost::Eye),
        ("transfer.points.1.opacity", "0.4", RecomputeCost::Lights(3)),
        ("lighting.scale", "0.5", RecomputeCost::Lights(3)),
        ("lighting.curve.mixing", "seen", RecomputeCost::Nothing),
        ("opacity_unit", r#"{"mm": 3}"#, RecomputeCost::Lights(3)),
        ("shading.diffuse", "0.1", RecomputeCost::Eye),
        ("shadows.algorithm", "off", RecomputeCost::Eye),
        ("shadows.algorithm", "direct", RecomputeCost::Eye),
        ("shadows.algorithm", "raycast", RecomputeCost::Lights(3)),
        ("shadows.strength", "0.5", RecomputeCost::Eye),
        ("shadows.gain", "2", RecomputeCost::Eye),
        // Near-field rays replace it (without them: `a_light_bias_fills_more_once_and_is_live_from_then_on`).
        ("shadows.bias_voxels", "1", RecomputeCost::Nothing),
        // Light volumes are filled where they are looked up: at the end of near-field rays.
        ("shadows.near_field", "off", RecomputeCost::Lights(3)),
        // Such a small volume is filled to its border, beyond which longer rays find nothing else.
        ("shadows.near_field", "long", RecomputeCost::Eye),
        ("shadows.reverse_kernel", "forward", RecomputeCost::Lights(3)),
        ("shading.sides", "two", RecomputeCost::Eye),
        ("shadows.balance", "1.5", RecomputeCost::Eye),
        ("shadows.transmission", "0.5", RecomputeCost::Lights(3)),
        ("shadows.keep_balanced", "true", RecomputeCost::Nothing),
        ("shadows.first_touch", "true", RecomputeCost::Lights(3)),
        ("shadows.kernel", "prefiltered", RecomputeCost::Lights(3)),
        ("shadows.resolution", "half", RecomputeCost::Lights(3)),
        // Combined light is not looked up ahead of samples.
        ("shadows.storage", "combined", RecomputeCost::Lights(3)),
        ("cuts.crop", r#"{"on": true}"#, RecomputeCost::Nothing),
        ("cuts.crop", r#"{"on": true, "low": [0.1, 0, 0]}"#, RecomputeCost::Lights(3)),
        ("cuts.crop", r#"{"on": true, "low": [0.1, 0, 0], "effect": "hidden"}"#, RecomputeCost::Eye),
        ("cuts.plane", r#"{"offset": 0.1}"#, RecomputeCost::Nothing),
        ("floor", r#"{"on": true}"#, RecomputeCost::Floor),
        ("floor", r#"{"height": -2}"#, RecomputeCost::Nothing),
        ("sampling.kernel", "prefiltered", RecomputeCost::Eye),
        ("sampling.order", "volume_aligned", RecomputeCost::Nothing),
        ("output.background.top", "[0,0,0]", RecomputeCost::Display),
        ("output.background.bottom", "[0,0,0]", RecomputeCost::Display),
        ("output.tone_map", "clip", RecomputeCost::Display),
        ("output.exposure", "2", RecomputeCost::Display),
        ("output.antialiasing", "8", RecomputeCost::Nothing),
    ];
    let bench = RecomputeCounter::new();
    for (path, value, expected) in table {
        assert_eq!(bench.cost_of(path, value), expected, "{path} = {value}");
    }
}

/// Sky visibility is recomputed when its occluders change, and never because of the colours of the sky, the camera or
/// other lights.
#[test]
fn a_sky_costs_a_picture_unless_something_else_is_in_its_way() {
    let bench = RecomputeCounter::new();
    let lit = apply_path(&base_settings(), "sky.mode", "gradient").expect("a setting");
    let lit = apply_path(&lit, "sky.directions", "6").expect("a setting");
    for (path, value, expected, filled) in [
        ("camera.azimuth_deg", "10", RecomputeCost::Eye, 0),
        ("camera.up", "plus_y", RecomputeCost::Eye, 0),
        ("sky.mode", "white", RecomputeCost::Eye, 0),
        ("sky.mode", "off", RecomputeCost::Eye, 0),
        ("sky.intensity", "0.1", RecomputeCost::Eye, 0),
        ("sky.zenith", "[1,0,0]", RecomputeCost::Eye, 0),
        ("sky.tilt_deg", "90", RecomputeCost::Eye, 0),
        ("lights.1.color", "[1,0,0]", RecomputeCost::Eye, 0),
        ("lights.1.position", "[0,6,1]", RecomputeCost::Lights(1), 0),
        ("transfer.points.0.color", "[1,0,0]", RecomputeCost::Eye, 0),
        ("shadows.strength", "0.5", RecomputeCost::Eye, 0),
        ("shadows.algorithm", "off", RecomputeCost::Eye, 0),
        ("sky.directions", "14", RecomputeCost::Sky, 1),
        ("sky.resolution", "quarter", RecomputeCost::Sky, 1),
        ("sky.density_scale", "2", RecomputeCost::Sky, 1),
        ("transfer.points.1.opacity", "0.4", RecomputeCost::Lights(3), 1),
        ("cuts.plane", r#"{"on": true, "offset": 0.1}"#, RecomputeCost::Lights(3), 1),
    ] {
        let changed = apply_path(&lit, path, value).expect("a setting");
        let runs = bench.runs(&lit, &changed, &RenderOptions::default());
        assert_eq!((recompute_cost(runs), runs.sky), (expected, filled), "{path} = {value}");
    }
}

/// Light from all directions is computed where it is looked up: an eye that sees more fills more, and one volume then
/// serves all parts of that. Previews, whose pixels are wide, use the existing volume.
#[test]
fn an_eye_that_sees_more_fills_more_once() {
    let bench = RecomputeCounter::new();
    let mut few = base_settings();
    (few.sky.mode, few.sky.directions) = (SkyMode::White, 6);
    (few.scattering.bounces, few.scattering.directions) = (1, 6);
    // The lighting curve shows the bright core alone.
    few.layer_mut().lighting.linked = false;
    let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
    few.layer_mut().lighting.curve.points = vec![point(210.0, 0.0), point(250.0, 0.5)];
    few.layer_mut().transfer.points = few.layer().lighting.curve.points.clone();
    let mut more = few.clone();
    more.layer_mut().transfer.points = vec![point(8.0, 0.0), point(250.0, 0.5)];
    let dataset = Dataset::new(scenes::creature(40, DVec3::ONE));
    let mut renderer = Renderer::with_shaders(&bench.context, bench.shaders.clone()).expect("a renderer");
    let mut filled = |settings: &Settings, preview: bool| {
        let options = RenderOptions::from(WorkOptions { preview, ..WorkOptions::default() });
        renderer.draw(&dataset, settings, SIZE, &options).expect("a picture");
        let runs = renderer.report().step_counts;
        (runs.sky, runs.bounces)
    };
    assert_eq!(filled(&few, false), (1, 1));
    let mut far = few.clone();
    far.camera.distance *= 20.0;
    assert_eq!(filled(&far, true), (0, 0), "a preview whose samples see farther");
    assert_eq!(filled(&more, false), (1, 1));
    assert_eq!(filled(&few, false), (0, 0));
    assert_eq!(filled(&more, false), (0, 0));
}

/// Scattered light is recomputed when lights, colours or occluders change, and never because of the view.
#[test]
fn light_that_bounces_is_kept_while_the_camera_turns() {
    let bench = RecomputeCounter::new();
    let lit = apply_path(&base_settings(), "scattering.bounces", "2").expect("a setting");
    let lit = apply_path(&lit, "scattering.directions", "6").expect("a setting");
    for (path, value, expected, filled) in [
        ("camera.azimuth_deg", "10", RecomputeCost::Eye, 0),
        ("scattering.strength", "2", RecomputeCost::Eye, 0),
        ("scattering.anisotropy", "0.3", RecomputeCost::Eye, 0),
        ("scattering.bounces", "0", RecomputeCost::Eye, 0),
        ("shadows.strength", "0.5", RecomputeCost::Eye, 0),
        ("shading.diffuse", "0.5", RecomputeCost::Eye, 0),
        ("lights.1.color", "[1,0,0]", RecomputeCost::Bounces, 1),
        ("transfer.points.0.color", "[1,0,0]", RecomputeCost::Bounces, 1),
        ("shading.emission", "0.5", RecomputeCost::Bounces, 1),
        ("scattering.albedo", "0.5", RecomputeCost::Bounces, 1),
        ("lights.1.position", "[0,6,1]", RecomputeCost::Lights(1), 1),
        ("transfer.points.1.opacity", "0.4", RecomputeCost::Lights(3), 1),
    ] {
        let changed = apply_path(&lit, path, value).expect("a setting");
        let runs = bench.runs(&lit, &changed, &RenderOptions::default());
        assert_eq!((recompute_cost(runs), runs.bounces), (expected, filled), "{path} = {value}");
    }
}

#[test]
fn a_saved_view_costs_nothing() {
    let mut kept = base_settings();
    assert!(kept.save_view_for_digit(1, "front"));
    assert_eq!(
        recompute_cost(RecomputeCounter::new().runs(&base_settings(), &kept, &RenderOptions::default())),
        RecomputeCost::Nothing
    );
}

#[test]
fn how_a_picture_is_shown_costs_one_display_pass() {
    let bench = RecomputeCounter::new();
    let options = [
        RenderOptions::from(PictureOptions { exposure: 1.5, ..PictureOptions::default() }),
        RenderOptions::from(PictureOptions { transparent: true, ..PictureOptions::default() }),
    ];
    for options in options {
        assert_eq!(
            recompute_cost(bench.runs(&base_settings(), &base_settings(), &options)),
            RecomputeCost::Display,
            "{options:?}"
        );
    }
    assert_eq!(
        recompute_cost(bench.runs(&base_settings(), &base_settings(), &RenderOptions::default())),
        RecomputeCost::Nothing
    );
}

#[test]
fn a_floor_that_changes_leaves_the_volume_as_it_is() {
    let bench = RecomputeCounter::new();
    let on = apply_path(&base_settings(), "floor.on", "true").expect("a setting");
    let lower = apply_path(&on, "floor.height", "-1.5").expect("a setting");
    assert_eq!(recompute_cost(bench.runs(&on, &lower, &RenderOptions::default())), RecomputeCost::Floor);
    assert_eq!(
        recompute_cost(bench.runs(&on, &base_settings(), &RenderOptions::default())),
        RecomputeCost::Display,
        "it goes away"
    );
}

#[test]
fn tables_are_baked_when_their_curves_change() {
    let bench = RecomputeCounter::new();
    let baked = |path: &str, value: &str| {
        let changed = apply_path(&base_settings(), path, value).expect("a setting");
        bench.runs(&base_settings(), &changed, &RenderOptions::default()).tables
    };
    assert_eq!(baked("camera.azimuth_deg", "10"), 0);
    assert_eq!(baked("transfer.points.0.color", "[1,0,0]"), 1, "the light meets no colours");
    assert_eq!(baked("lighting.scale", "0.5"), 1);
    assert_eq!(baked("transfer.points.1.opacity", "0.4"), 2);
}

/// Cached pictures are the bytes that would be drawn.
#[test]
fn pictures_that_are_shown_again_are_the_same_bytes() {
    let bench = RecomputeCounter::new();
    let mut renderer = Renderer::with_shaders(&bench.context, bench.shaders.clone()).expect("a renderer");
    let mut draw = |settings: &Settings| {
        let picture = renderer.render(&bench.dataset, settings, SIZE, &RenderOptions::default());
        (picture.expect("a picture"), renderer.report().step_counts.eye)
    };
    let light = apply_path(&base_settings(), "output.background.top", "[1,1,1]").expect("a setting");
    let (first, drawn) = draw(&base_settings());
    assert!(drawn > 0);
    let (shown, drawn) = draw(&light);
    assert_eq!(drawn, 0);
    assert_eq!(shown.linear, first.linear);
    assert_ne!(shown.display, first.display, "the background is seen");
    let (again, drawn) = draw(&base_settings());
    assert_eq!((again, drawn), (first, 0));
    let mut fresh = Renderer::with_shaders(&bench.context, bench.shaders.clone()).expect("a renderer");
    let anew = fresh.render(&bench.dataset, &light, SIZE, &RenderOptions::default()).expect("a picture");
    assert_eq!(anew, shown);
}

/// A picture does not depend on the pictures drawn before it on the same renderer, as in contact sheets.
#[test]
fn a_picture_does_not_depend_on_the_one_before() {
    use chiaroscuro_scene::{
        LightVolumeResolution, ReconstructionKernel, SlabMode, first_look::first_settings,
    };
    use chiaroscuro_volume::{Histogram, synthetic::builtin};
    let volume = builtin("chair", Some(48)).unwrap();
    let mut whole = first_settings(&volume, &Histogram::from_volume(&volume));
    whole.shadows.resolution = LightVolumeResolution::Half;
    (whole.shadows.kernel, whole.sampling.kernel) =
        (ReconstructionKernel::Prefiltered, ReconstructionKernel::Prefiltered);
    whole.sampling.slabs = SlabMode::Even;
    let mut cut = whole.clone();
    cut.cuts.plane.on = true;
    let dataset = Dataset::new(volume);
    let options = RenderOptions::default();
    let mut one_after_the_other = new_renderer();
    let mut draw = |settings: &Settings| {
        one_after_the_other.render_display(&dataset, settings, [88, 66], &options).expect("a picture")
    };
    let before = draw(&whole);
    draw(&cut);
    let after = draw(&whole);
    draw(&cut);
    let mut turned = cut.clone();
    turned.camera.azimuth_deg += 70.0;
    draw(&turned);
    let again = draw(&whole);
    let mut fresh = new_renderer();
    let alone = fresh.render_display(&dataset, &whole, [88, 66], &options).expect("a picture");
    assert!(before == alone && after == alone && again == alone);
}
