//! Hints on the values of an NRRD file: from the fields `sample units`, `content`, `old min` and `old max`, and from
//! keys that programs add: 3D Slicer's segments, and DICOM attributes by their tags.

use super::header::NrrdHeader;
use chiaroscuro_volume::{MAX_LABELS, Modality, ValueMeaning, ValueMetadata};

/// Keys of the modality, in order of preference.
const MODALITY: [&str; 3] = ["modality", "DICOM_0008_0060", "DICOM.Modality"];

/// Keys of the padding value (of unmeasured voxels), in the numbers of the file.
const PADDING: [&str; 2] = ["padding value", "PaddingValue"];

/// Keys of DICOM's padding value, in the scanner's stored numbers. If the header gives a rescale slope and intercept,
/// the voxels of the file are already rescaled (PS3.3, C.7.5.1.1.2 and C.11.1).
const STORED_PADDING: [&str; 2] = ["PixelPaddingValue", "DICOM_0028_0120"];
const RESCALE_SLOPE: [&str; 2] = ["RescaleSlope", "DICOM_0028_1053"];
const RESCALE_INTERCEPT: [&str; 2] = ["RescaleIntercept", "DICOM_0028_1052"];

/// Keys of descriptions of the acquisition: free text, of the series, of the protocol.
const ACQUISITION: [&str; 4] = ["acquisition", "SeriesDescription", "DICOM_0008_103E", "DICOM_0018_1030"];

/// Keys of the display window: centre and width (PS3.3, C.11.2.1.2).
const WINDOW_CENTER: [&str; 2] = ["DICOM_0028_1050", "WindowCenter"];
const WINDOW_WIDTH: [&str; 2] = ["DICOM_0028_1051", "WindowWidth"];

/// Key in which DICOM names the unit of rescaled values.
const RESCALE_TYPE: &str = "DICOM_0028_1054";

/// Keys by which Slicer marks segmentations; older versions write the second.
const SEGMENTATION: [&str; 4] = [
    "Segmentation_ContainedRepresentationNames",
    "containedRepresentationNames",
    "Segmentation_MasterRepresentation",
    "Segmentation_SourceRepresentation",
];

impl NrrdHeader {
    /// Collects the hints that the header gives on its values.
    pub(super) fn hints(&self) -> ValueMetadata {
        let mut hints = ValueMetadata::default();
        let first = |keys: &[&str]| keys.iter().find_map(|key| self.get_key(key)).unwrap_or_default();
        let content = self.get("content").unwrap_or_default();
        hints.modality = match Modality::from_code(first(&MODALITY)) {
            Modality::Unknown => Modality::from_description(content),
            known => known,
        };
        hints.is_rescaled = self.get("old min").or_else(|| self.get("old max")).is_some();
        self.add_segments(&mut hints);
        let is_segmentation = hints.modality == Modality::Segmentation
            || SEGMENTATION.iter().any(|key| self.get_key(key).is_some());
        if is_segmentation || !hints.labels.is_empty() {
            hints.meaning = ValueMeaning::Labels;
        }
        for unit in [self.get("sample units"), self.get_key(RESCALE_TYPE)].into_iter().flatten() {
            hints.set_unit(unit.trim_matches(['"', ' ']));
        }
        let number = |keys: &[&str]| first(keys).trim().parse::<f64>().ok();
        let rescaled = |stored: f64| {
            number(&RESCALE_SLOPE).unwrap_or(1.0) * stored + number(&RESCALE_INTERCEPT).unwrap_or(0.0)
        };
        if let Some(padding) = number(&PADDING).or_else(|| number(&STORED_PADDING).map(rescaled)) {
            hints.set_padding(padding);
        }
        // Only the first of several windows is used.
        let first_number = |keys: &[&str]| first(keys).split('\\').next()?.trim().parse::<f64>().ok();
        if let (Some(center), Some(width)) = (first_number(&WINDOW_CENTER), first_number(&WINDOW_WIDTH)) {
            hints.set_window(center - width / 2.0, center + width / 2.0);
        }
        hints.set_acquisition(first(&ACQUISITION));
        hints
    }

    /// Adds Slicer's segments: `Segment0_LabelValue:=1`, `Segment0_Name:=…`, `Segment0_Color:=0.5 0.7 0.5`. Segments
    /// of layers other than the first are skipped, as those layers are not read.
    fn add_segments(&self, hints: &mut ValueMetadata) {
        for index in 0..MAX_LABELS {
            let part = |part: &str| self.get_key(&format!("Segment{index}_{part}"));
            let (value, name) = (part("LabelValue"), part("Name"));
            if value.is_none() && name.is_none() && part("ID").is_none() {
                break;
            }
            if part("Layer").is_some_and(|layer| layer.trim() != "0") {
                continue;
            }
            // Before layers existed, the label value was that of the segment's position.
            let number = value.map_or_else(|| Some(index as i64 + 1), |value| value.trim().parse().ok());
            if let Some(number) = number {
                hints.labels.insert(number, name.unwrap_or_default(), part("Color").and_then(parse_color));
            }
        }
    }
}

/// Parses three numbers as an sRGB colour.
fn parse_color(text: &str) -> Option<[f32; 3]> {
    let parts: Option<Vec<f32>> = text.split_whitespace().map(|part| part.parse().ok()).collect();
    parts?.try_into().ok()
}
