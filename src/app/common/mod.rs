//! What all parts of the window share: commands and their keys, colours and sizes, keys for lights, facts of the open volume, long names.

pub(super) mod aspect;
pub(super) mod commands;
pub(super) mod dock;
pub(super) mod elide;
pub(super) mod frame;
pub(super) mod give_up;
pub(super) mod input_pacing;
pub(super) mod light_keys;
pub(super) mod places;
pub(super) mod preset_use;
pub(super) mod reveal;
pub(super) mod shortcuts;
pub(super) mod theme;
pub(super) mod volume_facts;
