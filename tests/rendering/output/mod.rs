//! Output stages, from linear light to files and screens: tiles, samples, previews, downsampled volumes, the window,
//! other programs.

mod bands;
mod dither;
mod painter;
mod preview;
mod reduced;
mod tone_map;
mod window;
