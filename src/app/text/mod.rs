//! What the window says, in one place: for whoever reads it all at once, corrects or translates it.
//!
//! One file per part of the window. Plain texts are constants; texts with figures in them are functions,
//! because other languages put the figures elsewhere. The look of a text stays where it is shown. The names of
//! presets, colour maps, views and sets of lights are with them in `src/model`; errors word themselves.

pub(super) mod camera;
pub(super) mod commands;
pub(super) mod common;
pub(super) mod compared;
pub(super) mod contact_sheet;
pub(super) mod cut_handles;
pub(super) mod cuts;
pub(super) mod data;
pub(super) mod export;
pub(super) mod files;
pub(super) mod floor;
pub(super) mod help;
pub(super) mod light_volume;
pub(super) mod lights;
pub(super) mod marks;
pub(super) mod menu;
pub(super) mod messages;
pub(super) mod opening;
pub(super) mod picture;
pub(super) mod probe;
pub(super) mod raw;
pub(super) mod sampling;
pub(super) mod sections;
pub(super) mod shading;
pub(super) mod shadows;
pub(super) mod slices;
pub(super) mod status;
pub(super) mod transfer;
pub(super) mod work;

/// A control's name, and what a pointer resting on it is told.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Named {
    /// Beside the control or on it; also what screen readers call it.
    pub name: &'static str,
    /// A sentence without a full stop.
    pub tip: &'static str,
}

/// A name and its tip.
const fn named(name: &'static str, tip: &'static str) -> Named {
    Named { name, tip }
}
