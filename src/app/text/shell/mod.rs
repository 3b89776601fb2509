//! Texts of menus, commands, messages and the status bar.

pub(crate) mod change_descriptions;
pub(crate) mod commands;
pub(crate) mod menu;
pub(crate) mod messages;
pub(crate) mod opening;
pub(crate) mod persistence;
pub(crate) mod start_screen;
pub(crate) mod status;
