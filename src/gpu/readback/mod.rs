//! Readback of pictures of any size and of light volumes, and statistics of the renderer.

pub(super) mod pictures;
pub(super) mod statistics;
#[cfg(feature = "testing")]
mod testing;
pub(super) mod tiled;
