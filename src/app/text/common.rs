//! What many parts of the window say.

use crate::data::SpacingUnit;

/// What is rarely needed, folded away.
pub(crate) const ADVANCED: &str = "Advanced";

/// Behind a factor.
pub(crate) const TIMES: &str = " ×";

/// Leaves what is being done or asked.
pub(crate) const CANCEL: &str = "Cancel";

/// Behind a length in voxels.
pub(crate) const VOX: &str = " vox";

/// A unit of lengths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LengthUnit {
    /// How many millimetres it is long; 1 where nobody knows.
    pub mm: f64,
    /// Behind a number.
    pub suffix: &'static str,
}

impl LengthUnit {
    /// The one in which a length has digits in front of the point: millimetres where they do, and shorter ones where not.
    /// Where nobody knows how large voxels are, these.
    pub(crate) fn showing(length_mm: f64, has_unknown_scale: bool) -> Self {
        Self::of(if has_unknown_scale { SpacingUnit::Voxels } else { SpacingUnit::showing(length_mm) })
    }

    /// That of distances between voxels.
    pub(crate) fn of(unit: SpacingUnit) -> Self {
        let suffix = match unit {
            SpacingUnit::Voxels => VOX,
            SpacingUnit::Nm => " nm",
            SpacingUnit::Um => " µm",
            SpacingUnit::Mm => " mm",
            SpacingUnit::Cm => " cm",
            SpacingUnit::M => " m",
        };
        Self { mm: unit.mm(), suffix }
    }

    /// How it is written by itself.
    pub(crate) fn symbol(self) -> &'static str {
        self.suffix.trim_start()
    }
}

/// Behind an angle.
pub(crate) const DEGREES: &str = "°";

/// What the button that puts a value back is called.
pub(crate) fn reset(label: &str) -> String {
    format!("Reset {label}")
}

/// The tip of a button that puts a value back.
pub(crate) fn reset_to(value: &str) -> String {
    format!("Reset to {value}")
}

/// What is put back that is no number.
pub(crate) const FIRST_LOOK: &str = "the first look";

/// The tip of the button that puts a section back.
pub(crate) fn reset_to_first_look(section: &str) -> String {
    format!("{} to {FIRST_LOOK}", reset(section))
}
