//! Tolerances of the snapshots of the window, with their reasons.

/// Difference of a channel that is not visible, in 255ths. Blended edges are rounded on the adapter: one step of 255
/// was seen between versions of one driver, and up to four blends overlap.
pub(crate) const MAX_CHANNEL_STEPS: u8 = 8;

/// Number of pixels that may differ by more: corners of shapes that fall between two pixels. None was seen; the
/// shortest words that can be confused, "x" and "y", differ in more.
pub(crate) const MAX_DIFFERENT_PIXELS: usize = 10;
