//! What holds the window together: start, picture, menu, history, messages, the balance
//! that is kept.

pub(super) mod execute;
pub(super) mod history;
pub(super) mod icon;
pub(super) mod keep_balanced;
pub(super) mod menu;
pub(super) mod messages;
pub(super) mod opening;
pub(super) mod picture;
pub(super) mod session;
pub(super) mod start;
pub(super) mod status;
pub(super) mod status_file;
