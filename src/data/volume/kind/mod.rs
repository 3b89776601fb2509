//! What kind of data a volume holds: what its file says, else what the values and their neighbourhoods tell.
//!
//! Of the voxels at most two million are looked at, but for those of masks and label maps, of which no value is left out.
//! What holds nothing, as the file declares it, is no value. Nothing depends on how the grid lies or on the
//! number type; what has no absolute meaning does not depend on scale and offset of the values either.

mod inverted;
mod labels;
mod sampled;
#[cfg(test)]
mod tests;

use self::inverted::MOST_OF_OBJECT;
use self::sampled::{Sampled, quantile};
use super::Volume;
use crate::data::{Meaning, Modality};

/// What kind of data a volume holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DataKind {
    /// Two values: there is something, or nothing.
    Mask,
    /// Numbers of what is there; nothing lies between two of them.
    LabelMap {
        /// How many there are, without what is around them.
        count: usize,
    },
    /// Deviations to both sides of zero.
    Signed,
    /// Hounsfield units of a CT scanner.
    HounsfieldCt {
        /// The value of water: 0, or 1024 where nothing is negative.
        water: f64,
    },
    /// An object that is darker than all that is around it.
    DarkOnBright,
    /// More is more of something.
    Scalar,
}

/// A kind of data by its name: what a volume can be treated as.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum KindName {
    /// See [`DataKind::Mask`].
    Mask,
    /// See [`DataKind::LabelMap`].
    LabelMap,
    /// See [`DataKind::Signed`].
    Signed,
    /// See [`DataKind::HounsfieldCt`].
    HounsfieldCt,
    /// See [`DataKind::DarkOnBright`].
    DarkOnBright,
    /// See [`DataKind::Scalar`].
    Scalar,
}

impl KindName {
    /// All of them, in the order of menus.
    pub const ALL: [Self; 6] =
        [Self::Scalar, Self::DarkOnBright, Self::HounsfieldCt, Self::Signed, Self::Mask, Self::LabelMap];

    /// What a volume can be treated as: as it is, and as each of them.
    pub fn choices() -> impl Iterator<Item = Option<Self>> {
        std::iter::once(None).chain(Self::ALL.map(Some))
    }

    /// What machines and the command line call it.
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
    /// Which kind it is.
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

    /// The kind of that name, as it is in a volume whatever it looks like.
    pub fn of_name(name: KindName, volume: &Volume) -> Self {
        match name {
            KindName::Mask => Self::Mask,
            KindName::LabelMap => Self::LabelMap { count: labels::count(volume) },
            KindName::Signed => Self::Signed,
            KindName::HounsfieldCt => Self::HounsfieldCt { water: water(volume) },
            KindName::DarkOnBright => Self::DarkOnBright,
            KindName::Scalar => Self::Scalar,
        }
    }
}

/// The kind of a volume's data, and why it is taken for that.
#[derive(Debug, Clone, PartialEq)]
pub struct KindFound {
    /// The kind.
    pub kind: DataKind,
    /// Why, for people who look into it.
    pub why: String,
}

impl KindFound {
    fn new(kind: DataKind, why: impl Into<String>) -> Self {
        Self { kind, why: why.into() }
    }

    /// Finds the kind of a volume's data.
    pub fn of(volume: &Volume) -> Self {
        let hints = volume.hints();
        if hints.meaning == Meaning::Labels {
            let count = labels::count(volume);
            return Self::new(DataKind::LabelMap { count }, "the file says that values are labels");
        }
        if hints.meaning == Meaning::HounsfieldUnits {
            let kind = DataKind::HounsfieldCt { water: 0.0 };
            return Self::new(kind, "the file says that values are Hounsfield units");
        }
        let sampled = Sampled::of(volume);
        if let Some(found) = labels::mask(volume, &sampled).or_else(|| labels::label_map(volume, &sampled)) {
            return found;
        }
        let is_patient = matches!(hints.modality, Modality::Ct | Modality::Unknown) && !hints.is_rescaled;
        if is_patient && let Some(found) = hounsfield(volume, &sampled) {
            return found;
        }
        let rest = sampled.without_spikes();
        if let Some(found) = inverted::dark_on_bright(&rest) {
            return found;
        }
        if hints.meaning != Meaning::PositiveDensity
            && let Some(found) = signed(&rest)
        {
            return found;
        }
        Self::new(DataKind::Scalar, "nothing says that it is anything else")
    }
}

/// The value of water, where values are Hounsfield units: scanners that know no negative numbers add 1024.
fn water(volume: &Volume) -> f64 {
    if volume.value_range().low < BELOW_FAT { 0.0 } else { 1024.0 }
}

/// Hounsfield units below which there is no tissue but lung. Scans that show air reach far below, and those to which 1024
/// was added go below zero by noise alone.
const BELOW_FAT: f64 = -200.0;

/// Hounsfield units have peaks at air and at soft tissue, and little between them: what lies there is lungs, and the
/// surfaces of everything.
fn hounsfield(volume: &Volume, sampled: &Sampled<'_>) -> Option<KindFound> {
    let water = water(volume);
    // Without negative numbers, MR scans whose tissue is at a thousand have the same peaks.
    let is_ct = volume.hints().modality == Modality::Ct;
    if water > 0.0 && !is_ct {
        return None;
    }
    let share = |low: f64, high: f64| sampled.share(water + low, water + high);
    // Air is −1000, and fat, water, muscle and blood lie within 150 of zero. Between them are lungs, and spongy bone beyond:
    // windows well apart from both peaks, whose noise is a few tens.
    let (air, soft) = (share(-1050.0, -950.0), share(-150.0, 150.0));
    // Per Hounsfield unit, so that windows of different widths compare.
    let (between, beyond) = (share(-650.0, -250.0) / 400.0, share(350.0, 650.0) / 300.0);
    let are_peaks = air / 100.0 >= PEAK * between && soft / 300.0 >= PEAK * between.max(beyond);
    // A scan may show no air; then its header has to say what it is, and there is as much soft tissue as in both peaks.
    let is_found =
        (are_peaks && air >= LEAST_PEAK && soft >= LEAST_PEAK) || is_ct && soft >= 2.0 * LEAST_PEAK;
    is_found.then(|| {
        let why = format!(
            "{:.0} % of the values are near that of air, {:.0} % near that of soft tissue",
            100.0 * air,
            100.0 * soft
        );
        KindFound::new(DataKind::HounsfieldCt { water }, why)
    })
}

/// Share of the values in the peaks of air and of soft tissue, at least: a head in wide air has 26 % and 57 %, a chest
/// 21 % and 28 %; a limb in a tank of air has a few of the second.
const LEAST_PEAK: f64 = 0.03;

/// How much denser than what is between them peaks are, at least. Measured: 3 and more; equal in evenly spread values.
const PEAK: f64 = 2.0;

/// Signed fields reach about as far below zero as above, in lobes rather than in single voxels.
fn signed(sampled: &Sampled<'_>) -> Option<KindFound> {
    let (below, above) = sampled.nonzero_quantiles(OUTLIERS)?;
    let balance = below.abs().min(above) / below.abs().max(above);
    if below >= 0.0 || above <= 0.0 || balance < LEAST_BALANCE {
        return None;
    }
    // Around deviations there is none: what is far below zero all around is the dark margin of a scan.
    let is_all_strong = |face: &Vec<f64>| {
        quantile(face, 1.0 - MOST_OF_OBJECT) <= below / 2.0 || quantile(face, MOST_OF_OBJECT) >= above / 2.0
    };
    if sampled.faces().iter().filter(|face| is_all_strong(face)).count() >= STRONG_FACES {
        return None;
    }
    let coherence = sampled.coherence_beyond(below / 2.0).min(sampled.coherence_beyond(above / 2.0));
    (coherence >= LEAST_COHERENCE).then(|| {
        let why = format!(
            "values reach from {below:.3} to {above:.3} in lobes to both sides of zero: {:.0} % of strong values have neighbours like them",
            100.0 * coherence
        );
        KindFound::new(DataKind::Signed, why)
    })
}

/// Share of the values that are not zero at either end that are outliers: fewer make no lobe that is seen.
const OUTLIERS: f64 = 0.002;

/// How far a signed field reaches to its weaker side, as a share of the stronger, at least. Six of six signed fields
/// have 0.49 and more, noise below zero beside a signal above it seldom 0.3: well apart from both.
const LEAST_BALANCE: f64 = 0.35;

/// So many of the six faces are not around a signed field if all of their values are strong: one may cut an object.
const STRONG_FACES: usize = 5;

/// How many neighbours of strong values are half as strong, at least. In lobes 0.9 and more; in white noise 0.1.
const LEAST_COHERENCE: f64 = 0.5;
