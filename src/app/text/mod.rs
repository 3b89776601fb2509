//! All texts of the window in one place, for proofreading and translation.
//!
//! One file per part of the window. Plain texts are constants; texts with figures in them are functions, because
//! other languages put the figures elsewhere. Fonts and colours are chosen where a text is shown. The names of
//! presets, colour maps, views and light rigs are with these in `src/model`; errors have their messages where they
//! are defined.

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

/// Name of a control, with its tooltip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Named {
    /// Label beside or on the control; also its accessible name for screen readers.
    pub name: &'static str,
    /// Tooltip: a sentence without a full stop.
    pub tip: &'static str,
}

/// Makes a [`Named`] in a constant expression.
const fn named(name: &'static str, tip: &'static str) -> Named {
    Named { name, tip }
}
