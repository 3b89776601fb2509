//! Readback of pictures of any size and of light volumes, and statistics of the renderer.

pub(super) mod part_pages;
pub(super) mod pictures;
pub(super) mod statistics;
#[cfg(feature = "testing")]
mod test_hooks;
pub(super) mod tiled;
