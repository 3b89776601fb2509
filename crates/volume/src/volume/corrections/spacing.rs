//! Voxel spacings as the user writes them, and their units.

use serde::{Deserialize, Deserializer, Serialize};

/// Unit of voxel spacings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SpacingUnit {
    /// Nanometres, 1e-6 mm.
    Nm,
    /// Micrometres, 1e-3 mm.
    #[serde(alias = "µm", alias = "μm")]
    Um,
    /// Millimetres, the unit of world space.
    Mm,
    /// Centimetres, 10 mm.
    Cm,
    /// Metres, 1000 mm.
    M,
    /// Unknown: spacings have only ratios.
    Voxels,
}

impl SpacingUnit {
    /// All units, the shortest first, then voxels.
    pub const ALL: [Self; 6] = [Self::Nm, Self::Um, Self::Mm, Self::Cm, Self::M, Self::Voxels];

    /// Returns the length of the unit in mm; 1 if it is unknown.
    pub fn mm(self) -> f64 {
        match self {
            Self::Nm => 1e-6,
            Self::Um => 1e-3,
            Self::Mm | Self::Voxels => 1.0,
            Self::Cm => 10.0,
            Self::M => 1e3,
        }
    }

    /// Returns the unit in which a length is at least 1: millimetres if possible, otherwise a shorter one.
    pub fn suiting_length(length_mm: f64) -> Self {
        match length_mm {
            length if length >= 1.0 => Self::Mm,
            length if length >= 1e-3 => Self::Um,
            _ => Self::Nm,
        }
    }

    /// Finds the unit of exactly this length in mm.
    pub(crate) fn from_mm(mm: f64) -> Option<Self> {
        Self::ALL.into_iter().find(|unit| *unit != Self::Voxels && unit.mm().to_bits() == mm.to_bits())
    }

    /// Returns the unit in which spacings are shown: down to a hundredth of a millimetre, decimals of millimetres
    /// suffice.
    pub fn suiting_spacing(spacing_mm: [f64; 3]) -> Self {
        Self::suiting_length(100.0 * spacing_mm.into_iter().fold(0.0, f64::max))
    }

    /// Returns the symbol written after a number.
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

/// Serialised form: three spacings, one for all axes, or a text of either.
#[derive(Deserialize)]
#[serde(untagged, expecting = "expected three numbers, as in 0.5,0.5,2, or one for all axes")]
enum WrittenSpacing {
    Three([f64; 3]),
    One(f64),
    Text(String),
}

/// Deserialises spacings; null for those of the file.
pub(super) fn deserialize_spacing<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<[f64; 3]>, D::Error> {
    let Some(written) = Option::<WrittenSpacing>::deserialize(deserializer)? else { return Ok(None) };
    let parsed = match written {
        WrittenSpacing::Three(three) => Some(three),
        WrittenSpacing::One(one) => Some([one; 3]),
        WrittenSpacing::Text(text) => parse_spacing(&text),
    };
    let refused = || serde::de::Error::custom("expected three numbers, as in 0.5,0.5,2, or one for all axes");
    parsed.ok_or_else(refused).map(Some)
}

/// Parses `0.5,0.5,2` or `0.5x0.5x2`.
fn parse_spacing(text: &str) -> Option<[f64; 3]> {
    let parts: Vec<f64> =
        text.split(['x', 'X', '×', ',']).map(|part| part.trim().parse().ok()).collect::<Option<_>>()?;
    parts.try_into().ok()
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::{Samples, Volume};

    #[test]
    fn distances_are_said_in_units_that_suit_them() {
        for (spacing, unit) in [
            ([0.5, 0.5, 2.0], SpacingUnit::Mm),
            ([0.0005, 0.0005, 0.02], SpacingUnit::Mm),
            ([0.0005, 0.0005, 0.002], SpacingUnit::Um),
            ([3.25e-6; 3], SpacingUnit::Nm),
        ] {
            assert_eq!(SpacingUnit::suiting_spacing(spacing), unit, "{spacing:?}");
        }
        assert_eq!(SpacingUnit::suiting_length(0.5), SpacingUnit::Um);
    }

    #[test]
    fn lengths_are_said_in_the_unit_of_the_file_where_it_suits_them() {
        let of = |spacing_mm: f64, unit_mm: f64| {
            let samples = Samples::U8((0..64).collect());
            let volume = Volume::with_spacing("t", [4; 3], DVec3::splat(spacing_mm), samples).unwrap();
            volume.with_length_unit(unit_mm).length_unit()
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
