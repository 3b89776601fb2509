//! Output stages, from linear light to files and screens: tiles, samples, previews, downsampled volumes, the window,
//! other programs.

mod antialiasing;
mod dither;
mod downsampled;
mod painter;
mod preview;
mod tiles;
mod tone_map;
mod window;
