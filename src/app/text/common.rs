//! Texts that several parts of the window share: buttons, units and tooltips of reset buttons.

use chiaroscuro_volume::SpacingUnit;

/// Caption of a collapsed group of rarely needed settings.
pub(crate) const ADVANCED: &str = "Advanced";

/// Suffix of a field that holds a factor.
pub(crate) const FACTOR_SUFFIX: &str = " ×";

/// Caption of the button that abandons a running task or closes a question.
pub(crate) const CANCEL: &str = "Cancel";

/// Suffix of a length in voxels.
pub(crate) const VOXELS_SUFFIX: &str = " vox";

/// Unit of length for display, with its suffix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LengthUnit {
    /// Length of the unit in millimetres; 1 where the voxel size is unknown.
    pub mm: f64,
    /// Suffix behind a number, with the leading space where there is one.
    pub suffix: &'static str,
}

impl LengthUnit {
    /// Returns the unit in which a length has digits before the decimal point: millimetres from 1 mm, micrometres
    /// from 1 µm, nanometres below; voxels where the voxel size is unknown.
    pub(crate) fn for_length(length_mm: f64, has_unknown_scale: bool) -> Self {
        Self::from_spacing_unit(if has_unknown_scale {
            SpacingUnit::Voxels
        } else {
            SpacingUnit::suiting_length(length_mm)
        })
    }

    /// Converts the unit of a voxel spacing into a unit for display.
    pub(crate) fn from_spacing_unit(unit: SpacingUnit) -> Self {
        let suffix = match unit {
            SpacingUnit::Voxels => VOXELS_SUFFIX,
            SpacingUnit::Nm => " nm",
            SpacingUnit::Um => " µm",
            SpacingUnit::Mm => " mm",
            SpacingUnit::Cm => " cm",
            SpacingUnit::M => " m",
        };
        Self { mm: unit.mm(), suffix }
    }

    /// Returns the symbol without the leading space of the suffix.
    pub(crate) fn symbol(self) -> &'static str {
        self.suffix.trim_start()
    }
}

/// Suffix of an angle in degrees.
pub(crate) const DEGREES: &str = "°";

/// Accessible name of the button that resets a setting.
pub(crate) fn reset_name(label: &str) -> String {
    format!("Reset {label}")
}

/// Tooltip of the button that resets a number.
pub(crate) fn reset_tooltip(value: &str) -> String {
    format!("Reset to {value}")
}

/// Value to which a reset button goes back where the setting is not a number.
pub(crate) const FIRST_LOOK: &str = "the first look";

/// Tooltip of the button that resets a section of the side panel.
pub(crate) fn reset_section_tooltip(section: &str) -> String {
    format!("{} to {FIRST_LOOK}", reset_name(section))
}
