//! Shell of the window: editor of the look, opening of files, commands, menu, picture area, status bar and messages.

pub(super) mod execute;
pub(super) mod history;
pub(super) mod look_editor;
pub(super) mod menu;
pub(super) mod messages;
pub(super) mod opening;
pub(super) mod picture_area;
mod recent_files;
pub(super) mod start_screen;
pub(super) mod status;
pub(super) mod status_file;
pub(super) mod time_series;
pub(super) mod tool_windows;
