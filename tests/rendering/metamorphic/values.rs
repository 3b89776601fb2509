//! Values and lengths in other units: the picture does not know them.

use chiaroscuro_scene::DensityRange;
use chiaroscuro_volume::{Samples, ValueRange};

use super::{FEW_SEEDS, MANY_SEEDS, SceneVariant, TestScene, check_relation};
use crate::thresholds::REVALUED;

/// Factor and offset of values in another unit: whole values stay whole numbers of 16 bits.
const STRETCH: (f64, f64) = (7.0, -700.0);

impl TestScene {
    fn as_i16(&self, (factor, offset): (f64, f64)) -> Samples {
        Samples::I16(self.values.iter().map(|&value| (f64::from(value) * factor + offset) as i16).collect())
    }

    /// Changes the curve and the range for values × `factor` + `offset`.
    fn with_stretched_curve(&self, (factor, offset): (f64, f64)) -> Self {
        let mut changed = self.clone();
        let layer = changed.settings.layer_mut();
        layer.range = DensityRange::Typed(ValueRange { low: offset, high: 255.0 * factor + offset });
        for point in &mut layer.transfer.points {
            point.value = point.value * factor + offset;
        }
        changed
    }
}

fn revalued(scene: &TestScene) -> Vec<SceneVariant> {
    let mut larger = scene.clone();
    larger.spacing *= 10.0;
    vec![
        SceneVariant {
            samples: Some(scene.as_i16((1.0, 0.0))),
            ..SceneVariant::same("16 bits", scene.clone())
        },
        SceneVariant {
            samples: Some(scene.as_i16(STRETCH)),
            ..SceneVariant::same("values in another unit", scene.with_stretched_curve(STRETCH))
        },
        SceneVariant::same("ten times as large", larger),
    ]
}

#[test]
fn values_and_lengths_in_other_units_look_the_same() {
    check_relation(FEW_SEEDS, REVALUED, revalued);
}

#[test]
#[ignore = "long: twenty scenes more; script/test --all runs it"]
fn many_values_and_lengths_in_other_units_look_the_same() {
    check_relation(MANY_SEEDS, REVALUED, revalued);
}
