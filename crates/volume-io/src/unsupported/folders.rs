//! Folders that are an unsupported format of their own.

use std::path::Path;

use super::UnsupportedFormat;

/// Folder formats, each with files that only such a folder has.
pub(super) const FOLDERS: &[(&[&str], UnsupportedFormat)] = &[
    (
        &["attributes.json"],
        UnsupportedFormat {
            description: "an N5 folder",
            signatures: &[],
            extensions: &[],
            advice: "open it in Fiji (File > Import > HDF5/N5/Zarr/OME-NGFF) and save it as TIFF",
        },
    ),
    (
        &["visu_pars", "acqp", "2dseq"],
        UnsupportedFormat {
            description: "a folder of a Bruker scanner (ParaVision)",
            signatures: &[],
            extensions: &[],
            advice: "convert the folder of the study: brkraw tonii FOLDER",
        },
    ),
];

/// Recognises an unsupported format of a folder.
pub(crate) fn unsupported_folder(path: &Path) -> Option<&'static UnsupportedFormat> {
    let is_marked = |names: &[&str]| names.iter().any(|name| path.join(name).is_file());
    FOLDERS.iter().find(|(names, _)| is_marked(names)).map(|(_, format)| format)
}
