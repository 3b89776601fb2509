//! Adapting a look to corrections of its volume: lengths and data values in the settings are converted, so that the
//! image keeps showing the same part of the object.

use crate::{DensityRange, LabelTable, MaterialBox, OpacityLength, Settings, VolumeLayer};
use chiaroscuro_volume::{Corrections, DataKind, ValueRange, ValueScale, Volume};

/// Significant digits of a converted length, so that converting there and back gives the original number.
const SIGNIFICANT_DIGITS: usize = 12;

/// Largest integer up to which every integer is exact in f64.
const MAX_EXACT_INTEGER: f64 = (1_i64 << 53) as f64;

impl Settings {
    /// Applies other corrections to the volume. Lengths in millimetres keep their share of the volume's size, and
    /// data values keep referring to the same numbers in the file.
    pub fn apply_corrections(&mut self, corrections: Corrections, volume: &Volume) {
        let before = std::mem::replace(&mut self.volume, corrections);
        self.volume.sanitise();
        let [old, new] = [before, self.volume].map(|by| volume.corrected_scene(&by).mm_per_unit);
        let longer = new / old;
        let (before_scale, after_scale) = (before.value_scale, self.volume.value_scale);
        self.mode.isovalue = self.mode.isovalue.map(|value| before_scale.convert(after_scale, value));
        for layer in self.layers.iter_mut() {
            if let OpacityLength::Mm(mm) = layer.opacity_unit
                && longer != 1.0
                && longer.is_finite()
                && longer > 0.0
            {
                layer.opacity_unit = OpacityLength::Mm(round_to_digits(mm * longer));
            }
            layer.convert_values(before_scale, after_scale);
        }
    }
}

/// Value of the material of tables, in Hounsfield units above water: between foam, which need not be seen, and the shells
/// around it, of which voxels may hold a half.
const TABLE_HOUNSFIELD: f64 = -500.0;

/// Share of a curve's largest opacity from which on values are material, in volumes that are no CT scans.
const MATERIAL_OPACITY_SHARE: f64 = 0.1;

impl Settings {
    /// Hides the table under a body, or shows it again; what is material follows from the volume and from the curve.
    pub fn toggle_table(&mut self, volume: &Volume) {
        let hidden_table = match self.volume.hidden_table {
            Some(_) => None,
            None => Some(self.material_threshold(volume)),
        };
        self.apply_corrections(Corrections { hidden_table, ..self.volume }, volume);
    }

    /// Returns the value from which on voxels of a volume are material.
    pub fn material_threshold(&self, volume: &Volume) -> f64 {
        match volume.kind().kind {
            DataKind::HounsfieldCt { water } => water + TABLE_HOUNSFIELD,
            _ => self.layer().transfer.value_at_opacity_share(MATERIAL_OPACITY_SHARE),
        }
    }
}

impl VolumeLayer {
    /// Converts data values from one value scale to another.
    fn convert_values(&mut self, before: ValueScale, after: ValueScale) {
        if before == after {
            return;
        }
        let moved = |value: f64| before.convert(after, value);
        for function in [&mut self.transfer, &mut self.lighting.curve] {
            for point in &mut function.points {
                point.value = moved(point.value);
            }
            if before.slope.signum() != after.slope.signum() {
                // Points at the same value are jumps, whose direction is reversed now.
                function.points.reverse();
            }
            function.sort();
        }
        for MaterialBox { values, changes, .. } in &mut self.materials {
            *values = values.map(moved);
            values.sort_by(f64::total_cmp);
            *changes = changes.map(|change| (moved(change) - moved(0.0)).abs());
        }
        if let DensityRange::Typed(ValueRange { low, high }) = self.range {
            self.range = DensityRange::Typed(ValueRange::new(moved(low), moved(high))).sanitised();
        }
        let renumbered = |number: i64| {
            let value = moved(number as f64).round();
            (value.abs() < MAX_EXACT_INTEGER).then_some(value as i64)
        };
        let looks = self.labels.iter().filter_map(|(number, look)| Some((renumbered(number)?, look.clone())));
        self.labels = looks.collect::<LabelTable>();
    }
}

/// Rounds to as many digits as survive a few multiplications.
fn round_to_digits(number: f64) -> f64 {
    format!("{number:.*e}", SIGNIFICANT_DIGITS - 1).parse().unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::{ControlPoint, LabelLook};
    use chiaroscuro_volume::{Samples, SpacingUnit};

    fn volume() -> Volume {
        let samples = Samples::U8((0..=255).collect());
        Volume::with_spacing("t", [16, 4, 4], DVec3::new(0.5, 0.5, 2.0), samples).unwrap()
    }

    fn look() -> Settings {
        let mut look = Settings::default().with_opacity_unit(OpacityLength::Mm(1.3));
        let point = |value| ControlPoint::new(value, [1.0; 3], value / 255.0);
        look.layer_mut().transfer.points = [10.0, 10.0, 200.0].map(point).to_vec();
        look.layer_mut().range = DensityRange::Typed(ValueRange::new(3.0, 230.0));
        look.layer_mut().labels.entry_mut(7);
        look
    }

    #[test]
    fn lengths_are_the_same_share_of_the_object_and_come_back() {
        let (volume, before) = (volume(), look());
        let steps = [[1.0, 1.0, 1.0], [0.1, 0.7, 11.0], [3e-6, 1e-6, 2e-6]];
        let mut look = before.clone();
        for spacing in steps {
            let wanted = Corrections { spacing: Some(spacing), ..Corrections::default() };
            look.apply_corrections(wanted, &volume);
            let corrected = volume.corrected(&look.volume).unwrap();
            let share =
                |look: &Settings, volume: &Volume| look.layer().opacity_unit.scene_units(&volume.scene());
            assert!((share(&look, &corrected) / share(&before, &volume) - 1.0).abs() < 1e-10);
        }
        look.apply_corrections(
            Corrections { unit: Some(SpacingUnit::Um), ..Corrections::default() },
            &volume,
        );
        assert_eq!(look.layer().opacity_unit, OpacityLength::Mm(1.3e-3));
        look.apply_corrections(Corrections::default(), &volume);
        assert_eq!(look, before);
    }

    #[test]
    fn values_mean_the_same_numbers_and_come_back() {
        let (volume, before) = (volume(), look());
        for (slope, intercept) in [(2.0, -1024.0), (-1.0, 255.0), (0.5, 0.0)] {
            let value_scale = ValueScale { slope, intercept };
            let mut look = before.clone();
            look.apply_corrections(Corrections { value_scale, ..Corrections::default() }, &volume);
            assert!(look.layer().transfer.points.windows(2).all(|pair| pair[0].value <= pair[1].value));
            for number in [0.0, 9.0, 11.0, 100.0, 199.0] {
                let opacity = look.layer().transfer.opacity_at(value_scale.value_from_number(number));
                assert!(
                    (opacity - before.layer().transfer.opacity_at(number)).abs() < 1e-12,
                    "{slope}: {number}"
                );
            }
            let DensityRange::Typed(range) = look.layer().range else { panic!("it was typed") };
            assert!(range.low < range.high && range.contains(value_scale.value_from_number(3.0)));
            let number = value_scale.value_from_number(7.0).round() as i64;
            assert_eq!(look.layer().labels.get(number), Some(&LabelLook::default_for(7)));
            look.apply_corrections(Corrections::default(), &volume);
            assert_eq!(
                (&look.layer().transfer, look.layer().range),
                (&before.layer().transfer, before.layer().range)
            );
        }
    }
}
