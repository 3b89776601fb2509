//! Mutation tests of pre-integrated slabs: the comparison with the reference detects mistakes.

use chiaroscuro::model::{Settings, Slabs};
use chiaroscuro::reference::Fault;

use super::mutations::{disagree_in, in_shader};
use crate::scenes;

/// Look with pre-integrated slabs for the eye.
fn look() -> Settings {
    let mut settings = scenes::look();
    settings.sampling.slabs = Slabs::Preintegrated;
    settings
}

#[test]
fn undamaged_preintegrated_slabs_agree() {
    assert!(!disagree_in(&look(), 40, "\u{0}", "", Fault::None));
}

#[test]
fn damaged_preintegrated_slabs_are_noticed() {
    let damages = [
        // Twice as dense.
        ("0.25 * length * (a.there + b.there)", "0.5 * length * (a.there + b.there)"),
        // Half of each step left out.
        ("behind_front * exp(-back)", "behind_front"),
        // Shaded a voxel behind the opacity's position.
        ("layer.places / layer.share", "layer.places / layer.share + 2.0"),
        // Shaded after each step.
        ("const LAYER_STEPS = 4", "const LAYER_STEPS = 1"),
    ];
    for (from, to) in damages {
        in_shader("eye/gather.wgsl", from);
        assert!(disagree_in(&look(), 40, from, to, Fault::None), "the comparison does not notice {to:?}");
    }
}
