//! Kind of data in a volume: as its file declares, otherwise detected from the values and their neighbourhoods.
//!
//! At most two million voxels are sampled, except for masks and label maps, whose values are all visited. Declared
//! padding is ignored. The result is independent of the orientation of the grid and of the number type, and for kinds
//! without an absolute meaning also of the scale and offset of the values.

mod dark_on_bright;
mod labels;
mod sampled;
#[cfg(test)]
mod tests;

use self::dark_on_bright::MAX_OBJECT_SHARE;
use self::sampled::{SampledValues, quantile};
use super::Volume;
use crate::{Modality, ValueMeaning, ValueRange};

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
            KindName::HounsfieldCt => Self::HounsfieldCt { water: water_value(volume) },
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
        if is_patient && let Some(found) = detect_hounsfield(volume, &sampled) {
            return found;
        }
        let rest = sampled.without_spikes();
        if let Some(found) = dark_on_bright::detect_dark_on_bright(&rest) {
            return found;
        }
        if hints.meaning != ValueMeaning::PositiveDensity
            && let Some(found) = detect_signed(&rest)
        {
            return found;
        }
        Self::new(DataKind::Scalar, "there is no sign of another kind")
    }
}

/// Returns the value of water if values are Hounsfield units: scanners without negative numbers add 1024.
fn water_value(volume: &Volume) -> f64 {
    if volume.value_range().low < MIN_SOFT_TISSUE_HU { 0.0 } else { 1024.0 }
}

/// Hounsfield units below which the only tissue is lung. Scans that show air reach far below; those with an offset of
/// 1024 go below zero only by noise.
const MIN_SOFT_TISSUE_HU: f64 = -200.0;

/// Detects CT scans: Hounsfield units have peaks at air and at soft tissue, and little between them, i.e. lungs and
/// partial volumes at surfaces.
fn detect_hounsfield(volume: &Volume, sampled: &SampledValues<'_>) -> Option<DetectedKind> {
    let water = water_value(volume);
    // Without negative numbers, MR scans whose tissue is at a thousand have the same peaks.
    let is_ct = volume.metadata().modality == Modality::Ct;
    if water > 0.0 && !is_ct {
        return None;
    }
    let share = |low: f64, high: f64| sampled.share_in_range(water + low, water + high);
    // Air is −1000; fat, water, muscle and blood are within 150 of zero. Between them are lungs, and beyond them
    // spongy bone: windows well apart from both peaks, whose noise is a few tens.
    let (air, soft) = (share(-1050.0, -950.0), share(-150.0, 150.0));
    // Densities per Hounsfield unit, so that windows of different widths compare.
    let (between, beyond) = (share(-650.0, -250.0) / 400.0, share(350.0, 650.0) / 300.0);
    let are_peaks =
        air / 100.0 >= MIN_PEAK_RATIO * between && soft / 300.0 >= MIN_PEAK_RATIO * between.max(beyond);
    // A scan may show no air; then its header must state CT, and the soft tissue must be as much as both peaks
    // together.
    let is_found = (are_peaks && air >= MIN_PEAK_SHARE && soft >= MIN_PEAK_SHARE)
        || is_ct && soft >= 2.0 * MIN_PEAK_SHARE;
    is_found.then(|| {
        let why = format!(
            "{:.0} % of the values are near that of air, {:.0} % near that of soft tissue",
            100.0 * air,
            100.0 * soft
        );
        DetectedKind::new(DataKind::HounsfieldCt { water }, why)
    })
}

/// Minimum share of the values in each of the peaks of air and soft tissue: a head in wide air has 26 % and 57 %, a
/// chest 21 % and 28 %; a limb in a tank of air has a few percent of the second.
const MIN_PEAK_SHARE: f64 = 0.03;

/// Minimum ratio of the density in a peak to that between the peaks. Measured: 3 and more; evenly spread values have
/// 1.
const MIN_PEAK_RATIO: f64 = 2.0;

/// Detects signed fields: they reach about as far below zero as above, in lobes rather than single voxels.
fn detect_signed(sampled: &SampledValues<'_>) -> Option<DetectedKind> {
    let ValueRange { low: below, high: above } = sampled.nonzero_quantiles(SIGNED_OUTLIER_SHARE)?;
    let balance = below.abs().min(above) / below.abs().max(above);
    if below >= 0.0 || above <= 0.0 || balance < MIN_SIGNED_BALANCE {
        return None;
    }
    // The background of a signed field is zero: faces far below it are the dark margin of a scan.
    let is_all_strong = |face: &Vec<f64>| {
        quantile(face, 1.0 - MAX_OBJECT_SHARE) <= below / 2.0
            || quantile(face, MAX_OBJECT_SHARE) >= above / 2.0
    };
    if sampled.faces().iter().filter(|face| is_all_strong(face)).count() >= MAX_STRONG_FACES {
        return None;
    }
    let coherence = sampled.coherence_beyond(below / 2.0).min(sampled.coherence_beyond(above / 2.0));
    (coherence >= MIN_LOBE_COHERENCE).then(|| {
        let why = format!(
            "values reach from {below:.3} to {above:.3} in lobes on both sides of zero: {:.0} % of strong values have \
             similar neighbours",
            100.0 * coherence
        );
        DetectedKind::new(DataKind::Signed, why)
    })
}

/// Share of the nonzero values at either end that count as outliers: fewer form no visible lobe.
const SIGNED_OUTLIER_SHARE: f64 = 0.002;

/// Minimum ratio of the weaker side of a signed field to the stronger. Six of six signed fields have 0.49 and more,
/// noise below zero beside a signal above it rarely 0.3: a threshold well apart from both.
const MIN_SIGNED_BALANCE: f64 = 0.35;

/// Number of faces with only strong values at which a field is not signed; fewer may cut an object.
const MAX_STRONG_FACES: usize = 5;

/// Minimum share of neighbours of strong values that are at least half as strong. In lobes it is 0.9 and more; in
/// white noise 0.1.
const MIN_LOBE_COHERENCE: f64 = 0.5;
