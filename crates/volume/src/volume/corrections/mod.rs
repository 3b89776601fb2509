//! Corrections of a file's metadata by the user: spacing, orientation, padding value and value scale. They belong to
//! the file, not to the look.

mod apply;
mod axes;
mod patient_table;
mod rescale;
mod spacing;
#[cfg(test)]
mod tests;

pub(super) use apply::AppliedCorrections;
pub use axes::{AnatomicalAxes, AxisOrder, Flips, Orientation};
pub use patient_table::PatientTable;
pub use spacing::SpacingUnit;

use serde::{Deserialize, Serialize};

use crate::load_context::{is_usable_spacing, spacing_ratio_error};

/// Maximum slope of values; larger ones, or smaller ones than its inverse, would leave the range of 32-bit floats.
const MAX_SLOPE: f64 = 1e12;

/// Maximum intercept: values beyond are close to the limit of 32-bit floats, where differences overflow.
const MAX_VALUE: f64 = 1e30;

/// Corrections of a volume relative to its file. The default corrects nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Corrections {
    /// Voxel spacings along the three axes of the file, in [`Self::unit`]; `None` for those of the file. On the
    /// command line also as text: `0.5,0.5,2`, or one number for all three.
    #[serde(deserialize_with = "spacing::deserialize_spacing")]
    pub spacing: Option<[f64; 3]>,
    /// Unit of spacings, also of the file's own ones. `None` for the unit in the file, or for millimetres if spacings
    /// are given here.
    pub unit: Option<SpacingUnit>,
    /// Axes of the file along which the order of voxels is reversed.
    pub flip: Flips,
    /// Permutation of the three axes of the file.
    pub axis_order: AxisOrder,
    /// Anatomical orientation of the file's axes, applied before they are permuted and flipped.
    pub orientation: Option<Orientation>,
    /// Value of missing voxels, among the values after [`Self::value_scale`].
    pub padding_value: PaddingValue,
    /// Linear scale from numbers of the file to values.
    pub value_scale: ValueScale,
    /// Value from which on voxels are material, among the values after [`Self::value_scale`], if the table under a
    /// body is hidden; `None` leaves it.
    pub hidden_table: Option<f64>,
}

/// Padding value of missing voxels; in JSON null, `"new"` or a number.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(from = "WrittenPadding", into = "WrittenPadding")]
pub enum PaddingValue {
    /// The padding value that the file declares, if any.
    #[default]
    InFile,
    /// No padding value, whatever the file declares.
    Nothing,
    /// Padding value given by the user, in data units.
    Value(f64),
}

/// Serialised form of a padding value.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a number, \"none\", or null for what the file declares")]
enum WrittenPadding {
    Value(f64),
    Word(NoPaddingKeyword),
    InFile,
}

/// Keyword for no padding at all.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum NoPaddingKeyword {
    None,
}

impl From<WrittenPadding> for PaddingValue {
    fn from(written: WrittenPadding) -> Self {
        match written {
            WrittenPadding::Value(value) => Self::Value(value),
            WrittenPadding::Word(NoPaddingKeyword::None) => Self::Nothing,
            WrittenPadding::InFile => Self::InFile,
        }
    }
}

impl From<PaddingValue> for WrittenPadding {
    fn from(padding: PaddingValue) -> Self {
        match padding {
            PaddingValue::Value(value) => Self::Value(value),
            PaddingValue::Nothing => Self::Word(NoPaddingKeyword::None),
            PaddingValue::InFile => Self::InFile,
        }
    }
}

/// Linear scale of values in data units: `slope · number + intercept`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ValueScale {
    /// Factor of the file's numbers; never 0.
    pub slope: f64,
    /// Offset that is added after scaling.
    pub intercept: f64,
}

impl Default for ValueScale {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl ValueScale {
    /// Scale in which values are the numbers of the file, the default.
    const IDENTITY: Self = Self { slope: 1.0, intercept: 0.0 };

    /// Returns true if values are the numbers of the file, unscaled.
    pub fn is_none(self) -> bool {
        self == Self::IDENTITY
    }

    /// Converts a number of the file to a value.
    pub fn value_from_number(self, number: f64) -> f64 {
        self.slope * number + self.intercept
    }

    /// Converts a value back to the number in the file.
    pub fn number_from_value(self, value: f64) -> f64 {
        (value - self.intercept) / self.slope
    }

    /// Converts a value of this scale to the value of the same number in another scale.
    pub fn convert(self, other: Self, value: f64) -> f64 {
        if self == other { value } else { other.value_from_number(self.number_from_value(value)) }
    }
}

impl Corrections {
    /// Corrections of nothing, the default.
    pub(crate) const NONE: Self = Self {
        spacing: None,
        unit: None,
        flip: Flips { x: false, y: false, z: false },
        axis_order: AxisOrder::Xyz,
        orientation: None,
        padding_value: PaddingValue::InFile,
        value_scale: ValueScale::IDENTITY,
        hidden_table: None,
    };

    /// Returns true if nothing is corrected.
    pub fn is_none(&self) -> bool {
        *self == Self::NONE
    }

    /// Returns the corrections of positions alone, which hold for every field on the grid.
    #[must_use]
    pub fn of_grid(&self) -> Self {
        let Self { spacing, unit, flip, axis_order, orientation, .. } = *self;
        Self { spacing, unit, flip, axis_order, orientation, ..Self::default() }
    }

    /// Returns true if voxels keep their values and only their positions may change.
    pub fn keeps_values(&self) -> bool {
        self.padding_value == PaddingValue::InFile
            && self.value_scale.is_none()
            && self.hidden_table.is_none()
    }

    /// Returns true if other corrections change values in the same way.
    fn corrects_values_like(&self, other: &Self) -> bool {
        // The position of a table depends on the spacing and on the axes.
        self.padding_value == other.padding_value
            && self.value_scale == other.value_scale
            && self.hidden_table.is_none()
            && other.hidden_table.is_none()
    }

    /// Resets numbers that are out of range to their defaults.
    pub fn sanitise(&mut self) {
        let Self {
            spacing,
            unit,
            flip: _,
            axis_order: _,
            orientation: _,
            padding_value,
            value_scale,
            hidden_table,
        } = self;
        *hidden_table = hidden_table.filter(|value| value.is_finite());
        let unit_mm = unit.map_or(1.0, SpacingUnit::mm);
        let is_usable = |spacing: &[f64; 3]| {
            let spacing_mm = spacing.map(|length| length * unit_mm);
            spacing_mm.iter().all(|&length| is_usable_spacing(length))
                && spacing_ratio_error(spacing_mm).is_none()
        };
        *spacing = spacing.filter(is_usable);
        if let PaddingValue::Value(value) = padding_value
            && !value.is_finite()
        {
            *padding_value = PaddingValue::InFile;
        }
        let ValueScale { slope, intercept } = value_scale;
        if !(MAX_SLOPE.recip()..=MAX_SLOPE).contains(&slope.abs()) {
            *slope = 1.0;
        }
        if !(-MAX_VALUE..=MAX_VALUE).contains(intercept) {
            *intercept = 0.0;
        }
    }

    /// Describes each correction in a few words.
    pub fn in_words(&self) -> Vec<String> {
        let Self { spacing, unit, flip, axis_order, orientation, padding_value, value_scale, hidden_table } =
            self;
        let mut words = Vec::new();
        let symbol = unit.unwrap_or(SpacingUnit::Mm).symbol();
        match spacing {
            Some([x, y, z]) => words.push(format!("spacing {x} × {y} × {z} {symbol}")),
            None => words.extend(unit.map(|_| format!("spacing in {symbol}"))),
        }
        words.extend(orientation.map(|orientation| format!("orientation {orientation}")));
        if *axis_order != AxisOrder::default() {
            words.push(format!("axes in the order {}", axis_order.name()));
        }
        let flipped: Vec<_> = ["x", "y", "z"]
            .into_iter()
            .zip(flip.axes())
            .filter(|(_, on)| *on)
            .map(|(axis, _)| axis)
            .collect();
        if !flipped.is_empty() {
            words.push(format!("flipped along {}", flipped.join(", ")));
        }
        match padding_value {
            PaddingValue::InFile => {}
            PaddingValue::Nothing => words.push("no padding".to_owned()),
            PaddingValue::Value(value) => words.push(format!("padding {value}")),
        }
        if !value_scale.is_none() {
            words.push(format!("values × {} + {}", value_scale.slope, value_scale.intercept));
        }
        words.extend(hidden_table.map(|value| format!("hidden table, material from {value}")));
        words
    }
}
