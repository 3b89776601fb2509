//! Shared parts of the window: commands, shortcuts, theme, docked tools, and facts about the open volume.
//!
//! Further: revealing of settings, keyboard control of lights, pacing of input, and elision of names.

pub(super) mod alternatives;
pub(super) mod commands;
pub(super) mod dock;
pub(super) mod drag_cancel;
pub(super) mod elide;
pub(super) mod input_pacing;
pub(super) mod light_keys;
pub(super) mod overlay_windows;
pub(super) mod preset_match;
pub(super) mod reveal;
pub(super) mod searchable_settings;
pub(super) mod shortcuts;
pub(super) mod theme;
pub(super) mod volume_facts;
