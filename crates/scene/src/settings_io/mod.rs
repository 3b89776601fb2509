//! Stored settings: presets, sessions, the preset library, and the records embedded in exported images.

pub(super) mod json_limits;
mod layer_fields;
mod merge;
pub(super) mod path_encoding;
pub(super) mod preset_error;
pub(super) mod preset_json;
pub(super) mod preset_library;
pub(super) mod record;
mod renames;
mod saved_entries;
mod schema_defaults;
mod unknown_content;
pub(super) mod volume_location;
