//! Stored settings: presets, sessions, the preset library, and the records embedded in exported images.

pub(super) mod bounds;
mod kept_entries;
pub(super) mod library;
pub(super) mod made_by;
pub(super) mod path_text;
pub(super) mod place;
pub(super) mod preset;
pub(super) mod preset_error;
pub(super) mod record;
mod renames;
mod schemas;
mod unknown;
