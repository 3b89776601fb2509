//! What a user knows better than a file: how far voxels are apart, which way they run, which of their values is none, and
//! what their numbers mean. It belongs to the file, and not to what a picture looks like.

mod apply;
mod axes;
mod scaled;
mod spacing;
#[cfg(test)]
mod tests;

pub(in crate::data::volume) use apply::Corrected;
pub use axes::{AxisOrder, Flips, Headings, Orientation};
pub use spacing::SpacingUnit;

use serde::{Deserialize, Serialize};

use crate::data::attempt::{is_usable_spacing, unlike_spacings};

/// Slopes of values beyond this, and below its inverse, are mistakes: they would leave 32-bit numbers.
const MAX_SLOPE: f64 = 1e12;

/// Values beyond this leave 32-bit numbers soon, and leave none for a difference.
const MAX_VALUE: f64 = 1e30;

/// How a volume differs from what its file says. The default is not at all.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Corrections {
    /// Distances between voxels along the three axes of the file, in [`Self::unit`]; `None` for those of the file. On
    /// the command line also as text: `0.5,0.5,2`, or one number for all three.
    #[serde(deserialize_with = "spacing::read")]
    pub spacing: Option<[f64; 3]>,
    /// The unit of distances, the file's own among them. `None` for what the file says, which of distances that are given
    /// here is millimetres.
    pub unit: Option<SpacingUnit>,
    /// Axes of the file along which voxels run the other way.
    pub flip: Flips,
    /// Where the three axes of the file run.
    pub axis_order: AxisOrder,
    /// Where the three axes of the file run in a body, before they are put into another order and flipped.
    pub orientation: Option<Orientation>,
    /// The value of voxels that hold nothing, among the values as they are after [`Self::value_scale`].
    pub padding_value: PaddingValue,
    /// What the numbers of the file mean.
    pub value_scale: ValueScale,
}

/// Which value stands for nothing; in JSON null, `"none"` or a number.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(from = "WrittenPadding", into = "WrittenPadding")]
pub enum PaddingValue {
    /// The one that the file declares, if it does.
    #[default]
    InFile,
    /// No value does, whatever the file declares.
    Nothing,
    /// This one.
    Value(f64),
}

/// How a padding value is written.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a number, \"none\", or null for what the file declares")]
enum WrittenPadding {
    Value(f64),
    Word(NoPadding),
    InFile,
}

/// The word for no padding at all.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum NoPadding {
    None,
}

impl From<WrittenPadding> for PaddingValue {
    fn from(written: WrittenPadding) -> Self {
        match written {
            WrittenPadding::Value(value) => Self::Value(value),
            WrittenPadding::Word(NoPadding::None) => Self::Nothing,
            WrittenPadding::InFile => Self::InFile,
        }
    }
}

impl From<PaddingValue> for WrittenPadding {
    fn from(padding: PaddingValue) -> Self {
        match padding {
            PaddingValue::Value(value) => Self::Value(value),
            PaddingValue::Nothing => Self::Word(NoPadding::None),
            PaddingValue::InFile => Self::InFile,
        }
    }
}

/// Values in data units from the numbers of a file: `slope · number + intercept`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ValueScale {
    /// Multiplies the numbers; never 0.
    pub slope: f64,
    /// Is added then.
    pub intercept: f64,
}

impl Default for ValueScale {
    fn default() -> Self {
        Self { slope: 1.0, intercept: 0.0 }
    }
}

impl ValueScale {
    /// Whether values are the numbers of the file.
    pub fn is_none(self) -> bool {
        self == Self::default()
    }

    /// What a number means.
    pub fn value(self, number: f64) -> f64 {
        self.slope * number + self.intercept
    }

    /// The number that means a value.
    pub fn number(self, value: f64) -> f64 {
        (value - self.intercept) / self.slope
    }

    /// What a value of this scale is in another.
    pub fn in_scale(self, other: Self, value: f64) -> f64 {
        if self == other { value } else { other.value(self.number(value)) }
    }
}

impl Corrections {
    /// Whether the file is right in all.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// Whether voxels and their values are those of the file: only where they lie may be another place.
    pub fn keeps_values(&self) -> bool {
        self.padding_value == PaddingValue::InFile && self.value_scale.is_none()
    }

    /// Whether others correct values in the same way.
    fn has_values_of(&self, other: &Self) -> bool {
        self.padding_value == other.padding_value && self.value_scale == other.value_scale
    }

    /// Lets go of numbers that cannot be meant.
    pub fn sanitise(&mut self) {
        let Self { spacing, unit, flip: _, axis_order: _, orientation: _, padding_value, value_scale } = self;
        let unit_mm = unit.map_or(1.0, SpacingUnit::mm);
        let is_usable = |spacing: &[f64; 3]| {
            let spacing_mm = spacing.map(|length| length * unit_mm);
            spacing_mm.iter().all(|&length| is_usable_spacing(length))
                && unlike_spacings(spacing_mm).is_none()
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

    /// What is corrected, each in a few words.
    pub fn in_words(&self) -> Vec<String> {
        let Self { spacing, unit, flip, axis_order, orientation, padding_value, value_scale } = self;
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
        words
    }
}
