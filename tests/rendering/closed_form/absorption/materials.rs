//! Materials by value and change in closed form: a slab between slabs of another value.

use chiaroscuro_scene::{DensityRange, MaterialBox, OpacityLength, RenderEngine};
use chiaroscuro_volume::{Samples, Volume};
use glam::DVec3;

use crate::closed_form::{base, renderer};
use crate::common::{Dataset, render};
use crate::thresholds::CHORD_OPACITY;

/// Edge of the volume in voxels.
const EDGE: usize = 24;

/// Opacity of a voxel of the material.
const OPACITY: f64 = 0.04;

/// Volume of 100, with a slab of 200 from the tenth voxel to the thirteenth along the view.
fn slab() -> Dataset {
    let values = (0..EDGE.pow(3)).map(|at| match at / EDGE % EDGE {
        10..=13 => 200.0,
        _ if at == 0 => 0.0,
        _ if at == 1 => 255.0,
        _ => 100.0,
    });
    let samples = Samples::F32(values.collect());
    Dataset::new(Volume::with_spacing("slab", [EDGE; 3], DVec3::ONE, samples).expect("a volume"))
}

/// Opacity of a material through the middle of the slab.
fn opacity_of(engine: RenderEngine, values: [f64; 2], changes: [f64; 2]) -> f64 {
    let mut settings = base(engine, OPACITY);
    settings.sampling.slab = 0.5;
    let layer = settings.layer_mut();
    (layer.range, layer.opacity_unit) = (DensityRange::Full, OpacityLength::Voxels(1.0));
    layer.materials =
        vec![MaterialBox { values, changes, softness: 0.0, opacity: OPACITY, ..MaterialBox::default() }];
    let picture = render(&mut renderer(), &slab(), &settings, [64, 64]);
    f64::from(picture.linear[32 * 64 + 32][3])
}

/// Voxels that a material includes are as opaque as it says, and others are not there: inside, around, and at borders,
/// where values change by half of a step across two voxels.
fn materials_are_where_they_say(engine: RenderEngine) {
    let still = [0.0, 5.0];
    let border = [30.0, 70.0];
    for (what, values, changes, voxels) in [
        ("inside", [150.0, 250.0], still, 2),
        ("around", [50.0, 150.0], still, EDGE - 6),
        // Voxels at borders have densities over half of the change: the inner ones from 175 to 200, and the outer ones
        // from 100 to 125.
        ("border from inside", [140.0, 260.0], border, 2),
        ("border from outside", [50.0, 130.0], border, 2),
        ("part of the border's values", [112.5, 300.0], border, 3),
        ("any change", [-1e3, 1e3], [0.0, 1e3], EDGE),
        ("nothing", [150.0, 250.0], [200.0, 300.0], 0),
    ] {
        let expected = 1.0 - (1.0 - OPACITY).powi(voxels as i32);
        let found = opacity_of(engine, values, changes);
        assert!((found - expected).abs() <= CHORD_OPACITY, "{what}: {found} not {expected}");
    }
}

#[test]
fn materials_are_where_they_say_gathered() {
    materials_are_where_they_say(RenderEngine::Gather);
}

#[test]
fn materials_are_where_they_say_scattered() {
    materials_are_where_they_say(RenderEngine::Scatter);
}
