//! Folders that are an unsupported format of their own.

use std::path::Path;

use super::UnsupportedFormat;

/// Folder formats, each with files that only such a folder has.
const FOLDERS: &[(&[&str], UnsupportedFormat)] = &[
    (
        &[".zattrs", ".zgroup", ".zarray", ".zmetadata", "zarr.json"],
        UnsupportedFormat {
            what: "a Zarr folder, as OME-Zarr images are",
            marks: &[],
            endings: &[],
            help: "save an array of it: python -c \"import zarr, numpy; \
                   numpy.save('OUT.npy', zarr.open('FOLDER', mode='r')['0'][:])\"",
        },
    ),
    (
        &["attributes.json"],
        UnsupportedFormat {
            what: "an N5 folder",
            marks: &[],
            endings: &[],
            help: "open it in Fiji (File > Import > HDF5/N5/Zarr/OME-NGFF) and save it as TIFF",
        },
    ),
    (
        &["visu_pars", "acqp", "2dseq"],
        UnsupportedFormat {
            what: "a folder of a Bruker scanner (ParaVision)",
            marks: &[],
            endings: &[],
            help: "convert the folder of the study: brkraw tonii FOLDER",
        },
    ),
];

/// Recognises an unsupported format of a folder.
pub(crate) fn of_folder(path: &Path) -> Option<&'static UnsupportedFormat> {
    let is_marked = |names: &[&str]| names.iter().any(|name| path.join(name).is_file());
    FOLDERS.iter().find(|(names, _)| is_marked(names)).map(|(_, format)| format)
}
