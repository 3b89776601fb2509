//! What a file says of its values beyond the values themselves: what they measure, which of them are no measurement,
//! what labels are called. Every reader says here what it knows; the first look asks.

mod labels;
mod modality;

pub use self::labels::{Label, Labels, MAX_LABEL_NAME, MAX_LABELS};
pub use self::modality::Modality;

use super::foreign::plain;

/// Characters of a unit that are kept: those that exist have a few.
const MAX_UNIT: usize = 40;

/// Characters of a description of how the data were acquired that are kept: a line.
const MAX_ACQUISITION: usize = 200;

/// What the values of a volume stand for, where its file says so.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Meaning {
    /// The file does not say.
    #[default]
    Unknown,
    /// Hounsfield units: −1000 is air and 0 is water.
    HounsfieldUnits,
    /// The number of what is there: nothing lies between two of them.
    Labels,
    /// More is more material, and what is below zero is noise: maps of electron density.
    PositiveDensity,
}

impl Meaning {
    /// What machines call it; nothing where it is not known.
    pub fn key(self) -> Option<&'static str> {
        match self {
            Self::Unknown => None,
            Self::HounsfieldUnits => Some("hounsfield_units"),
            Self::Labels => Some("labels"),
            Self::PositiveDensity => Some("positive_density"),
        }
    }

    /// What a name of a unit says of the values in it.
    pub fn of_unit(unit: &str) -> Self {
        let unit = unit.trim().to_lowercase();
        let is_hounsfield =
            matches!(unit.as_str(), "hu" | "[hnsf'u]" | "hnsf'u") || unit.contains("hounsfield");
        if is_hounsfield { Self::HounsfieldUnits } else { Self::Unknown }
    }
}

/// What a file says of its values. Nothing of it need be true: files are not trusted.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Hints {
    /// How the data were acquired.
    pub modality: Modality,
    /// What the values stand for.
    pub meaning: Meaning,
    /// The values were brought from their own range into that of the number type: they have no absolute meaning.
    pub is_rescaled: bool,
    /// The value of voxels that were not measured.
    pub padding: Option<f64>,
    /// The values between which it suggests to show greys.
    pub window: Option<[f64; 2]>,
    /// What labels are called, and their colours.
    pub labels: Labels,
    unit: Option<String>,
    acquisition: Option<String>,
}

impl Hints {
    /// States the unit of the values in the file's words, and what follows from it. An empty one says nothing.
    pub fn set_unit(&mut self, unit: &str) {
        self.unit = told(unit, MAX_UNIT).or_else(|| self.unit.take());
        if self.meaning == Meaning::Unknown {
            self.meaning = Meaning::of_unit(unit);
        }
    }

    /// The unit of the values, as one line without control characters.
    pub fn unit(&self) -> Option<&str> {
        self.unit.as_deref()
    }

    /// States in the file's words how the data were acquired. Empty ones say nothing.
    pub fn set_acquisition(&mut self, acquisition: &str) {
        self.acquisition = told(acquisition, MAX_ACQUISITION).or_else(|| self.acquisition.take());
    }

    /// How the data were acquired, as one line without control characters.
    pub fn acquisition(&self) -> Option<&str> {
        self.acquisition.as_deref()
    }

    /// States the value of voxels that were not measured; what is no finite number says nothing.
    pub fn set_padding(&mut self, padding: f64) {
        self.padding = Some(padding).filter(|padding| padding.is_finite()).or(self.padding);
    }

    /// States between which values greys are to be shown; two that are not finite, or not in order, say nothing.
    pub fn set_window(&mut self, low: f64, high: f64) {
        let is_usable = low.is_finite() && high.is_finite() && low < high;
        self.window = is_usable.then_some([low, high]).or(self.window);
    }

    /// Whether the file says nothing at all.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// Text from outside, if there is any.
fn told(text: &str, longest: usize) -> Option<String> {
    let text = text.trim();
    (!text.is_empty()).then(|| plain(text, longest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_say_what_values_mean() {
        for unit in ["HU", " hu ", "Hounsfield units", "[hnsf'U]"] {
            let mut hints = Hints::default();
            hints.set_unit(unit);
            assert_eq!(hints.meaning, Meaning::HounsfieldUnits, "{unit}");
        }
        for unit in ["", "mm", "Hz", "hue", "US"] {
            assert_eq!(Meaning::of_unit(unit), Meaning::Unknown, "{unit}");
        }
        let mut labels = Hints { meaning: Meaning::Labels, ..Hints::default() };
        labels.set_unit("HU");
        assert_eq!(labels.meaning, Meaning::Labels, "what was said before stays");
    }

    #[test]
    fn texts_are_short_and_harmless() {
        let mut hints = Hints::default();
        hints.set_unit("  ");
        hints.set_acquisition("");
        hints.set_padding(f64::NAN);
        assert!(hints.is_empty());
        hints.set_unit("mg\u{1b}[31m/ml");
        hints.set_acquisition(&"x".repeat(100_000));
        assert_eq!(hints.unit(), Some("mg·[31m/ml"));
        assert_eq!(hints.acquisition().map(|text| text.chars().count()), Some(MAX_ACQUISITION + 1));
        hints.set_padding(-2000.0);
        hints.set_padding(f64::INFINITY);
        assert_eq!(hints.padding, Some(-2000.0));
    }
}
