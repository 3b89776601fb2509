//! Layers in closed form: media that fill the same space, and a gate that keeps a part of one.

use chiaroscuro_scene::{
    LabelLook, LabelTable, LayerBlend, OpacityLength, RenderEngine, Settings, VolumeLayer,
};
use chiaroscuro_volume::Volume;

use crate::closed_form::{base, renderer};
use crate::common::{Dataset, full_attenuation, render};
use crate::scenes;
use crate::thresholds::LAYER_MATTER;

const N: usize = 48;
/// First voxel and end of the block.
const BLOCK: std::ops::Range<usize> = 12..36;

fn block(depth: std::ops::Range<usize>) -> Volume {
    scenes::block(N, |[x, y, z]| BLOCK.contains(&x) && depth.contains(&y) && BLOCK.contains(&z))
}

/// Medium with an extinction per voxel and a colour.
fn medium(per_voxel: f64, color: [f32; 3]) -> VolumeLayer {
    let mut transfer = scenes::linear_extinction(per_voxel);
    for point in &mut transfer.points {
        point.color = color;
    }
    VolumeLayer { transfer, opacity_unit: OpacityLength::Voxels(1.0), ..VolumeLayer::default() }
}

/// Look in which all material glows in its own colour, and nothing else is seen.
fn glowing(first: VolumeLayer, second: VolumeLayer) -> Settings {
    let mut settings = base(RenderEngine::Gather, 0.1);
    *settings.layer_mut() = first;
    settings.layers.push(second);
    (settings.shading.emission, settings.shading.ambient, settings.shading.diffuse) = (1.0, 0.0, 0.0);
    settings.shading.specular = 0.0;
    settings.sampling.slab = 0.25;
    settings
}

fn middle(dataset: &Dataset, settings: &Settings) -> [f64; 4] {
    let picture = render(&mut renderer(), dataset, settings, [96, 96]);
    picture.linear[48 * 96 + 48].map(f64::from)
}

fn check(name: &str, found: [f64; 4], expected: [f64; 4]) {
    for (found, expected) in found.into_iter().zip(expected) {
        assert!((found - expected).abs() <= LAYER_MATTER, "{name}: {found} not {expected}");
    }
}

#[test]
fn media_in_the_same_space_add_their_extinctions_and_mix_their_colors() {
    let dataset = Dataset::new(block(BLOCK)).with_field(&block(BLOCK), "second").expect("a field");
    for (a, b) in [(0.02, 0.05), (0.1, 0.01), (0.3, 0.3)] {
        let settings = glowing(medium(a, [1.0, 0.0, 0.0]), medium(b, [0.0, 1.0, 0.0]));
        let seen = 1.0 - (-(a + b) * BLOCK.len() as f64).exp();
        check("media", middle(&dataset, &settings), [seen * a / (a + b), seen * b / (a + b), 0.0, seen]);
        // Light from +z, three voxels above the lower face.
        let light = full_attenuation(&mut renderer(), &dataset, &settings, 0);
        let z = BLOCK.start + 3;
        let found = f64::from(light[N / 2 + N * (N / 2 + N * z)]);
        let alone = {
            let mut one = settings.clone();
            one.layers.truncate(1);
            one.sampling.classification = chiaroscuro_scene::ClassificationOrder::Pre;
            *one.layer_mut() = medium(a + b, [1.0; 3]);
            let first = Dataset::new(block(BLOCK));
            f64::from(full_attenuation(&mut renderer(), &first, &one, 0)[N / 2 + N * (N / 2 + N * z)])
        };
        assert!((found - alone).abs() <= LAYER_MATTER, "light: {found}, and {alone} through one medium");
    }
}

#[test]
fn a_gate_keeps_the_part_in_it_and_a_tint_only_its_color() {
    let half = BLOCK.start..BLOCK.start + BLOCK.len() / 2;
    let dataset = Dataset::new(block(BLOCK)).with_field(&block(half.clone()), "mask").expect("a field");
    let mut labels = LabelTable::default();
    labels.entry_mut(0).visible = false;
    *labels.entry_mut(255) =
        LabelLook { color: [0.0, 0.0, 1.0], opacity: 1.0, ..LabelLook::default_for(255) };
    let with = |blend| {
        let layer = VolumeLayer { labels: labels.clone(), blend, ..VolumeLayer::default() };
        glowing(medium(0.05, [1.0, 0.0, 0.0]), layer)
    };
    // The mean over the densities in a voxel gives the one in front of the block an eighth of the material, and the
    // first one in it seven eighths; the gate removes the eighth.
    let eighth = 0.125;
    let chord = half.len() as f64 - eighth;
    let kept = 1.0 - (-0.05 * chord).exp();
    check("gate", middle(&dataset, &with(LayerBlend::Gate)), [kept, 0.0, 0.0, kept]);
    // The tint of labels reaches a voxel further, and so does the color of the half in front.
    let labelled = Dataset::new(block(BLOCK)).with_field(&block(0..half.end), "labels").expect("a field");
    let part = |length: f64| 1.0 - (-0.05 * length).exp();
    let (blue, seen) = (part(half.len() as f64 + 1.0), part(BLOCK.len() as f64));
    check("tint", middle(&labelled, &with(LayerBlend::Tint)), [seen - blue, 0.0, blue, seen]);
}
