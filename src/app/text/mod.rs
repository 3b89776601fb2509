//! What the window says, in one place: for whoever reads it all at once, corrects or translates it.
//!
//! One file per part of the window. Plain texts are constants; texts with figures in them are functions,
//! because other languages put the figures elsewhere. The look of a text stays where it is shown. The names of
//! presets, colour maps, views and sets of lights are with them in `src/model`; errors word themselves.

pub(super) mod common;
pub(super) mod dock;
pub(super) mod history;
pub(super) mod kept;
mod panels;
mod shell;
pub(super) mod transfer;
mod viewport;
mod windows;
pub(super) mod work;

pub(super) use self::panels::{
    camera, corrections, cuts, data, floor, found, labels, lights, sampling, scattering, sections, shading,
    shadows, sky,
};
pub(super) use self::shell::{changes, commands, memory, menu, messages, opening, status};
pub(super) use self::viewport::{compared, cut_handles, picture, probe};
pub(super) use self::windows::{
    chooser, contact_sheet, export, files, foreign_path, help, light_volume, palette, raw, roomy, slices,
};

/// A control's name, and its tip.
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
