//! Texts of menus, commands, messages and the status bar.

pub(in crate::app) mod changes;
pub(in crate::app) mod commands;
pub(in crate::app) mod memory;
pub(in crate::app) mod menu;
pub(in crate::app) mod messages;
pub(in crate::app) mod opening;
pub(in crate::app) mod status;
