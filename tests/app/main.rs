//! The real window, driven without a display: pointer, keys and widgets by their names.

mod cuts;
mod editor;
mod export;
mod foreign_paths;
mod gestures;
mod harness;
mod keep_balanced;
mod lights;
mod names;
mod opening;
mod panels;
mod sessions;
mod snapshots;
mod thresholds;
mod views;
