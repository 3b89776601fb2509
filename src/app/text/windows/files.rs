//! Texts of file dialogs, and errors of files of settings and transfer functions.

use std::fmt::Display;
use std::path::Path;

/// Wording of a request for a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct FileRequest {
    /// Title of the desktop's file dialog, and of the window for typing a path.
    pub title: &'static str,
    /// Hint in the empty field of the typing window.
    pub hint: &'static str,
    /// Caption of the confirming button of the typing window.
    pub verb: &'static str,
}

pub(crate) const OPEN_VOLUME: FileRequest = FileRequest {
    title: "Open volume",
    hint: "a volume, a folder of slices, or builtin:chair",
    verb: "Open",
};
pub(crate) const OPEN_FOLDER: FileRequest = FileRequest {
    title: "Open a folder of slices",
    hint: "a folder of DICOM files or pictures",
    verb: "Open",
};
pub(crate) const ADD_LAYER: FileRequest =
    FileRequest { title: "Show another volume as a layer", verb: "Add", ..OPEN_VOLUME };
pub(crate) const VOLUME_OF_LOOK: FileRequest =
    FileRequest { title: "Open the volume of the look", ..OPEN_VOLUME };
pub(crate) const LOAD_SETTINGS: FileRequest = FileRequest {
    title: "Load session or settings",
    hint: "a .json file, or an exported .png, .exr, .gif or .mp4",
    verb: "Load",
};
pub(crate) const COMPARE_SETTINGS: FileRequest =
    FileRequest { title: "Compare with settings", hint: LOAD_SETTINGS.hint, verb: "Compare" };
pub(crate) const SAVE_SETTINGS: FileRequest =
    FileRequest { title: "Save session", hint: "a .json file", verb: "Save" };
pub(crate) const OPEN_ENVIRONMENT_MAP: FileRequest = FileRequest {
    title: "Light from environment map",
    hint: "a panorama of all directions: .hdr, .exr, .png, .jpg",
    verb: "Use",
};
/// File filter for environment maps.
pub(crate) const ENVIRONMENT_MAPS: &str = "Panoramas";
pub(crate) const IMPORT_TRANSFER: FileRequest = FileRequest {
    title: "Import transfer function",
    hint: "ParaView, AGAVE .json, Slicer .vp, Inviwo .itf, Voreen .tfi, MRIcroGL .clut, ImageJ .lut",
    verb: "Import",
};
pub(crate) const EXPORT_TRANSFER: FileRequest = FileRequest {
    title: "Export transfer function",
    hint: "ParaView .json, Slicer .vp or .vp.json, Inviwo .itf, MRIcroGL .clut, ImageJ .lut, \
           .preset.json of this program",
    verb: "Write",
};
pub(crate) const EXPORT_PICTURE: FileRequest = FileRequest {
    title: "Export picture",
    hint: ".png or .exr for a picture; .png, .gif, .mp4 or a folder for a turntable",
    verb: "Use",
};
pub(crate) const EXPORT_CONTACT_SHEET: FileRequest =
    FileRequest { title: "Contact sheet of saved views and looks", hint: "a .png file", verb: "Export" };
pub(crate) const EXPORT_LIGHT: FileRequest = FileRequest {
    title: "Export light volume",
    hint: "a .nrrd file for the volume, a .png file for the slice",
    verb: "Export",
};

/// Message while a file dialog is already open.
pub(crate) const DIALOG_IS_OPEN: &str = "A file dialog is open already; close that one first";

/// Button that confirms overwriting a file.
pub(crate) const REPLACE: &str = "Replace";

/// Question before an existing file is overwritten.
pub(crate) fn overwrite_question(file: &Path) -> String {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    format!("{name} already exists. Replace it?")
}

/// Names of file filters in the desktop's dialog.
pub(crate) const VOLUMES: &str = "Volumes";
pub(crate) const ALL_FILES: &str = "All files";
pub(crate) const SETTINGS_AND_PICTURES: &str = "Settings and pictures";
pub(crate) const SETTINGS: &str = "Settings";
pub(crate) const TRANSFER_FUNCTIONS: &str = "Transfer functions";
pub(crate) const PICTURES: &str = "Pictures";
pub(crate) const LIGHT_VOLUME: &str = "Light volume";
pub(crate) const SLICE: &str = "Slice";

/// Message after reading a file was cancelled.
pub(crate) const READING_CANCELLED: &str = "Reading was cancelled";

/// Error when the reader thread cannot be spawned.
pub(crate) fn no_thread(err: impl Display) -> String {
    format!("could not start the thread that reads files: {err}")
}

/// Label of the field for typing a path.
pub(crate) const PATH: &str = "Path";

/// Error for a picture without embedded settings.
pub(crate) fn no_settings(picture: &Path) -> String {
    format!("the picture contains no settings ({}); pictures exported by this program do", picture.display())
}

/// Error when a settings file cannot be read.
pub(crate) fn settings_not_read(file: &Path, err: impl Display) -> String {
    format!("could not read the settings: {err} ({})", file.display())
}

/// Error when a settings file was read but is invalid.
pub(crate) fn settings_invalid(file: &Path, err: impl Display) -> String {
    format!("could not use the settings: {err} ({})", file.display())
}

/// Error when another program's transfer function cannot be read.
pub(crate) fn transfer_not_read(file: &Path, err: impl Display) -> String {
    format!("could not read the transfer function: {err} ({})", file.display())
}

/// Error when another program's transfer function was read but is invalid.
pub(crate) fn transfer_invalid(file: &Path, err: impl Display) -> String {
    format!("could not use the transfer function: {err} ({})", file.display())
}
