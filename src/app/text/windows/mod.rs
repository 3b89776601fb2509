//! Texts of tool windows and dialogs.

pub(crate) mod chooser;
pub(crate) mod contact_sheet;
pub(crate) mod export;
pub(crate) mod files;
pub(crate) mod foreign_path;
pub(crate) mod help;
pub(crate) mod large_volume;
pub(crate) mod light_volume;
pub(crate) mod palette_synonyms;
pub(crate) mod raw;
pub(crate) mod slices;
