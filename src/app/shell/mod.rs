//! Shell of the window: picture, menu, status bar, history, session, messages and automatic balance.

pub(super) mod auto_balance;
mod easing;
pub(super) mod execute;
pub(super) mod file_tasks;
pub(super) mod history;
pub(super) mod light_placement;
pub(super) mod menu;
pub(super) mod messages;
pub(super) mod object;
pub(super) mod opening;
pub(super) mod picture_area;
pub(super) mod session;
pub(super) mod status;
pub(super) mod status_file;
