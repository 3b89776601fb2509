//! Several fields as layers, against the reference.

use std::sync::Arc;

use chiaroscuro_reference::{Reference, ReferenceOptions};
use chiaroscuro_scene::{
    ClipEffect, ClipPlane, Clipping, CropBox, CutShape, DensityRange, LabelLook, LabelTable, LayerBlend,
    LayerComposition, LayerVisibility, MaterialBox, Settings, ShapeCut, SphereCut, VolumeLayer,
};
use chiaroscuro_volume::{Samples, Volume};
use glam::DVec3;

use super::mutations::differs_with;
use super::{check_with, round_to_f16};
use crate::closed_form::renderer;
use crate::common::{Dataset, full_attenuation};
use crate::scenes;

const EDGE: usize = 32;

fn options() -> ReferenceOptions {
    ReferenceOptions { rounding: Some(round_to_f16), ..ReferenceOptions::default() }
}

fn volume_of(value: impl Fn(DVec3) -> f32) -> Arc<Volume> {
    let place =
        |at: usize| DVec3::new((at % EDGE) as f64, (at / EDGE % EDGE) as f64, (at / EDGE / EDGE) as f64);
    let values = (0..EDGE.pow(3)).map(|at| value(place(at))).collect();
    Arc::new(Volume::with_spacing("field", [EDGE; 3], DVec3::ONE, Samples::F32(values)).expect("a volume"))
}

/// Soft ball beside the middle; NaN in one corner, where voxels are missing.
fn ball() -> Arc<Volume> {
    volume_of(|place| {
        let distance = place.distance(DVec3::new(11.0, 18.0, 15.0));
        let is_missing = place.max_element() < 13.0;
        if is_missing { f32::NAN } else { (1.0 - distance as f32 / 12.0).max(0.0) }
    })
}

/// Waves that fill the grid.
fn waves() -> Arc<Volume> {
    volume_of(|place| (0.5 + 0.5 * (0.4 * place.x).sin() * (0.3 * place.y + 0.2 * place.z).cos()) as f32)
}

/// Label map of four labels, one of which is hidden.
fn labels() -> (Arc<Volume>, LabelTable) {
    let number =
        |at: usize| [0, 3, 9, 40][(at % EDGE / 11 + at / EDGE % EDGE / 9 + at / EDGE / EDGE / 13) % 4];
    let values = (0..EDGE.pow(3)).map(number).collect();
    let volume =
        Volume::with_spacing("labels", [EDGE; 3], DVec3::ONE, Samples::U8(values)).expect("a volume");
    let look = |number: i64, at: usize| LabelLook {
        color: [[0.9, 0.2, 0.1], [0.1, 0.8, 0.3], [0.2, 0.3, 0.9]][at],
        opacity: [0.5, 0.9, 1.0][at],
        ..LabelLook::default_for(number)
    };
    let mut table: LabelTable = [3, 9, 40].into_iter().zip(0..).map(|(at, i)| (at, look(at, i))).collect();
    table.entry_mut(0).visible = false;
    (volume.into(), table)
}

fn dataset_of(further: &[Arc<Volume>]) -> Dataset {
    let first = Dataset::new(scenes::creature(EDGE, DVec3::ONE));
    further.iter().fold(first, |dataset, volume| dataset.with_field(volume, "field").expect("another field"))
}

/// Layer with another colour and steeper opacities than those of the first.
fn second() -> VolumeLayer {
    let mut transfer = scenes::linear_extinction(0.9);
    for point in &mut transfer.points {
        (point.value, point.color) = (0.004 * point.value, [0.1, 0.7, 0.9]);
    }
    VolumeLayer { transfer, ..VolumeLayer::default() }
}

fn labelled(blend: LayerBlend) -> (Arc<Volume>, VolumeLayer) {
    let (volume, table) = labels();
    (volume, VolumeLayer { labels: table, blend, ..VolumeLayer::default() })
}

fn look(further: &[VolumeLayer]) -> Settings {
    let mut settings = scenes::look();
    for layer in further {
        settings.layers.push(layer.clone());
    }
    settings
}

fn check(name: &str, dataset: &Dataset, settings: &Settings) {
    let drawn = settings.resolved_for_dataset(dataset);
    check_with(name, dataset, settings, &Reference::with_layers(dataset, &drawn, options()));
}

#[test]
fn layers_add_their_matter() {
    check("two fields", &dataset_of(&[ball()]), &look(&[second()]));
    let mut third = second();
    third.lighting.linked = false;
    third.lighting.curve = scenes::linear_extinction(0.2);
    third.transfer.points[1].color = [1.0, 0.2, 0.1];
    check("three fields", &dataset_of(&[ball(), waves()]), &look(&[second(), third]));
}

#[test]
fn layers_may_cast_without_being_seen_and_may_be_hidden() {
    let with = |visibility| look(&[VolumeLayer { visibility, ..second() }]);
    let (mask, gate) = labelled(LayerBlend::Gate);
    for visibility in [LayerVisibility::CastsShadows, LayerVisibility::Hidden] {
        check(&format!("{visibility:?}"), &dataset_of(&[ball()]), &with(visibility));
        let gated = look(&[VolumeLayer { visibility, ..gate.clone() }]);
        check(&format!("gate, {visibility:?}"), &dataset_of(std::slice::from_ref(&mask)), &gated);
    }
}

#[test]
fn labels_tint_gate_and_add() {
    for blend in LayerBlend::ALL {
        let (volume, layer) = labelled(blend);
        check(&format!("{blend:?}"), &dataset_of(&[volume]), &look(&[layer]));
    }
}

#[test]
fn tints_of_one_field_leave_its_matter() {
    let (volume, layer) = labelled(LayerBlend::Tint);
    let glow = VolumeLayer { blend: LayerBlend::Tint, ..second() };
    let (dataset, mut settings) = (dataset_of(&[volume, ball()]), look(&[layer, glow]));
    assert_eq!(settings.layer_composition(), LayerComposition::Tinted);
    check("labels and a field", &dataset, &settings);
    let drawn = settings.resolved_for_dataset(&dataset).into_owned();
    let reference = Reference::with_layers(&dataset, &drawn, options());
    for (from, to) in [
        ("color * (1.0 - tint.r) + tint.gba", "color + tint.gba"),
        ("matter = densest_beside(i, voxel)", "matter = vec4f(0.0)"),
        ("mix(tint.a, 1.0, opacity)", "opacity"),
    ] {
        assert!(differs_with(&dataset, &settings, &reference, (from, to)), "{to}");
    }
    // Channels of color, alone and after a layer with matter.
    for blend in LayerBlend::CHANNELS {
        let channel = VolumeLayer { blend, range: DensityRange::Full, ..VolumeLayer::default() };
        let colors = look(&[channel.clone(), channel.clone()]);
        let two = dataset_of(&[waves(), ball()]);
        check(&format!("{blend:?}"), &two, &colors);
        check(&format!("{blend:?} after matter"), &two, &look(&[second(), channel]));
        let drawn = colors.resolved_for_dataset(&two).into_owned();
        let reference = Reference::with_layers(&two, &drawn, options());
        let swap = ("vec3u(0u, 1u, 2u) + LAYER_RED", "vec3u(1u, 2u, 0u) + LAYER_RED");
        assert!(differs_with(&two, &colors, &reference, swap), "another channel than {blend:?}");
    }
    // The opacities of a tint are not those of its matter, and light does not meet them.
    let light = |settings: &Settings| full_attenuation(&mut renderer(), &dataset, settings, 0);
    let tinted = light(&settings);
    settings.layers.truncate(1);
    assert_eq!(tinted, light(&settings));
}

#[test]
fn edges_are_left_of_one_field_and_of_several() {
    let mut settings = look(&[]);
    settings.layer_mut().edges = 0.08;
    check("edges of one field", &dataset_of(&[]), &settings);
    for blend in [LayerBlend::Tint, LayerBlend::Gate, LayerBlend::Add] {
        let (volume, layer) = labelled(blend);
        let outlines = look(&[VolumeLayer { edges: 1.0, ..layer }]);
        check(&format!("outlines of labels, {blend:?}"), &dataset_of(&[volume]), &outlines);
        let is_tint = outlines.layer_composition() == LayerComposition::Tinted;
        assert_eq!(is_tint, blend == LayerBlend::Tint, "a scan stays as sharp as it is");
    }
    let layer = VolumeLayer { edges: 0.05, ..second() };
    check("edges of the second field", &dataset_of(&[ball()]), &look(&[layer]));
}

#[test]
fn mistakes_in_outlines_are_noticed() {
    let (volume, layer) = labelled(LayerBlend::Tint);
    let (dataset, settings) = (dataset_of(&[volume]), look(&[VolumeLayer { edges: 1.0, ..layer }]));
    let drawn = settings.resolved_for_dataset(&dataset);
    let reference = Reference::with_layers(&dataset, &drawn, options());
    for (from, to) in [
        ("found.highest[i] > found.lowest[i]", "found.highest[i] > found.own[i]"),
        ("select(is_edge, is_outline, layer.is_label == 1u)", "is_edge"),
        (
            "let is_without = layer_mean(i, found.own[i], found.own[i]).a <= 0.0",
            "let is_without = matter.a <= 0.0",
        ),
    ] {
        assert!(differs_with(&dataset, &settings, &reference, (from, to)), "{to}");
    }
}

/// Look in which a box, a plane and a ball cut one layer, and the other stays whole: the second, unless it is a gate.
fn cut_around(blend: LayerBlend) -> Settings {
    // A gate that is cut leaves nothing there of what is whole.
    let is_first_whole = blend == LayerBlend::Gate;
    let mut settings = look(&[VolumeLayer { ignores_cuts: !is_first_whole, blend, ..second() }]);
    settings.layer_mut().ignores_cuts = is_first_whole;
    let ball = SphereCut { center: [0.3, -0.2, 0.3], radius: 0.4 };
    settings.cuts = Clipping {
        crop: CropBox { on: true, high: [1.0, 1.0, 0.8], effect: ClipEffect::Hidden, ..CropBox::default() },
        plane: ClipPlane { on: true, normal: [1.0, -2.0, 0.5], offset: 0.1, ..ClipPlane::default() },
        shapes: vec![ShapeCut { shape: CutShape::Sphere(ball), ..ShapeCut::default() }],
    };
    settings
}

#[test]
fn layers_that_are_never_cut_stay_whole() {
    let dataset = dataset_of(&[ball()]);
    for blend in [LayerBlend::Add, LayerBlend::Gate] {
        let settings = cut_around(blend);
        check(&format!("never cut, {blend:?}"), &dataset, &settings);
    }
    let settings = cut_around(LayerBlend::Add);
    let drawn = settings.resolved_for_dataset(&dataset);
    let reference = Reference::with_layers(&dataset, &drawn, options());
    let differs = |from, to| differs_with(&dataset, &settings, &reference, (from, to));
    assert!(!differs("", ""), "nothing is damaged");
    let never = "select(unmasked, 1.0, layers.layers[i].ignores_cuts == 1u)";
    assert!(differs(never, "unmasked"), "all layers are cut");
    assert!(differs(never, "1.0"), "no layer is cut");
}

#[test]
fn mistakes_in_layers_are_noticed() {
    let (volume, layer) = labelled(LayerBlend::Tint);
    let mut third = second();
    third.edges = 0.05;
    let (dataset, settings) = (dataset_of(&[ball(), waves(), volume]), look(&[second(), third, layer]));
    let drawn = settings.resolved_for_dataset(&dataset);
    let reference = Reference::with_layers(&dataset, &drawn, options());
    let differs = |from, to| differs_with(&dataset, &settings, &reference, (from, to));
    assert!(!differs("sum += matter", "sum = sum + matter"), "the same");
    for (from, to) in [
        ("sum += matter", "sum += 0.99 * matter"),
        ("found.own[i] - half_width", "found.own[min(i + 1u, 3u)] - half_width"),
        ("0.5 * found.slope[i]", "1.5 * found.slope[i]"),
        ("select(0.0, 1.0, found.is_present[i])", "1.0"),
        ("smoothstep(0.5 * layer.edges, layer.edges, found.slope[i])", "step(layer.edges, found.slope[i])"),
        ("mix(sum.rgb, color * weight, opacity)", "mix(sum.rgb, color, opacity)"),
        ("layer_tables[layer].integrals[low]", "layer_tables[0].integrals[low]"),
    ] {
        assert!(differs(from, to), "{to}");
    }
}

/// Materials at borders and between them, narrow and wide, that overlap.
fn materials() -> Vec<MaterialBox> {
    let material =
        |values, changes, softness, color, opacity| MaterialBox { values, changes, softness, color, opacity };
    vec![
        material([20.0, 90.0], [0.0, 12.0], 0.5, [0.9, 0.3, 0.1], 0.3),
        material([60.0, 220.0], [10.0, 400.0], 0.2, [0.2, 0.5, 0.9], 0.8),
        material([150.0, 151.0], [0.0, 60.0], 0.0, [0.1, 0.9, 0.3], 0.9),
        material([180.0, 400.0], [0.0, 30.0], 1.0, [0.9, 0.9, 0.8], 0.5),
    ]
}

#[test]
fn materials_by_value_and_change() {
    let mut settings = look(&[]);
    settings.layer_mut().materials = materials();
    check("materials of one field", &dataset_of(&[]), &settings);
    settings.layer_mut().lighting.scale = 0.4;
    check("fainter shadows of materials", &dataset_of(&[]), &settings);
    let mut shell = materials()[1];
    (shell.values, shell.changes) = ([0.2, 0.9], [0.03, 0.3]);
    let second = VolumeLayer { materials: vec![shell], edges: 0.02, ..second() };
    check("materials of the second field", &dataset_of(&[ball()]), &look(&[second]));
}

#[test]
fn mistakes_in_materials_are_noticed() {
    let mut settings = look(&[]);
    settings.layer_mut().materials = materials();
    let dataset = dataset_of(&[]);
    let drawn = settings.resolved_for_dataset(&dataset);
    let reference = Reference::with_layers(&dataset, &drawn, options());
    for (from, to) in [
        ("* region_weight(material.changes, change)", ""),
        ("region_weight(material.changes, change)", "region_weight(material.changes, 0.9 * change)"),
        (
            "mean_weight(material.densities, low, high)",
            "region_weight(material.densities, 0.5 * (low + high))",
        ),
        ("(rise - ramp_integral(ends.zw, high)", "(rise - 0.9 * ramp_integral(ends.zw, high)"),
        (
            "sum += matter_of_mean(weight * material.matter)",
            "sum = max(sum, matter_of_mean(weight * material.matter))",
        ),
        ("layers.layers[i].materials[at]", "layers.layers[i].materials[at / 2u * 2u]"),
    ] {
        assert!(differs_with(&dataset, &settings, &reference, (from, to)), "{to}");
    }
}
