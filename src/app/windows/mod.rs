//! Windows over the main window: export, files, slices, contact sheet, help.

pub(super) mod chooser;
pub(super) mod contact_sheet;
pub(super) mod export;
pub(super) mod files;
pub(super) mod foreign_path;
pub(super) mod help;
pub(super) mod light_slice;
pub(super) mod lost_again;
pub(super) mod palette;
pub(super) mod quit;
pub(super) mod raw_dialog;
pub(super) mod recovery;
pub(super) mod roomy;
pub(super) mod slices;
