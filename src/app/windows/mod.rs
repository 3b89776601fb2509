//! Windows over the main window: export, files, slices, contact sheet, help.

pub(super) mod contact_sheet;
pub(super) mod device_loss;
pub(super) mod export;
pub(super) mod file_dialogs;
pub(super) mod help;
pub(super) mod large_volume;
pub(super) mod light_slice;
pub(super) mod palette;
pub(super) mod quit_dialog;
pub(super) mod raw_dialog;
pub(super) mod recovery;
pub(super) mod slices;
pub(super) mod untrusted_path;
pub(super) mod volume_chooser;
