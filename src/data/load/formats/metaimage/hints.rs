//! What a header says of its values: the fields of `MetaImage`, and DICOM attributes by their tags, which programs of ITK
//! write beside them.

use super::header::Header;
use crate::data::{Hints, Modality};

/// The hints of a header.
pub(super) fn of(header: &Header) -> Hints {
    let text = |name| header.get(name).unwrap_or_default();
    let (modality, comment) = (text("Modality"), text("Comment"));
    let known = [
        Modality::of_code(modality.strip_prefix("MET_MOD_").unwrap_or(modality)),
        Modality::of_code(text("0008|0060")),
        Modality::of_description(comment),
    ];
    let modality = known.into_iter().find(|&modality| modality != Modality::Unknown).unwrap_or_default();
    let mut hints = Hints::default();
    hints.modality = modality;
    hints.set_acquisition(comment);
    hints.set_acquisition(text("0008|103e"));
    hints.set_unit(text("0028|1054"));
    hints
}
