//! What is read back: pictures of any size, light volumes, and figures about what the renderer keeps.

pub(super) mod pictures;
pub(super) mod statistics;
#[cfg(feature = "testing")]
mod testing;
pub(super) mod tiled;
