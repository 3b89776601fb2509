//! Modules import downwards only (the table in `src/lib.rs`), and no two of a folder import each other; the window
//! library stays in the window and the GPU library in the renderer; files say what they are and stay short, and
//! folders can be taken in at a glance.

mod advisories;
mod circles;
mod disk;
mod form;
mod layers;
mod paths;
mod sources;
mod tokens;
