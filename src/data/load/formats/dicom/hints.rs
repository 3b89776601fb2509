//! What a header says of the values.

use super::groups::Slice;
use super::header::found::Found;
use super::pixels::shape::{Colors, PixelNumber, Shape};
use crate::data::{Hints, Meaning, Modality};

impl Found {
    /// What the series is called.
    pub(super) fn description(&self) -> &str {
        let said = [&self.series_description, &self.protocol];
        said.into_iter().find(|text| !text.is_empty()).map_or("", String::as_str)
    }

    /// Everything that is said of how the series was acquired.
    fn acquisition(&self) -> String {
        match (self.series_description.as_str(), self.protocol.as_str()) {
            (description, protocol) if description.is_empty() || description == protocol => {
                protocol.to_owned()
            }
            (description, "") => description.to_owned(),
            (description, protocol) => format!("{description}, {protocol}"),
        }
    }

    /// The unit of rescaled values.
    fn unit(&self) -> &str {
        let is_scaled = self.all.slope.or(self.shared.slope).is_some();
        match (self.rescale_type.as_str(), self.units.as_str()) {
            // "Unspecified".
            ("" | "US", "")
                if self.modality == "CT" && is_scaled && !self.image_type.contains("LOCALIZER") =>
            {
                "HU"
            }
            ("" | "US", "") => "",
            ("" | "US", units) => units,
            (rescale_type, _) => rescale_type,
        }
    }
}

/// What a header says of the values of slices, which have a common slope and intercept or none.
pub(super) fn hints(found: &Found, shape: &Shape, slice: &Slice, scale: Option<[f64; 2]>) -> Hints {
    let mut hints = Hints::default();
    hints.modality = Modality::of_code(&found.modality);
    hints.set_acquisition(&found.acquisition());
    if shape.samples > 1 {
        return hints;
    }
    hints.set_unit(found.unit());
    if let ([Some(center), Some(width)], true) = (slice.plane.window, width_is_usable(slice)) {
        // PS3.3 section C.11.2.1.2: a width of 256 has 256 values.
        let low = center - 0.5 - (width - 1.0) / 2.0;
        hints.set_window(low, low + width - 1.0);
    }
    if let (Some(padding), Some([slope, intercept]), PixelNumber::Integer(bits)) =
        (found.padding, scale, shape.number)
    {
        let padding = if bits.is_signed { f64::from(padding as i16) } else { f64::from(padding) };
        hints.set_padding(padding * slope + intercept);
    }
    if hints.modality == Modality::Segmentation {
        hints.meaning = Meaning::Labels;
    }
    hints
}

fn width_is_usable(slice: &Slice) -> bool {
    slice.plane.window[1].is_some_and(|width| width >= 1.0)
}

/// What users should know of how values are shown.
pub(super) fn remarks(found: &Found, shape: &Shape, is_component_chosen: bool) -> Vec<String> {
    let mut remarks = Vec::new();
    match shape.colors {
        Colors::Inverted => remarks.push("high values are meant to be shown dark; they are kept as they are"),
        Colors::Palette => {
            remarks.push("its values are numbers of colours in a table: they mean no brightness");
        }
        Colors::Rgb | Colors::Ybr | Colors::YbrPairs if !is_component_chosen => {
            remarks.push("colours are shown as their luminance");
        }
        Colors::Grey | Colors::Rgb | Colors::Ybr | Colors::YbrPairs => {}
    }
    if found.has_value_table {
        remarks.push("a table of what values mean is not applied: they are shown as they are stored");
    }
    if found.image_type.contains("MOSAIC") {
        remarks.push("its slices lie side by side in one picture (a mosaic): `dcm2niix` takes them apart");
    }
    remarks.into_iter().map(str::to_owned).collect()
}
