//! Metadata of a file's values: modality, meaning, unit, padding value, display window and labels. Every reader fills
//! in what its format knows; the first look is derived from it.

mod labels;
mod modality;

pub use self::labels::{FileLabel, FileLabelTable, MAX_LABEL_NAME, MAX_LABELS};
pub use self::modality::Modality;

use chiaroscuro_files::sanitised;

/// Maximum length of a unit in characters; real ones have a few.
const MAX_UNIT: usize = 40;

/// Maximum length of the acquisition's description, in characters: a line.
const MAX_ACQUISITION: usize = 200;

/// Meaning of a volume's values, if its file states it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ValueMeaning {
    /// The file does not state the meaning.
    #[default]
    Unknown,
    /// Hounsfield units: −1000 is air and 0 is water.
    HounsfieldUnits,
    /// Labels, i.e. numbers of objects: values between two of them mean nothing.
    Labels,
    /// Density that grows with material, with noise below zero: maps of electron density.
    PositiveDensity,
}

impl ValueMeaning {
    /// Returns the identifier for machine-readable output; `None` if unknown.
    pub fn key(self) -> Option<&'static str> {
        match self {
            Self::Unknown => None,
            Self::HounsfieldUnits => Some("hounsfield_units"),
            Self::Labels => Some("labels"),
            Self::PositiveDensity => Some("positive_density"),
        }
    }

    /// Derives the meaning of values from the name of their unit.
    pub fn from_unit(unit: &str) -> Self {
        let unit = unit.trim().to_lowercase();
        let is_hounsfield =
            matches!(unit.as_str(), "hu" | "[hnsf'u]" | "hnsf'u") || unit.contains("hounsfield");
        if is_hounsfield { Self::HounsfieldUnits } else { Self::Unknown }
    }
}

/// Metadata of a file's values. None of it is trusted to be true.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ValueMetadata {
    /// Modality by which the data were acquired.
    pub modality: Modality,
    /// Meaning of the values, such as Hounsfield units.
    pub meaning: ValueMeaning,
    /// True if values were rescaled to the range of the number type, so that they have no absolute meaning.
    pub is_rescaled: bool,
    /// Padding value, of voxels that were not measured.
    pub padding: Option<f64>,
    /// Display window that the file suggests: the values shown as black and as white.
    pub window: Option<[f64; 2]>,
    /// Names and colours of labels.
    pub labels: FileLabelTable,
    unit: Option<String>,
    acquisition: Option<String>,
}

impl ValueMetadata {
    /// Sets the unit of the values in the file's words, and the meaning that follows from it. An empty unit is
    /// ignored.
    pub fn set_unit(&mut self, unit: &str) {
        self.unit = sanitised_if_any(unit, MAX_UNIT).or_else(|| self.unit.take());
        if self.meaning == ValueMeaning::Unknown {
            self.meaning = ValueMeaning::from_unit(unit);
        }
    }

    /// Returns the unit of the values, as one line without control characters.
    pub fn unit(&self) -> Option<&str> {
        self.unit.as_deref()
    }

    /// Sets the description of the acquisition in the file's words. An empty one is ignored.
    pub fn set_acquisition(&mut self, acquisition: &str) {
        self.acquisition = sanitised_if_any(acquisition, MAX_ACQUISITION).or_else(|| self.acquisition.take());
    }

    /// Returns the description of the acquisition, as one line without control characters.
    pub fn acquisition(&self) -> Option<&str> {
        self.acquisition.as_deref()
    }

    /// Sets the padding value, of voxels that were not measured; a value that is not finite is ignored.
    pub fn set_padding(&mut self, padding: f64) {
        self.padding = Some(padding).filter(|padding| padding.is_finite()).or(self.padding);
    }

    /// Sets the display window; bounds that are not finite or not ascending are ignored.
    pub fn set_window(&mut self, low: f64, high: f64) {
        let is_usable = low.is_finite() && high.is_finite() && low < high;
        self.window = is_usable.then_some([low, high]).or(self.window);
    }

    /// Returns true if the file states no metadata at all.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// Trims and sanitises text from a file; `None` if it is empty.
fn sanitised_if_any(text: &str, longest: usize) -> Option<String> {
    let text = text.trim();
    (!text.is_empty()).then(|| sanitised(text, longest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_say_what_values_mean() {
        for unit in ["HU", " hu ", "Hounsfield units", "[hnsf'U]"] {
            let mut hints = ValueMetadata::default();
            hints.set_unit(unit);
            assert_eq!(hints.meaning, ValueMeaning::HounsfieldUnits, "{unit}");
        }
        for unit in ["", "mm", "Hz", "hue", "US"] {
            assert_eq!(ValueMeaning::from_unit(unit), ValueMeaning::Unknown, "{unit}");
        }
        let mut labels = ValueMetadata { meaning: ValueMeaning::Labels, ..ValueMetadata::default() };
        labels.set_unit("HU");
        assert_eq!(labels.meaning, ValueMeaning::Labels, "what was said before stays");
    }

    #[test]
    fn texts_are_short_and_harmless() {
        let mut hints = ValueMetadata::default();
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
