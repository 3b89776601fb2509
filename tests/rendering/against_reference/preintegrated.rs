//! Mutation tests of pre-integrated slabs: the comparison with the reference detects mistakes.

use chiaroscuro_reference::ReferenceFault;
use chiaroscuro_scene::{Settings, SlabMode};

use super::mutations::{assert_in_shader, differs_in_look};
use crate::scenes;

/// Look with pre-integrated slabs for the eye.
fn look() -> Settings {
    let mut settings = scenes::look();
    settings.sampling.slabs = SlabMode::Preintegrated;
    settings
}

#[test]
fn undamaged_preintegrated_slabs_agree() {
    assert!(!differs_in_look(&look(), 40, "\u{0}", "", ReferenceFault::None));
}

#[test]
fn damaged_preintegrated_slabs_are_noticed() {
    let damages = [
        // Twice as dense.
        ("0.25 * length * (a.presence + b.presence)", "0.5 * length * (a.presence + b.presence)"),
        // Half of each step left out.
        ("behind_front * exp(-back)", "behind_front"),
        // Shaded a voxel behind the opacity's position.
        ("layer.places / layer.share", "layer.places / layer.share + 2.0"),
        // Shaded after each step.
        ("const LAYER_STEPS = 4", "const LAYER_STEPS = 1"),
    ];
    for (from, to) in damages {
        assert_in_shader("eye/eye_pass.wgsl", from);
        assert!(
            differs_in_look(&look(), 40, from, to, ReferenceFault::None),
            "the comparison does not notice {to:?}"
        );
    }
}
