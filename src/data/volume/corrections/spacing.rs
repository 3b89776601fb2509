//! Distances between voxels as users write them, and their units.

use serde::{Deserialize, Deserializer, Serialize};

use crate::data::volume::Volume;

/// The unit of distances between voxels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SpacingUnit {
    /// Nanometres.
    Nm,
    /// Micrometres.
    #[serde(alias = "µm", alias = "μm")]
    Um,
    /// Millimetres.
    Mm,
    /// Centimetres.
    Cm,
    /// Metres.
    M,
    /// Nobody knows: distances can only be compared with each other.
    Voxels,
}

impl SpacingUnit {
    /// All of them, the shortest first.
    pub const ALL: [Self; 6] = [Self::Nm, Self::Um, Self::Mm, Self::Cm, Self::M, Self::Voxels];

    /// How many millimetres it is long; 1 where nobody knows.
    pub fn mm(self) -> f64 {
        match self {
            Self::Nm => 1e-6,
            Self::Um => 1e-3,
            Self::Mm | Self::Voxels => 1.0,
            Self::Cm => 10.0,
            Self::M => 1e3,
        }
    }

    /// The one in which a length has digits in front of the point: millimetres where they do, and shorter ones where not.
    pub fn showing(length_mm: f64) -> Self {
        match length_mm {
            length if length >= 1.0 => Self::Mm,
            length if length >= 1e-3 => Self::Um,
            _ => Self::Nm,
        }
    }

    /// The one that is so long.
    fn of_mm(mm: f64) -> Option<Self> {
        Self::ALL.into_iter().find(|unit| *unit != Self::Voxels && unit.mm().to_bits() == mm.to_bits())
    }

    /// The one in which distances between voxels are said: down to a hundredth of a millimetre there are digits enough
    /// behind the point.
    pub fn of_spacing(spacing_mm: [f64; 3]) -> Self {
        Self::showing(100.0 * spacing_mm.into_iter().fold(0.0, f64::max))
    }

    /// How it is written behind a number.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Nm => "nm",
            Self::Um => "µm",
            Self::Mm => "mm",
            Self::Cm => "cm",
            Self::M => "m",
            Self::Voxels => "voxels",
        }
    }
}

/// From a ten-thousandth of a length on, its number in a unit has more digits than anybody reads.
const MOST_UNITS: f64 = 1e4;

impl Volume {
    /// States in which unit its file has lengths, by its millimetres; what is no known unit says nothing.
    #[must_use]
    pub fn said_in_units_of(self, mm: f64) -> Self {
        Self { length_unit: SpacingUnit::of_mm(mm).unwrap_or(self.length_unit), ..self }
    }

    /// The unit in which lengths as long as the object are said: that of the file, if it has one that suits them.
    pub fn length_unit(&self) -> SpacingUnit {
        let length_mm = self.scene().mm_per_unit;
        match self.length_unit {
            SpacingUnit::Voxels => SpacingUnit::Voxels,
            unit if (1.0..=MOST_UNITS).contains(&(length_mm / unit.mm())) => unit,
            _ => SpacingUnit::showing(length_mm),
        }
    }
}

/// Three distances, one for all three, or a text of either.
#[derive(Deserialize)]
#[serde(untagged, expecting = "expected three numbers, as in 0.5,0.5,2, or one for all axes")]
enum Written {
    Three([f64; 3]),
    One(f64),
    Text(String),
}

/// Reads distances; null for those of the file.
pub(super) fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<[f64; 3]>, D::Error> {
    let Some(written) = Option::<Written>::deserialize(deserializer)? else { return Ok(None) };
    let parsed = match written {
        Written::Three(three) => Some(three),
        Written::One(one) => Some([one; 3]),
        Written::Text(text) => numbers(&text),
    };
    let refused = || serde::de::Error::custom("expected three numbers, as in 0.5,0.5,2, or one for all axes");
    parsed.ok_or_else(refused).map(Some)
}

/// `0.5,0.5,2` and `0.5x0.5x2`.
fn numbers(text: &str) -> Option<[f64; 3]> {
    let parts: Vec<f64> =
        text.split(['x', 'X', '×', ',']).map(|part| part.trim().parse().ok()).collect::<Option<_>>()?;
    parts.try_into().ok()
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::data::Samples;

    #[test]
    fn distances_are_said_in_units_that_suit_them() {
        for (spacing, unit) in [
            ([0.5, 0.5, 2.0], SpacingUnit::Mm),
            ([0.0005, 0.0005, 0.02], SpacingUnit::Mm),
            ([0.0005, 0.0005, 0.002], SpacingUnit::Um),
            ([3.25e-6; 3], SpacingUnit::Nm),
        ] {
            assert_eq!(SpacingUnit::of_spacing(spacing), unit, "{spacing:?}");
        }
        assert_eq!(SpacingUnit::showing(0.5), SpacingUnit::Um);
    }

    #[test]
    fn lengths_are_said_in_the_unit_of_the_file_where_it_suits_them() {
        let of = |spacing_mm: f64, unit_mm: f64| {
            let samples = Samples::U8((0..64).collect());
            let volume = Volume::with_spacing("t", [4; 3], DVec3::splat(spacing_mm), samples).unwrap();
            volume.said_in_units_of(unit_mm).length_unit()
        };
        assert_eq!(
            [of(20.0, 10.0), of(20.0, 1e3), of(2e3, 1e3)],
            [SpacingUnit::Cm, SpacingUnit::Mm, SpacingUnit::M]
        );
        assert_eq!(
            [of(1.0, 1e-3), of(1.0, 1e-6), of(1e-3, 1.0)],
            [SpacingUnit::Um, SpacingUnit::Mm, SpacingUnit::Um]
        );
        assert_eq!(of(20.0, 25.4), SpacingUnit::Mm, "inches are not known");
    }
}
