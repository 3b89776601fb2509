//! From linear light to what is written and shown: parts, samples, previews, fewer voxels, the
//! window, other programs.

mod bands;
mod dither;
mod painter;
mod preview;
mod reduced;
mod tone_map;
mod window;
