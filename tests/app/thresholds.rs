//! How far a picture of the window may be from its snapshot, with reasons.

/// Steps of 255 by which a channel may differ without being seen. Blended edges are rounded on the adapter: one step
/// was seen, of 255, between versions of one driver, and up to four blends lie over each other.
pub(crate) const STEPS: u8 = 8;

/// Pixels that may differ by more: corners of shapes that fall between two pixels. None was seen; the shortest words
/// that can be confused, "x" and "y", differ in more.
pub(crate) const PIXELS: usize = 10;
