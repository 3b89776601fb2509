//! Hints on the values of a `NIfTI` or Analyze file: modality, unit, window, description, labels.

use super::header::NiftiHeader;
use chiaroscuro_volume::{Modality, ValueMeaning, ValueMetadata};

/// Intents whose numbers are labels (`NIFTI_INTENT_LABEL`, `NIFTI_INTENT_NEURONAME`).
const LABEL_INTENTS: [i32; 2] = [1002, 1003];

/// Collects the hints that a header gives on its values.
pub(super) fn hints_from_header(header: &NiftiHeader) -> ValueMetadata {
    let mut hints = ValueMetadata::default();
    hints.modality = Modality::from_description(&header.descrip);
    if LABEL_INTENTS.contains(&header.intent_code) {
        hints.meaning = ValueMeaning::Labels;
    }
    hints.set_unit(&header.analyze_units[1]);
    hints.set_window(header.cal_min, header.cal_max);
    hints.set_acquisition(&header.descrip);
    hints
}
