//! Texts of tool windows and dialogs.

pub(in crate::app) mod chooser;
pub(in crate::app) mod contact_sheet;
pub(in crate::app) mod export;
pub(in crate::app) mod files;
pub(in crate::app) mod foreign_path;
pub(in crate::app) mod help;
pub(in crate::app) mod light_volume;
pub(in crate::app) mod palette;
pub(in crate::app) mod raw;
pub(in crate::app) mod roomy;
pub(in crate::app) mod slices;
