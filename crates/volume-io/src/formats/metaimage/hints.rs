//! Hints on the values of a `MetaImage`: from its own fields, and from DICOM attributes by their tags, which ITK
//! programs write beside them.

use super::header::MetaImageHeader;
use chiaroscuro_volume::{Modality, ValueMetadata};

/// Collects the hints that a header gives on its values.
pub(super) fn hints_from_header(header: &MetaImageHeader) -> ValueMetadata {
    let text = |name| header.get(name).unwrap_or_default();
    let (modality, comment) = (text("Modality"), text("Comment"));
    let known = [
        Modality::from_code(modality.strip_prefix("MET_MOD_").unwrap_or(modality)),
        Modality::from_code(text("0008|0060")),
        Modality::from_description(comment),
    ];
    let modality = known.into_iter().find(|&modality| modality != Modality::Unknown).unwrap_or_default();
    let mut hints = ValueMetadata::default();
    hints.modality = modality;
    hints.set_acquisition(comment);
    hints.set_acquisition(text("0008|103e"));
    hints.set_unit(text("0028|1054"));
    // The padding value is stored in the scanner's numbers, while voxels are rescaled if the header gives a slope and
    // intercept (PS3.3, C.7.5.1.1.2, C.11.1).
    if let Some(stored) = header.number("0028|0120") {
        let slope = header.number("0028|1053").unwrap_or(1.0);
        hints.set_padding(slope * stored + header.number("0028|1052").unwrap_or(0.0));
    }
    // Only the first of several windows is used.
    let first = |name| text(name).split('\\').next()?.trim().parse::<f64>().ok();
    if let (Some(center), Some(width)) = (first("0028|1050"), first("0028|1051")) {
        hints.set_window(center - width / 2.0, center + width / 2.0);
    }
    hints
}
