//! What holds the window together: start, commands, history, memory of earlier sessions, messages, menu, theme.

pub(super) mod commands;
pub(super) mod execute;
pub(super) mod history;
pub(super) mod icon;
pub(super) mod light_keys;
pub(super) mod memory;
pub(super) mod menu;
pub(super) mod messages;
pub(super) mod opening;
pub(super) mod start;
pub(super) mod status;
pub(super) mod status_file;
pub(super) mod theme;
pub(super) mod volume_facts;
