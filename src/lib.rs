//! Chiaroscuro: a viewer for volume data with volumetric shadows. This package is the program: the window and the
//! command line. The layers below it are crates of their own, which import downwards only:
//!
//! | crate | contents |
//! |---|---|
//! | `chiaroscuro-files` | safe reading and writing of files |
//! | `chiaroscuro-codecs` | decoders of pixels: 12-bit JPEG, JPEG-LS |
//! | `chiaroscuro-volume` | volumes: voxels, statistics, bricks, built-ins; spaces and boxes |
//! | `chiaroscuro-volume-io` | readers and writers of volume formats |
//! | `chiaroscuro-scene` | `Settings`, the single value that describes the whole look |
//! | `chiaroscuro-media` | pictures, animations and environment maps in files |
//! | `chiaroscuro-render` | the renderer: plan of a picture's products, passes on the GPU |
//! | `chiaroscuro-reference` | the paper in f64, literal and slow; for tests only |
//! | `chiaroscuro-python` | the package for Python |
//! | `chiaroscuro` | the window (`app`, feature `window`) and the command line (`cli`, feature `cli`) |
//!
//! `examples/` writes a picture to a file and shows a light volume as an array, a turntable, and the renderer inside
//! another wgpu program.

#[cfg(feature = "window")]
pub mod app;
#[cfg(feature = "cli")]
pub mod cli;
