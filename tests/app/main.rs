//! Tests of the real window without a display: pointer and keyboard events, and widgets found by their names.

mod accessibility;
mod clipping;
mod editor;
mod files;
mod gestures;
mod harness;
mod keep_balanced;
mod lights;
mod looks;
mod orientation;
mod panels;
mod snapshots;
mod thresholds;
mod views;
