//! What many parts of the window say.

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
        let (mm, suffix) = match length_mm {
            _ if has_unknown_scale => (1.0, VOX),
            length if length >= 1.0 => (1.0, " mm"),
            length if length >= 1e-3 => (1e-3, " µm"),
            _ => (1e-6, " nm"),
        };
        Self { mm, suffix }
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
pub(crate) fn reset_tip(label: &str) -> String {
    reset(&label.to_lowercase())
}
