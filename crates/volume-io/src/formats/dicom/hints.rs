//! Hints on the values of a DICOM volume, from its header.

use super::header::DicomHeader;
use super::header::segments::{SegmentationType, labels_from_segments};
use super::header::values::DicomValues;
use super::mosaic::is_mosaic;
use super::pixels::layout::{PhotometricKind, PixelLayout, PixelNumber};
use super::slice_layer::DicomSlice;
use chiaroscuro_volume::{Modality, ValueMeaning, ValueMetadata};

impl DicomValues {
    /// Returns the series description, or else the protocol name.
    pub(super) fn description(&self) -> &str {
        let said = [&self.series_description, &self.protocol];
        said.into_iter().find(|text| !text.is_empty()).map_or("", String::as_str)
    }

    /// Returns series description and protocol name, joined if they differ.
    fn acquisition_text(&self) -> String {
        match (self.series_description.as_str(), self.protocol.as_str()) {
            (description, protocol) if description.is_empty() || description == protocol => {
                protocol.to_owned()
            }
            (description, "") => description.to_owned(),
            (description, protocol) => format!("{description}, {protocol}"),
        }
    }

    /// Returns the unit of rescaled values.
    fn unit(&self) -> &str {
        let is_scaled = self.file_plane.slope.or(self.shared_plane.slope).is_some();
        match (self.rescale_type.as_str(), self.units.as_str()) {
            // "US" means "unspecified".
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

/// Collects the hints that a header gives on the values of slices, which share a slope and intercept, or have none.
///
/// `has_masks` tells that the slices are masks of segments, from which labels were made.
pub(super) fn volume_hints(
    found: &DicomValues,
    shape: &PixelLayout,
    slice: &DicomSlice,
    scale: Option<[f64; 2]>,
    has_masks: bool,
) -> ValueMetadata {
    let mut hints = ValueMetadata::default();
    hints.modality = Modality::from_code(&found.modality);
    hints.set_acquisition(&found.acquisition_text());
    if shape.samples > 1 {
        return hints;
    }
    hints.set_unit(found.unit());
    if let ([Some(center), Some(width)], true) = (slice.plane.window, width_is_usable(slice)) {
        // PS3.3 section C.11.2.1.2: a window of width 256 contains 256 values.
        let low = center - 0.5 - (width - 1.0) / 2.0;
        hints.set_window(low, low + width - 1.0);
    }
    if let (Some(padding), Some([slope, intercept]), false) = (stored_padding(found, shape), scale, has_masks)
    {
        hints.set_padding(padding * slope + intercept);
    }
    let is_field = found.segmentation == Some(SegmentationType::Fractional) && !has_masks;
    if hints.modality == Modality::Segmentation && !is_field {
        hints.meaning = ValueMeaning::Labels;
        hints.labels = labels_from_segments(&found.segments);
    }
    hints
}

/// Returns the stored value of unmeasured pixels (Pixel Padding Value).
pub(super) fn stored_padding(found: &DicomValues, shape: &PixelLayout) -> Option<f64> {
    let PixelNumber::Integer(bits) = shape.number else { return None };
    let padding = found.padding?;
    Some(if bits.is_signed { f64::from(padding as i16) } else { f64::from(padding) })
}

/// Names the rule by which one of several overlapping segments is shown.
pub(super) fn overlap_rule(found: &DicomValues) -> &'static str {
    match found.segmentation {
        Some(SegmentationType::Fractional) => "the largest fraction",
        _ => "the highest number",
    }
}

/// Returns the value of a mask pixel that lies entirely in its segment.
pub(super) fn full_mask_value(found: &DicomValues) -> f64 {
    match found.segmentation {
        Some(SegmentationType::Fractional) => f64::from(found.max_fraction.unwrap_or(255)),
        _ => 1.0,
    }
}

fn width_is_usable(slice: &DicomSlice) -> bool {
    slice.plane.window[1].is_some_and(|width| width >= 1.0)
}

/// Flags that tell which part of the images a volume shows.
#[derive(Debug, Clone, Copy)]
pub(super) struct ShownImagePart {
    /// True if the user selected one component of colours.
    pub(super) is_component: bool,
    /// True if the slices were cut out of a mosaic.
    pub(super) is_mosaic_tile: bool,
}

/// Returns remarks for the user on how values are shown.
pub(super) fn remarks(
    header: &DicomHeader,
    shape: &PixelLayout,
    ShownImagePart { is_component, is_mosaic_tile: is_unpacked }: ShownImagePart,
) -> Vec<String> {
    let found = &header.values;
    let mut remarks = Vec::new();
    match shape.colors {
        PhotometricKind::Inverted => {
            remarks.push("high values are meant to be shown dark (MONOCHROME1): they are not inverted");
        }
        PhotometricKind::Palette => {
            remarks.push("its values are indices into a colour table, not brightness");
        }
        PhotometricKind::Rgb | PhotometricKind::YbrFull | PhotometricKind::Ybr422 if !is_component => {
            remarks.push("colours are shown as their luminance");
        }
        PhotometricKind::Grey | PhotometricKind::Rgb | PhotometricKind::YbrFull | PhotometricKind::Ybr422 => {
        }
    }
    if found.has_value_table {
        remarks.push("its Modality LUT (a table of values) is not applied: values are shown as stored");
    }
    if is_mosaic(header) && !is_unpacked {
        remarks.push(
            "its slices lie side by side in one image (a mosaic), and their number is not stated: `dcm2niix` may \
             separate them",
        );
    }
    remarks.into_iter().map(str::to_owned).collect()
}
