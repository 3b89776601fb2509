//! Hints on the values of a `NIfTI` or Analyze file: modality, unit, window, description, labels.

use super::header::Header;
use crate::data::{Hints, Meaning, Modality};

/// Intents whose numbers are labels (`NIFTI_INTENT_LABEL`, `NIFTI_INTENT_NEURONAME`).
const LABEL_INTENTS: [i32; 2] = [1002, 1003];

/// Collects the hints that a header gives on its values.
pub(super) fn of(header: &Header) -> Hints {
    let mut hints = Hints::default();
    hints.modality = Modality::of_description(&header.descrip);
    if LABEL_INTENTS.contains(&header.intent_code) {
        hints.meaning = Meaning::Labels;
    }
    hints.set_unit(&header.words[1]);
    hints.set_window(header.cal_min, header.cal_max);
    hints.set_acquisition(&header.descrip);
    hints
}
