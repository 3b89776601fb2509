//! Kind of data in a volume: as its file declares, otherwise detected from the values and their neighbourhoods.
//!
//! At most two million voxels are sampled, except for masks and label maps, whose values are all visited. Declared
//! padding is ignored. The result is independent of the orientation of the grid and of the number type, and for kinds
//! without an absolute meaning also of the scale and offset of the values.

mod dark_on_bright;
mod hounsfield;
mod labels;
mod sampled;
mod signed;
#[cfg(test)]
mod tests;

use self::sampled::SampledValues;
use super::Volume;
use crate::{Modality, ValueMeaning};

/// Kind of data in a volume.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DataKind {
    /// Binary mask: two values, background and object.
    Mask,
    /// Label map: numbers of objects; values between two of them mean nothing.
    LabelMap {
        /// Number of labels without the background.
        count: usize,
    },
    /// Signed field: deviations to both sides of zero.
    Signed,
    /// CT scan in Hounsfield units.
    HounsfieldCt {
        /// Value of water: 0, or 1024 if no value is negative.
        water: f64,
    },
    /// Object darker than its background.
    DarkOnBright,
    /// Scalar field in which larger values mean more of some quantity.
    Scalar,
}

/// Name of a kind of data, by which the user can override the detection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum KindName {
    /// Name of [`DataKind::Mask`].
    Mask,
    /// Name of [`DataKind::LabelMap`].
    LabelMap,
    /// Name of [`DataKind::Signed`].
    Signed,
    /// Name of [`DataKind::HounsfieldCt`].
    HounsfieldCt,
    /// Name of [`DataKind::DarkOnBright`].
    DarkOnBright,
    /// Name of [`DataKind::Scalar`].
    Scalar,
}

impl KindName {
    /// All kinds, in the order of menus.
    pub const ALL: [Self; 6] =
        [Self::Scalar, Self::DarkOnBright, Self::HounsfieldCt, Self::Signed, Self::Mask, Self::LabelMap];

    /// Iterates over the user's choices: `None` for the detected kind, then each kind.
    pub fn choices() -> impl Iterator<Item = Option<Self>> {
        std::iter::once(None).chain(Self::ALL.map(Some))
    }

    /// Returns the identifier for machine-readable output and the command line.
    pub const fn key(self) -> &'static str {
        match self {
            Self::Mask => "mask",
            Self::LabelMap => "labels",
            Self::Signed => "signed",
            Self::HounsfieldCt => "ct",
            Self::DarkOnBright => "dark-on-bright",
            Self::Scalar => "scalar",
        }
    }
}

impl DataKind {
    /// Returns the name of this kind.
    pub fn name(self) -> KindName {
        match self {
            Self::Mask => KindName::Mask,
            Self::LabelMap { .. } => KindName::LabelMap,
            Self::Signed => KindName::Signed,
            Self::HounsfieldCt { .. } => KindName::HounsfieldCt,
            Self::DarkOnBright => KindName::DarkOnBright,
            Self::Scalar => KindName::Scalar,
        }
    }

    /// Creates the kind of the given name for a volume, whatever its values look like.
    pub fn from_name(name: KindName, volume: &Volume) -> Self {
        match name {
            KindName::Mask => Self::Mask,
            KindName::LabelMap => Self::LabelMap { count: labels::count_labels(volume) },
            KindName::Signed => Self::Signed,
            KindName::HounsfieldCt => Self::HounsfieldCt { water: hounsfield::water_value(volume) },
            KindName::DarkOnBright => Self::DarkOnBright,
            KindName::Scalar => Self::Scalar,
        }
    }
}

/// Detected kind of a volume's data, with the reason.
#[derive(Debug, Clone, PartialEq)]
pub struct DetectedKind {
    /// Kind of the data.
    pub kind: DataKind,
    /// Reason for the decision, for diagnostics.
    pub reason: String,
}

impl DetectedKind {
    fn new(kind: DataKind, why: impl Into<String>) -> Self {
        Self { kind, reason: why.into() }
    }

    /// Detects the kind of a volume's data.
    pub fn detect(volume: &Volume) -> Self {
        let hints = volume.metadata();
        if hints.meaning == ValueMeaning::Labels {
            let count = labels::count_labels(volume);
            return Self::new(DataKind::LabelMap { count }, "the file says that values are labels");
        }
        if hints.meaning == ValueMeaning::HounsfieldUnits {
            let kind = DataKind::HounsfieldCt { water: 0.0 };
            return Self::new(kind, "the file says that values are Hounsfield units");
        }
        let sampled = SampledValues::from_volume(volume);
        if let Some(found) =
            labels::detect_mask(volume, &sampled).or_else(|| labels::detect_label_map(volume, &sampled))
        {
            return found;
        }
        let is_patient = matches!(hints.modality, Modality::Ct | Modality::Unknown) && !hints.is_rescaled;
        if is_patient && let Some(found) = hounsfield::detect_hounsfield(volume, &sampled) {
            return found;
        }
        let rest = sampled.without_spikes();
        if let Some(found) = dark_on_bright::detect_dark_on_bright(&rest) {
            return found;
        }
        // The tissues of a scan without any air are no deviations from zero.
        let may_be_signed = hints.meaning != ValueMeaning::PositiveDensity
            && !(is_patient && hounsfield::is_like_hounsfield(volume, &rest));
        if may_be_signed && let Some(found) = signed::detect_signed(&rest) {
            return found;
        }
        Self::new(DataKind::Scalar, "there is no sign of another kind")
    }
}
